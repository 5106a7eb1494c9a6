"""Run tasks in processes of this machine or on a Dask cluster, through `concurrent.futures`.

Results do not depend on the executor. Each task is one call of a function with arguments that can
be pickled. Results come back in any order, and every task gives a result or an error. If a process
dies, each task that was running is repeated in a process of its own. A task fails only if that
process dies, too.
"""

from __future__ import annotations

import importlib
import multiprocessing
from collections import deque
from collections.abc import Callable, Collection, Generator, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from typing import Any, TypeVar

from firm_hdl.jobs.processes import worker_pool

__all__ = ["PROCESSES", "ExecutorError", "check_executor", "run_each"]

K = TypeVar("K")
R = TypeVar("R")

PROCESSES = "processes"
"""The executor on this machine."""

DASK = "dask://"
CONNECT_SECONDS = 10
CHECK_SECONDS = 5
MAX_IDLE_SECONDS = 60

# Number of submitted tasks per worker. With two, no worker waits for its next task. With more, more
# tasks would be repeated when a worker dies.
TASKS_PER_WORKER = 2


class ExecutorError(ValueError):
    """There is no such executor, it is out of reach, or it was lost; the message says which."""


def check_executor(name: str) -> str:
    """Check the name of an executor, and return it.

    Raises `ExecutorError` if the name is not that of an executor.
    """
    address = name.removeprefix(DASK)
    host, _, port = address.rpartition(":")
    if name == PROCESSES or (address != name and host and port.isdecimal()):
        return name
    raise ExecutorError(f"executor must be '{PROCESSES}' or 'dask://HOST:PORT', not '{name}'")


def run_each(
    work: Callable[..., R],
    tasks: Sequence[tuple[K, tuple[Any, ...]]],
    *,
    executor: str = PROCESSES,
    jobs: int | None = None,
) -> Generator[tuple[K, R | Exception], None, None]:
    """Call a function for each task, and yield results as they come.

    * `executor`: ``processes``, or ``dask://HOST:PORT`` with the address of a scheduler.
    * `jobs`: number of processes on this machine (`None`: one per processor); 1 runs everything in
      this process. On a cluster, the largest number of running tasks (`None`: as many as it has
      threads).

    Yields each key with the result of `work`, or with the exception that it raised, or with an
    `ExecutorError` if its process died.

    Raises `ExecutorError` if there is no such executor, or the cluster was lost.
    """
    check_executor(executor)
    if executor != PROCESSES:
        with _dask(executor.removeprefix(DASK), jobs) as source:
            yield from _run_on(source, work, tasks)
    elif jobs == 1:
        for key, arguments in tasks:
            yield key, _called(work, arguments)
    else:
        number = jobs or multiprocessing.cpu_count()
        source = _PoolSource(worker_pool, BrokenExecutor, number, TASKS_PER_WORKER * number)
        yield from _run_on(source, work, tasks)


def _called(work: Callable[..., R], arguments: tuple[Any, ...]) -> R | Exception:
    try:
        return work(*arguments)
    except Exception as error:
        return error


@dataclass(frozen=True, slots=True)
class _PoolSource:
    """Opens pools of workers, on this machine or on a cluster."""

    # Returns a pool with a number of workers, as a context manager.
    open: Callable[[int], AbstractContextManager[Executor]]
    broken: type[BaseException]  # Exception of a task whose worker died.
    # Number of workers, and largest number of submitted tasks.
    workers: int
    window: int
    # Return whether a worker is running a task. It is needed for clusters: a cluster does not
    # report that it has lost all workers, whereas a pool of this machine reports a dead process.
    is_busy: Callable[[], bool] = lambda: True


def _run_on(
    source: _PoolSource, work: Callable[..., R], tasks: Sequence[tuple[K, tuple[Any, ...]]]
) -> Iterator[tuple[K, R | Exception]]:
    remaining = deque(tasks)
    while remaining:
        before = len(remaining)
        with source.open(source.workers) as pool:
            suspects = yield from _distribute(pool, source, source.window, work, remaining)
        for key, arguments in suspects:
            # One of the suspects ended the worker. Alone in a process, it cannot end other tasks.
            with source.open(1) as pool:
                again = deque([(key, arguments)])
                dead = yield from _distribute(pool, source, 1, work, again)
            if dead or again:
                yield key, ExecutorError("the process that ran it died, also when it was repeated")
        if len(remaining) == before:
            raise ExecutorError("processes die before they get a task")


def _distribute(
    pool: Executor,
    source: _PoolSource,
    window: int,
    work: Callable[..., R],
    remaining: deque[tuple[K, tuple[Any, ...]]],
) -> Generator[tuple[K, R | Exception], None, list[tuple[K, tuple[Any, ...]]]]:
    """Submit tasks until none remains, or until a worker has died.

    Returns the tasks that were running when the worker died.
    """
    running: dict[Future[R], tuple[K, tuple[Any, ...]]] = {}
    suspects: list[tuple[K, tuple[Any, ...]]] = []
    while True:
        while remaining and not suspects and len(running) < window:
            try:
                future = pool.submit(work, *remaining[0][1])
            except BrokenExecutor:
                break
            running[future] = remaining.popleft()
        if not running:
            return suspects
        finished = _finished(running, source)
        # Keep the order of the tasks; the set of finished futures is unordered.
        for future in [each for each in running if each in finished]:
            key, arguments = running.pop(future)
            try:
                result: R | Exception = future.result()
            except source.broken:
                suspects.append((key, arguments))
                continue
            except CancelledError:
                raise ExecutorError("the executor was lost; results so far are kept") from None
            except Exception as error:
                result = error
            yield key, result


def _finished(running: Collection[Future[R]], source: _PoolSource) -> set[Future[R]]:
    """Wait for at least one result; give up if no worker has been busy for a while."""
    idle = 0
    while True:
        finished, _ = wait(running, timeout=CHECK_SECONDS, return_when=FIRST_COMPLETED)
        if finished:
            return finished
        idle = 0 if source.is_busy() else idle + CHECK_SECONDS
        if idle >= MAX_IDLE_SECONDS:
            raise ExecutorError(
                f"no process has worked on a test for {idle} s; the results so far are kept"
            )


@contextmanager
def _dask(address: str, jobs: int | None) -> Iterator[_PoolSource]:
    try:
        # Not a plain import: Dask is optional, and mypy must not depend on its types.
        distributed: Any = importlib.import_module("distributed")
    except ImportError:
        raise ExecutorError(
            "Dask is not installed: python3 -m pip install 'firm-hdl[distributed]'"
        ) from None
    try:
        client = distributed.Client(
            f"tcp://{address}", timeout=CONNECT_SECONDS, set_as_default=False
        )
    except (OSError, ValueError) as error:
        raise ExecutorError(f"no Dask scheduler at {address}: {error}") from None
    with client:

        @contextmanager
        def pool(workers: int) -> Iterator[Executor]:
            # Not pure: equal tasks must run again, because their time is measured.
            with client.get_executor(pure=False) as executor:
                try:
                    yield executor
                except BaseException:
                    executor.shutdown(wait=False)
                    raise

        def is_busy() -> bool:
            try:
                return any(client.processing().values())
            except Exception:
                return False

        threads = max(1, sum(client.nthreads().values()))
        window = jobs or TASKS_PER_WORKER * threads
        yield _PoolSource(pool, distributed.KilledWorker, threads, window, is_busy)
