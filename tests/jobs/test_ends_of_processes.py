"""Ends of processes: normal exit, kill, interrupt, SIGTERM, and a parent that dies."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import pytest

from firm_hdl.jobs import processes, run_each
from firm_hdl.jobs.processes import (
    ToolError,
    cpu_seconds,
    hang_up,
    made_by,
    run_tool,
    unwound_when_terminated,
)


def start_process(*command, **options):
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    return subprocess.Popen(command, **pipes, **options)


def test_process_that_ends_when_its_input_closes_is_not_killed():
    process = start_process("cat")
    hang_up(process, 30)
    assert process.returncode == 0
    assert process.stdin.closed and process.stdout.closed


def test_process_that_does_not_end_is_killed():
    process = start_process("sleep", "60")
    began = time.monotonic()
    hang_up(process, 0.01)
    assert process.returncode == -signal.SIGKILL
    assert time.monotonic() - began < 30


def test_hanging_up_on_a_dead_process_is_no_error():
    process = start_process("true")
    process.wait()
    process.stdin.write(b"still to be said")
    hang_up(process)
    assert process.returncode == 0


def test_tool_error_without_output_says_so():
    assert str(ToolError(" what \n")) == "what"
    assert str(ToolError(" \n")) == "it failed without output"


def test_made_by_requires_the_file(tmp_path):
    file = tmp_path / "out.v"
    with pytest.raises(
        ToolError, match=r"^yosys ended without an error, but did not write out\.v$"
    ):
        made_by("yosys", file)
    file.mkdir()
    with pytest.raises(ToolError, match="did not write"):
        made_by("yosys", file)
    file.rmdir()
    file.touch()
    assert made_by("yosys", file) == file
    file.write_text(" \n")
    with pytest.raises(ToolError, match="did not write"):
        made_by("yosys", file, may_be_empty=False)
    file.write_text("module\n")
    assert made_by("yosys", file, may_be_empty=False) == file


def test_tool_has_empty_input_and_may_print_any_bytes(tmp_path):
    assert run_tool(["cat"], tmp_path) == ""
    assert run_tool(["printf", r"\377"], tmp_path) == "\ufffd"
    environment = {"A_NAME": "b"}
    output = run_tool(["sh", "-c", "echo $A_NAME $HOME"], tmp_path, environment=environment)
    assert output == f"b {os.environ.get('HOME', '')}\n"
    assert "A_NAME" not in os.environ
    # The caller's value counts, not that of this process.
    output = run_tool(["sh", "-c", "echo $HOME"], tmp_path, environment={"HOME": "/elsewhere"})
    assert output == "/elsewhere\n"
    # No tool is registered as running.
    assert processes._running == set()


def test_missing_tool_is_file_not_found_error(tmp_path):
    with pytest.raises(FileNotFoundError):
        run_tool([str(tmp_path / "none")], tmp_path)
    assert processes._running == set()


def test_interrupt_while_a_tool_runs_kills_the_tool(tmp_path):
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            run_tool(["sh", "-c", "echo $$ > me; kill -INT $PPID; exec sleep 60"], tmp_path)
    finally:
        signal.signal(signal.SIGINT, before)
    assert not Path(f"/proc/{(tmp_path / 'me').read_text().strip()}").exists()
    assert processes._running == set()


def test_cpu_seconds_include_children():
    before = cpu_seconds()
    burn = "import time\nwhile time.process_time() < 0.2: pass"
    subprocess.run([sys.executable, "-S", "-c", burn], check=True)
    assert cpu_seconds() - before >= 0.2
    before = cpu_seconds()
    while cpu_seconds() - before < 0.01:
        pass
    before = cpu_seconds()
    time.sleep(0.1)
    assert cpu_seconds() - before < 0.1


def test_terminated_process_runs_its_cleanup():
    tidied, own = [], lambda number, frame: None
    before = signal.signal(signal.SIGTERM, own)
    try:
        with pytest.raises(SystemExit) as caught, unwound_when_terminated():
            try:
                signal.raise_signal(signal.SIGTERM)
            finally:
                tidied.append(True)
        assert signal.getsignal(signal.SIGTERM) is own
    finally:
        signal.signal(signal.SIGTERM, before)
    assert caught.value.code == 128 + signal.SIGTERM
    assert tidied == [True]


def test_threads_install_no_signal_handler():
    before = signal.getsignal(signal.SIGTERM)
    seen = []

    def run():
        with unwound_when_terminated():
            seen.append(signal.getsignal(signal.SIGTERM))

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    assert seen == [before]


def test_process_that_has_ended_is_not_killed_again(monkeypatch):
    """Its number may belong to another process by now."""
    process = start_process("true")
    process.wait()
    killed = []
    monkeypatch.setattr(processes.os, "killpg", lambda *who: killed.append(who))
    processes._kill(process)
    assert killed == []
    hang_up(process)


def test_temporary_files_of_workers_go_with_their_pool(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    ((_, folder),) = run_each(tempfile.mkdtemp, [("a", ())], jobs=2)
    assert Path(folder).parent.parent == tmp_path
    assert Path(folder).parent.name.startswith("firm-hdl-")
    assert list(tmp_path.iterdir()) == []
