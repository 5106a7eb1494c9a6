"""``ros2 interface proto``, if the user has sourced ROS 2: there are no other packages of it."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator, Sequence
from typing import ClassVar

from firm_hdl.verify.ts1.case import DefinitionCase
from firm_hdl.verify.ts1.oracles.oracle import Accepted, Answer, NotJudged, Oracle

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
        return None if shutil.which("ros2") else "there is no command 'ros2'; source ROS 2's setup"

    def judge(self, cases: Sequence[DefinitionCase]) -> Iterator[Answer]:
        for case in cases:
            yield self._judge(case)

    def _judge(self, case: DefinitionCase) -> Answer:
        command = ["ros2", "interface", "proto", case.full_name]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=_MOST_SECONDS, check=False
            )
        except (OSError, subprocess.TimeoutExpired) as error:
            return NotJudged(f"ros2 failed: {error}")
        if done.returncode != 0:
            lines = (done.stderr or done.stdout).strip().splitlines() or ["it does not say why"]
            return NotJudged(f"ros2 does not have it: {lines[-1]}")
        if not done.stdout.strip():
            return NotJudged("ros2 says nothing of it")
        # The command's `print` adds one line end.
        return Accepted({"proto": done.stdout.removesuffix("\n")})
