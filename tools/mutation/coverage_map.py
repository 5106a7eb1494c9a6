"""Which tests run which lines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

__all__ = ["SHARED", "CoverageMap", "Part", "Test"]

# What is run for all tests of a file, whichever comes first.
SHARED = "+"


@dataclass(frozen=True)
class Test:
    """A test that passes without a fault.

    Attributes
    ----------
    name : str
        As pytest calls it.
    cpu_seconds : float
        What it takes, with the processes that it starts, while lines are counted.
    opaque : bool
        It may run lines that the map does not know of.
    snapshot : bool
        It compares with a file that the program itself has written, once.
    measured : bool
        It was run. What was not, for having more sets of parameters than were asked for, is taken
        to run what the measured ones of the same function do, and to take as long.
    """

    __test__ = False

    name: str
    cpu_seconds: float
    opaque: bool
    snapshot: bool = False
    measured: bool = True

    @property
    def file(self) -> str:
        """The file it is in."""
        return self.name.partition("::")[0]

    @property
    def function(self) -> str:
        """Its name without parameters."""
        return self.name.partition("[")[0]


@dataclass(frozen=True)
class Part:
    """The map of one test file.

    Attributes
    ----------
    tests : list of Test
    lines : mapping of str to mapping of str to int
        By file of the program, and by number of the test or `SHARED`: the lines that were run; bit
        n for line n.
    stale : bool
        Something has changed since, so that tests may run other lines today.
    """

    tests: list[Test]
    lines: Mapping[str, Mapping[str, int]]
    stale: bool = False

    def running(self, masks: Mapping[str, int], wanted: int) -> set[str]:
        """Return names of tests that run one of some lines of a file themselves."""
        own = {
            test.name
            for number, test in enumerate(self.tests)
            if masks.get(str(number), 0) & wanted
        }
        functions = {test.function for test in self.tests if test.name in own}
        return own | {
            test.name for test in self.tests if not test.measured and test.function in functions
        }


@dataclass(frozen=True)
class CoverageMap:
    """The map of all test files.

    Attributes
    ----------
    parts : list of Part
    complete : bool
        No test of the suite was left out.
    tree : str
        Names the program and its tests.
    """

    parts: list[Part]
    complete: bool
    tree: str

    def running(self, path: str, lines: Iterable[int]) -> Iterator[tuple[Test, bool]]:
        """Yield tests for which one of some lines was run, and whether they ran it themselves."""
        wanted = sum(1 << line for line in set(lines))
        for part in self.parts:
            masks = part.lines.get(path, {})
            shared = bool(masks.get(SHARED, 0) & wanted)
            own = part.running(masks, wanted)
            for test in part.tests:
                if test.name in own or shared:
                    yield test, test.name in own

    def opaque(self) -> list[Test]:
        """Return the tests of which not all is known."""
        return [test for part in self.parts for test in part.tests if test.opaque]

    def touching(self, path: str, *, stale: bool = False) -> set[str]:
        """Return the names of tests that run something of a file, or folder, themselves.

        Parameters
        ----------
        stale : bool, optional
            Only those of which the map may be wrong today.
        """
        return {
            name
            for part in self.parts
            if part.stale or not stale
            for file, masks in part.lines.items()
            if file == path or (path.endswith("/") and file.startswith(path))
            for name in part.running(masks, -1)
        }

    def named(self, names: Iterable[str]) -> list[Test]:
        """Return tests by their names."""
        wanted = set(names)
        return [test for part in self.parts for test in part.tests if test.name in wanted]
