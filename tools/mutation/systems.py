"""The test system of each test file, and the test files of a module.

Linters are not a test system here, nor are tests that check the form of the source. If they notice
an injected fault, this says nothing about the tests of behaviour.
"""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatch
from pathlib import Path, PurePosixPath

__all__ = ["REST", "SNAPSHOT", "SYSTEMS", "mirrored", "mirrors", "system_of", "test_files"]

# Patterns of names of test files; `*` also matches folders. The first matching system counts.
SYSTEMS = {
    "ts1": ["tests/frontend/*", "tests/verify/ts1/*"],
    "ts2": ["tests/wire/*", "tests/plan/*", "tests/verify/ts2/test_golden*"],
    "ts3": ["tests/gateware/*", "tests/verify/ts3/test_acceptance.py"],
    "ghdl": [
        *("tests/export/test_sample.py", "tests/export/vhdl/*"),
        *("tests/names/*", "tests/rtlil/*", "tests/vhdl/*"),
        "tests/verify/simulators/test_crosscheck.py",
        "tests/equivalence/*",
    ],
}
# All other tests.
REST = "rest"
# Tests of all systems that compare with files that the program itself has written.
SNAPSHOT = "snapshot"
# Tests that judge no mutants: the tests of this tool, and tests of the form of the source.
NOT_JUDGES = ("tests/mutation/", "tests/test_architecture.py", "tests/test_ci.py")


def system_of(name: str) -> str:
    """Return the system of a test file, or of a test in it."""
    file = name.partition("::")[0]
    for system, patterns in SYSTEMS.items():
        if any(fnmatch(file, pattern) for pattern in patterns):
            return system
    return REST


def mirrored(path: str) -> str:
    """Return the folder of tests that mirrors the folder of a module."""
    return "tests" + str(PurePosixPath(path).parent).removeprefix("firm_hdl")


def mirrors(name: str, path: str) -> bool:
    """Return whether a test file tests a module or grammar of the same name.

    The test file may be in a sub-folder of the folder that mirrors that of the module.
    """
    module = "parse" if path.endswith(".lark") else PurePosixPath(path).stem
    file = PurePosixPath(name)
    folders = (file.parent, file.parent.parent)
    return file.name == f"test_{module}.py" and PurePosixPath(mirrored(path)) in folders


def test_files(root: Path, only: Sequence[str] = ()) -> list[str]:
    """Return all test files that judge mutants, or only those at or below some paths."""
    files = sorted(file.relative_to(root).as_posix() for file in root.glob("tests/**/test_*.py"))
    return [
        file
        for file in files
        if not file.startswith(NOT_JUDGES)
        and (not only or any(PurePosixPath(file).is_relative_to(part) for part in only))
    ]


test_files.__test__ = False  # type: ignore[attr-defined]
