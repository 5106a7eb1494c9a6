"""How programs are started: their group, their limit of time, and signals at that moment."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from firm_hdl.jobs import processes
from firm_hdl.jobs.processes import cpu_seconds, run_tool, worker_pool


def test_a_program_leads_a_group_and_a_session_of_its_own(tmp_path):
    """So a signal of the terminal does not reach it, and all that it starts can be killed."""
    output = run_tool(["sh", "-c", "echo $$; cut -d' ' -f 5,6 /proc/$$/stat"], tmp_path)
    own, group, session = output.split()
    assert own == group == session != str(os.getpgrp())


def test_programs_run_in_threads_too(tmp_path):
    """Only the main thread may set handlers of signals."""
    found = []
    thread = threading.Thread(target=lambda: found.append(run_tool(["echo", "a"], tmp_path)))
    thread.start()
    thread.join(60)
    assert found == ["a\n"]


@pytest.fixture
def handlers():
    """Return a function that sets the handlers of both signals; they are restored afterwards."""
    numbers = (signal.SIGINT, signal.SIGTERM)
    before = [signal.getsignal(number) for number in numbers]

    def set_all(handler):
        for number in numbers:
            signal.signal(number, handler)

    yield set_all
    for number, handler in zip(numbers, before, strict=True):
        signal.signal(number, handler)


def test_all_signals_that_come_while_a_program_is_started_are_handled_in_order(
    tmp_path, monkeypatch, handlers
):
    came, running = [], []

    def note(number, frame):
        came.append(number)
        running.append(len(processes._running))

    class Interrupted(subprocess.Popen):
        def __init__(self, *given, **options):
            for number in (signal.SIGTERM, signal.SIGINT, signal.SIGTERM):
                signal.raise_signal(number)
            assert came == []
            super().__init__(*given, **options)

    handlers(note)
    monkeypatch.setattr(processes.subprocess, "Popen", Interrupted)
    assert run_tool(["echo", "a"], tmp_path) == "a\n"
    assert came == [signal.SIGTERM, signal.SIGINT, signal.SIGTERM]
    # By then, the program is known, and would be killed.
    assert running == [1, 1, 1]


def test_a_program_ignores_the_signals_that_its_parent_ignores(tmp_path, handlers):
    """So does what a shell starts in the background, or with nohup."""
    handlers(signal.SIG_IGN)
    script = "kill -INT $$; kill -TERM $$; echo still there"
    assert run_tool(["sh", "-c", script], tmp_path) == "still there\n"
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def test_processor_time_is_that_of_one_thread():
    """Other tasks of this process may run in other threads."""

    def burn():
        until = time.thread_time() + 0.1
        while time.thread_time() < until:
            pass

    before = cpu_seconds()
    thread = threading.Thread(target=burn)
    thread.start()
    thread.join()
    assert cpu_seconds() - before < 0.1


def test_an_interrupted_pool_ends_its_own_processes_only():
    other = multiprocessing.Process(target=time.sleep, args=(60,))
    other.start()
    try:
        with pytest.raises(KeyboardInterrupt), worker_pool(1) as pool:
            assert pool.submit(abs, -1).result(60) == 1
            raise KeyboardInterrupt
        until = time.monotonic() + 60
        while multiprocessing.active_children() != [other]:
            assert other.is_alive() and time.monotonic() < until
            time.sleep(0.01)
    finally:
        other.kill()
        other.join()
        other.close()


def test_the_limit_of_time_is_that_of_the_program_in_seconds(tmp_path):
    with pytest.raises(processes.TooSlowError, match=r"^sleep took more than 0 s$"):
        run_tool(["/bin/sleep", "60"], tmp_path, timeout=0.05)
    # An interpreter that ends in time is no error.
    assert run_tool([sys.executable, "-S", "-c", "print(1)"], tmp_path, timeout=60) == "1\n"
