"""Yosys in a process of its own: what it prints, its errors, and its end."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest

from firm_hdl.verilog import runtime
from firm_hdl.verilog.runtime import YosysError, run_yosys

# Each mux of `proc` gets a number that Yosys counts up as long as it runs.
CHOICE = r"""
read_rtlil <<rtlil
module \m
  wire width 1 input 0 \a
  wire width 1 output 1 \b
  process $p
    assign \b 1'0
    switch \a
      case 1'1
        assign \b 1'1
    end
  end
end
rtlil
proc -norom
write_rtlil
"""


def numbers(text: str) -> set[str]:
    return set(re.findall(r"\$procmux\$\d+", text))


def process() -> int:
    """Return the number of the process that has Yosys."""
    run_yosys("write_rtlil")
    return runtime._started[-1]._process.pid


def test_a_run_does_not_depend_on_those_before():
    first = run_yosys(CHOICE)
    assert numbers(first)
    assert run_yosys(CHOICE) == first
    # One run counts on.
    both = run_yosys(CHOICE + CHOICE.replace(r"\m", r"\n"))
    assert numbers(both) > numbers(first)


def test_one_process_serves_all_runs():
    assert process() == process()


def test_the_encoding_of_the_user_s_output_is_not_that_of_the_pipes(monkeypatch):
    monkeypatch.setenv("PYTHONIOENCODING", "utf-16")
    monkeypatch.setattr(runtime, "_started", [])
    assert run_yosys(CHOICE)
    runtime._started[-1].close()


def test_mistakes_in_a_script_are_errors():
    with pytest.raises(YosysError, match=r"^ERROR: No such command: no_command"):
        run_yosys("no_command")


def test_a_forked_process_starts_its_own():
    """Threads of a runtime do not survive a fork: once, all workers waited for them for ever."""
    own = process()
    with ProcessPoolExecutor(2, mp_context=get_context("fork")) as pool:
        others = {future.result(60) for future in [pool.submit(process) for _ in range(4)]}
        assert own not in others and process() == own


@pytest.mark.thorough
def test_a_process_that_died_is_an_error_and_the_next_run_starts_another():
    dead = process()
    os.kill(dead, signal.SIGSTOP)
    ends = subprocess.Popen(["sh", "-c", f"sleep 0.3; kill -9 {dead}"])
    with pytest.raises(YosysError, match=r"^the process with Yosys died\nended by SIGKILL$"):
        run_yosys("write_rtlil")
    ends.wait()
    assert process() != dead


FAILS = """\
import json, pathlib, sys
folder = pathlib.Path(json.loads(sys.stdin.readline()))
(folder / "out").write_text("half of a module")
(folder / "errors").write_text({said!r})
print({answer!r}, flush=True)
sys.stdin.readline()
"""


@pytest.mark.parametrize(
    ("said", "answer", "message"),
    [
        # What Yosys has printed before counts for nothing.
        ("", '{"status": 7}', "^Yosys ended with exit status 7$"),
        ("ERROR: no\n", '{"status": 1}', "^ERROR: no$"),
        ("Some words. ", '{"failed": "a trap"}', "^Some words. a trap$"),
    ],
)
def test_each_failure_is_an_error(monkeypatch, tmp_path, said, answer, message):
    failing = tmp_path / "script.py"
    failing.write_text(FAILS.format(said=said, answer=answer))
    monkeypatch.setattr(runtime, "_SCRIPT", failing)
    monkeypatch.setattr(runtime, "_started", [])
    with pytest.raises(YosysError, match=message):
        run_yosys("write_rtlil")
    runtime._started[-1].close()


def test_an_interrupted_run_leaves_no_answer_for_the_next_one(monkeypatch, tmp_path):
    """The process ends, because the answer to the run before may still come."""
    slow = tmp_path / "script.py"
    slow.write_text("input(); print('{}', flush=True); input()")
    monkeypatch.setattr(runtime, "_SCRIPT", slow)
    monkeypatch.setattr(runtime, "_started", [])

    def interrupted(*arguments: object) -> None:
        raise KeyboardInterrupt

    process = runtime._process()
    monkeypatch.setattr(runtime, "answered", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run_yosys("write_rtlil")
    assert not process.is_usable
    assert runtime._process() is not process
    runtime._started[-1].close()


def test_it_ends_with_the_process_that_asks_even_in_the_middle_of_a_run(tmp_path):
    script = (
        "import os\n"
        "from firm_hdl.verilog import runtime\n"
        "runtime.run_yosys('write_rtlil')\n"
        "print(runtime._started[-1]._process.pid, flush=True)\n"
        "runtime.run_yosys('\\n'.join(['write_rtlil'] * 10_000_000))\n"
    )
    asks = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert asks.stdout is not None
    number = int(asks.stdout.readline())
    time.sleep(0.3)
    assert asks.poll() is None and Path(f"/proc/{number}").exists()
    asks.kill()
    asks.wait()
    asks.stdout.close()
    for _ in range(300):
        if not Path(f"/proc/{number}").exists():
            return
        time.sleep(0.1)
    pytest.fail(f"process {number} is still there")
