"""What a test system is, and how its results get to the disk.

A system knows its tests before it runs any, so that a file of results can say what is missing. It
asks a recorder for what an earlier session found out, runs the rest, and hands over each record as
soon as it is there. Printing is the system's own business.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from typing import Any, ClassVar, TypeVar

from firm_hdl.frontend import DISTROS
from firm_hdl.jobs.executors import PROCESSES, ExecutorError, run_each
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.records import Record, Test, settled
from firm_hdl.verify.results.verdict import Verdict

__all__ = ["Judged", "Recorder", "System", "judged", "run_shares", "shares_of", "wire_of"]

K = TypeVar("K")
R = TypeVar("R")


@dataclass(frozen=True, slots=True, kw_only=True)
class Judged:
    """What was asked of a test system, and what it says.

    Attributes
    ----------
    what : str
        For people: a type, where it is from, and how it was tested.
    verdict : Verdict
    """

    what: str
    verdict: Verdict


def judged(records: Iterable[Record]) -> list[Judged]:
    """Return what the tests of some records are worth, all of one system."""
    by_key = {record.test.key: record for record in records}
    return [
        Judged(what=record.test.title, verdict=settled(record, by_key))
        for record in by_key.values()
    ]


class Recorder:
    """Where records go, and where those of earlier sessions are.

    Parameters
    ----------
    writer : ResultsWriter or None
        `None`: nothing is kept, and nothing is known.
    """

    def __init__(self, writer: ResultsWriter | None = None):
        self._writer = writer

    def known(self, test: Test) -> Record | None:
        """Return what an earlier session found out."""
        return None if self._writer is None else self._writer.before.records.get(test.key)

    def add(self, *records: Record) -> None:
        """Keep records; they are on the disk when this returns."""
        if self._writer is not None and records:
            self._writer.add(*records)

    def resume(self, tests: Mapping[K, Test], what: str) -> dict[K, Record]:
        """Return what an earlier session found out, by the keys of `tests`; print how much it is.

        Parameters
        ----------
        what : str
            The tests, in the plural.
        """
        found = {key: record for key, test in tests.items() if (record := self.known(test))}
        if self._writer is not None and found:
            print(f"{len(found)} of {len(tests)} {what} have a result in {self._writer.path}")
        return found


class System(ABC):
    """A test system with all that it is to test; a context manager.

    Attributes
    ----------
    name : str
        As ``--systems`` takes it.
    """

    name: ClassVar[str]

    def __enter__(self) -> System:
        return self

    def __exit__(self, *error: object) -> None:
        return None

    @property
    @abstractmethod
    def tests(self) -> Sequence[Test]:
        """All tests, in the order in which they are begun."""

    @property
    @abstractmethod
    def options(self) -> Mapping[str, Any]:
        """What results depend on, as JSON can say it; the same name means the same everywhere."""

    @abstractmethod
    def run(self, recorder: Recorder) -> list[Judged]:
        """Run what has no record, print what came of all, and return it."""


def wire_of(distro: str, wire: str | None) -> str:
    """Return the name of a wire format; `None`: that of the distribution."""
    return wire or ("ros1" if DISTROS[distro].dialect == "ros1" else "cdr")


def shares_of(items: Sequence[K], most: int, parts: int = 64) -> list[tuple[K, ...]]:
    """Deal out items in order, at most `most` in a share, in at least `parts` shares if it can be.

    Records of a share are synced together, which costs some milliseconds each time.
    """
    size = min(most, max(1, len(items) // parts))
    return [tuple(items[at : at + size]) for at in range(0, len(items), size)]


def run_shares(
    work: Callable[[Any, tuple[K, ...]], R],
    context: object,
    shares: Sequence[tuple[K, ...]],
    *,
    executor: str = PROCESSES,
    jobs: int | None = None,
) -> Generator[tuple[tuple[K, ...], R | Exception], None, None]:
    """Call ``work(context, share)`` for each share, and yield shares with results as they come.

    A share that ends its process is run again item by item, so that one item alone is blamed.

    Raises
    ------
    ExecutorError
        See :func:`firm_hdl.jobs.executors.run_each`.
    """
    again: list[tuple[K, ...]] = []
    tasks = [(share, (context, share)) for share in shares]
    with closing(run_each(work, tasks, executor=executor, jobs=jobs)) as results:
        for share, result in results:
            if isinstance(result, ExecutorError) and len(share) > 1:
                again += [(item,) for item in share]
            else:
                yield share, result
    if again:
        yield from run_shares(work, context, again, executor=executor, jobs=jobs)
