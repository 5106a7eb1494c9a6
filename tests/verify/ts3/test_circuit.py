"""The runs of a circuit, with a harness and a replay that only remember what they are asked."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

import firm_hdl.verify.ts3.circuit as circuit
from firm_hdl.frontend import load_message
from firm_hdl.plan import build_plan
from firm_hdl.sim import DeadlineError, Stalls
from firm_hdl.verify import Options, Result
from firm_hdl.verify.simulators.crosscheck import Comparison
from firm_hdl.wire import lay_out

MESSAGE = load_message("std_msgs/msg/Bool")
PLAN = build_plan(lay_out(MESSAGE), bus_bytes=4, max_message_bytes=77)
PACKETS = [b"one", b"two"]
STALLS = Stalls.bits("01")


class FakeHarness:
    """Counts ten cycles for each run, and answers or fails as it is told."""

    def __init__(self, rx, tx, **options):
        self.cores, self.options = (rx, tx), options
        self.bench, self.runs = SimpleNamespace(cycles=10), []
        self.answer = "seen"

    def run_packets(self, packets, options):
        self.runs.append((packets, options))
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer


class FakeCrosscheck:
    """A replay that finds what it is told."""

    comparison = Comparison(failures=(), cycles=5)

    def __init__(self, simulator, cores, make, message):
        self.simulator, self.cores, self.make, self.message = simulator, cores, make, message
        self.trace, self.calls = SimpleNamespace(probes=["a probe"]), []

    def start(self, name):
        self.calls.append(name)
        return f"observer of {name}"

    def done(self, seen):
        self.calls.append(seen)

    def compare(self):
        return self.comparison


@pytest.fixture
def make(monkeypatch):
    """A function that makes a circuit; it returns that, its result and its harnesses."""
    harnesses = []

    def harness(*cores, **options):
        harnesses.append(FakeHarness(*cores, **options))
        return harnesses[-1]

    monkeypatch.setattr(circuit, "Harness", harness)
    monkeypatch.setattr(circuit, "Crosscheck", FakeCrosscheck)
    for core in ("Deserializer", "Serializer"):
        kind = core.lower()
        monkeypatch.setattr(circuit, core, lambda *message, kind=kind, **o: (kind, *message, o))
    fake = SimpleNamespace(title="Fake")
    monkeypatch.setattr(circuit, "simulator", lambda name: None if name == "python" else fake)

    def made(**options):
        result = Result(distro="lyrical", name=MESSAGE.name)
        found = circuit.Circuit(MESSAGE, PLAN, Options(**options), result)
        return found, result, harnesses

    return made


@pytest.mark.parametrize("simulator", ["python", "ghdl"])
@pytest.mark.parametrize("stalled", [True, False])
def test_the_converters_are_those_of_the_plan(make, simulator, stalled):
    made, _, (harness,) = make(simulator=simulator, stalled=stalled)
    limits = {"wire": "cdr", "bus_bytes": 4, "max_message_bytes": 77}
    both = tuple((kind, MESSAGE, limits) for kind in ("deserializer", "serializer"))
    assert harness.cores == both
    assert harness.options["gated"] == stalled
    # Exported text keeps its state from run to run.
    assert harness.options["keeps_state"] == (simulator == "ghdl")
    assert list(harness.options["probes"]) == (["a probe"] if simulator == "ghdl" else [])
    if simulator == "ghdl":
        assert (made._cross.cores, made._cross.message) == (both, MESSAGE.name)
        assert made._cross.make() == both


@pytest.mark.parametrize("simulator", ["python", "ghdl"])
def test_a_run_is_counted_and_kept_for_the_replay(make, simulator):
    made, result, (harness,) = make(simulator=simulator)
    assert made.send("here", PACKETS, STALLS) == made.send("there", PACKETS, None) == "seen"
    assert [packets for packets, _ in harness.runs] == [PACKETS] * 2
    assert [options.stalls for _, options in harness.runs] == [STALLS, None]
    observers = ["observer of here", "observer of there"] if simulator == "ghdl" else [None] * 2
    assert [options.observe for _, options in harness.runs] == observers
    assert (result.packets, result.simulated_cycles, result.failures) == (4, 20, [])
    if simulator == "ghdl":
        assert made._cross.calls == ["here", "seen", "there", "seen"]


def test_a_run_that_fails_is_a_failure_and_the_next_one_follows(make):
    made, result, (harness,) = make(simulator="ghdl")
    harness.answer = DeadlineError("No transfer")
    assert made.send("here", PACKETS, None) is None
    assert result.failures == ["here: DeadlineError: No transfer"]
    assert (result.packets, made._cross.calls) == (0, ["here"])
    harness.answer = "seen"
    assert made.send("there", PACKETS, None) == "seen"
    assert result.failures == ["here: DeadlineError: No transfer"] and result.packets == 2


@pytest.mark.parametrize(
    ("answer", "failures"),
    [
        # The run is meant to end early.
        (DeadlineError("No transfer"), []),
        ("seen", []),
        (AssertionError("valid fell"), ["hardware, nothing taken: AssertionError: valid fell"]),
    ],
)
def test_full_circuits_are_interrupted_for_the_replay(make, answer, failures):
    made, result, (harness,) = make(simulator="ghdl")
    harness.answer = answer
    made.interrupt(PACKETS)
    ((packets, options),) = harness.runs
    assert (packets, result.failures) == (PACKETS, failures)
    # Nothing may leave them before the run ends.
    assert set(options.stalls) == {"packets_out", "status", "sent_status"}
    for each in options.stalls.values():
        assert set(each.pattern[: options.limit]) == {"0"}
    assert options.observe == "observer of hardware, nothing taken"
    # It is no run with packets to compare, but its cycles are replayed.
    assert (result.packets, result.simulated_cycles) == (0, 10)
    assert made._cross.calls == ["hardware, nothing taken"]


def test_without_a_replay_nothing_is_interrupted_or_compared(make):
    made, result, (harness,) = make()
    made.interrupt(PACKETS)
    made.crosscheck()
    assert harness.runs == [] and result.comparison is None and result.failures == []


@pytest.mark.parametrize(
    ("comparison", "failures"),
    [
        (Comparison(failures=(), cycles=5), []),
        (Comparison(failures=("Fake: one", "Fake: two"), cycles=5), ["Fake: one", "Fake: two"]),
        # It was asked for, so it has to say something.
        (Comparison(failures=(), cycles=0), ["Fake: no cycle was compared"]),
    ],
)
def test_what_the_replay_finds_is_a_failure(make, monkeypatch, comparison, failures):
    monkeypatch.setattr(FakeCrosscheck, "comparison", comparison)
    made, result, _ = make(simulator="ghdl")
    result.failures.append("before")
    made.crosscheck()
    assert result.comparison is comparison and result.failures == ["before", *failures]


@pytest.mark.parametrize("simulator", ["python", "ghdl"])
def test_each_run_has_a_waveform_of_its_own(make, tmp_path, simulator):
    folder = tmp_path / "new" / "waves"
    made, result, harnesses = make(simulator=simulator, vcd=str(folder))
    made.send("here", PACKETS, None)
    (folder / "std_msgs_msg_Bool_cdr_4_run2.vcd").symlink_to(tmp_path / "thesis.tex")
    made.send("there", PACKETS, STALLS)
    files = [str(folder / f"std_msgs_msg_Bool_cdr_4_run{number}.vcd") for number in (1, 2)]
    # A link is not followed.
    assert [*folder.iterdir()] == []
    # In a replay, runs keep the state of the run before, so waveforms are those of others.
    waves = harnesses[-1]
    assert len(harnesses) == (2 if simulator == "ghdl" else 1)
    assert [options.vcd for _, options in waves.runs] == files
    assert [options.stalls for _, options in waves.runs] == [None, STALLS]
    if simulator == "ghdl":
        assert not waves.options.get("keeps_state") and waves.options["gated"]
        assert [options.observe for _, options in waves.runs] == [None, None]
        assert [options.vcd for _, options in harnesses[0].runs] == [None, None]
    assert (result.packets, result.simulated_cycles) == (4, 20)
