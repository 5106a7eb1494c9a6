"""The process of an engine: how it is started and ended, and what is told of its end."""

from __future__ import annotations

import gc
import os
import signal
from pathlib import Path
from types import SimpleNamespace

import pytest

from firm_hdl.sim.fast import BuildError, SimulationError, process
from firm_hdl.sim.fast.process import VerilatorEngine


@pytest.fixture
def start(tmp_path, request, monkeypatch):
    """Start a shell script in place of a compiled design; it has all the time that it needs."""
    monkeypatch.setattr(process, "_END_SECONDS", 60.0)

    def started(text: str) -> VerilatorEngine:
        path = tmp_path / "program"
        path.write_text(f"#!/bin/sh\n{text}\n")
        path.chmod(0o755)
        engine = VerilatorEngine(path)
        request.addfinalizer(engine.close)
        return engine

    return started


WAITS = "cat >/dev/null"
"""Waits until its socket is closed."""


def test_a_program_is_told_its_parent_and_is_not_interrupted_with_it(start, tmp_path):
    engine = start(f'echo "$@" >{tmp_path}/words; {WAITS}')
    assert os.getsid(engine.process.pid) == engine.process.pid != os.getsid(0)
    engine.close()
    assert (tmp_path / "words").read_text().split() == [str(os.getpid())]


def test_a_program_has_time_to_end(start):
    engine = start(f"{WAITS}; exit 7")
    engine.close()
    assert engine.process.returncode == 7
    engine.close()


def test_a_program_that_does_not_end_is_killed(start, monkeypatch):
    monkeypatch.setattr(process, "_END_SECONDS", 0.05)
    engine = start("exec sleep 5")
    engine.close()
    assert engine.process.returncode == -signal.SIGKILL


def test_a_program_that_nobody_closed_is_ended(start, tmp_path):
    Path(tmp_path, "program").write_text(f"#!/bin/sh\n{WAITS}\n")
    Path(tmp_path, "program").chmod(0o755)
    engine = VerilatorEngine(tmp_path / "program")
    child = engine.process
    del engine
    gc.collect()
    assert child.returncode == 0


def test_again_is_another_process_of_the_same_program(start):
    first = start(WAITS)
    second = first.again()
    assert second.process.args == first.process.args
    assert second.process.pid != first.process.pid
    second.close()
    assert first.process.poll() is None
    first.close()


@pytest.mark.parametrize(
    ("end", "reason"),
    [
        ("exit 0", "exit status 0"),
        ("exit 3", "exit status 3"),
        ("kill -TERM $$", "killed by SIGTERM"),
        ("kill -KILL $$", "killed by SIGKILL"),
    ],
)
def test_the_end_of_a_program_is_told(start, end, reason):
    engine = start(end)
    with pytest.raises(SimulationError, match=f"^The simulation ended: {reason}$"):
        engine.receive(None)


@pytest.mark.parametrize(
    ("status", "reason"), [(None, "exit status None"), (-77, "killed by signal 77")]
)
def test_an_end_without_a_name_is_told_as_a_number(start, status, reason):
    engine = start(WAITS)
    child, engine.process = engine.process, SimpleNamespace(returncode=status)
    assert engine._reason() == reason
    engine.process = child


def test_a_program_that_is_not_there_cannot_be_started(tmp_path):
    with pytest.raises(BuildError, match=r"cannot be started: .*No such file"):
        VerilatorEngine(tmp_path / "missing")
