"""Damaged datagrams for a participant: a short run, and a node that is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from lab.rtps.__main__ import compile_board, fuzz


@pytest.mark.thorough
@pytest.mark.usefixtures("verilator")
def test_damaged_datagrams_leave_good_ones_alone(tmp_path: Path) -> None:
    assert fuzz(compile_board(tmp_path), 1, 3000, newcomer=300) == []


@pytest.mark.parametrize(
    ("said", "problem"),
    [
        (r"\002", "the node hangs after 0 bad datagrams"),
        # Ticks of a node that is silent: 61 seconds.
        (r"\000\100\311\242\003\000\000\000\000", "peer 1 is not matched after 60.0 s"),
    ],
)
def test_a_wrong_node_is_found(tmp_path: Path, said: str, problem: str) -> None:
    program = tmp_path / "board"
    program.write_text(f"#!/bin/sh\nprintf '{said}'\ncat > /dev/null\n")
    program.chmod(0o755)
    assert fuzz(program, 1, 100) == [f"seed 1: {problem}"]
