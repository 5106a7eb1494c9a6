"""Where tests run: in processes here, or on a Dask cluster, through `concurrent.futures`.

What an executor is does not matter to results: each task is one call of a function with arguments
that can be pickled, results come back in whatever order, and a task is either answered or blamed.
A process that dies takes no other task with it: those that were under way are repeated, each in a
process of its own, and only the one that dies again has failed.
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
MOST_IDLE_SECONDS = 60

# So many tasks per worker are handed out at a time: none is idle, and few are in doubt if one dies.
TASKS_PER_WORKER = 2


class ExecutorError(ValueError):
    """An executor is not there, or was lost; the text says why."""


def check_executor(name: str) -> str:
    """Return the name of an executor.

    Raises
    ------
    ExecutorError
        If there is none of that name.
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

    Parameters
    ----------
    tasks : sequence of (key, arguments)
    executor : str
        ``processes``, or ``dask://HOST:PORT`` with the address of a scheduler.
    jobs : int or None
        Processes here (`None`: one per processor); 1 runs everything in this one. On a cluster, how
        many tasks are under way at most (`None`: as many as it has threads).

    Yields
    ------
    key, result
        What `work` raised, or why it cannot be said, stands for a result that there is none of.

    Raises
    ------
    ExecutorError
        If there is no such executor, or a cluster was lost on the way.
    """
    check_executor(executor)
    if executor != PROCESSES:
        with _dask(executor.removeprefix(DASK), jobs) as place:
            yield from _at(place, work, tasks)
    elif jobs == 1:
        for key, arguments in tasks:
            yield key, _called(work, arguments)
    else:
        number = jobs or multiprocessing.cpu_count()
        place = _Place(worker_pool, BrokenExecutor, number, TASKS_PER_WORKER * number)
        yield from _at(place, work, tasks)


def _called(work: Callable[..., R], arguments: tuple[Any, ...]) -> R | Exception:
    try:
        return work(*arguments)
    except Exception as error:
        return error


@dataclass(frozen=True, slots=True)
class _Place:
    """Where tasks run.

    Attributes
    ----------
    open : callable
        Returns a pool of so many workers, as a context manager.
    broken : exception type
        Of a task whose worker died.
    workers, window : int
        How many there are, and how many tasks are under way at most.
    is_busy : callable
        Whether anybody works on a task. A pool here tells when one of its processes dies; a cluster
        that has lost its workers just says nothing.
    """

    open: Callable[[int], AbstractContextManager[Executor]]
    broken: type[BaseException]
    workers: int
    window: int
    is_busy: Callable[[], bool] = lambda: True


def _at(
    place: _Place, work: Callable[..., R], tasks: Sequence[tuple[K, tuple[Any, ...]]]
) -> Iterator[tuple[K, R | Exception]]:
    left = deque(tasks)
    while left:
        before = len(left)
        with place.open(place.workers) as pool:
            suspects = yield from _share_out(pool, place, place.window, work, left)
        for key, arguments in suspects:
            # One of these ended a worker. Alone, it takes nobody else's result with it.
            with place.open(1) as pool:
                again = deque([(key, arguments)])
                dead = yield from _share_out(pool, place, 1, work, again)
            if dead or again:
                yield key, ExecutorError("the process that ran it died, and died again")
        if len(left) == before:
            raise ExecutorError("processes die before they are given anything")


def _share_out(
    pool: Executor,
    place: _Place,
    window: int,
    work: Callable[..., R],
    left: deque[tuple[K, tuple[Any, ...]]],
) -> Generator[tuple[K, R | Exception], None, list[tuple[K, tuple[Any, ...]]]]:
    """Hand out tasks until there are none left, or until a worker died.

    Returns
    -------
    list of (key, arguments)
        Tasks that nobody knows the end of.
    """
    running: dict[Future[R], tuple[K, tuple[Any, ...]]] = {}
    suspects: list[tuple[K, tuple[Any, ...]]] = []
    while True:
        while left and not suspects and len(running) < window:
            try:
                future = pool.submit(work, *left[0][1])
            except BrokenExecutor:
                break
            running[future] = left.popleft()
        if not running:
            return suspects
        finished = _finished(running, place)
        for future in finished:
            key, arguments = running.pop(future)
            try:
                result: R | Exception = future.result()
            except place.broken:
                suspects.append((key, arguments))
                continue
            except CancelledError:
                raise ExecutorError("the executor was lost; results so far are kept") from None
            except Exception as error:
                result = error
            yield key, result


def _finished(running: Collection[Future[R]], place: _Place) -> set[Future[R]]:
    """Wait for results, as long as somebody works on them."""
    idle = 0
    while True:
        finished, _ = wait(running, timeout=CHECK_SECONDS, return_when=FIRST_COMPLETED)
        if finished:
            return finished
        idle = 0 if place.is_busy() else idle + CHECK_SECONDS
        if idle >= MOST_IDLE_SECONDS:
            raise ExecutorError(
                f"nobody has worked on any test for {idle} s; the results so far are kept"
            )


@contextmanager
def _dask(address: str, jobs: int | None) -> Iterator[_Place]:
    try:
        # Not a plain import: whether it is there, and has types, is nobody else's business.
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
            # Not pure: what a type costs is measured each time.
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
        yield _Place(pool, distributed.KilledWorker, threads, window, is_busy)
