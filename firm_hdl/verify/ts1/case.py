"""Definitions in the form that oracles get."""

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
        The kind of interface that is defined, and the name of the folder of the file.
    language : "msg", "srv", "action" or "idl"
        The language of the definition, and the suffix of the file's name.
    text : str
        The whole text, with its own line ends.
    source : str
        The name of the file, or of a text that comes with firm-hdl.
    before : str or None
        The original text of the file, if `text` was changed.
    included : tuple of str
        For IDL, the texts of all files that are included, directly or by other included files.
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
        """Whether the text differs from that of the file."""
        return self.before is not None

    @property
    def changes(self) -> list[str]:
        """Lines that a change has removed (``-``) and added (``+``)."""
        lines = difflib.unified_diff(
            (self.before or "").splitlines(), self.text.splitlines(), lineterm="", n=0
        )
        return [repr(line)[1:-1] for line in list(lines)[2:] if not line.startswith("@@")]

    @property
    def full_name(self) -> str:
        """Name of the type. In ROS 1, it does not contain the kind."""
        middle = f"{self.kind}/" if self.dialect == "ros2" else ""
        return f"{self.package}/{middle}{self.name}"

    @property
    def spelled_name(self) -> str:
        """Name of the type in the form that the command accepts for any dialect and kind."""
        return f"{self.package}/{self.kind}/{self.name}"

    @property
    def file(self) -> str:
        """Name of the file."""
        return f"{self.name}.{self.language}"
