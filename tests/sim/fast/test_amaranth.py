"""Amaranth's simulator as an engine, on a design that takes little time."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from amaranth.hdl import Module
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.sim import DeadlineError, Stalls
from firm_hdl.sim.fast import FastSimulation, Transfer, amaranth_engine, protocol


class Pipes(wiring.Component):
    """Two registers in streams, and a plain input that goes through."""

    def __init__(self):
        byte = stream.Signature(8)
        super().__init__(
            {
                "i": In(byte),
                "o": Out(byte),
                "j": In(byte),
                "p": Out(byte),
                "x": In(8, init=1),
                "y": Out(8),
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.d.comb += self.y.eq(self.x)
        for come, go in ((self.i, self.o), (self.j, self.p)):
            m.d.comb += come.ready.eq(~go.valid | go.ready)
            with m.If(come.ready):
                m.d.sync += [go.valid.eq(come.valid), go.payload.eq(come.payload)]
        return m


@pytest.fixture
def start(request):
    """Start a simulation that is closed at the end of the test."""

    def started(**options):
        simulation = FastSimulation(Pipes(), engine="amaranth", **options)
        request.addfinalizer(simulation.close)
        return simulation

    return started


def test_the_last_value_of_an_input_counts(start):
    simulation = start()
    assert simulation.get("y") == 1
    for value in (5, 2, 0, 0x81):
        simulation.set("x", value)
        assert simulation.get("y") == value
    simulation.run(3)
    for _ in range(2):
        simulation.reset()
        # The look at the value applies it; another reset takes it back.
        assert simulation.get("y") == 0x81 and simulation.cycle == 0


def test_calls_after_a_look_at_a_cycle_still_change_that_cycle(start):
    simulation = start()
    simulation.send("i", b"a")
    simulation.run(1)
    assert simulation.get("y") == 1
    # In cycle 1, `o` would transfer. Of four cycles, three are stalled, and cycle 3 is not.
    simulation.stall("o", [True] * 3 + [False])
    simulation.send("j", b"b")
    simulation.run(6)
    assert simulation.transfers("o") == [(3, ord("a"))]
    assert simulation.transfers("p") == [(2, ord("b"))]


def test_a_reset_forgets_what_was_offered(start):
    simulation = start()
    simulation.stall("o", [True] * 9 + [False])
    for _ in range(2):
        # The payload that was offered last is offered again, and one stays in the queue.
        simulation.send("i", b"ab")
        simulation.run(5)
        assert (simulation.cycle, simulation.queued("i")) == (5, 1)
        simulation.reset()
    simulation.stall("o", [])
    simulation.send("i", b"b")
    simulation.run(4)
    assert simulation.transfers("o") == [Transfer(1, ord("b"))]


def test_many_transfers_come_in_their_order(start, monkeypatch):
    monkeypatch.setattr(amaranth_engine, "_FLUSH_TRANSFERS", 4)
    simulation = start()
    simulation.send("i", bytes(range(30)))
    simulation.send("j", bytes(range(7)))
    simulation.run(40)
    assert simulation.transfers("o") == [(n + 1, n) for n in range(30)]
    assert simulation.transfers("p") == [(n + 1, n) for n in range(7)]


def test_each_condition_counts_its_own_stream_and_all_must_be_met(start):
    simulation = start(stalls={"j": Stalls.bits("0" * 20 + "1")})
    simulation.send("i", bytes(9))
    simulation.send("j", b"x")
    # More transfers come on `o` than are asked for.
    simulation.run_until({"o": 2, "p": 1}, limit=60)
    assert simulation.cycle == 22
    assert len(simulation.transfers("o")) == 9 and len(simulation.transfers("p")) == 1
    # Conditions of one run do not end the next.
    simulation.send("i", bytes(2))
    simulation.run(5)
    assert simulation.cycle == 27


@pytest.mark.parametrize(("limit", "comes"), [(3, False), (4, True)])
def test_a_condition_may_be_met_in_the_last_cycle(start, limit, comes):
    simulation = start()
    simulation.send("i", b"abc")
    if comes:
        simulation.run_until({"o": 3}, limit=limit)
    else:
        with pytest.raises(DeadlineError, match="Did not come in 3 cycles: 1 on 'o'"):
            simulation.run_until({"o": 3}, limit=limit)
    assert simulation.cycle == limit


@pytest.mark.parametrize("quiet", [1, 5])
def test_silence_begins_with_each_run_and_after_each_transfer(start, quiet):
    simulation = start()
    simulation.run_until_idle(quiet=quiet)
    assert simulation.cycle == quiet
    simulation.send("i", b"ab")
    simulation.run_until_idle(quiet=quiet)
    # Two transfers in, and the last one out a cycle later.
    assert simulation.cycle == quiet + 3 + quiet
    simulation.run_until_idle(quiet=quiet)
    assert simulation.cycle == quiet + 3 + 2 * quiet


def test_an_offer_stays_during_a_stall_of_its_stream(start):
    # Offered in cycle 1, when `o` holds the first payload back until cycle 6.
    stalls = {"i": Stalls.bits("1100000001"), "o": Stalls.bits("0000001111")}
    simulation = start(stalls=stalls)
    simulation.send("i", b"ab")
    simulation.run(9)
    assert simulation.transfers("o") == [(6, ord("a")), (7, ord("b"))]


def test_an_engine_that_sleeps_runs_some_cycles_after_each_nap(start, monkeypatch):
    naps = []

    def select(read, write, other, seconds=None):
        if seconds:
            naps.append(seconds)
        return real(read, write, other, seconds)

    real = amaranth_engine.select.select
    monkeypatch.setattr(amaranth_engine, "select", SimpleNamespace(select=select))
    simulation = start()
    simulation.go_live(quiet=0, nap_cycles=7, nap_ms=20)
    while len(naps) < 3:
        assert not simulation.wait(0.01)
    simulation.halt()
    assert set(naps) == {0.02}
    # From one sleep to the next are as many cycles as were asked for.
    assert simulation.cycle % 7 == 0 and simulation.cycle >= 21
    simulation.send("i", b"a")
    simulation.go_live(quiet=10, nap_cycles=1, nap_ms=1000)
    assert simulation.wait(60)
    simulation.halt()
    assert [each.bits for each in simulation.transfers("o")] == [ord("a")]


def test_a_long_run_ends_when_its_simulation_is_closed(start):
    simulation = start()
    channel = simulation._channel
    channel.send(protocol.run(1 << 40, 0, []))
    simulation.close()
    assert not channel._thread.is_alive()


def test_what_came_before_a_restart_is_gone(start):
    simulation = start(stalls={"i": Stalls.bits("001")})
    simulation.send("i", b"abc")
    simulation.run(20)
    simulation.set("x", 9)
    simulation.restart()
    assert simulation.transfers("o") == [] and simulation.get("y") == 1
    simulation.send("i", b"ab")
    simulation.run(20)
    # The stalls are those of the start.
    assert simulation.transfers("o") == [(3, ord("a")), (6, ord("b"))]
