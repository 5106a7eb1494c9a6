"""The reader of IDL, with all checks of the front end."""

from __future__ import annotations

from firm_hdl.errors import Diagnostic, Source
from firm_hdl.frontend.idl import read_idl
from firm_hdl.frontend.interfaces import check_members
from firm_hdl.frontend.syntax import MessageSyntax

__all__ = ["read"]


def read(text: str) -> tuple[dict[str, MessageSyntax], list[Diagnostic]]:
    """Read a text as the front end does, with all checks."""
    messages, wrong = read_idl(Source(name="test.idl", text=text), lambda path: None)
    for syntax in messages.values():
        wrong = [*wrong, *check_members(syntax)]
    return messages, wrong
