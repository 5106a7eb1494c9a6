"""Programs and processes: their output, and that an interruption leaves nothing behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from firm_hdl.jobs.processes import (
    ToolError,
    TooSlowError,
    run_tool,
    unwound_when_terminated,
)


def test_output_of_a_tool_is_returned(tmp_path):
    output = run_tool(["sh", "-c", "pwd; echo $WHAT >&2"], tmp_path, environment={"WHAT": "this"})
    assert output == f"{tmp_path}\nthis\n"


def test_tool_that_fails_is_an_error_with_its_output(tmp_path):
    with pytest.raises(ToolError, match=r"^so what$"):
        run_tool(["sh", "-c", "echo so what; exit 3"], tmp_path)
    with pytest.raises(ToolError, match=r"^exit status 3$"):
        run_tool(["sh", "-c", "exit 3"], tmp_path)


def test_tool_that_was_killed_is_an_error(tmp_path):
    """What it has written so far is no result."""
    with pytest.raises(ToolError, match=r"^ended by SIGKILL$"):
        run_tool(["sh", "-c", "kill -9 $$"], tmp_path)
    with pytest.raises(ToolError, match=r"^half a result\nended by SIGSEGV$"):
        run_tool(["sh", "-c", "echo half a result; kill -11 $$"], tmp_path)
    with pytest.raises(ToolError, match=r"^ended by signal 35$"):
        run_tool(["sh", "-c", "kill -35 $$"], tmp_path)
    # A shell script that ran the program.
    with pytest.raises(ToolError, match=r"^half a result\n(Killed\n)?exit status 137$"):
        run_tool(["sh", "-c", "echo half a result; sh -c 'kill -9 $$'; exit $?"], tmp_path)


def test_standard_error_can_be_left_out_of_the_result(tmp_path):
    script = "echo warning >&2; echo result"
    assert run_tool(["sh", "-c", script], tmp_path, with_errors=False) == "result\n"
    with pytest.raises(ToolError, match=r"^warning$"):
        run_tool(["sh", "-c", f"{script}; exit 3"], tmp_path, with_errors=False)
    with pytest.raises(ToolError, match=r"^result$"):
        run_tool(["sh", "-c", "echo result; exit 3"], tmp_path, with_errors=False)


def test_tool_that_takes_too_long_is_ended_with_all_that_it_started(tmp_path):
    script = "sleep 60 & echo $! > child; wait"
    with pytest.raises(TooSlowError, match=r"^sh took more than 1 s$"):
        run_tool(["sh", "-c", script], tmp_path, timeout=1)
    wait_for_exit(int((tmp_path / "child").read_text()))


@pytest.mark.sampled(3)
@pytest.mark.parametrize("with_errors", [True, False])
@pytest.mark.parametrize(
    "script",
    [
        "yes $(seq 1000)",
        "yes >&2",
        # The program itself has ended, and what it started goes on.
        "yes & exit 0",
    ],
)
def test_tool_that_prints_without_end_is_ended_with_all_that_it_started(
    tmp_path, script, with_errors
):
    script = f"sleep 60 & echo $! > child; {script}"
    with pytest.raises(ToolError, match=r"^sh was ended: it printed more than 256 MiB$"):
        run_tool(["sh", "-c", script], tmp_path, with_errors=with_errors)
    wait_for_exit(int((tmp_path / "child").read_text()))


def test_error_quotes_the_begin_and_the_end_of_a_long_output(tmp_path):
    with pytest.raises(ToolError, match=r"^1\n2\n(.|\n)*\n99999\n100000$") as caught:
        run_tool(["sh", "-c", "seq 100000; exit 1"], tmp_path)
    assert len(str(caught.value)) < 70_000


@pytest.mark.parametrize("variable", ["utf-16", "ascii"])
def test_output_is_read_as_utf_8_whatever_the_environment_says(tmp_path, monkeypatch, variable):
    monkeypatch.setenv("PYTHONIOENCODING", variable)
    monkeypatch.setenv("LC_ALL", "C")
    # A program in Python, and one that is not.
    assert run_tool([sys.executable, "-c", "print('\xe9')"], tmp_path) == "\xe9\n"
    assert run_tool(["printf", r"\303\251\r\n\303"], tmp_path) == "\xe9\n\ufffd"


def wait_for_exit(process: int) -> None:
    """Wait until a process has ended."""
    for _ in range(300):
        try:
            state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
        except (FileNotFoundError, ProcessLookupError):
            return
        # An orphan may stay a zombie: perhaps no process waits for it.
        if state == "Z":
            return
        time.sleep(0.1)
    raise AssertionError(f"process {process} is still there")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_while_a_program_is_started_ends_the_program(tmp_path, monkeypatch, number):
    started = []

    class Interrupted(subprocess.Popen):
        def __init__(self, *arguments, **options):
            super().__init__(*arguments, **options)
            started.append(self.pid)
            signal.raise_signal(number)

    monkeypatch.setattr(subprocess, "Popen", Interrupted)
    before = [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)]
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with unwound_when_terminated(), pytest.raises((KeyboardInterrupt, SystemExit)):
            run_tool(["sleep", "60"], tmp_path)
    finally:
        signal.signal(signal.SIGINT, before[0])
    (process,) = started
    assert not Path(f"/proc/{process}").exists()
    assert [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)] == before


INTERRUPTED = """
import signal
import sys
from pathlib import Path
from firm_hdl.jobs import run_each, run_tool
from tests.jobs.test_processes import work

if __name__ == "__main__":
    # Shells have it ignored by what they start in the background, and so these tests may have.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        list(run_each(work, [(n, (sys.argv[1], n)) for n in range(9)], jobs=2))
    except KeyboardInterrupt:
        sys.exit(130)
"""


def work(folder: str, number: int) -> None:
    """Make a temporary folder, and start a program that runs for long."""
    import tempfile

    with tempfile.TemporaryDirectory() as own:
        script = f"echo $$ {own} > {folder}/new{number}; mv {folder}/new{number} {folder}/{number}"
        run_tool(["sh", "-c", f"{script}; sleep 60"], Path(own))


def wait_for_removal(folder: Path) -> None:
    """Wait until a folder is removed."""
    for _ in range(300):
        if not folder.exists():
            return
        time.sleep(0.1)
    raise AssertionError(f"{folder} is still there")


@pytest.mark.skipif(not Path("/proc").exists(), reason="it looks at processes")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_interruption_ends_everything_and_leaves_nothing(tmp_path, number):
    (tmp_path / "go.py").write_text(INTERRUPTED)
    (tmp_path / "seen").mkdir()
    (tmp_path / "temporary").mkdir()
    root = str(Path(__file__).parents[2])
    environment = {**os.environ, "PYTHONPATH": root, "TMPDIR": str(tmp_path / "temporary")}
    process = subprocess.Popen(
        [sys.executable, str(tmp_path / "go.py"), str(tmp_path / "seen")], env=environment
    )
    seen: list[Path] = []
    for _ in range(600):
        seen = [tmp_path / "seen" / name for name in ("0", "1")]
        if all(path.exists() for path in seen):
            break
        time.sleep(0.1)
    started = [path.read_text().split() for path in seen]
    # Signal this process alone: its children must not depend on the signal.
    process.send_signal(number)
    if number == signal.SIGINT:
        assert process.wait(timeout=60) == 130
    for child, folder in started:
        # Do not wait for a killed process first: its children still have to notice.
        wait_for_exit(int(child))
        wait_for_removal(Path(folder))
    process.wait(timeout=60)
    for folder in (tmp_path / "temporary").iterdir():
        wait_for_removal(folder)
    assert list((tmp_path / "temporary").iterdir()) == []
    assert sorted(path.name for path in (tmp_path / "seen").iterdir()) == ["0", "1"]
