"""Definitions as oracles are given them."""

from __future__ import annotations

import difflib
from dataclasses import dataclass, field

from firm_hdl.frontend.names import Kind
from firm_hdl.frontend.sources import Language
from firm_hdl.model import Dialect

__all__ = ["DefinitionCase"]


@dataclass(frozen=True, slots=True, kw_only=True)
class DefinitionCase:
    """One definition to judge.

    Attributes
    ----------
    kind : "msg", "srv" or "action"
        What it defines, and the name of the folder that it is in.
    language : "msg", "srv", "action" or "idl"
        What it is written in, and how the file's name ends.
    text : str
        All of it, line ends as they are.
    source : str
        Where it is: the name of a file, or of a text that comes with firm-hdl.
    before : str or None
        If `text` is another one than the file's: that of the file.
    included : tuple of str
        In IDL, the texts of the files that it includes, and of those that they do.
    """

    dialect: Dialect
    package: str
    kind: Kind
    name: str
    language: Language
    text: str
    source: str = field(default="", compare=False)
    before: str | None = None
    included: tuple[str, ...] = ()

    @property
    def is_changed(self) -> bool:
        """Whether the text is another one than the file's."""
        return self.before is not None

    @property
    def changes(self) -> list[str]:
        """Lines that a change took away (``-``) and put in (``+``)."""
        lines = difflib.unified_diff(
            (self.before or "").splitlines(), self.text.splitlines(), lineterm="", n=0
        )
        return [repr(line)[1:-1] for line in list(lines)[2:] if not line.startswith("@@")]

    @property
    def full_name(self) -> str:
        """Name of the type, in which ROS 1 does not say the kind."""
        middle = f"{self.kind}/" if self.dialect == "ros2" else ""
        return f"{self.package}/{middle}{self.name}"

    @property
    def spelled_name(self) -> str:
        """Name of the type as the command takes it for any dialect and kind."""
        return f"{self.package}/{self.kind}/{self.name}"

    @property
    def file(self) -> str:
        """Name of the file."""
        return f"{self.name}.{self.language}"
