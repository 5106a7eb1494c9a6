"""ROS's own readers: in separate processes (see `worker_script`), and the command ``ros2``.

Debian has genmsg and the rosidl of humble. Newer releases of rosidl come from PyPI. Each of them
has its own oracles, whose names end in the version.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache, cached_property
from pathlib import Path
from typing import Any, ClassVar

from firm_hdl.frontend import DISTROS
from firm_hdl.jobs.processes import ToolError, TooSlowError, run_tool
from firm_hdl.jobs.programs import which
from firm_hdl.verify.ros2_wheels import RELEASES, Release
from firm_hdl.verify.ros_python.worker import ROS_PYTHON, Worker
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Answer, NotJudged, Oracle, Refused
from firm_hdl.verify.ts1.universe import DefinitionCase

__all__ = ["NEWER", "Genmsg", "Ros2Proto", "RosidlAdapter", "RosidlParser"]


class _Worked(Oracle):
    """An oracle whose answers come from a worker process."""

    family: ClassVar[str]
    judge_name: ClassVar[str]
    """The name that the worker has for the oracle."""
    packages: ClassVar[str]
    """The packages of Debian that have the oracle."""
    release: ClassVar[Release | None] = None
    """The release whose environment has the oracle; `None`: the system has it."""

    @cached_property
    def _worker(self) -> Worker:
        return _shared_worker(self.family, str(self.release.python) if self.release else ROS_PYTHON)

    def missing(self) -> str | None:
        why = self._worker.missing
        if why is None:
            return None
        how = f"(Debian, Ubuntu: apt install {self.packages})"
        return f"{why} {how if self.release is None else self.release.how}"

    def version(self) -> str:
        return self._worker.versions.get(self.judge_name, "")

    def judge(self, case: DefinitionCase) -> Answer:
        return _answer(self._worker.ask(self._request(case)))

    def _request(self, case: DefinitionCase) -> dict[str, Any]:
        return {
            "oracle": self.judge_name,
            "folder": self.universe.folder,
            "package": case.package,
            "kind": case.kind,
            "name": case.name,
            "file": case.file,
            "has_events": DISTROS[self.universe.distro].has_events,
        }

    def cpu_seconds(self) -> float:
        return self._worker.cpu_seconds

    def close(self) -> None:
        if "_worker" in self.__dict__:
            self._worker.close()


@cache
def _shared_worker(family: str, python: str) -> Worker:
    # Oracles of one family ask about the same texts, which a shared worker reads only once.
    return Worker(family, "", modules=Path(__file__).parent, python=python)


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

    name = judge_name = "genmsg"
    family = "genmsg"
    packages = "python3-genmsg python3-rosmsg"
    languages: ClassVar = {"ros1": frozenset({"msg", "srv", "action"})}


class RosidlAdapter(_Worked):
    """rosidl_adapter: what ``.msg``, ``.srv`` and ``.action`` of ROS 2 declare, comments included.

    A definition that rosidl_adapter cannot write as IDL is refused, as in a build.
    """

    name = judge_name = "rosidl_adapter"
    family = "rosidl"
    packages = "python3-rosidl python3-empy"
    languages: ClassVar = {"ros2": frozenset({"msg", "srv", "action"})}


class RosidlParser(_Worked):
    """rosidl_parser: what IDL declares. rosidl_adapter first converts other definitions to IDL.

    From iron on, the facts include event messages of services, and the type hashes that
    rosidl_generator_type_description computes.
    """

    name = judge_name = "rosidl_parser"
    family = "rosidl"
    packages = "python3-rosidl"
    languages: ClassVar = {"ros2": frozenset({"msg", "srv", "action", "idl"})}

    def alike(self, case: DefinitionCase) -> Mapping[str, str]:
        # rosidl_adapter writes char as uint8 in IDL.
        return {} if case.language == "idl" else {"char": "uint8"}


def _newer() -> Iterator[type[Oracle]]:
    for release in RELEASES:
        for base in (RosidlAdapter, RosidlParser):
            name = f"{base.name}-{release.rosidl}"
            members = {"__doc__": base.__doc__, "name": name, "release": release}
            yield type(f"{base.__name__}_{release.name}", (base,), members)


NEWER: tuple[type[Oracle], ...] = tuple(_newer())
"""Oracles of the releases that PyPI has, oldest first."""


_MOST_SECONDS = 60


class Ros2Proto(Oracle):
    """The command ``ros2 interface proto``, which is called for each type.

    It knows installed packages only. So a type that it does not find is not judged.
    """

    name = "ros2"
    languages: ClassVar = {"ros2": frozenset({"msg", "srv", "action", "idl"})}

    def missing(self) -> str | None:
        return None if which("ros2") else "there is no command 'ros2'; source ROS 2's setup"

    def judge(self, case: DefinitionCase) -> Answer:
        command = ["ros2", "interface", "proto", case.full_name]
        try:
            said = run_tool(command, timeout=_MOST_SECONDS, with_errors=False)
        except (TooSlowError, OSError) as error:
            return NotJudged(f"ros2 failed: {error}")
        except ToolError as error:
            return NotJudged(f"ros2 does not have it: {str(error).splitlines()[-1]}")
        if not said.strip():
            return NotJudged("ros2 says nothing of it")
        # The command's `print` adds one line end.
        return Accepted({"proto": said.removesuffix("\n")})
