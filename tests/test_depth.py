"""What `make test` leaves out, and `make nightly` runs."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from tests.depth import not_sampled


class Case:
    """A collected case of a test, with or without the marker."""

    def __init__(self, name, number=None):
        self.nodeid = name
        self._marker = None if number is None else SimpleNamespace(args=(number,))

    def get_closest_marker(self, name):
        return self._marker


@pytest.mark.parametrize(("count", "left"), [(1, 1), (2, 1), (7, 4), (8, 4)])
def test_one_case_in_two_is_left(count, left):
    cases = [Case(f"a.py::test[{number}]", 2) for number in range(count)]
    found = not_sampled(cases)
    assert len(cases) - len(found) == left
    # The choice does not depend on the order.
    assert not_sampled(reversed(cases)) == found


def test_tests_without_the_marker_are_whole():
    assert not_sampled(Case(f"a.py::test[{number}]") for number in range(8)) == set()


def test_each_test_is_sampled_by_itself():
    cases = [Case(f"a.py::{name}[{n}]", 3) for name in ("one", "two") for n in range(6)]
    left = {each.nodeid for each in cases} - {each.nodeid for each in not_sampled(cases)}
    assert sorted(each.partition("[")[0] for each in left) == ["a.py::one"] * 2 + ["a.py::two"] * 2
