"""The description of an attack: a folder, a command line, and the expected end."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

__all__ = ["Attack", "files"]


def _nothing(root: Path) -> None:
    pass


@dataclass(frozen=True, slots=True, kw_only=True)
class Attack:
    """One command line in one folder.

    Attributes
    ----------
    name : str
    argv : tuple of str
    make : callable
        Fills the folder in which the command runs.
    fails : bool or None
        Whether it must end with status 1 or 2, or with 0; `None`: either.
    says : str
        Text that standard error must contain.
    changes : tuple of str
        Files, by their paths there, that the command may change.
    """

    name: str
    argv: tuple[str, ...]
    make: Callable[[Path], None] = _nothing
    fails: bool | None = None
    says: str = ""
    changes: tuple[str, ...] = ()


def files(texts: Mapping[str, str | bytes]) -> Callable[[Path], None]:
    """Make a function that writes files, given by their paths."""

    def make(root: Path) -> None:
        for name, text in texts.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text.encode() if isinstance(text, str) else text)

    return make
