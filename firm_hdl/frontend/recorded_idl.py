"""Split IDL sections of a recording that declare several messages.

ROS has one message per file, and records one section per file. Other writers put all types of a
topic into one section. Here, each struct gets a copy of the section in which the other structs are
replaced by blanks. So constants, typedefs and line numbers stay.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from firm_hdl.frontend.names import KINDS, PARTS, Kind

__all__ = ["structs_of"]

_TEXT_OR_COMMENT = re.compile(r'"(?:[^"\\\n]|\\.)*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
_MARK = re.compile(r"\bmodule\s+(?P<module>\w+)\s*\{|\bstruct\s+(?P<struct>\w+)\s*\{|[{}]")
_EMPTY = re.compile(r"\bmodule\s+\w+\s*\{\s*\}\s*;?")
_SUFFIXES = PARTS["ros2", "srv"] + PARTS["ros2", "action"]


@dataclass(frozen=True, slots=True)
class _Struct:
    """The position of a struct with its annotations, and the modules around it."""

    modules: tuple[str, ...]
    name: str
    start: int
    end: int


def structs_of(text: str) -> dict[tuple[str, Kind, str], str]:
    """Cut a section into texts of one message each, by package, folder and name.

    The result is empty if there is nothing to cut: the section has one message, a service or an
    action.
    """
    found = _find(_blank(text))
    if len(found) < 2 or any(each.name.endswith(_SUFFIXES) for each in found):
        return {}
    texts: dict[tuple[str, Kind, str], str] = {}
    for each in found:
        kind = next((kind for kind in KINDS if each.modules[1:] == (kind,)), None)
        if kind is None:
            return {}
        texts[each.modules[0], kind, each.name] = _isolated(text, each, found)
    return texts


def _blank(text: str) -> str:
    """Replace string literals and comments by blanks; the length stays the same."""
    return _TEXT_OR_COMMENT.sub(lambda match: _blanks(match[0]), text)


def _blanks(text: str) -> str:
    return re.sub(r"[^\n]", " ", text)


def _find(code: str) -> list[_Struct]:
    found: list[_Struct] = []
    scopes: list[tuple[str, str, int]] = []
    for mark in _MARK.finditer(code):
        if mark[0] != "}":
            # The part starts after the previous declaration, so that it includes annotations.
            start = max(code.rfind(sign, 0, mark.start()) for sign in ";{}") + 1
            kind = "module" if mark["module"] else "struct" if mark["struct"] else ""
            scopes.append((kind, mark["module"] or mark["struct"] or "", start))
        elif scopes:
            kind, name, start = scopes.pop()
            if kind == "struct":
                terminator = re.compile(r"\s*;?").match(code, mark.end())
                assert terminator is not None
                modules = tuple(each for what, each, _ in scopes if what == "module")
                found.append(_Struct(modules, name, start, terminator.end()))
    return found


def _isolated(text: str, struct: _Struct, structs: list[_Struct]) -> str:
    for other in structs:
        if other is not struct:
            inside = text[other.start : other.end]
            text = text[: other.start] + _blanks(inside) + text[other.end :]
    code = _blank(text)
    while (empty := _EMPTY.search(code)) is not None:
        start, end = empty.span()
        text = text[:start] + _blanks(text[start:end]) + text[end:]
        code = _blank(text)
    return _with_scopes(text, code, struct, structs)


def _with_scopes(text: str, code: str, struct: _Struct, structs: list[_Struct]) -> str:
    """Write the names of structs in the same module in full, as ROS does."""
    others = (each for each in structs if each is not struct)
    siblings = [each.name for each in others if each.modules == struct.modules]
    if not siblings:
        return text
    name = f"(?:{'|'.join(map(re.escape, siblings))})"
    # As the type of a member, or as the element of a sequence.
    places = re.compile(rf"(?<![\w:]){name}(?=\s+\w+\s*[;,\[])|(?<=<)\s*{name}(?=\s*[>,])")
    for match in reversed([*places.finditer(code)]):
        start = match.end() - len(match[0].lstrip())
        full = "::".join([*struct.modules, text[start : match.end()]])
        text = text[:start] + full + text[match.end() :]
    return text
