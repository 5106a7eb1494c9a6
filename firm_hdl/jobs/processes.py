"""Run programs and worker processes such that an interruption leaves neither processes nor files.

A program runs in a process group of its own. When the process that waits for the program is
stopped, the group is killed. An interrupted parent stops its workers without waiting for them.
"""

from __future__ import annotations

import multiprocessing
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TypeVar

__all__ = [
    "TooSlowError",
    "ToolError",
    "cpu_seconds",
    "hang_up",
    "in_processes",
    "made_by",
    "run_tool",
    "unwound_when_terminated",
    "with_end",
    "worker_pool",
]

T = TypeVar("T")
R = TypeVar("R")

_running: set[subprocess.Popen[str]] = set()

REMOVAL_ATTEMPTS = 50
"""How often a worker tries to remove the temporary files, at intervals of 0.1 s."""

_starting = threading.Lock()
"""Held while a program is started, and for ever by a process that is about to end."""


def cpu_seconds() -> float:
    """Return the processor time of this thread, and of programs that it has waited for."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.thread_time() + children.ru_utime + children.ru_stime


class ToolError(Exception):
    """A program failed, took too long, or did not write its result.

    Parameters
    ----------
    output : str
        What the program printed; the message of the error.
    """

    def __init__(self, output: str):
        super().__init__(output.strip() or "it failed without output")


class TooSlowError(ToolError):
    """A program exceeded its time limit, and was stopped."""


def made_by(tool: str, file: Path, *, may_be_empty: bool = True) -> Path:
    """Return a file that a program had to write.

    Parameters
    ----------
    may_be_empty : bool
        False: a text without any word counts as not written.

    Raises
    ------
    ToolError
        If the file does not exist. A program may end without an error and still not write it.
    """
    if not file.is_file() or not (may_be_empty or file.read_text(encoding="utf-8").strip()):
        raise ToolError(f"{tool} ended without an error, but did not write {file.name}")
    return file


def run_tool(
    command: Sequence[str],
    folder: Path,
    *,
    environment: Mapping[str, str] | None = None,
    timeout: float | None = 600.0,
    with_errors: bool = True,
) -> str:
    """Run a program in a folder; return its standard output and standard error.

    Parameters
    ----------
    timeout : float or None
        Seconds after which the program is stopped; `None`: never.
    with_errors : bool
        False leaves standard error out of the result. Then the message of an error is what the
        program printed there, or else its standard output.

    Raises
    ------
    TooSlowError
        If the program takes longer than `timeout` seconds.
    ToolError
        If the program fails.
    """
    process = None
    try:
        with _signals_later(), _starting:
            process = subprocess.Popen(
                command,
                cwd=folder,
                env={**os.environ, **(environment or {})},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT if with_errors else subprocess.PIPE,
                text=True,
                errors="replace",
                start_new_session=True,
            )
            _running.add(process)
        output, errors = process.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        raise TooSlowError(f"{Path(command[0]).name} took more than {timeout:.0f} s") from None
    finally:
        if process is not None:
            _kill(process)
            # Waits for the program, and closes its output.
            with process:
                _running.discard(process)
    if process.returncode:
        said = (errors or "").strip() or output.strip()
        raise ToolError(with_end(said, process.returncode))
    return output


def with_end(said: str, status: int) -> str:
    """Return an output, with the end of its program if the output may not tell it."""
    if status < 0:
        # What a program has printed does not say that it crashed. Some signals have no names.
        names = {each.value: each.name for each in signal.Signals}
        return f"{said}\nended by {names.get(-status, f'signal {-status}')}".lstrip()
    # A shell adds 128 to the signal that ended its last command.
    return f"{said}\nexit status {status}".lstrip() if status > 128 or not said else said


@contextmanager
def _signals_later() -> Iterator[None]:
    """Let signals of interruption wait for the end of the block.

    A program runs before `Popen` returns. A signal in between would not end the program.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    handlers = {each: signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)}
    # A signal that is ignored, or ends this process at once, has no handler that could wait.
    waiting = {number: handler for number, handler in handlers.items() if callable(handler)}
    for number in waiting:
        signal.signal(number, lambda number, frame: came.append(number))
    try:
        yield
    finally:
        for number, handler in waiting.items():
            signal.signal(number, handler)
        for each in came:
            signal.raise_signal(each)


def hang_up(process: subprocess.Popen[Any], seconds: float = 0.0) -> None:
    """Close the pipes of a process, and kill the process if it has not ended `seconds` later."""
    assert process.stdin is not None and process.stdout is not None
    with suppress(OSError):  # The process may be dead, with input not yet written to the pipe.
        process.stdin.close()
    process.stdout.close()
    with suppress(subprocess.TimeoutExpired):
        process.wait(seconds)
    process.kill()
    process.wait()


def in_processes(
    work: Callable[..., R], tasks: Sequence[tuple[T, tuple[Any, ...]]], jobs: int | None
) -> Iterator[tuple[T, R | Exception]]:
    """Call a function for each task, in `jobs` processes (`None`: one per processor).

    Parameters
    ----------
    work : callable
        A function of a module. Its temporary files are removed when the processes end.
    tasks : sequence of (key, arguments)

    Yields
    ------
    key, result
        Results in the order in which tasks end. An exception is the result if the process died.
    """
    if jobs == 1:
        for key, arguments in tasks:
            yield key, work(*arguments)
        return
    with worker_pool(jobs) as pool:
        futures = {pool.submit(work, *arguments): key for key, arguments in tasks}
        for future in as_completed(futures):
            error = future.exception()
            if error is None:
                yield futures[future], future.result()
            else:
                # The results of the other tasks are kept.
                yield futures[future], Exception(f"{type(error).__name__}: {error}")


@contextmanager
def worker_pool(jobs: int | None) -> Iterator[ProcessPoolExecutor]:
    """Open a pool of processes that end when its owner is interrupted, stopped, or killed."""
    with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
        before = set(multiprocessing.active_children())
        arguments = (folder, os.getpid())
        with ProcessPoolExecutor(jobs, initializer=_prepare, initargs=arguments) as pool:
            try:
                yield pool
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                for child in set(multiprocessing.active_children()) - before:
                    child.terminate()
                raise


@contextmanager
def unwound_when_terminated() -> Iterator[None]:
    """Make SIGTERM raise an exception, so that this process cleans up before it ends."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def leave(number: int, frame: object) -> None:
        sys.exit(128 + number)

    before = signal.signal(signal.SIGTERM, leave)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _prepare(folder: str, parent: int) -> None:
    """Make a worker ignore Ctrl-C; the parent stops it.

    The worker's temporary files are in a folder that the parent removes, however the worker ends.
    """
    tempfile.tempdir = folder
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, _stop)
    threading.Thread(target=_end_with, args=(parent, folder), daemon=True).start()


def _end_with(parent: int, folder: str) -> None:
    """End this process when its parent has been killed; no signal reports that."""
    # This process was forked by the parent, or by a fork server that ends with the parent. When the
    # forking process dies, `getppid` changes at once, even if the dead process is still a zombie.
    forked_by = os.getppid()
    while os.getppid() == forked_by and _exists(parent):
        time.sleep(1)
    # The main thread goes on. From here on, it cannot start a program. But it may begin another
    # task, whose files can appear while the folder is being removed.
    with _starting:
        for process in list(_running):
            _kill(process)
        for _ in range(REMOVAL_ATTEMPTS):
            shutil.rmtree(folder, ignore_errors=True)
            if not os.path.exists(folder):
                break
            time.sleep(0.1)
        os._exit(128 + signal.SIGKILL)


def _exists(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def _stop(number: int, frame: object) -> None:
    for process in list(_running):
        _kill(process)
    os._exit(128 + number)


def _kill(process: subprocess.Popen[str]) -> None:
    # After a process has been waited for, its number may belong to another process.
    if process.poll() is None:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
