"""Definitions of real packages against oracles; all of them: ``make verify``."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.ts1.system import Ts1
from firm_hdl.verify.ts1.universe import Universe
from tests.depth import by_depth
from tests.verify.ts1.conftest import judged_by, need

JUDGED = ("passed", "failed", "known difference")
DISTROS = {"ros1": "noetic", "ros2": "lyrical"}


@cache
def spelled_names(path, distro):
    """Return the names of the definitions in a folder, except for those with long texts."""
    cases = Universe(distro, [path]).select([])
    return tuple(case.spelled_name for case in cases if len(case.text) < 20_000)


def differences(request, oracle):
    """Judge; return the differences, and the numbers of refused and judged definitions."""
    with Ts1(replace(request, oracles=(oracle,), jobs=1)) as run:
        need(oracle, run.missing.get(oracle))
        verdicts, refused, wrong = judged_by(run)
    return wrong, refused, sum(verdicts[oracle, each] for each in JUDGED)


@pytest.mark.parametrize(
    ("dialect", "oracle", "step"),
    [
        ("ros1", "genmsg", by_depth(200, 10)),
        pytest.param("ros2", "rosidl_adapter", 20, marks=pytest.mark.thorough),
        pytest.param("ros2", "rosidl_parser", 100, marks=pytest.mark.thorough),
        # Includes hashes, which need all nested types.
        pytest.param("ros2", "rosidl_parser-4.9", 100, marks=pytest.mark.thorough),
    ],
)
def test_a_sample_is_read_as_oracles_read_it(corpus, dialect, oracle, step):
    path, distro = str(corpus / dialect), DISTROS[dialect]
    types = spelled_names(path, distro)[::step]
    request = Request(distros=(distro,), paths=(path,), types=types)
    wrong, refused, judged = differences(request, oracle)
    assert (wrong, refused) == ([], 0)
    assert judged >= 0.9 * len(types) > by_depth(3, 60)


@pytest.mark.parametrize(
    ("dialect", "oracle"),
    [
        ("ros1", "genmsg"),
        pytest.param("ros2", "rosidl_adapter", marks=pytest.mark.thorough),
        pytest.param("ros2", "rosidl_parser", marks=pytest.mark.thorough),
    ],
)
def test_invalid_definitions_are_refused_by_both(corpus, dialect, oracle):
    distro = DISTROS[dialect]
    bad = str(corpus / "invalid" / dialect)
    types = tuple(case.spelled_name for case in Universe(distro, [bad]).select([]))
    paths = (bad, str(corpus / dialect))
    request = Request(distros=(distro,), paths=paths, types=types)
    wrong, refused, judged = differences(request, oracle)
    assert wrong == []
    assert refused == judged == len(types) > 10
