"""rosbags as an oracle: it reads ``.msg``, and computes type hashes.

rosbags is right about bytes, but reads definitions in its own way. Its known differences from ROS
are in `firm_hdl.verify.ts1.known`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from importlib import metadata
from typing import Any, ClassVar

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore

from firm_hdl.model import Dialect
from firm_hdl.verify.ts1.facts import Facts
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Answer, NotJudged, Oracle, Refused
from firm_hdl.verify.ts1.universe import DefinitionCase

__all__ = ["Rosbags"]

# rosbags has the names of ROS 2 for the builtin types of ROS 1.
_TIMES = {"builtin_interfaces/msg/Time": "time", "builtin_interfaces/msg/Duration": "duration"}
_OWN_TIME = re.compile(r"(?m)^[ \t]*builtin_interfaces/(?:Time|Duration)\b")


class Rosbags(Oracle):
    """rosbags: structure of messages, and in ROS 2 their hashes."""

    name = "rosbags"
    languages: ClassVar = {"ros1": frozenset({"msg"}), "ros2": frozenset({"msg"})}

    def missing(self) -> str | None:
        return None

    def version(self) -> str:
        return metadata.version("rosbags")

    def judge(self, case: DefinitionCase) -> Answer:
        try:
            return self._judge(case)
        except RecursionError:
            return NotJudged("it is nested too deeply for rosbags")
        except _UnreadableError as error:
            return NotJudged(str(error))
        # Assertions of the parser and code for hashes may raise anything.
        except Exception as error:
            why = " ".join(str(error).split())
            why = why if len(why) <= 300 else f"{why[:30]} ... {why[-265:]}"
            is_meant = isinstance(error, TypesysError)
            return Refused(why if is_meant else f"{type(error).__name__} {why}")

    def _judge(self, case: DefinitionCase) -> Answer:
        found: dict[str, Any] = {}
        pending = [case]
        has_returns = False
        while pending:
            each = pending.pop()
            if each.dialect == "ros1" and _OWN_TIME.search(each.text):
                raise _UnreadableError("rosbags takes builtin_interfaces/Time for time of ROS 1")
            # Without its line ends, more of a text can be compared than that it is refused.
            has_returns |= "\r" in each.text
            text = each.text.replace("\r\n", "\n").replace("\r", "\n")
            full = f"{each.package}/msg/{each.name}"
            found[full] = _parsed(text, full)
            for need in _needs(found[full][1]):
                if need in found or (case.dialect == "ros1" and need in _TIMES):
                    continue
                needed = self.universe.message_case(*need.split("/msg/"))
                if needed is None:
                    return Refused(f"{need} is not there")
                if needed.language != "msg":
                    raise _UnreadableError(f"it needs {need}, which is written in IDL")
                pending.append(needed)
        full = f"{case.package}/msg/{case.name}"
        if _contains_itself(full, found):
            return Refused(f"{full} contains itself")
        constants, fields = found[full]
        facts: Facts = {"structure": {case.full_name: _message(constants, fields, case.dialect)}}
        if has_returns:
            facts["line ends"] = "refused"
        if case.dialect == "ros2":
            store = get_typestore(Stores.EMPTY)
            # Leave out constants: rosbags writes them into Python code, which may not be valid.
            # Hashes do not depend on constants.
            store.register({name: ([], fields) for name, (_, fields) in found.items()})
            facts["hash"] = {case.full_name: store.hash_rihs01(full)}
        return Accepted(facts)


@lru_cache(maxsize=1024)
def _parsed(text: str, full: str) -> Any:
    # Most messages need the same Header, and most texts are read several times.
    return get_types_from_msg(text, full)[full]


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
