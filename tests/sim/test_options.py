# amaranth: UnusedElaboratable=no
"""What a harness and the functions of a converter pass on to their bench."""

from __future__ import annotations

import gc
import importlib
from types import SimpleNamespace

import pytest

from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.signatures import Status, packet_layout
from firm_hdl.sim import Harness, RunOptions, Stalls, decode, encode, loopback
from firm_hdl.sim.bench import CHUNK, Bench, in_chunks
from firm_hdl.sim.record import RunResult
from tests.strategies import make

# The name `loopback` is also that of a function in the package.
FUNCTIONS = importlib.import_module("firm_hdl.sim.loopback")
SMALL = make("ros1", {"a": "uint8"})
MESSAGE = make("ros2", {"a": "uint8", "n": "uint8[]"})
PACKET = bytes.fromhex("00010000 07 000000 02000000 0102")
VALUE = {"a": 7, "n": [1, 2]}
STALLS = {"packets_in": Stalls.bits("01")}


@pytest.fixture
def jobs(monkeypatch):
    """The jobs of all benches, which are not run."""
    seen = []

    def run(bench, job):
        seen.append(job)
        job.sources.update({name: list(given) for name, given in job.sources.items()})
        return 0

    monkeypatch.setattr(Bench, "run", run)
    return seen


def test_counts_of_beats_that_a_deserializer_has_to_ignore_are_noise(jobs):
    packets = [bytes(27), b"", bytes(range(8))] * 9
    result = Harness(Deserializer(MESSAGE, bus_bytes=4), None).run_packets(packets)
    beats = [packet_layout(4).from_bits(bits) for bits in jobs[0].sources["packets_in"]]
    assert {beat.count for beat in beats if not beat.last} == {0, 1, 2, 3, 4}
    assert [beat.count for beat in beats if beat.last] == [3, 0, 4] * 9
    # A packet of 27 bytes has seven beats, and an empty one has one.
    assert result.beats_in == len(beats) == 9 * (7 + 1 + 2)


def test_a_limit_that_is_given_is_that_of_the_run(jobs):
    harness = Harness(None, Serializer(MESSAGE))
    harness.run_messages([], RunOptions(limit=77, deadline=5, settle=9))
    harness.run_messages([], RunOptions(deadline=5))
    assert [(job.options.limit, job.options.deadline) for job in jobs] == [(77, 5), (10_000, 5)]
    assert jobs[0].options.settle == 9


@pytest.mark.parametrize(
    ("stalls", "longest"),
    [
        (Stalls(0.5, 2, 7, seed=1), 7),
        # The longest stall of any stream, also where a pattern begins again.
        ({"packets_in": Stalls.bits("0110"), "status": Stalls.bits("01")}, 2),
        ({"status": Stalls.bits("1000"), "message.a": Stalls(0.5, 1, 2)}, 3),
    ],
)
def test_the_limit_grows_with_the_packets_and_with_their_stalls(jobs, stalls, longest):
    harness = Harness(Deserializer(MESSAGE, bus_bytes=4), None)
    for given in (None, stalls):
        for packets in ([], [PACKET], [PACKET] * 3, [PACKET, b""]):
            harness.run_packets(packets, RunOptions(stalls=given))
    least, *limits = [job.options.limit for job in jobs]
    one, three, other, same, *stalled = [limit - least for limit in limits]
    assert least > 1000 and one >= 10 * len(PACKET) and three == 3 * one
    # A packet without bytes is one, too.
    assert one < other < 2 * one
    assert same == 0 and stalled == [(1 + longest) * each for each in (one, three, other)]


def test_all_transfers_that_are_not_taken_are_counted(jobs):
    transfers = {0: [7], 1: [2], 2: [((1, 2, 0, 0, 0, 0, 0, 0), True)]}
    result = Harness(None, Serializer(MESSAGE)).run_messages([transfers, {0: [8, 9]}])
    assert result.not_taken == {0: 3, 1: 1, 2: 1}
    assert jobs[0].sources["message.a"] == [7, 8, 9]


@pytest.mark.parametrize("keeps_state", [True, False])
def test_a_harness_may_keep_its_state(keeps_state, tmp_path):
    harness = Harness(Deserializer(MESSAGE), None, keeps_state=keeps_state)
    for _ in range(2):
        assert harness.run_packets([PACKET]).statuses == [Status.OK]
    options = RunOptions(vcd=tmp_path / "x.vcd")
    if keeps_state:
        with pytest.raises(ValueError, match="keeps its state writes no waveforms"):
            harness.run_packets([PACKET], options)
    else:
        assert harness.run_packets([PACKET], options).statuses == [Status.OK]


def test_streams_are_sources_sinks_or_taps_of_a_bench():
    both = Harness(Deserializer(SMALL), Serializer(SMALL)).bench
    assert (set(both.sources), set(both.taps)) == ({"packets_in"}, {"message.a"})
    assert set(both.sinks) == {"status", "packets_out", "sent_status"}
    first = Harness(Deserializer(SMALL), None).bench
    assert (set(first.sources), set(first.taps)) == ({"packets_in"}, set())
    assert set(first.sinks) == {"status", "message.a"}
    second = Harness(None, Serializer(SMALL)).bench
    assert (set(second.sources), set(second.taps)) == ({"message.a"}, set())
    assert set(second.sinks) == {"status", "packets_out"}


@pytest.fixture
def collected():
    """Converters that nothing elaborates are collected, and warn, before the test is over."""
    yield
    gc.collect()


@pytest.mark.usefixtures("collected")
@pytest.mark.parametrize("function", [loopback, decode, encode])
def test_functions_have_all_options(function, monkeypatch):
    seen = []

    class Fake:
        def __init__(self, rx, tx, *, message, gated=False):
            seen.append((rx, tx, message, gated))

        def run(self, given, options):
            seen.append((given, options))
            return RunResult(packets=["p"], statuses=["s"], sent_statuses=["t"], transfers={0: []})

        run_packets = run_messages = run

    monkeypatch.setattr(FUNCTIONS, "Harness", Fake)
    given = {"stalls": STALLS, "deadline": 5, "limit": 6, "vcd": "x.vcd"}
    plan = {"wire": "ros1", "bus_bytes": 2, "max_message_bytes": 77}
    result = function(MESSAGE, iter([VALUE if function is encode else PACKET]), **plan, **given)
    (rx, tx, message, gated), (sent, options) = seen
    assert (rx is None, tx is None) == (function is encode, function is decode)
    for each in (rx, tx):
        if each is not None:
            assert {name: getattr(each.plan, name) for name in plan} == plan
    assert message is MESSAGE and not gated
    assert options == RunOptions(**given)
    assert sent == ([{0: [7], 1: [2], 2: [((1, 2), True)]}] if function is encode else [PACKET])
    # What it unpacks to: never the statuses of the second converter.
    assert tuple(result) == (({0: []} if function is decode else ["p"]), ["s"])
    # Without options, they are those of a converter and of a run.
    seen.clear()
    function(MESSAGE, [])
    usual = {"wire": "cdr", "bus_bytes": 8, "max_message_bytes": 1 << 24}
    for each in seen[0][:2]:
        if each is not None:
            assert {name: getattr(each.plan, name) for name in usual} == usual
    assert seen[0][3] is False and seen[1] == ([], RunOptions())


@pytest.mark.usefixtures("collected")
@pytest.mark.parametrize(
    ("stalls", "gated"),
    [
        (Stalls.bits("01"), True),
        ({"message.n.items": Stalls.bits("01")}, True),
        ({"message": Stalls.bits("11"), "status": Stalls.bits("01")}, False),
    ],
)
def test_a_loop_has_gates_if_any_leaf_is_stalled(stalls, gated, monkeypatch):
    seen = []

    def harness(rx, tx, *, message, gated):
        seen.append(gated)
        return SimpleNamespace(run_packets=lambda packets, options: RunResult())

    monkeypatch.setattr(FUNCTIONS, "Harness", harness)
    loopback(MESSAGE, [], stalls=stalls)
    assert seen == [gated]


def test_a_value_without_fields_is_no_mapping_of_transfers():
    empty = make("ros1", {})
    result = encode(empty, [{}, {0: [1]}])
    assert (result.packets, result.statuses) == ([b"", b""], [Status.OK] * 2)


@pytest.mark.parametrize("count", [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 3 * CHUNK + 1])
def test_every_stream_is_in_a_chunk(count):
    chunks = list(in_chunks(range(count)))
    assert [each for chunk in chunks for each in chunk] == list(range(count))
    assert all(0 < len(chunk) <= CHUNK for chunk in chunks)
