"""ROS's own readers, which run in a process of their own: see `worker_script`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache, cached_property
from typing import Any, ClassVar

from firm_hdl.verify.ts1.case import Case
from firm_hdl.verify.ts1.facts import Facts
from firm_hdl.verify.ts1.oracle import Accepted, Answer, NotJudged, Oracle, Refused
from firm_hdl.verify.ts1.worker import Worker

__all__ = ["Genmsg", "RosidlAdapter", "RosidlParser"]


class _Worked(Oracle):
    """An oracle that a worker answers for."""

    family: ClassVar[str]

    @cached_property
    def _worker(self) -> Worker:
        return _shared_worker(self.family, self.universe.folder)

    def missing(self) -> str | None:
        return self._worker.missing

    def version(self) -> str:
        return self._worker.versions.get(self.name, "")

    def judge(self, cases: Sequence[Case]) -> Iterator[Answer]:
        for case in cases:
            yield _answer(self._worker.ask(self._request(case)))

    def _request(self, case: Case) -> dict[str, Any]:
        return {
            "oracle": self.name,
            "package": case.package,
            "kind": case.kind,
            "name": case.name,
            "file": case.file,
            "text": case.text if case.is_changed else None,
        }

    def cpu_seconds(self) -> float:
        return self._worker.cpu_seconds

    def close(self) -> None:
        if "_worker" in self.__dict__:
            self._worker.close()


@cache
def _shared_worker(family: str, folder: str) -> Worker:
    # Two oracles of one family ask about the same texts, which it then reads once.
    return Worker(family, folder)


def _answer(answer: dict[str, Any]) -> Answer:
    if "facts" in answer:
        return Accepted(answer["facts"])
    if "refused" in answer:
        return Refused(str(answer["refused"]))
    if "failed" in answer:
        return NotJudged(str(answer["failed"]))
    raise ValueError(f"the process that was asked answered {answer!r}")


class Genmsg(_Worked):
    """genmsg and rosmsg: structure, ``rosmsg show`` and md5sum of ROS 1.

    An action is expanded by the rule of actionlib before genmsg reads its messages.
    """

    name = "genmsg"
    family = "genmsg"
    languages: ClassVar = {"ros1": frozenset({"msg", "srv", "action"})}


class RosidlAdapter(_Worked):
    """rosidl_adapter: what ``.msg``, ``.srv`` and ``.action`` of ROS 2 declare, comments included.

    A definition that it cannot write out as IDL is refused, as in a build.
    """

    name = "rosidl_adapter"
    family = "rosidl"
    languages: ClassVar = {"ros2": frozenset({"msg", "srv", "action"})}


class RosidlParser(_Worked):
    """rosidl_parser: what IDL declares. Other definitions go through rosidl_adapter before."""

    name = "rosidl_parser"
    family = "rosidl"
    languages: ClassVar = {"ros2": frozenset({"msg", "srv", "action", "idl"})}

    def judge(self, cases: Sequence[Case]) -> Iterator[Answer]:
        for case, answer in zip(cases, super().judge(cases), strict=True):
            if case.language == "idl" and isinstance(answer, Accepted):
                _name_as_file(answer.facts, case)
            yield answer

    def alike(self, case: Case) -> Mapping[str, str]:
        # There is no char in the IDL that rosidl_adapter writes.
        return {} if case.language == "idl" else {"char": "uint8"}


def _name_as_file(facts: Facts, case: Case) -> None:
    """Give a message of IDL the name of its file, which its modules may contradict."""
    names = list(facts["structure"])
    if len(names) == 1:
        facts["names"] = names
        facts["structure"] = {case.full_name: facts["structure"][names[0]]}
