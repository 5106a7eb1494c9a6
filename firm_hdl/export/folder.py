"""A type's folder: whole or not at all, and with what users have put there."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from firm_hdl.export.manifest import MANIFEST

__all__ = ["is_current", "is_empty", "read_manifest", "replace"]


def read_manifest(folder: Path) -> dict[str, Any] | None:
    """Return a folder's manifest; `None` if firm-hdl did not make the folder."""
    try:
        found = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) and "inputs_sha256" in found else None


def is_empty(folder: Path) -> bool:
    """Tell whether there is a folder, with nothing in it."""
    return folder.is_dir() and next(folder.iterdir(), None) is None


def is_current(folder: Path, inputs: Mapping[str, Any]) -> bool:
    """Tell whether a folder was made of these inputs and has all its files as they were written."""
    found = read_manifest(folder)
    if found is None or found.get("inputs") != inputs:
        return False
    try:
        return all(
            hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest
            for name, digest in found["files"].items()
        )
    except (OSError, KeyError, AttributeError):
        return False


def replace(folder: Path, files: dict[str, str]) -> None:
    """Make a folder have these files; whoever looks sees the old one or the new one."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    staging = folder.with_name(f".{folder.name}.{os.getpid()}.new")
    old = folder.with_name(f".{folder.name}.{os.getpid()}.old")
    try:
        staging.mkdir()
        for name, text in files.items():
            (staging / name).parent.mkdir(exist_ok=True)
            (staging / name).write_text(text, encoding="utf-8", newline="\n")
            if name.endswith(".sh"):
                (staging / name).chmod(0o755)
        if folder.exists():
            _keep_others(folder, staging, files)
            folder.rename(old)
        staging.rename(folder)
    except BaseException:
        if old.exists() and not folder.exists():
            old.rename(folder)
        raise
    finally:
        for leftover in (staging, old):
            with suppress(OSError):
                shutil.rmtree(leftover)


def _keep_others(folder: Path, staging: Path, files: dict[str, str]) -> None:
    """Copy what users have added to a folder."""
    ours = {*files, MANIFEST, *(read_manifest(folder) or {}).get("files", {})}
    shared = {name.partition("/")[0] for name in ours if "/" in name}
    entries = [
        *(entry for entry in folder.iterdir() if entry.name not in shared),
        *(entry for name in sorted(shared) for entry in _entries(folder / name)),
    ]
    for entry in entries:
        name = entry.relative_to(folder).as_posix()
        if name in ours:
            continue
        (staging / name).parent.mkdir(exist_ok=True)
        if entry.is_dir() and not entry.is_symlink():
            shutil.copytree(entry, staging / name, symlinks=True)
        else:
            shutil.copy2(entry, staging / name, follow_symlinks=False)


def _entries(folder: Path) -> list[Path]:
    return list(folder.iterdir()) if folder.is_dir() else []
