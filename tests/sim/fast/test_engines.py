# amaranth: UnusedElaboratable=no
"""Both engines: the same transfers in the same cycles, and those that are right."""

from __future__ import annotations

import gc
import random
from typing import Any

import pytest
from amaranth.hdl import DomainRenamer

from firm_hdl import PacketFifo
from firm_hdl.sim import DeadlineError, StallPlan, Stalls
from firm_hdl.sim.fast import FastSimulation
from tests.depth import by_depth
from tests.sim.fast.designs import Awkward, Fault

ENGINES = ("verilator", "amaranth")
NUMBERS = [1, -2, 300, -2048, 2047, 0, 0, 0, 17, -300]
PACKETS = [b"abcdefg", b"", b"1234", bytes(range(60)), b"x", b"12345678"]
STALLS: dict[str, StallPlan] = {
    "no stalls": None,
    "random": Stalls(probability=0.4, max_cycles=3, seed=5),
    "slow consumer": {"class": Stalls.bits("0001"), "packets_out": Stalls.bits("00100")},
    "slow producer": {"int": Stalls.bits("00001"), "packets_in": Stalls(0.9, seed=2)},
}
RECEIVED = ("class", "packets_out", "echo_out.0", "echo_out.1")


def observe(simulation: FastSimulation) -> dict[str, Any]:
    """Send and run in all ways; return all that can be seen."""
    seen: dict[str, Any] = {"at the start": (simulation.get("wide"), simulation.cycle)}
    simulation.send("int", NUMBERS)
    simulation.send_packets("packets_in", PACKETS)
    simulation.send("echo_in.0", b"hello")
    simulation.run(3)
    simulation.set("p.in", 0xA5)
    simulation.set("add", 4)
    seen["then"] = (simulation.get("wide"), simulation.cycle, simulation.queued("int"))
    simulation.run_until({"class": 4, "packets_out": 2})
    seen["until"] = simulation.cycle
    simulation.run_until_idle(quiet=30)
    seen["idle"] = simulation.cycle
    for name in RECEIVED:
        seen[name] = simulation.transfers(name)
    simulation.reset()
    simulation.send("int", [5])
    simulation.run_until({"class": 1})
    seen["after the reset"] = (simulation.transfers("class"), simulation.cycle)
    return seen


def in_amaranth(stalls: StallPlan, fault: Fault = "") -> dict[str, Any]:
    with FastSimulation(Awkward(fault), engine="amaranth", stalls=stalls) as simulation:
        return observe(simulation)


@pytest.fixture(params=STALLS)
def stalls(request: pytest.FixtureRequest) -> StallPlan:
    plan = STALLS[request.param]
    if isinstance(plan, Stalls):
        return dict.fromkeys(("int", "class", "packets_in", "packets_out"), plan)
    return plan


@pytest.mark.sampled(4)
def test_both_engines_transfer_the_same_in_the_same_cycles(start, stalls):
    seen = observe(start("verilator", stalls))
    assert seen == in_amaranth(stalls)
    assert all(seen[name] for name in RECEIVED if name != "echo_out.0")


@pytest.mark.parametrize("fault", ["value", "late", "order"])
@pytest.mark.sampled(3)
def test_a_fault_in_the_design_is_seen(start, fault):
    simulation = start("verilator")
    assert observe(simulation) != in_amaranth(None, fault)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.sampled(2)
def test_transfers_are_those_of_the_design(start, engine, stalls):
    simulation = start(engine, stalls)
    simulation.send("int", NUMBERS)
    simulation.send("echo_in.1", [200, 0x55])
    simulation.send_packets("packets_in", PACKETS)
    simulation.run_until_idle(quiet=50)
    sums = [sum(NUMBERS[: n + 1]) + 3 * (n + 1) for n in range(len(NUMBERS))]
    assert [(each.sum, each.odd) for each in simulation.receive("class")] == [
        (each, each & 1) for each in sums
    ]
    assert simulation.receive_packets("packets_out") == PACKETS
    assert simulation.receive("echo_out.0") == [200, 0x55]
    assert simulation.receive("echo_out.1") == []
    assert simulation.receive("class") == []


@pytest.mark.parametrize("clocks", [None, {"sync": 10, "video": 37}, {"video": 3, "sync": 2}])
@pytest.mark.sampled(4)
def test_packets_cross_to_another_clock(start, clocks):
    seen = []
    for engine in ENGINES:
        simulation = start(engine, {"far": Stalls(0.3, seed=1)}, clocks=clocks)
        simulation.send_packets("near", PACKETS)
        simulation.run_until({"far": 3})
        simulation.reset()
        simulation.send_packets("near", PACKETS)
        simulation.run_until_idle(quiet=40)
        packets = simulation.packets("far")
        assert [each.data for each in packets] == PACKETS
        simulation.run(370)
        seen.append((packets, simulation.cycle, simulation.get("far_cycles"), simulation.clocks))
    assert seen[0] == seen[1]
    _, cycle, far_cycles, periods = seen[0]
    first = next(iter(periods))
    # The first edges of both clocks are a period after the start.
    assert far_cycles == cycle * periods[first] // periods["video"]
    assert periods == (clocks or {"sync": 1, "video": 1}) and first == next(
        iter(clocks or ["sync"])
    )


@pytest.mark.parametrize("engine", by_depth(["amaranth"], ENGINES))
def test_a_renamed_design_has_the_ports_and_clocks_of_its_component(engine):
    renamed = DomainRenamer({"sync": "core"})(Awkward())
    clocks = {"core": 2, "video": 3}
    with FastSimulation(renamed, engine=engine, clocks=clocks, options=["-O0"]) as simulation:
        simulation.send_packets("near", PACKETS)
        simulation.run_until({"far": len(PACKETS)})
        assert simulation.receive_packets("far") == PACKETS
        assert simulation.cycle == simulation.get("wide") & ((1 << 40) - 1)
    with FastSimulation(DomainRenamer("link")(PacketFifo(4, 64, 8)), engine=engine) as simulation:
        simulation.send_packets("packets_in", PACKETS)
        simulation.run_until({"packets_out": len(PACKETS)})
        assert simulation.receive_packets("packets_out") == PACKETS
        assert simulation.clocks == {"link": 1}


@pytest.mark.parametrize("engine", ENGINES)
def test_live(start, engine):
    simulation = start(engine, ignored=["class"])
    simulation.go_live(quiet=200, nap_cycles=10, nap_ms=1)
    packets = [random.Random(n).randbytes(n) for n in range(40)]
    came = []
    for packet in packets:
        simulation.send_packets("packets_in", [packet])
        simulation.send("int", [1])
        while not (found := simulation.receive_packets("packets_out")):
            assert simulation.wait(60)
        came += found
    assert came == packets
    with pytest.raises(RuntimeError, match="live"):
        simulation.run(1)
    assert not simulation.wait(0.01)
    # It sleeps, and still some cycles pass.
    before = simulation.get("wide")
    while simulation.get("wide") == before:
        pass
    simulation.halt()
    assert simulation.queued("int") == 0
    assert simulation.receive("class") == []
    cycle = simulation.cycle
    simulation.run(5)
    assert simulation.cycle == cycle + 5


def cycle_of(simulation: FastSimulation) -> int:
    """Return the number of cycles, as the design counts them."""
    return simulation.get("wide") & ((1 << 40) - 1)


def look_often(simulation: FastSimulation) -> int:
    """Look at a live design 40 times; return the cycle of the last look.

    An engine that is awake runs at least 16 cycles between two looks, one that sleeps those of one
    nap.
    """
    return [cycle_of(simulation) for _ in range(40)][-1]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_live_engine_is_awake_at_first_and_after_each_call(start, engine):
    simulation = start(engine)
    # Silence before it is live does not count.
    simulation.run(400)
    simulation.go_live(quiet=400, nap_cycles=3, nap_ms=1000)
    assert look_often(simulation) >= 400 + 400
    for wake in (lambda: simulation.set("unused", 1), lambda: simulation.stall("int", [])):
        for _ in range(300):
            before = cycle_of(simulation)
            if cycle_of(simulation) - before == 3:
                break
        else:
            pytest.fail("it does not sleep")
        wake()
        assert look_often(simulation) >= before + 400
    simulation.halt()


@pytest.mark.parametrize("engine", ENGINES)
def test_transfers_may_come_in_the_last_cycle(start, engine):
    simulation = start(engine)
    simulation.send("echo_in.1", b"abc")
    with pytest.raises(DeadlineError, match=r"Did not come in 3 cycles: 1 on 'echo_out.0'"):
        simulation.run_until({"echo_out.0": 3}, limit=3)
    simulation.reset()
    simulation.send("echo_in.1", b"abc")
    simulation.run_until({"echo_out.0": 3}, limit=4)
    assert simulation.cycle == 4


@pytest.mark.parametrize("engine", ENGINES)
def test_a_deadlock_is_an_error(start, engine):
    simulation = start(engine)
    simulation.stall("packets_out", [True] * 5000 + [False])
    simulation.send_packets("packets_in", [bytes(60)] * 2)
    with pytest.raises(DeadlineError, match=r"^Not taken up to cycle \d+: \d+ on 'packets_in'$"):
        simulation.run_until_idle(quiet=100)
    late = r"^Did not come in 50 cycles: 2 on 'packets_out', 1 on 'class'$"
    with pytest.raises(DeadlineError, match=late):
        simulation.run_until({"packets_out": 2, "class": 1}, limit=50)
    simulation.stall("packets_out", [])
    simulation.run_until({"packets_out": 2})


@pytest.mark.parametrize("engine", ENGINES)
def test_much_is_sent_and_received_at_once(start, engine):
    simulation = start(engine)
    # Verilator's engine sends what came in parts of 64 KiB, and drops as much of what it was sent.
    data = bytes(range(250)) * (1 if engine == "amaranth" else 40)
    packets = [bytes([n & 255] * 59) for n in range(10 if engine == "amaranth" else 2000)]
    simulation.send("echo_in.1", data)
    simulation.send_packets("packets_in", packets)
    simulation.run_until({"packets_out": len(packets), "echo_out.0": len(data)})
    assert simulation.transfers("echo_out.0") == [(n + 1, each) for n, each in enumerate(data)]
    assert simulation.receive_packets("packets_out") == packets


@pytest.mark.parametrize("engine", ENGINES)
def test_a_simulation_that_starts_again_is_as_at_first(start, engine):
    simulation = start(engine, {"echo_in.1": Stalls(0.3, max_cycles=3)})
    seen = []
    for end in (simulation.halt, simulation.close):
        simulation.send("echo_in.1", bytes(range(20)))
        simulation.run(200)
        seen.append(simulation.transfers("echo_out.0"))
        simulation.send("echo_in.1", b"not taken")
        simulation.go_live()
        end()
        simulation._queued = [9] * len(simulation.ports.streams)
        simulation.restart()
        assert simulation.cycle == 0 and not simulation.is_live
        assert simulation.queued("echo_in.1") == 0
    simulation.send("echo_in.1", bytes(range(20)))
    simulation.run(200)
    seen.append(simulation.transfers("echo_out.0"))
    assert len(seen[0]) == 20 and seen[0] == seen[1] == seen[2]


def test_a_simulation_that_nobody_closed_leaves_no_process(start, programs):
    simulation = FastSimulation(Awkward(), engine="verilator", options=["-O0"], cache=programs)
    process = simulation._channel.process  # type: ignore[union-attr]
    assert process.poll() is None
    del simulation
    gc.collect()
    assert process.returncode is not None
