"""Folders with packages, made for one test."""

from __future__ import annotations

from pathlib import Path

from firm_hdl.frontend import Library

__all__ = ["errors_of", "library", "make_files"]


def make_files(root: Path, files: dict[str, str]) -> Path:
    """Write files, given by their paths below a folder; line ends stay as they are."""
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode())
    return root


def library(root: Path, files: dict[str, str], dialect: str = "ros2") -> Library:
    """Make a library of ``package/Name`` texts."""
    for name, text in files.items():
        package, base = name.split("/")
        make_files(root, {f"{package}/msg/{base}.msg": text})
    return Library("noetic" if dialect == "ros1" else "lyrical", [root])


def errors_of(error: BaseException, root: Path) -> str:
    """Return the text of an error, with paths as seen from a folder."""
    return str(error).replace(f"{root}/", "")
