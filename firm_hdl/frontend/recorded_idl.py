"""Split IDL sections of a recording that declare several messages.

ROS has one message per file, and records one section per file. Other writers put all types of a
topic into one section. Here, each struct gets a copy of the section in which the other structs are
replaced by blanks. So constants, typedefs and line numbers stay.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from firm_hdl.frontend.names import KINDS, PARTS, Kind

__all__ = ["MAX_COPIED", "structs_of"]

MAX_COPIED = 1 << 25
"""Characters of all copies of the sections of a recording."""

# What is not closed, ends with the line or with the text.
_TEXT_OR_COMMENT = re.compile(r'"(?:[^"\\\n]|\\.)*"?|//[^\n]*|/\*.*?(?:\*/|\Z)', re.DOTALL)
_MARK = re.compile(r"\bmodule\s+(?P<module>\w+)\s*\{|\bstruct\s+(?P<struct>\w+)\s*\{|[{}]")
_EMPTY = re.compile(r"\bmodule\s+\w+\s*\{\s*\}\s*;?")
_END = re.compile(r"\s*;?")
# A type of a member, or the element of a sequence.
_PLACE = re.compile(r"(?<![\w:])(\w+)(?=\s+\w+\s*[;,\[])|(?<=<)\s*(\w+)(?=\s*[>,])")
_SUFFIXES = PARTS["ros2", "srv"] + PARTS["ros2", "action"]
# Modules may be in modules: ROS has a package and a folder.
_MOST_LEVELS = 8


@dataclass(frozen=True, slots=True)
class _Struct:
    """The position of a struct with its annotations, and the modules around it."""

    modules: tuple[str, ...]
    name: str
    start: int
    end: int


def structs_of(text: str, most: int = MAX_COPIED) -> dict[tuple[str, Kind, str], str]:
    """Cut a section into texts of one message each, by package, folder and name.

    The result is empty if there is nothing to cut: the section has one message, a service or an
    action. It is also empty if the copies together would have more than `most` characters.
    """
    found = _find(_blank(text))
    if len(found) < 2 or any(each.name.endswith(_SUFFIXES) for each in found):
        return {}
    if len(found) * len(text) > most:
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
    before = 0
    for mark in _MARK.finditer(code):
        if mark[0] != "}":
            # The part starts after the previous declaration, so that it includes annotations.
            start = max(before, code.rfind(";", before, mark.start()) + 1)
            kind = "module" if mark["module"] else "struct" if mark["struct"] else ""
            scopes.append((kind, mark["module"] or mark["struct"] or "", start))
        elif scopes:
            kind, name, start = scopes.pop()
            if kind == "struct":
                terminator = _END.match(code, mark.end())
                assert terminator is not None
                modules = tuple(each for what, each, _ in scopes if what == "module")
                found.append(_Struct(modules, name, start, terminator.end()))
        before = mark.end()
    return found


def _isolated(text: str, struct: _Struct, structs: list[_Struct]) -> str:
    text = _without(text, [(each.start, each.end) for each in structs if each is not struct])
    code = _blank(text)
    for _ in range(_MOST_LEVELS):
        empty = [match.span() for match in _EMPTY.finditer(code)]
        if not empty:
            break
        text, code = _without(text, empty), _without(code, empty)
    return _with_scopes(text, code, struct, structs)


def _without(text: str, spans: list[tuple[int, int]]) -> str:
    """Replace parts by blanks. A part may be in another one."""
    parts: list[tuple[int, int, str]] = []
    for start, end in sorted(spans):
        if not parts or start >= parts[-1][1]:
            parts.append((start, end, _blanks(text[start:end])))
    return _replaced(text, parts)


def _replaced(text: str, parts: list[tuple[int, int, str]]) -> str:
    """Replace parts, in the order of the text, by others."""
    pieces, position = [], 0
    for start, end, new in parts:
        pieces += [text[position:start], new]
        position = end
    return "".join([*pieces, text[position:]])


def _with_scopes(text: str, code: str, struct: _Struct, structs: list[_Struct]) -> str:
    """Write the names of structs in the same module in full, as ROS does."""
    others = (each for each in structs if each is not struct)
    siblings = {each.name for each in others if each.modules == struct.modules}
    parts = []
    for match in _PLACE.finditer(code):
        name = match[1] or match[2]
        if name in siblings:
            full = "::".join([*struct.modules, name])
            parts.append((match.end() - len(name), match.end(), full))
    return _replaced(text, parts)
