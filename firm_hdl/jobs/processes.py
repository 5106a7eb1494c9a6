"""Run programs and worker processes such that an interruption leaves neither processes nor files.

A program runs in a process group of its own. When the process that waits for the program is
stopped, the group is killed. An interrupted parent stops its workers without waiting for them.

No program is started in the current folder of this process. Many programs run, or link to, what
lies in their current folder: modules of Python, libraries of an empty entry of ``LD_LIBRARY_PATH``.
"""

from __future__ import annotations

import io
import json
import multiprocessing
import os
import resource
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import IO, Any

__all__ = [
    "TooSlowError",
    "ToolError",
    "answered",
    "cpu_seconds",
    "hang_up",
    "made_by",
    "run_tool",
    "start_program",
    "unwound_when_terminated",
    "with_end",
    "worker_pool",
]

_running: set[subprocess.Popen[bytes]] = set()

MOST_OUTPUT_BYTES = 256 << 20
"""What a program may print before it is ended; GHDL prints netlists of millions of lines."""

MOST_MESSAGE_CHARACTERS = 1 << 16
"""What an error quotes of an output."""

_LOOK_SECONDS = 0.2

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

    * `output`: what the program printed; the message of the error, without the middle of a long
      output.
    """

    def __init__(self, output: str):
        said = output.strip() or "it failed without output"
        half = MOST_MESSAGE_CHARACTERS // 2
        if len(said) > 2 * half:
            said = f"{said[:half]}\n... {len(said) - 2 * half} characters ...\n{said[-half:]}"
        super().__init__(said)


class TooSlowError(ToolError):
    """A program exceeded its time limit, and was stopped."""


class _TooMuchError(Exception):
    """A program printed more than `MOST_OUTPUT_BYTES`."""


def made_by(tool: str, file: Path, *, may_be_empty: bool = True) -> Path:
    """Return a file that a program had to write.

    * `may_be_empty`: if not, a text without any word counts as not written.

    Raises `ToolError` if the file does not exist. A program may end without an error and still not
    write it.
    """
    if not file.is_file() or not (may_be_empty or file.read_text(encoding="utf-8").strip()):
        raise ToolError(f"{tool} ended without an error, but did not write {file.name}")
    return file


def start_program(
    command: Sequence[str],
    folder: Path = Path("/"),
    *,
    stdin: int = subprocess.DEVNULL,
    stdout: int | None = subprocess.PIPE,
    stderr: int | IO[bytes] | None = subprocess.DEVNULL,
    environment: Mapping[str, str] | None = None,
) -> subprocess.Popen[bytes]:
    """Start a program in a session of its own, in a folder that is not the current one.

    * `environment`: variables besides those of this process.
    """
    program = command[0]
    if os.sep in program:
        # As the user means it: relative to the current folder.
        program = os.path.abspath(program)
    return subprocess.Popen(
        [program, *command[1:]],
        cwd=folder,
        # What programs in Python print is decoded as UTF-8, whatever this process itself prints.
        env={**os.environ, "PYTHONIOENCODING": "utf-8:surrogateescape", **(environment or {})},
        stdin=stdin,
        stdout=stdout,
        stderr=stderr,
        start_new_session=True,
    )


def run_tool(
    command: Sequence[str],
    folder: Path | None = None,
    *,
    environment: Mapping[str, str] | None = None,
    timeout: float | None = 600.0,
    with_errors: bool = True,
    stop: threading.Event | None = None,
) -> str:
    """Run a program in a folder; return its standard output and standard error.

    * `folder`: `None` is an empty folder, which is removed afterwards.
    * `environment`: variables besides those of this process.
    * `timeout`: seconds after which the program is stopped; `None`: never.
    * `with_errors`: if not, the result has no standard error. Then the message of an error is
      what the program printed there, or else its standard output.
    * `stop`: the program is ended once another thread has set it.

    Raises `TooSlowError` if the program takes longer than `timeout` seconds. Raises `ToolError` if
    the program fails, is ended, or prints more than `MOST_OUTPUT_BYTES`.
    """
    own = tempfile.TemporaryDirectory(prefix="firm-hdl-") if folder is None else nullcontext(folder)
    process, name = None, Path(command[0]).name
    with own as place:
        try:
            with _signals_later(), _starting:
                process = start_program(
                    command,
                    Path(place),
                    stderr=subprocess.STDOUT if with_errors else subprocess.PIPE,
                    environment=environment,
                )
                _running.add(process)
            output, errors = _printed(process, timeout, stop)
        except subprocess.TimeoutExpired:
            raise TooSlowError(f"{name} took more than {timeout:.0f} s") from None
        except _TooMuchError:
            most = f"{MOST_OUTPUT_BYTES >> 20} MiB"
            raise ToolError(f"{name} was ended: it printed more than {most}") from None
        finally:
            if process is not None:
                _kill(process)
                # Waits for the program, and closes its output.
                with process:
                    _running.discard(process)
    if process.returncode:
        said = errors.strip() or output.strip()
        raise ToolError(with_end(said, process.returncode))
    return output


def _printed(
    process: subprocess.Popen[bytes], timeout: float | None, stop: threading.Event | None
) -> tuple[str, str]:
    """Wait until a program has ended; return its standard output and standard error.

    Raises `subprocess.TimeoutExpired` or `_TooMuchError`. Raises `ToolError` if it has to stop.
    """
    end = None if timeout is None else time.monotonic() + timeout
    buffers = bytearray(), bytearray()
    with selectors.DefaultSelector() as selector:
        for pipe, buffer in zip((process.stdout, process.stderr), buffers, strict=True):
            if pipe is not None:
                selector.register(pipe, selectors.EVENT_READ, buffer)
        while selector.get_map():
            left = None if end is None else end - time.monotonic()
            if left is not None and left <= 0:
                raise subprocess.TimeoutExpired(process.args, timeout or 0)
            if stop is not None:
                if stop.is_set():
                    raise ToolError("it was stopped")
                left = _LOOK_SECONDS if left is None else min(left, _LOOK_SECONDS)
            for key, _ in selector.select(left):
                data = os.read(key.fd, 1 << 16)
                key.data.extend(data)
                if not data:
                    selector.unregister(key.fileobj)
            if sum(map(len, buffers)) > MOST_OUTPUT_BYTES:
                raise _TooMuchError
    process.wait(None if end is None else max(0.0, end - time.monotonic()))
    output, errors = (
        # As text files are read, with any line ends.
        io.TextIOWrapper(io.BytesIO(buffer), encoding="utf-8", errors="replace").read()
        for buffer in buffers
    )
    return output, errors


def answered(process: subprocess.Popen[bytes], question: str | None) -> dict[str, Any]:
    """Send a line to a process that stays for the next one, and return its answer.

    * `question`: with `None`, the process speaks first.

    Returns an object in JSON, on one line.

    Raises `OSError` or `ValueError` if the process has ended, or says anything else.
    """
    assert process.stdin is not None and process.stdout is not None
    if question is not None:
        process.stdin.write(question.encode() + b"\n")
        process.stdin.flush()
    line = process.stdout.readline(MOST_OUTPUT_BYTES)
    with suppress(RecursionError):
        if line.endswith(b"\n") and isinstance(answer := json.loads(line), dict):
            return answer
    raise ValueError("no line with an object in JSON")


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


def hang_up(process: subprocess.Popen[bytes], seconds: float = 0.0) -> None:
    """Close the pipes of a process, and kill the process if it has not ended `seconds` later."""
    assert process.stdin is not None and process.stdout is not None
    with suppress(OSError):  # The process may be dead, with input not yet written to the pipe.
        process.stdin.close()
    process.stdout.close()
    with suppress(subprocess.TimeoutExpired):
        process.wait(seconds)
    process.kill()
    process.wait()


@contextmanager
def worker_pool(jobs: int | None) -> Iterator[ProcessPoolExecutor]:
    """Open a pool of processes that end when its owner is interrupted, stopped, or killed."""
    with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
        before = set(multiprocessing.active_children())
        options: dict[str, Any] = {
            # Other ways start with `python -c`, which searches the current folder.
            "mp_context": multiprocessing.get_context("fork"),
            "initializer": _prepare,
            "initargs": (folder, os.getpid()),
        }
        with ProcessPoolExecutor(jobs, **options) as pool:
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
    # When the parent dies, `getppid` changes at once, even if the parent is still a zombie.
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


def _kill(process: subprocess.Popen[bytes]) -> None:
    # After a process has been waited for, its number may belong to another process. One that has
    # only ended keeps its number, and may have left others in its group.
    if process.returncode is None:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
