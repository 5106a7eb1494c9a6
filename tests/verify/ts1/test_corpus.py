"""Definitions of real packages against oracles; all of them: ``make verify-ts1``."""

from __future__ import annotations

import pytest

from firm_hdl.verify.ts1 import Selection, Ts1Run
from firm_hdl.verify.ts1.universe import Universe
from tests.verify.ts1.conftest import need, tally_of

JUDGED = ("passed", "failed", "known difference")
DISTROS = {"ros1": "noetic", "ros2": "lyrical"}


def differing(selection, oracle):
    """Judge; list what differs, and count what both refuse and what was judged."""
    with Ts1Run(selection, [oracle], 1) as run:
        need(oracle, run.missing.get(oracle))
        tally = tally_of(run)
    wrong = [(each.case.full_name, each.verdict.failures) for each, _ in tally.differing]
    return wrong, tally.refused[oracle], sum(tally.verdicts[oracle, each] for each in JUDGED)


@pytest.mark.parametrize(
    ("dialect", "oracle", "step"),
    [
        ("ros1", "genmsg", 10),
        ("ros2", "rosidl_adapter", 20),
        ("ros2", "rosidl_parser", 100),
        # With hashes, which need all that a type is made of.
        ("ros2", "rosidl_parser-4.9", 100),
    ],
)
def test_a_sample_is_read_as_oracles_read_it(corpus, dialect, oracle, step):
    path, distro = str(corpus / dialect), DISTROS[dialect]
    cases = Universe(distro, [path]).select([])
    types = tuple(case.spelled_name for case in cases if len(case.text) < 20_000)[::step]
    wrong, refused, judged = differing(Selection(distro=distro, paths=(path,), types=types), oracle)
    assert (wrong, refused) == ([], 0)
    assert judged >= 0.9 * len(types) > 60


@pytest.mark.parametrize(
    ("dialect", "oracle"),
    [("ros1", "genmsg"), ("ros2", "rosidl_adapter"), ("ros2", "rosidl_parser")],
)
def test_what_is_invalid_is_refused_by_both(corpus, dialect, oracle):
    distro = DISTROS[dialect]
    bad = str(corpus / "invalid" / dialect)
    types = tuple(case.spelled_name for case in Universe(distro, [bad]).select([]))
    paths = (bad, str(corpus / dialect))
    wrong, refused, judged = differing(Selection(distro=distro, paths=paths, types=types), oracle)
    assert wrong == []
    assert refused == judged == len(types) > 10
