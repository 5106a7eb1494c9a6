"""``ros2 interface proto``, if the user has sourced ROS 2: there are no other packages of it."""

from __future__ import annotations

from typing import ClassVar

from firm_hdl.jobs.processes import ToolError, TooSlowError, run_tool
from firm_hdl.jobs.programs import which
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Answer, NotJudged, Oracle
from firm_hdl.verify.ts1.universe import DefinitionCase

__all__ = ["Ros2Proto"]

_MOST_SECONDS = 60


class Ros2Proto(Oracle):
    """The command ``ros2 interface proto``, which is called for each type.

    It knows installed packages only. So a type that it does not find is not judged.
    """

    name = "ros2"
    languages: ClassVar = {"ros2": frozenset({"msg", "srv", "action", "idl"})}
    judges_changes = False

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
