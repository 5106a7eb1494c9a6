"""Readings of IDL texts by rosidl_parser and by firm-hdl, in one form.

Only Debian's own Python finds Debian's ROS packages, so rosidl_parser runs in another process.
"""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

from firm_hdl.errors import Diagnostic, Source
from firm_hdl.frontend.idl import read_idl
from firm_hdl.frontend.interfaces import check_members
from firm_hdl.frontend.syntax import (
    ConstantSyntax,
    FieldSyntax,
    ListSyntax,
    MessageSyntax,
    TypeSyntax,
    ValueSyntax,
)
from tests.tools import need

__all__ = ["describe", "read", "rosidl"]

PYTHON = "/usr/bin/python3"
SCRIPT = Path(__file__).parent / "rosidl_script.py"

IDL_NAMES = {"bool": "boolean", "byte": "octet", "float32": "float", "float64": "double"}


def rosidl(texts: list[str]) -> list[list[dict[str, Any]] | str]:
    """Return the messages that rosidl_parser reads in each text, or its error."""
    probe = [PYTHON, "-c", "import rosidl_parser"]
    has_it = Path(PYTHON).exists() and not subprocess.run(probe, capture_output=True).returncode
    need("rosidl_parser", PYTHON if has_it else None)
    run = subprocess.run(
        [PYTHON, "-I", str(SCRIPT)],
        input=json.dumps(texts),
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(run.stdout)


def read(text: str) -> tuple[dict[str, MessageSyntax], list[Diagnostic]]:
    """Read a text as the front end does, with all checks."""
    messages, wrong = read_idl(Source(name="test.idl", text=text), lambda path: None)
    for syntax in messages.values():
        wrong = [*wrong, *check_members(syntax)]
    return messages, wrong


def describe(messages: dict[str, MessageSyntax]) -> list[dict[str, Any]]:
    """Describe our messages as the script describes those of rosidl_parser."""
    return [
        {
            "name": name,
            "comment": syntax.comment.splitlines(),
            "fields": [
                {
                    "name": member.name.text,
                    "type": _type(member.type),
                    "default": _default(member.default),
                    "unit": member.unit,
                    "comment": member.comment.splitlines(),
                }
                for member in syntax.members
                if isinstance(member, FieldSyntax)
            ],
            "constants": [
                {
                    "name": member.name.text,
                    "type": _type(member.type),
                    "value": member.value.value,
                    "comment": member.comment.splitlines(),
                }
                for member in syntax.members
                if isinstance(member, ConstantSyntax)
            ],
        }
        for name, syntax in messages.items()
    ]


def _default(syntax: ValueSyntax | ListSyntax | None) -> Any:
    if isinstance(syntax, ListSyntax):
        return repr(tuple(item.value for item in syntax.items))
    return None if syntax is None else syntax.value


def _type(syntax: TypeSyntax) -> str:
    text = IDL_NAMES.get(syntax.name, syntax.name)
    if not syntax.is_builtin:
        text = f"{syntax.package}::{syntax.kind}::{text}"
    if syntax.bound is not None:
        text += f"<{syntax.bound.value}>"
    size = "" if syntax.size is None else f"{syntax.size.value}"
    if syntax.array == "array":
        return f"{text}[{size}]"
    if syntax.array == "sequence":
        return f"sequence<{text}{', ' if size else ''}{size}>"
    return text
