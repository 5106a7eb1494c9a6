"""The runs that TS3 makes of a type, seen without a simulation."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

import firm_hdl.verify.ts3.circuit as circuit
from firm_hdl.verify import Options, accept
from firm_hdl.verify.results.verdict import Failed
from tests.frontend.workspace import make_files

UINT8 = "std_msgs/msg/UInt8"


@pytest.fixture
def runs(monkeypatch):
    """A function that returns the runs of a type: their packets, and whether there are stalls."""

    def of(name, **options):
        found = []

        class NoHarness:
            """Notes each run, which fails."""

            bench = SimpleNamespace(cycles=0)

            def __init__(self, *cores, gated, keeps_state, **more):
                assert (gated, keeps_state) == (options.get("stalled", True), False)

            def run_packets(self, packets, asked):
                found.append((list(packets), asked.stalls is not None))
                raise AssertionError("it hangs")

        monkeypatch.setattr(circuit, "Harness", NoHarness)
        for core in ("Deserializer", "Serializer"):
            monkeypatch.setattr(circuit, core, lambda message, **limits: None)
        result = accept("lyrical", name, Options(references=(), **options))
        assert isinstance(result.verdict, Failed)
        assert len(result.failures) == len(found), result.failures
        assert all(": AssertionError: it hangs" in text for text in result.failures)
        # The times of a test that fails are known as well.
        assert result.seconds.simulation > 0 and result.cpu_seconds > 0
        return found

    return of


@pytest.mark.parametrize(
    ("stalled", "broken", "expected"),
    [
        (True, True, [(2, False), (2, True), (4, True)]),
        (False, True, [(2, False), (4, False)]),
        (True, False, [(2, False), (2, True)]),
        (False, False, [(2, False)]),
    ],
)
def test_runs_are_those_that_were_asked_for(runs, stalled, broken, expected):
    found = runs(UINT8, most_cases=2, stalled=stalled, broken=broken)
    assert [(len(packets), has_stalls) for packets, has_stalls in found] == expected
    # Each damaged packet is followed by the good one that it was made of.
    if broken:
        assert found[-1][0][1::2] == found[0][0]


def test_packets_are_those_of_the_wire_and_of_the_seed(runs, tmp_path):
    def first(**options):
        return runs(UINT8, stalled=False, broken=False, **options)[0][0]

    assert {len(packet) for packet in first()} == {4 + 1}
    assert {len(packet) for packet in first(wire="ros1")} == {1}
    source = make_files(tmp_path, {"p/msg/A.msg": "float64 a\nuint64[9] b\n"})

    def own(seed):
        options = {"paths": (str(source),), "stalled": False, "broken": False}
        return runs("p/msg/A", seed=seed, **options)[0][0]

    assert own(3) == own(3) != own(4)


def test_packets_of_other_senders_are_sent_once_behind_the_cases(runs):
    """A string may come without its NUL; that is another packet with the same meaning."""
    (plain, _), (stalled, _) = runs("std_msgs/msg/String", broken=False)
    assert plain[: len(stalled)] == stalled and len(plain) == len(stalled) + 1
    bare = plain[-1]
    assert any(len(packet) == len(bare) + 1 and packet[-1] == 0 for packet in stalled)
