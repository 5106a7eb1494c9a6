# amaranth: UnusedElaboratable=no
"""A bench for packet gates, and packets of which some are bad."""

from __future__ import annotations

import random

from firm_hdl import GateStatus
from firm_hdl.gateware.packets.gate import COUNTED
from firm_hdl.plan import build_plan, decode
from firm_hdl.sim.payloads import beats_of
from firm_hdl.wire import lay_out
from tests.gateware.packets.bench import PacketBench, beats

LATENCY = 9
"""Cycles from the transfer of the last beat to the first beat, and to the status."""
ERROR = 4
"""Cycles that an error adds at most."""
BACKLOG = 4
"""Cycles more for a link that cannot be held."""

OK, FULL, LARGE, OVERRUN = GateStatus.OK, GateStatus.FULL, GateStatus.LARGE, GateStatus.OVERRUN
DIAGNOSTICS = "diagnostic_msgs/msg/DiagnosticArray"
BOMB_HEAD = "00010000 01000000 02000000 01000000 00 000000 00350c00"
BOMB = bytes.fromhex(BOMB_HEAD).ljust(60, b"\0")
"""A packet that claims 800,000 elements."""
NO_BOMB = bytes.fromhex(BOMB_HEAD[:-8] + "00000000")


def gate_bench(gate, **options):
    names = [*COUNTED, "overrun"]
    return PacketBench(
        gate,
        {"in": gate.packets_in},
        {"out": (gate.packets_out, gate.bus_bytes, gate.size)},
        others={"status": gate.status},
        final={name: gate.counters[name] for name in names},
        **options,
    )


class GateRun:
    """A run of packets through a gate, with the checks that hold for every run."""

    def __init__(self, gate, packets, bench=None, want=None, **options):
        bus = gate.bus_bytes
        bench = bench or gate_bench(gate)
        total = sum(beats_of(len(packet), bus) for packet in packets)
        want = {"in": total, "status": len(packets)} if want is None else want
        source = beats(packets, bus, noise=random.Random(1))
        seen = bench.run({"in": source}, want, **{"settle": 30, **options})
        self.packets, self.taken, self.left = (
            seen.packets["out"],
            seen.times["in"],
            seen.times["out"],
        )
        self.statuses = [GateStatus(bits) for bits in seen.others["status"]]
        self.times = seen.times["status"]
        self.counters = bench.state
        self.lasts, at = [], -1
        for packet in packets:
            at += beats_of(len(packet), bus)
            self.lasts.append(self.taken[at])
        # One status per packet. The good packets leave, with their sizes.
        assert len(self.statuses) == len(packets)
        pairs = zip(packets, self.statuses, strict=True)
        assert self.packets == [packet for packet, status in pairs if status == OK]
        assert seen.sides["out"] == [{len(packet)} for packet in self.packets]
        counted = {name: self.statuses.count(each) for name, each in COUNTED.items()}
        assert self.counters == counted | {"overrun": self.statuses.count(OVERRUN)}


def expected_statuses(message, packets, bus_bytes, most=1 << 24):
    """Return the statuses that the interpreter of the plan gives to packets."""
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes, max_message_bytes=most)
    return [GateStatus[str(decode(plan, packet).status)] for packet in packets]
