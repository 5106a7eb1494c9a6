# amaranth: UnusedElaboratable=no
"""A reset of one cycle, at any time: the current packet is discarded, later ones are right."""

from __future__ import annotations

import pytest
from amaranth.hdl import Cat, ClockDomain, Module, Value
from amaranth.sim import Simulator

from firm_hdl import Deserializer, Serializer, Status
from firm_hdl.gateware.signatures import leaf_streams
from firm_hdl.sim.levels import divided
from firm_hdl.sim.payloads import PacketCollector, all_beats, decoder_of, encoder_of
from tests.depth import by_depth
from tests.strategies import make

MESSAGE = make(
    "ros2", {"a": "uint8", "s": "string<=20", "p": (make("ros2", {"x": "uint16"}, "P"), "[]")}
)
GOOD = bytes.fromhex("00010000 01000000 05000000 6162636400000000 02000000 0a000b00")
# The packet during the reset: a good one, the middle of a run and of a loop, an error whose rest is
# completed with zeros, and an error whose rest is dropped.
BEFORE = {
    "good": GOOD,
    "run": bytes.fromhex("00010000 02000000 15000000") + b"x" * 20 + b"\0" * 4 + b"\3\0\0\0" * 4,
    "loop": bytes.fromhex("00010000 03000000 01000000 00000000 ff000000") + b"y" * 40,
    "length": bytes.fromhex("00010000 04000000 ff000000") + b"z" * 50,
    "drain": bytes.fromhex("00020000") + b"z" * 60,
    "trailing": GOOD + b"z" * 60,
}


# Leaves taken before the reset: all, none, or every other one, so that steps are half done.
TAKEN = (0b111111, 0b100001, 0, 0b110101, 0b101010)


class Bench:
    """A converter in a clock domain with a reset, driven in each cycle by a function."""

    def __init__(self, converter, good):
        # The packet after the reset.
        self.good = good
        top = Module()
        top.domains.sync = self.domain = ClockDomain("sync")
        top.submodules.converter = self.converter = converter
        self.leaves = leaf_streams(converter.message, converter.tree)
        self.simulator = Simulator(divided(top))
        self.simulator.add_clock(1e-6)
        self.simulator.add_testbench(self._testbench)
        self.used = False

    def run(self, script):
        """Run a testbench from the start."""
        if self.used:
            self.simulator.reset()
        self.used, self.script = True, script
        self.simulator.run()

    async def _testbench(self, ctx):
        await self.script(ctx)


async def offer(ctx, port, payloads, fired):
    """Offer the first of some payloads; drop the one that was taken in the last cycle."""
    if fired and payloads:
        payloads.pop(0)
    if payloads:
        ctx.set(Value.cast(port.payload), payloads[0])
    ctx.set(port.valid, bool(payloads))


def after_reset_of_reader(bench, packet, at, ready):
    """Return transfers and statuses after a reset in a cycle of a packet.

    `ready`: bits of the leaves and the status that are taken before the reset; registers of the
    others are full.
    """
    rx = bench.converter
    plan = rx.plan
    got, statuses = {leaf: [] for leaf in bench.leaves}, []
    outputs = [*bench.leaves.values(), rx.status]
    valids, bits = Cat(port.valid for port in outputs), [Value.cast(p.payload) for p in outputs]

    async def script(ctx):
        beats, fired = list(all_beats([packet] * 2, plan.bus_bytes)), False
        for cycle in range(at + 26 + 2 * len(bench.good) // plan.bus_bytes):
            if cycle == at:
                beats, fired = [], False
            if cycle == at + 1:
                beats = list(all_beats([bench.good] * 2, plan.bus_bytes))
            ctx.set(bench.domain.rst, cycle == at)
            await offer(ctx, rx.packets, beats, fired)
            for number, port in enumerate(outputs):
                ctx.set(port.ready, ready >> number & 1 or cycle > at)
            _, _, taken, valid, *payloads = await ctx.tick().sample(rx.packets.ready, valids, *bits)
            fired = taken and beats
            if cycle <= at:
                continue
            for leaf in got:
                if valid >> leaf & 1:
                    got[leaf].append(decoder_of(plan.leaves[leaf])(payloads[leaf]))
            if valid >> len(got):
                statuses.append(Status(payloads[-1]))

    bench.run(script)
    return got, statuses


def letters(text, lanes):
    parts = [text[at : at + lanes] for at in range(0, len(text), lanes)]
    return [
        ((*part, *[0] * (lanes - len(part))), number == len(parts) - 1)
        for number, part in enumerate(parts)
    ]


def transfers_of_good(lanes):
    return {0: [1], 1: [4], 2: letters(b"abcd", lanes), 3: [2], 4: [10, 11]}


def repeated(transfers):
    return {leaf: payloads * 2 for leaf, payloads in transfers.items()}


RIGHT = ([GOOD] * 2, [False] * 2, [Status.OK] * 2, b"")


@pytest.mark.parametrize("bus_bytes", by_depth([4], [4, 16]))
def test_deserializer_forgets_the_packet_under_way(bus_bytes):
    bench = Bench(Deserializer(MESSAGE, bus_bytes=bus_bytes, max_message_bytes=400), GOOD)
    right = repeated(transfers_of_good(bus_bytes))
    for what, packet in BEFORE.items():
        cycles = range(1, 2 * -(-len(packet) // bus_bytes) + 10)
        for number, at in enumerate(cycles[:: 1 + len(cycles) // by_depth(4, 8)]):
            found = after_reset_of_reader(bench, packet, at, TAKEN[number % len(TAKEN)])
            assert found == (right, [Status.OK] * 2), (what, at)


def after_reset_of_writer(bench, transfers, after, at, until, offers):
    """Return packets, which of them are marked, and statuses after a reset.

    `until`: the cycle up to which outputs are taken. `offers`: the number of offered leaves.
    """
    tx = bench.converter
    out, marked, statuses = PacketCollector(tx.plan.bus_bytes), [], []
    encoders = [encoder_of(leaf) for leaf in tx.plan.leaves]
    readies = Cat(port.ready for port in bench.leaves.values())

    def bits(messages):
        return {
            leaf: [encoders[leaf](payload) for one in messages for payload in one[leaf]]
            for leaf in bench.leaves
        }

    async def script(ctx):
        offered, fired = bits([transfers] * 2), 0
        offered |= {leaf: [] for leaf in list(offered)[offers:]}
        for cycle in range(at + 26 + 2 * len(bench.good) // tx.plan.bus_bytes):
            if cycle == at:
                offered, fired = bits([]), 0
            if cycle == at + 1:
                offered = bits([after] * 2)
            ctx.set(bench.domain.rst, cycle == at)
            for leaf, port in bench.leaves.items():
                await offer(ctx, port, offered[leaf], fired >> leaf & 1)
            for port in (tx.packets, tx.status):
                ctx.set(port.ready, cycle < until or cycle > at)
            _, _, fired, valid, beat, error, ended, status = await ctx.tick().sample(
                readies,
                tx.packets.valid,
                Value.cast(tx.packets.payload),
                tx.packet_error,
                tx.status.valid,
                tx.status.payload,
            )
            if cycle > at and valid and out.take(beat):
                marked.append(bool(error))
            if cycle > at and ended:
                statuses.append(status)

    bench.run(script)
    return out.packets, marked, statuses, out.partial


@pytest.mark.parametrize("bus_bytes", by_depth([16], [4, 16]))
def test_serializer_forgets_the_message_under_way(bus_bytes):
    bench = Bench(Serializer(MESSAGE, bus_bytes=bus_bytes, max_message_bytes=400), GOOD)
    good = transfers_of_good(bus_bytes)
    every = by_depth(4, 1)
    changes = {
        "good": {},
        "length": {1: [30], 2: letters(b"0123456789" * 3, bus_bytes)},
        "items": {2: [(lanes, not last) for lanes, last in good[2]]},
        "loop": {3: [9], 4: list(range(9))},
    }
    for number, (what, change) in enumerate(changes.items()):
        # The output is blocked before a reset in each cycle, or in some; then leaves
        # are missing.
        for at, until, offers in [
            *((at, at - 5, 5) for at in range(5 + number % every, 14 + 30 // bus_bytes, every)),
            *((9, 9, offers) for offers in range(1, 6)),
        ]:
            found = after_reset_of_writer(bench, good | change, good, at, until, offers)
            assert found == RIGHT, (what, at, offers)


# Messages that begin with a counter: of a loop, and of a run.
POINT = make("ros1", {"x": "uint16"}, "P")
LOOP = make("ros1", {"p": (POINT, "[3]"), "z": "uint8"})
RUN = make("ros1", {"b": "uint8[21]"})


@pytest.mark.parametrize(
    ("message", "good", "transfers"),
    [
        (LOOP, bytes.fromhex("01000200030004"), lambda lanes: {0: [1, 2, 3], 1: [4]}),
        (RUN, bytes(range(21)), lambda lanes: {0: letters(bytes(range(21)), lanes)}),
    ],
)
@pytest.mark.parametrize("bus_bytes", [1, 4])
@pytest.mark.sampled(4)
def test_counters_start_again(message, good, transfers, bus_bytes):
    right = transfers(bus_bytes)
    reader = Bench(Deserializer(message, bus_bytes=bus_bytes), good)
    writer = Bench(Serializer(message, bus_bytes=bus_bytes), good)
    # Odd cycles on one bus, even ones on the other.
    for at in by_depth(range(1 + bus_bytes // 4, 14, 2), range(1, 14)):
        found = after_reset_of_reader(reader, good, at, -1)
        assert found == (repeated(right), [Status.OK] * 2), at
        packets, *rest = after_reset_of_writer(writer, right, right, at, at, 2)
        assert (packets, rest) == ([good] * 2, [[False] * 2, [Status.OK] * 2, b""]), at
