"""What a map of tests and lines takes from the files that the processes of a test leave."""

from __future__ import annotations

import pytest
from coverage import CoverageData

from tools.mutation.map.store import _part

PROGRAM = "firm_hdl/names/words.py"


def written(folder, name):
    """Write the lines of a process of the first test."""
    data = CoverageData(str(folder / name))
    data.set_context("0")
    data.add_lines({str(folder / PROGRAM): [3, 5]})
    data.write()


@pytest.mark.parametrize(
    ("left", "opaque"),
    [
        # Two processes have left their lines; one has left none, or was killed while it wrote.
        ({"data.0.a": None, "data.0.b": None}, False),
        ({"data.0.a": None}, True),
        ({"data.0.a": None, "data.0.b": b"SQLite f"}, True),
    ],
)
def test_a_test_is_traced_if_each_of_its_processes_left_its_lines(tmp_path, left, opaque):
    for name, broken in left.items():
        if broken is None:
            written(tmp_path, name)
        else:
            (tmp_path / name).write_bytes(broken)
    each = {"id": "tests/a.py::test_it", "cpu": 1.0, "lost": False, "started": 2, "snapshot": False}
    part = _part(tmp_path, {"tests": [each], "skipped": []}, tmp_path)
    (test,) = part.tests
    assert test.opaque is opaque
    assert list(part.lines) == [PROGRAM]
    assert set(part.lines[PROGRAM].values()) == {1 << 3 | 1 << 5}
