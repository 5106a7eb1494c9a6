"""Which reference judges a library on a type, on which wire, and with which values."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from firm_hdl.verify.clients import run as module
from firm_hdl.verify.clients.judge import LibraryResult
from firm_hdl.verify.clients.run import judge_type
from firm_hdl.verify.systems.options import Request
from tests.frontend.workspace import make_files

INSTALLED = ("genpy", "rosbags", "fastcdr", "fastcdr-2.3")
OPTIONS = Request(libraries=("firm-hdl",), most_cases=2, seed=5)


@pytest.fixture
def asked(monkeypatch):
    """Comparisons that are asked for; `obstacles` has what is in the way, by reference."""
    found = SimpleNamespace(calls=[], obstacles={}, values=[])

    class Comparison:
        def __init__(self, library, reference, wire):
            self.library, self.reference, self.wire = library, reference, wire

        def judge(self, message, values):
            names = self.library.name, self.reference.name
            found.calls.append((*names, self.wire, message.name))
            found.values.append(values)
            return LibraryResult(
                library=names[0],
                reference=names[1],
                type=message.name,
                comparisons=1,
                answers=1,
                obstacle=found.obstacles.get(names[1]),
            )

    wires = {"mcap-ros1": {"ros1"}, "cyclonedds": {"cdr"}}
    monkeypatch.setattr(module, "LibraryComparison", Comparison)
    monkeypatch.setattr(
        module,
        "client",
        lambda name: SimpleNamespace(name=name, wires=wires.get(name, {"ros1", "cdr"})),
    )
    return found


def test_values_follow_from_the_options(asked, tmp_path, monkeypatch):
    def values(**more):
        asked.values.clear()
        judge_type("lyrical", "std_msgs/msg/String", replace(OPTIONS, **more), INSTALLED)
        return asked.values[0]

    assert values() == values() != values(seed=6)
    assert (
        len(values()) == 2 and len(values(most_cases=4)) == 4 and len(values(most_cases=None)) > 8
    )
    assert values(most_cases=4)[:2] == values()
    # A user's type may have the name of another one of the distribution.
    make_files(tmp_path, {"std_msgs/msg/String.msg": "uint8 own\n"})
    own = values(paths=(str(tmp_path),))
    assert [list(value) for value in own] == [["own"]] * 2
    wide = make_files(tmp_path / "wide", {"p/msg/W.msg": "wstring w\n"})
    asked.values.clear()
    judge_type("lyrical", "p/msg/W", replace(OPTIONS, paths=(str(wide),)), INSTALLED)
    assert asked.values[0][0].keys() == {"w"}
