# amaranth: UnusedElaboratable=no
"""The ports of packet parts, in Amaranth's simulator: they do what their names say."""

from __future__ import annotations

import pytest
from amaranth.sim import Simulator

from firm_hdl import load_message
from firm_hdl.export.parts import PartTop, make_part, part_ports


def through(
    kind,
    source,
    *,
    ins="s_axis",
    out="m_axis",
    held=None,
    extra=(),
    when=None,
    cycles=30,
    **parameters,
):
    """Send beats, as values of ports, to a part; return values of `out` and others of each beat.

    All that leaves is taken, except from `held`. With `when`, the name of another port, return
    values of `extra` in each cycle in which that port is high.
    """
    part = make_part(kind, **parameters)
    top, seen = PartTop(part), []
    names = [port.name for port in part_ports(part)]
    beat = [f"{out}_{each}" for each in ("tdata", "tkeep", "tlast") if when is None]
    wanted, when = [*beat, *extra], when or f"{out}_tvalid"
    clocks = [getattr(top, clock) for clock, _ in part.clocks.values()]

    async def bench(ctx):
        async def edge():
            for level in (1, 0):
                for clock in clocks:
                    ctx.set(clock, level)
                await ctx.delay(1e-7)

        for _, reset in part.clocks.values():
            ctx.set(getattr(top, reset), 0)
        await edge()
        for _, reset in part.clocks.values():
            ctx.set(getattr(top, reset), 1)
        for name in names:
            if name.startswith("m_axis") and name.endswith("_tready"):
                ctx.set(getattr(top, name), name != f"{held}_tready")
        todo = list(source)
        for _ in range(cycles):
            for name, value in todo[0].items() if todo else ():
                ctx.set(getattr(top, f"{ins}_{name}"), value)
            ctx.set(getattr(top, f"{ins}_tvalid"), bool(todo))
            await ctx.delay(1e-9)
            if todo and ctx.get(getattr(top, f"{ins}_tready")):
                todo.pop(0)
            if ctx.get(getattr(top, when)):
                seen.append(tuple(ctx.get(getattr(top, name)) for name in wanted))
            await edge()

    simulator = Simulator(top)
    simulator.add_testbench(bench)
    simulator.run()
    return seen


def beat(data, keep, last, **others):
    return {"tdata": data, "tkeep": keep, "tlast": last, **others}


def test_tkeep_counts_in_the_last_beat_only():
    beats = [beat(0x2211, 0, 0), beat(0x33, 0b01, 1), beat(0, 0, 1)]
    seen = through("width", beats, in_bytes=2, out_bytes=4)
    assert [(data & (1 << 24) - 1 if keep else 0, keep, last) for data, keep, last in seen] == [
        (0x332211, 0b0111, 1),
        (0, 0, 1),
    ]


def test_tkeep_of_other_beats_is_all_ones_behind_a_part_that_changes_nothing():
    beats = [beat(0x2211, 0, 0, tdest=0), beat(0x4433, 0b01, 0, tdest=1), beat(0x55, 0b01, 1)]
    want = [(0x2211, 0b11, 0), (0x4433, 0b11, 0), (0x55, 0b01, 1)]
    for kind, given in (
        ("crossing", {"beats": 4}),
        ("router", {"topics": 2, "out": "m_axis_0"}),
        ("arbiter", {"inputs": 2, "ins": "s_axis_1"}),
    ):
        left_out = () if kind == "router" else ("tdest",)
        sent = [{k: v for k, v in each.items() if k not in left_out} for each in beats]
        assert [seen[:3] for seen in through(kind, sent, bus_bytes=2, **given)] == want


def test_tuser_of_a_fifo_drops_a_packet_as_a_serializer_asks_for():
    beats = [beat(7, 3, 1, tuser=1), beat(8, 3, 0, tuser=1), beat(9, 1, 1, tuser=0)]
    extra = ("packet_bytes", "count_passed", "count_aborted")
    seen = through("fifo", beats, bus_bytes=2, memory_bytes=16, packets=2, extra=extra)
    assert seen == [(8, 3, 0, 3, 1, 1), (9, 1, 1, 3, 1, 1)]


def test_what_travels_beside_a_beat_is_in_tuser():
    sent = [beat(7, 3, 0, tuser=5), beat(8, 1, 1, tuser=6)]
    given = {"bus_bytes": 2, "side_bits": 3, "extra": ("m_axis_tuser",)}
    assert through("crossing", sent, beats=4, **given) == [(7, 3, 0, 5), (8, 1, 1, 6)]
    # Bit 0 of a FIFO still drops the packet.
    sent = [beat(9, 3, 1, tuser=15), *({**each, "tuser": 2 * each["tuser"]} for each in sent)]
    seen = through("fifo", sent, memory_bytes=16, packets=2, **given)
    assert seen == [(7, 3, 0, 5), (8, 1, 1, 6)]


def test_a_fifo_says_what_became_of_each_packet():
    # Four beats of room, and a packet of five.
    sent = [beat(1, 3, 1, tuser=1), beat(2, 3, 1), *(beat(3, 3, n == 4) for n in range(5))]
    sent = [{"tuser": 0, **each} for each in sent]
    given = {"bus_bytes": 2, "memory_bytes": 8, "packets": 2}
    assert through("fifo", sent, when="ended", extra=("outcome",), **given) == [(1,), (0,), (3,)]
    names = [f"count_{each}" for each in ("passed", "aborted", "full", "large")]
    assert through("fifo", sent, when="aresetn", extra=names, **given)[-1] == (1, 1, 0, 1)
    # Nothing leaves, so there is no room for a second packet of four beats.
    sent = [beat(number, 3, number % 4 == 3, tuser=0) for number in range(8)]
    given |= {"when_full": "drop", "held": "m_axis"}
    assert through("fifo", sent, when="ended", extra=("outcome",), **given) == [(0,), (2,)]
    assert through("fifo", sent, when="aresetn", extra=names, **given)[-1] == (1, 0, 1, 0)


def test_a_gate_has_a_status_on_a_stream_of_whole_bytes():
    message = load_message("std_msgs/msg/UInt16")
    beats = [beat(0x100, 15, 0), beat(0x1234, 3, 1), beat(0x100, 15, 1)]
    given = {"message": message, "bus_bytes": 4, "memory_bytes": 64}
    assert through("gate", beats, **given) == [(0x100, 15, 0), (0x1234, 3, 1)]
    # Beside each beat is the size of its packet.
    sizes = {"when": "m_axis_tvalid", "extra": ("packet_bytes",)}
    assert through("gate", beats, **sizes, **given) == [(6,), (6,)]
    statuses = {"when": "m_axis_status_tvalid", "extra": ("m_axis_status_tdata",)}
    assert through("gate", beats, **statuses, **given) == [(0,), (1,)]
    # A status that is not taken stays.
    assert set(through("gate", beats, **statuses, held="m_axis_status", **given)) == {(0,)}
    part = make_part("gate", **given)
    ports = {port.name: port for port in part_ports(part)}
    assert ports["m_axis_status_tdata"].width == 8
    assert ports["m_axis_status_tready"].direction == "in"


def test_a_gate_counts_each_kind_of_packet():
    message = load_message("std_msgs/msg/String")
    # Good twice, cut, too long, a length that is too large, no CDR, no NUL.
    packets = [
        *("00010000 01000000 00", "00010000 02000000 7800", "00010000 01"),
        *("00010000 01000000 00ffffffff", "00010000 ffffffff 00", "07010000 01000000 00"),
        "00010000 01000000 01",
    ]
    lines = [bytes.fromhex(packet) for packet in packets]
    sent = [beat(int.from_bytes(each, "little"), (1 << len(each)) - 1, 1) for each in lines]
    counted = {"passed": 2, "truncated": 1, "trailing": 1, "length": 1, "encapsulation": 1}
    counted |= {"string": 1, "full": 0, "large": 0, "overrun": 0}
    given = {"message": message, "bus_bytes": 16, "memory_bytes": 64, "packets": 4}
    names = [f"count_{each}" for each in counted]
    seen = through("gate", sent, when="aresetn", extra=names, cycles=60, **given)
    assert dict(zip(counted, seen[-1], strict=True)) == counted


def test_a_router_sends_to_tdest_and_an_arbiter_says_tid():
    beats = [beat(1, 1, 1, tdest=0), beat(2, 1, 1, tdest=2), beat(3, 1, 1, tdest=9)]
    given = {"bus_bytes": 1, "topics": 3, "topic_bits": 4, "out": "m_axis_2"}
    assert through("router", beats, **given) == [(2, 1, 1)]
    counted = {"when": "aresetn", "extra": ("count_routed", "count_unknown")}
    assert through("router", beats, **given, **counted)[-1] == (2, 1)
    sides = [{**each, "tuser": 2} for each in beats]
    given |= {"side_bits": 2, "extra": ("m_axis_2_tuser",)}
    assert through("router", sides, **given) == [(2, 1, 1, 2)]
    beats = [beat(5, 1, 1, tuser=21)]
    given = {"ins": "s_axis_2", "extra": ("m_axis_tid", "m_axis_tuser"), "side_bits": 5}
    assert through("arbiter", beats, bus_bytes=1, inputs=3, **given) == [(5, 1, 1, 2, 21)]


def test_a_crossing_has_two_clocks():
    beats = [beat(number, 3, number == 4) for number in range(5)]
    assert [seen[0] for seen in through("crossing", beats, bus_bytes=2, beats=4)] == [*range(5)]
    names = [port.name for port in part_ports(make_part("crossing", bus_bytes=2))]
    assert names[:4] == ["s_axis_aclk", "s_axis_aresetn", "m_axis_aclk", "m_axis_aresetn"]


@pytest.mark.parametrize(("reset", "leave"), [(None, 4), ("m_axis", 4), ("s_axis", 0)])
def test_each_side_of_a_crossing_has_its_own_clock_and_reset(reset, leave):
    top = PartTop(make_part("crossing", bus_bytes=1, beats=4))
    came, gone = [], []

    async def bench(ctx):
        async def edges(count, *sides):
            for _ in range(count):
                if ctx.get(top.s_axis_tready) and "s_axis" in sides and ctx.get(top.s_axis_tvalid):
                    came.append(len(came))
                if ctx.get(top.m_axis_tvalid) and "m_axis" in sides and ctx.get(top.m_axis_tready):
                    gone.append(ctx.get(top.m_axis_tdata))
                for level in (1, 0):
                    for side in sides:
                        ctx.set(getattr(top, f"{side}_aclk"), level)
                    await ctx.delay(1e-7)
                ctx.set(top.s_axis_tdata, len(came))
                await ctx.delay(1e-9)

        await edges(5, "s_axis", "m_axis")
        for side in ("s_axis", "m_axis"):
            ctx.set(getattr(top, f"{side}_aresetn"), 1)
        await edges(5, "s_axis", "m_axis")
        # Four beats have room while the reading clock stands still.
        ctx.set(top.s_axis_tvalid, 1)
        await edges(9, "s_axis")
        assert came == [0, 1, 2, 3] and not ctx.get(top.m_axis_tvalid)
        ctx.set(top.s_axis_tvalid, 0)
        if reset:
            # That of the writing side empties the FIFO; that of the reading side discards nothing.
            ctx.set(getattr(top, f"{reset}_aresetn"), 0)
            await edges(5, "s_axis", "m_axis")
            ctx.set(getattr(top, f"{reset}_aresetn"), 1)
            await edges(5, "s_axis", "m_axis")
        # They leave while the writing clock stands still, whose side does not see the room.
        is_ready = ctx.get(top.s_axis_tready)
        ctx.set(top.m_axis_tready, 1)
        await edges(9, "m_axis")
        assert ctx.get(top.s_axis_tready) == is_ready

    simulator = Simulator(top)
    simulator.add_testbench(bench)
    simulator.run()
    assert gone == came[:leave]


def leaves_after_reset(cycles, phase):
    """Return whether beats leave a crossing after a reset of some cycles of the writing clock.

    The reading clock has a fifth of its rate; `phase` says when the reset begins.
    """
    top, seen = PartTop(make_part("crossing", bus_bytes=1, beats=8)), []
    resets = (top.s_axis_aresetn, top.m_axis_aresetn)
    number = 0

    async def bench(ctx):
        async def steps(count):
            nonlocal number
            for _ in range(count):
                number += 1
                ctx.set(top.s_axis_aclk, 1)
                ctx.set(top.m_axis_aclk, number % 5 == 0)
                await ctx.delay(1e-7)
                ctx.set(top.s_axis_aclk, 0)
                ctx.set(top.m_axis_aclk, 0)
                await ctx.delay(1e-7)
                seen.append(ctx.get(top.m_axis_tvalid))

        for reset in resets:
            ctx.set(reset, 1)
        ctx.set(top.s_axis_tvalid, 1)
        await steps(40 + phase)
        assert any(seen)
        ctx.set(top.s_axis_tvalid, 0)
        for level, count in ((0, cycles), (1, 60)):
            for reset in resets:
                ctx.set(reset, level)
            seen.clear()
            await steps(count)

    simulator = Simulator(top)
    simulator.add_testbench(bench)
    simulator.run()
    return any(seen)


@pytest.mark.parametrize("phase", range(5))
def test_a_reset_of_two_edges_of_the_slower_clock_empties_a_crossing(phase):
    assert not leaves_after_reset(10, phase)
