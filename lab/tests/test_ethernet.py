"""Frames through the edge to Ethernet: a short run, and a board that is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from firm_hdl.ethernet.drops import DROPS
from lab.ethernet.__main__ import fuzz
from lab.ethernet.board import compile_board


@pytest.mark.thorough
@pytest.mark.usefixtures("verilator")
def test_damaged_frames_leave_good_ones_alone(tmp_path: Path) -> None:
    assert fuzz(compile_board(tmp_path), 1, 3000) == []


def test_a_wrong_board_is_found(tmp_path: Path) -> None:
    program = tmp_path / "board"
    drops = "0 " * len(DROPS)
    said = ("d 00000000 1 2 33", "bad size 00", f"drops {drops}")
    program.write_text("#!/bin/sh\ncat > /dev/null\n" + "".join(f"echo {line}\n" for line in said))
    program.chmod(0o755)
    problems = "\n".join(fuzz(program, 1, 300))
    for part in ("sent: bad size", "came: d 0000", "datagrams are missing", "damaged: 0 instead"):
        assert part in problems
