"""rosbags as an oracle: it reads ``.msg``, and computes type hashes.

rosbags is right about bytes, but reads definitions in its own way. Its known differences from ROS
are in `firm_hdl.verify.ts1.known`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from importlib import metadata
from typing import Any, ClassVar

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore

from firm_hdl.model import Dialect
from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.facts import Facts
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Answer, NotJudged, Oracle, Refused

__all__ = ["Rosbags"]

# rosbags has the names of ROS 2 for the builtin types of ROS 1.
_TIMES = {"builtin_interfaces/msg/Time": "time", "builtin_interfaces/msg/Duration": "duration"}
_OWN_TIME = re.compile(r"(?m)^[ \t]*builtin_interfaces/(?:Time|Duration)\b")


class Rosbags(Oracle):
    """rosbags: structure of messages, and in ROS 2 their hashes."""

    name = "rosbags"
    languages: ClassVar = {"ros1": frozenset({"msg"}), "ros2": frozenset({"msg"})}
    judges_changes = False
    changes_needs = True

    _last: tuple[tuple[str, list[str]], Answer] | None = None

    def missing(self) -> str | None:
        return None

    def version(self) -> str:
        return metadata.version("rosbags")

    def judge(self, cases: Sequence[DefinitionCase]) -> Iterator[Answer]:
        for case in cases:
            yield self.judge_changed(case, lambda case: case)

    def judge_changed(
        self, case: DefinitionCase, change: Callable[[DefinitionCase], DefinitionCase]
    ) -> Answer:
        try:
            return self._judge(case, change)
        except RecursionError:
            return NotJudged("it is nested too deeply for rosbags")
        except _UnreadableError as error:
            return NotJudged(str(error))
        # Assertions of the parser and code for hashes may raise anything.
        except Exception as error:
            why = " ".join(str(error).split())[-300:]
            is_meant = isinstance(error, TypesysError)
            return Refused(why if is_meant else f"{type(error).__name__} {why}")

    def _judge(
        self, case: DefinitionCase, change: Callable[[DefinitionCase], DefinitionCase]
    ) -> Answer:
        found: dict[str, Any] = {}
        texts: list[str] = []
        missing = self._read(case, found, lambda case: _collected(change(case), texts))
        if missing is not None:
            return Refused(f"{missing} is not there")
        if self._last is not None and self._last[0] == (case.full_name, texts):
            # The texts are the same as in the last question.
            return self._last[1]
        answer = self._answer(case, found)
        self._last = (case.full_name, texts), answer
        return answer

    def _answer(self, case: DefinitionCase, found: dict[str, Any]) -> Answer:
        full = f"{case.package}/msg/{case.name}"
        if _contains_itself(full, found):
            return Refused(f"{full} contains itself")
        constants, fields = found[full]
        facts: Facts = {"structure": {case.full_name: _message(constants, fields, case.dialect)}}
        if case.dialect == "ros2":
            store = get_typestore(Stores.EMPTY)
            # Leave out constants: rosbags writes them into Python code, which may not be valid.
            # Hashes do not depend on constants.
            store.register({name: ([], fields) for name, (_, fields) in found.items()})
            facts["hash"] = {case.full_name: store.hash_rihs01(full)}
        return Accepted(facts)

    def _read(
        self,
        root: DefinitionCase,
        found: dict[str, Any],
        change: Callable[[DefinitionCase], DefinitionCase],
    ) -> str | None:
        """Read a definition and those that it needs; return the name of a type that is missing."""
        pending = [root]
        while pending:
            case = change(pending.pop())
            if case.dialect == "ros1" and _OWN_TIME.search(case.text):
                raise _UnreadableError("rosbags takes builtin_interfaces/Time for time of ROS 1")
            full = f"{case.package}/msg/{case.name}"
            found[full] = _parsed(case.text, full)
            for need in _needs(found[full][1]):
                if need in found or (case.dialect == "ros1" and need in _TIMES):
                    continue
                needed = self.universe.message_case(*need.split("/msg/"))
                if needed is None:
                    return need
                if needed.language != "msg":
                    raise _UnreadableError(f"it needs {need}, which is written in IDL")
                pending.append(needed)
        return None


@lru_cache(maxsize=1024)
def _parsed(text: str, full: str) -> Any:
    # Most messages need the same Header, and most texts are read several times.
    return get_types_from_msg(text, full)[full]


def _collected(case: DefinitionCase, texts: list[str]) -> DefinitionCase:
    texts.append(case.text)
    return case


class _UnreadableError(Exception):
    """The definition may be correct, but rosbags cannot read it."""


def _contains_itself(full: str, found: dict[str, Any]) -> bool:
    """Whether a message contains itself, or needs a message that contains itself."""
    done: set[str] = set()
    path: dict[str, None] = {}

    def visit(name: str) -> bool:
        if name in path:
            return True
        if name in done or name not in found:
            return False
        path[name] = None
        if any(visit(need) for need in _needs(found[name][1])):
            return True
        del path[name]
        done.add(name)
        return False

    return visit(full)


def _needs(fields: Any) -> Iterator[str]:
    for _, (kind, detail) in fields:
        element, name = (kind, detail) if kind in (Nodetype.NAME, Nodetype.BASE) else detail[0]
        if element == Nodetype.NAME:
            yield str(name)


def _message(constants: Any, fields: Any, dialect: Dialect) -> Facts:
    return {
        "fields": [{"name": name, "type": _type(kind, dialect)} for name, kind in fields],
        "constants": [{"name": name, "type": kind, "value": v} for name, kind, v in constants],
    }


def _type(description: Any, dialect: Dialect) -> str:
    kind, detail = description
    if kind == Nodetype.BASE:
        name, bound = detail
        return f"{name}<={bound}" if bound else str(name)
    if kind == Nodetype.NAME:
        name = str(detail)
        return _TIMES.get(name, name.replace("/msg/", "/")) if dialect == "ros1" else name
    element, count = detail
    if kind == Nodetype.ARRAY:
        return f"{_type(element, dialect)}[{count}]"
    return f"{_type(element, dialect)}[{f'<={count}' if count else ''}]"
