"""A map of which tests run which lines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

__all__ = ["SHARED", "CoverageMap", "Part", "Test"]

# Owner of lines that run once for all tests of a file, in the first test that needs them.
SHARED = "+"


@dataclass(frozen=True)
class Test:
    """A test that passes without a fault.

    Attributes
    ----------
    name : str
        Name in pytest.
    cpu_seconds : float
        Processor time of the test and of its processes, with tracing.
    opaque : bool
        Whether the test may run lines that are not in the map.
    snapshot : bool
        Whether the test compares with a file that the program itself has written.
    measured : bool
        Whether the test was run. If a function has too many sets of parameters, some are not run.
        These tests are assumed to run the same lines as the measured ones, and to take as long.
    """

    __test__ = False

    name: str
    cpu_seconds: float
    opaque: bool
    snapshot: bool = False
    measured: bool = True

    @property
    def file(self) -> str:
        """The file of the test."""
        return self.name.partition("::")[0]

    @property
    def function(self) -> str:
        """The name of the test without parameters."""
        return self.name.partition("[")[0]


@dataclass(frozen=True)
class Part:
    """The map of one test file.

    Attributes
    ----------
    tests : list of Test
    lines : mapping of str to mapping of str to int
        The lines that were run, by file of the program and by number of the test (or `SHARED`).
        They are a bit mask: bit n stands for line n.
    stale : bool
        Whether the program or its tests have changed since, so that tests may run other lines now.
    """

    tests: list[Test]
    lines: Mapping[str, Mapping[str, int]]
    stale: bool = False

    def running(self, masks: Mapping[str, int], wanted: int) -> set[str]:
        """Return names of tests that themselves run one of the wanted lines of a file."""
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
        Whether the map has all tests of the suite.
    tree : str
        Digest of the program and its tests.
    """

    parts: list[Part]
    complete: bool
    tree: str

    def running(self, path: str, lines: Iterable[int]) -> Iterator[tuple[Test, bool]]:
        """Yield tests that need one of the lines, and whether they ran the line themselves."""
        wanted = sum(1 << line for line in set(lines))
        for part in self.parts:
            masks = part.lines.get(path, {})
            shared = bool(masks.get(SHARED, 0) & wanted)
            own = part.running(masks, wanted)
            for test in part.tests:
                if test.name in own or shared:
                    yield test, test.name in own

    def opaque(self) -> list[Test]:
        """Return the tests that may run lines that are not in the map."""
        return [test for part in self.parts for test in part.tests if test.opaque]

    def touching(self, path: str, *, stale: bool = False) -> set[str]:
        """Return the names of tests that themselves run some line of a file or folder.

        Parameters
        ----------
        stale : bool, optional
            Return only tests of stale parts.
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
