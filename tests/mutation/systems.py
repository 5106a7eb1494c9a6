"""Which tests are which test system, and in which order a mutant meets them.

A stage is what one run of pytest gets. Its files are in the order in which they are likely to
notice: those that mirror the changed module first, then those of the same folder. Linters are no
test system here: what they would say of an injected fault says nothing about the tests.
"""

from __future__ import annotations

from pathlib import Path, PurePosixPath

__all__ = ["ORDER", "SYSTEMS", "mirrored", "rest", "stages"]

# Fast files first; what takes long for what it finds is left to `rest`.
_F, _P, _V, _E = "tests/frontend", "tests/plan", "tests/verify", "tests/export"
SYSTEMS: dict[str, list[list[str]]] = {
    "ts1": [
        [
            *(
                f"{_F}/test_{name}.py"
                for name in ("terminals", "facts", "parse", "errors", "search")
            ),
            *(f"{_F}/test_{name}.py" for name in ("library", "comments", "embedded", "interfaces")),
            *(f"{_F}/idl/test_{name}.py" for name in ("terminals", "values", "parse", "read")),
        ],
        [
            *(f"{_F}/test_{name}.py" for name in ("sources", "show", "resolve", "recordings")),
            f"{_F}/idl/test_*.py",
            f"{_F}/test_fuzz.py",
            f"{_V}/ts1/test_*.py",
        ],
    ],
    "ts2": [
        [
            "tests/wire/test_*.py",
            *(f"{_P}/test_{name}.py" for name in ("edges", "shape", "reference_bytes", "compare")),
            f"{_V}/test_golden.py",
            *(f"{_P}/test_{name}.py" for name in ("build", "geometry", "wire_facts", "errors")),
        ],
        [f"{_P}/test_*.py"],
    ],
    "ts3": [
        [f"tests/gateware/test_{name}.py" for name in ("members", "converters", "wstring")],
        ["tests/gateware/test_*.py", f"{_V}/test_acceptance.py"],
    ],
    "ghdl": [
        [
            *(f"{_E}/test_{name}.py" for name in ("sample", "rtlil", "names")),
        ],
        [f"{_E}/test_vhdl_types.py", f"{_E}/test_vhdl.py"],
        [f"{_E}/test_vhdl_random.py", f"{_E}/test_vhdl_wide.py", f"{_E}/test_vhdl_bench.py"],
        [f"{_V}/test_crosscheck.py", "tests/equivalence/test_*.py"],
    ],
}
# Systems that can notice a fault of a target, soonest first. The others are part of the rest.
ORDER = {
    "grammar": ["ts1"],
    "resolver": ["ts1"],
    "layout": ["ts2"],
    "plan": ["ts2", "ghdl", "ts3"],
    "gateware": ["ts3", "ghdl"],
    "vhdl": ["ghdl"],
}
# The tool's own tests judge the tool.
NOT_JUDGES = ("tests/mutation/",)


def mirrored(path: str) -> str:
    """Return the folder of tests that mirrors the one of a module."""
    return "tests" + str(PurePosixPath(path).parent).removeprefix("firm_hdl")


def _relevance(name: str, path: str) -> tuple[bool, bool]:
    """Rank a test file, least first: the one that mirrors a module, those beside it, others."""
    module = "parse" if path.endswith(".lark") else PurePosixPath(path).stem
    beside = str(PurePosixPath(name).parent) == mirrored(path)
    return not (beside and PurePosixPath(name).stem == f"test_{module}"), not beside


def _files(root: Path, patterns: list[str]) -> list[str]:
    return [
        file.relative_to(root).as_posix()
        for pattern in patterns
        for file in sorted(root.glob(pattern))
    ]


def stages(root: Path, system: str, path: str) -> list[list[str]]:
    """Return the files of each stage of a system, for a fault in `path`; each file once."""
    # What mirrors the module is never left to a later stage.
    every = {name for group in SYSTEMS[system] for name in _files(root, group)}
    seen = {name for name in every if not _relevance(name, path)[0]}
    result: list[list[str]] = []
    for number, group in enumerate(SYSTEMS[system]):
        files = sorted(seen) if number == 0 else []
        for name in _files(root, group):
            if name not in seen:
                seen.add(name)
                files.append(name)
        if files:
            result.append(sorted(files, key=lambda name: _relevance(name, path)))
    return result


def rest(root: Path, path: str, done: set[str]) -> list[str]:
    """Return all test files that a mutant has not met."""
    files = sorted(file.relative_to(root).as_posix() for file in root.glob("tests/**/test_*.py"))
    judges = [file for file in files if not file.startswith(NOT_JUDGES)]
    left = [file for file in judges if file not in done]
    return sorted(left, key=lambda name: _relevance(name, path))
