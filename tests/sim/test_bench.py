"""The bench, cycle by cycle: offers, transfers, observations and deadlines.

The design is a register in a stream: a payload leaves one cycle after it enters.
"""

from __future__ import annotations

import pytest
from amaranth.hdl import Cat, Module, Signal

from firm_hdl.sim import DeadlineError, StreamRuleError
from firm_hdl.sim.bench import RESET_CYCLES, WORD_BITS, Bench, Job, Ports, RunOptions
from firm_hdl.sim.stalls import Stalls
from tests.sim.components import Relay


class Run:
    """A run of parallel relays, with the payloads that were taken from each, by cycle."""

    def __init__(
        self,
        given,
        *,
        shapes=8,
        expected=None,
        fault="",
        probes=lambda relays: (),
        payloads=lambda relays: {},
        **options,
    ):
        relays = [Relay(shapes, fault) for _ in given]
        top = Module()
        top.submodules += relays
        self.taken = {f"o{n}": [] for n in range(len(given))}
        ports = Ports(
            sources={f"i{n}": relay.i for n, relay in enumerate(relays)},
            sinks={f"o{n}": relay.o for n, relay in enumerate(relays)},
            payloads=payloads(relays),
        )
        self.bench = Bench(top, ports, probes=probes(relays))
        wanted = sum(map(len, given)) if expected is None else expected
        self.job = Job(
            sources={f"i{n}": each for n, each in enumerate(given)},
            takes={
                name: lambda cycle, bits, name=name: self.taken[name].append((cycle, bits))
                for name in self.taken
            },
            finished=lambda: sum(map(len, self.taken.values())) >= wanted,
            outstanding=lambda: "something",
            options=RunOptions(**options),
        )

    def go(self):
        return self.bench.run(self.job)


class RelayBench:
    """A relay, a counter of clock edges without a reset, and one with a reset."""

    def __init__(self, *, keeps_state, bits=8):
        relay, top = Relay(bits), Module()
        self.edges, self.since = Signal(8, reset_less=True), Signal(8)
        top.submodules.relay = relay
        top.d.sync += [self.edges.eq(self.edges + 1), self.since.eq(self.since + 1)]
        ports = Ports(sources={"i": relay.i}, sinks={"o": relay.o})
        probes = [self.edges, self.since, relay.i.payload, relay.o.valid]
        self.bench = Bench(top, ports, probes=probes, keeps_state=keeps_state)

    def run(self, given, **options):
        """Run until all payloads are taken; return the probes of each cycle."""
        seen, taken = [], []
        self.bench.run(
            Job(
                sources={"i": given},
                takes={"o": lambda cycle, bits: taken.append(bits)},
                finished=lambda: len(taken) >= len(given),
                outstanding=lambda: "something",
                options=RunOptions(observe=seen.append, **options),
            )
        )
        assert taken == given
        return seen


@pytest.mark.parametrize("keeps_state", [True, False])
def test_between_runs_is_a_reset_or_a_new_start(keeps_state):
    relay_bench = RelayBench(keeps_state=keeps_state)
    first, second = relay_bench.run([5, 6]), relay_bench.run([7])
    assert first[0] == [0, 0, 0, 0]
    # The edge that ends the last cycle, and those of the reset.
    edges = first[-1][0] + 1 + RESET_CYCLES if keeps_state else 0
    assert second[0] == [edges, 0, 0, 0]
    assert [row[1:] for row in second] == [
        row[1:] for row in RelayBench(keeps_state=False).run([7])
    ]


def test_a_run_that_failed_is_followed_by_a_reset():
    relay_bench = RelayBench(keeps_state=True)
    with pytest.raises(DeadlineError, match="No end after 4 cycles"):
        relay_bench.run([5], stalls={"o": Stalls.bits("0" * 9 + "1")}, limit=4)
    second = relay_bench.run([7])
    assert second[0] == [5 + 1 + RESET_CYCLES, 0, 0, 0]


@pytest.mark.parametrize(
    ("stalls", "taken"),
    [
        # In the same cycle, one payload leaves the register and the next one enters.
        ({"o0": "10"}, [(2, 1), (4, 2), (6, 3)]),
        ({"o0": "001"}, [(2, 1), (5, 2), (8, 3)]),
        ({"i0": "001"}, [(3, 1), (6, 2), (9, 3)]),
        ({"i0": "01", "o0": "011"}, [(2, 1), (4, 2), (7, 3)]),
    ],
)
def test_stalls_delay_by_exactly_their_cycles(stalls, taken):
    run = Run([[1, 2, 3]], stalls={name: Stalls.bits(bits) for name, bits in stalls.items()})
    run.go()
    assert run.taken["o0"] == taken


@pytest.mark.parametrize("bits", [WORD_BITS // 4, WORD_BITS // 2, WORD_BITS - 3, WORD_BITS, 400])
def test_wide_payloads_arrive_whole(bits):
    """The words that the bench drives divide them at any bit."""
    ones = (1 << bits) - 1
    given = [[ones, 0, 1, ones - 1], [1 << (bits - 1), ones], [0, ones // 3]]
    run = Run(given, shapes=bits)
    run.go()
    got = [[value for _, value in each] for each in run.taken.values()]
    assert got == given


def test_deadline_is_the_most_cycles_without_a_transfer():
    # No stream transfers in the cycles 2 to 6.
    stalls = {"i0": Stalls.bits("10000001")}
    run = Run([[1, 2]], stalls=stalls, deadline=1000)
    run.go()
    assert run.taken["o0"] == [(1, 1), (8, 2)]
    silent = Run([[1]], expected=2, deadline=5)
    expected_message = (
        "No transfer in 6 cycles up to cycle 7; outstanding: something; "
        "offered and not taken: nothing"
    )
    with pytest.raises(DeadlineError) as caught:
        silent.go()
    assert str(caught.value) == expected_message
    assert silent.bench.cycles == 8
    with pytest.raises(DeadlineError, match=r"^No transfer in 1001 cycles"):
        Run([[1]], expected=2).go()


@pytest.mark.parametrize(("fault", "rule"), [("drop", "2"), ("change", "3")])
def test_rules_are_watched_at_sinks(fault, rule):
    run = Run([[4, 4]], fault=fault, stalls={"o0": Stalls.bits("00001")})
    with pytest.raises(StreamRuleError, match=f"[Rr]ule {rule}"):
        run.go()


def test_probes_are_seen_in_each_cycle_and_before_the_first():
    seen = []
    run = Run(
        [[5, 6]],
        observe=seen.append,
        probes=lambda relays: [relays[0].o.payload, Cat(relays[0].o.valid, relays[0].i.valid)],
    )
    cycles = run.go()
    assert len(seen) == cycles + 1
    assert seen[:5] == [[0, 0], [0, 2], [5, 3], [6, 1], [6, 0]]
