"""Facts of the manifest that all packaging files need."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

__all__ = ["Manifest", "own_files", "remark", "shared_packages", "version"]

Manifest = Mapping[str, Any]


def remark(manifest: Manifest) -> str:
    """Return the message and its options, for a comment."""
    inputs = manifest["inputs"]
    options = inputs["options"]
    return (
        f"{inputs['message']} ({inputs['distro']}, {options['wire']}, "
        f"bus of {options['bus_bytes']} bytes)"
    )


def version(manifest: Manifest) -> str:
    """Return the version of firm-hdl that made the files."""
    return str(manifest["inputs"]["generator"]["firm-hdl"])


def shared_packages(manifest: Manifest) -> list[Manifest]:
    """Return the packages that have the same text in the folders of all messages that need them."""
    return list(manifest["vhdl"]["shared_packages"])


def own_files(files: Iterable[str], section: Manifest) -> list[str]:
    """Return the files that no other folder has."""
    others = {*section["common_files"], *(p["file"] for p in section.get("shared_packages", ()))}
    return [file for file in files if file not in others]
