"""A cocotb bench: cocotbext-axi's masters on converters and a node, with random pauses.

The Python of a simulator runs this module; :mod:`tests.registers.test_verilog` starts it. What has
to be in the words follows from `struct` of Python, and what has to be in packets from rosbags.
"""

from __future__ import annotations

import json
import os
import random
import struct
from itertools import pairwise
from pathlib import Path

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, Combine, RisingEdge, with_timeout
from cocotb.utils import get_sim_time
from cocotbext.axi import (
    AxiLiteBus,
    AxiLiteMaster,
    AxiResp,
    AxiStreamBus,
    AxiStreamFrame,
    AxiStreamSink,
    AxiStreamSource,
)
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from firm_hdl.node.control import ControlRequest, ControlResponse, Operation
from firm_hdl.node.messages import MessageReceiver, MessageSender, NodeMessage

ROUNDS = int(os.environ["ROUNDS"])
STORE = get_typestore(Stores.ROS2_JAZZY)
STORE.register(
    get_types_from_msg(Path(os.environ["DEFINITION"]).read_text(), "test_msgs/msg/Mixed")
)
Mixed = STORE.types["test_msgs/msg/Mixed"]
# The struct as C lays it out. `name` is left out.
FORM = "@BdBh3B2fq0d"
SIZE = struct.calcsize(FORM)
ID, FINGERPRINT, CONTROL, STATUS, ENABLE, EVENTS, MESSAGES = 0, 8, 0x10, 0x14, 0x18, 0x1C, 0x20
WORDS = 0x40
END = WORDS + -(-SIZE // 4) * 4
COMMIT, LATCH, RESET = 1, 2, 4
STREAMS = {"rx": ["s_axis"], "tx": ["m_axis"], "node": ["s_axis", "m_axis"]}
NODE = {each["name"]: each for each in json.loads(os.environ["NODE"])}
AT = {name: each["address"] for name, each in NODE.items()}
SET_TIME, SET_RATE = 1, 8
NS = 22  # The rate of a clock has so many bits behind the point.


def random_values(chosen):
    return (
        chosen.getrandbits(8),
        chosen.uniform(-1e9, 1e9),
        chosen.getrandbits(1),
        chosen.randint(-(2**15), 2**15 - 1),
        *chosen.randbytes(3),
        *struct.unpack("2f", struct.pack("2f", chosen.random(), -chosen.random())),
        chosen.randint(-(2**63), 2**63 - 1),
    )


def packet(values, name=""):
    import numpy as np

    a, b, c, d, *rest = values
    message = Mixed(
        a=a,
        b=b,
        name=name,
        c=bool(c),
        d=d,
        e=np.array(rest[:3], dtype=np.uint8),
        f=np.array(rest[3:5], dtype=np.float32),
        g=rest[5],
    )
    return bytes(STORE.serialize_cdr(message, "test_msgs/msg/Mixed"))


def pauses(seed):
    chosen = random.Random(seed)
    while True:
        yield chosen.random() < 0.4


async def begin(dut, side):
    """Start the clock of a design; return the clock, a master, and its sources and sinks."""
    clock, resetn = getattr(dut, f"{side}_aclk"), getattr(dut, f"{side}_aresetn")
    cocotb.start_soon(Clock(clock, 10, "ns").start())
    reset = {"reset": resetn, "reset_active_level": False}
    bus = AxiLiteBus.from_prefix(dut, f"{side}_s_axi")
    master = AxiLiteMaster(bus, clock, **reset)
    write, read = master.write_if, master.read_if
    channels = [write.aw_channel, write.w_channel, write.b_channel]
    channels += [read.ar_channel, read.r_channel]
    ends = []
    for name in STREAMS[side]:
        stream = AxiStreamBus.from_prefix(dut, f"{side}_{name}")
        end = AxiStreamSource if name == "s_axis" else AxiStreamSink
        ends.append(end(stream, clock, **reset))
    for number, each in enumerate([*channels, *ends]):
        each.set_pause_generator(pauses(number))
    resetn.value = 0
    await ClockCycles(clock, 3)
    assert not any(getattr(dut, f"{side}_s_axi_{name}").value for name in ("bvalid", "rvalid"))
    resetn.value = 1
    await RisingEdge(clock)
    return clock, master, *ends


async def word(master, address):
    got = await with_timeout(master.read(address, 4), 100, "us")
    assert got.resp == AxiResp.OKAY, hex(address)
    return int.from_bytes(got.data, "little")


async def put(master, address, value):
    got = await with_timeout(master.write(address, value.to_bytes(4, "little")), 100, "us")
    assert got.resp == AxiResp.OKAY, hex(address)


async def counters(master):
    await put(master, CONTROL, LATCH)
    return [await word(master, MESSAGES + 4 * k) for k in range(3)]


async def transfer_at_random(master, held, bits, free, known):
    """Bytes that were written are read. At wrong addresses, reads fail and writes do nothing.

    A write and a read go at the same time. `held` has the bytes that are read, `bits` those that
    can be written. `free` and `known` are words that can be written and read, besides the control
    register, to which only 0 is written.
    """
    chosen, end = random.Random(1), len(held)

    def place():
        address = chosen.randrange(end + 8 if chosen.random() < 0.9 else 4096)
        return address, chosen.randint(1, 4 - address % 4)

    for number in range(ROUNDS // 2):
        (address, count), (other, other_count) = place(), place()
        # What acts is no subject here.
        data = bytes(count) if address // 4 == CONTROL // 4 else chosen.randbytes(count)
        write = cocotb.start_soon(master.write(address, data))
        got = await with_timeout(master.read(other, other_count), 100, "us")
        wrote = await with_timeout(write, 100, "us")
        read = slice(other, other + other_count)
        before = bytes(held[read])
        if address // 4 in free:
            index = slice(address, address + count)
            kept = zip(bits[index], data, strict=True)
            held[index] = bytes(mask & value for mask, value in kept)
        good = other // 4 in known
        assert got.resp == (AxiResp.OKAY if good else AxiResp.SLVERR), (number, hex(other))
        assert wrote.resp == AxiResp.OKAY, (number, hex(address))
        expected = (before, held[read]) if good else (bytes(other_count),)
        assert got.data in expected, (number, hex(other))


@cocotb.test()
async def any_transfers(dut):
    _, tx, _ = await begin(dut, "tx")
    held = bytearray(END)
    # Bits that can be written: of a bool the lowest one, and none of the padding.
    bits = bytearray(END)
    bits[WORDS : WORDS + SIZE] = struct.pack(
        FORM,
        255,
        struct.unpack("d", b"\xff" * 8)[0],
        1,
        -1,
        *b"\xff" * 3,
        *struct.unpack("2f", b"\xff" * 8),
        -1,
    )
    bits[WORDS + 8 : WORDS + 16] = b"\xff" * 8
    bits[WORDS + 24 : WORDS + 32] = b"\xff" * 8
    bits[ENABLE] = 3
    for address, value in ((ID, b"FIRM"), (6, b"\1\0")):
        held[address : address + len(value)] = value
    held[FINGERPRINT : FINGERPRINT + 8] = int(os.environ["FINGERPRINT"]).to_bytes(8, "little")
    free = {ENABLE // 4, EVENTS // 4, *range(WORDS // 4, END // 4)}
    known = {*range((MESSAGES + 12) // 4), *range(WORDS // 4, END // 4)}
    await transfer_at_random(tx, held, bits, free, known)


@cocotb.test()
async def any_transfers_with_a_node(dut):
    _, node, *_ = await begin(dut, "node")
    end = max(AT.values()) + 4
    held, bits = bytearray(end), bytearray(end)
    for each in NODE.values():
        for field in each["fields"]:
            word = slice(each["address"], each["address"] + 4)
            if field["kind"] in ("constant", "setting"):
                value = int.from_bytes(held[word], "little") | field["reset"] << field["low"]
                held[word] = value.to_bytes(4, "little")
            if field["kind"] == "setting":
                value = (1 << field["bits"]) - 1 << field["low"]
                old = int.from_bytes(bits[word], "little")
                bits[word] = (old | value).to_bytes(4, "little")
    held[AT["rate"] : AT["rate"] + 4] = (10 << NS).to_bytes(4, "little")
    writes = ("setting", "event")
    free = {e["address"] // 4 for e in NODE.values() if e["fields"][0]["kind"] in writes}
    await transfer_at_random(node, held, bits, free, {each // 4 for each in AT.values()})


@cocotb.test()
async def node_is_seen(dut):
    """Counters, interrupt and clock of a node, and its reset."""
    clock, node, source, sink = await begin(dut, "node")
    sender = MessageSender()

    async def send(*packets, topic=1):
        for packet in packets:
            for frame in sender.frames(NodeMessage(topic=topic, packet=packet)):
                await source.send(AxiStreamFrame(frame))
        await with_timeout(source.wait(), 100, "us")
        await ClockCycles(clock, 200)

    async def latched(*names):
        await put(node, CONTROL, LATCH)
        return [await word(node, AT[name]) for name in names]

    async def now():
        """Return the time of the node, and the earliest and the latest time of the latch."""
        first = get_sim_time("ns")
        await put(node, CONTROL, LATCH)
        last = get_sim_time("ns")
        sec, nanosec = [await word(node, AT[f"time_{each}"]) for each in ("sec", "nanosec")]
        return sec * 10**9 + nanosec, first, last

    async def check_rate(rate):
        a, first, then = await now()
        await ClockCycles(clock, 100)
        b, later, last = await now()
        assert (later - then) * rate <= b - a <= (last - first) * rate

    names = ("subscribe_came_passed", "subscribe_came_truncated", "publish_goes_passed")
    names += ("subscribe_came_bytes_low", "subscribe_came_bytes_high", "link_passed")
    good, bad = bytes([0, 1, 0, 0, 7]), bytes([0, 1, 0, 0])
    for enabled, packets in ((1, [bad]), (2, [good] * 3)):
        await put(node, ENABLE, enabled)
        await send(*packets)
        assert await word(node, EVENTS) == 3 - enabled and dut.node_irq.value == 0
        await put(node, ENABLE, 3)
        await ClockCycles(clock, 2)
        assert dut.node_irq.value == 1
        await put(node, EVENTS, 3)
        await ClockCycles(clock, 2)
        assert dut.node_irq.value == 0
    assert [await word(node, AT[name]) for name in names] == [0] * 6
    assert await latched(*names) == [3, 1, 3, 15, 0, 4]
    await send(good)
    assert await word(node, AT["subscribe_came_passed"]) == 3
    assert (await latched(*names))[:4] == [4, 1, 4, 20]
    # The clock: two words are set in one cycle, and no time that is none.
    await check_rate(1)
    for name, value in (("new_sec", 7), ("new_nanosec", 999_999_990), ("new_rate", 15 << NS)):
        await put(node, AT[name], value)
    first = get_sim_time("ns")
    await put(node, CONTROL, SET_TIME)
    time, _, last = await now()
    assert 0 < time - 7_999_999_990 < last - first
    await put(node, AT["new_nanosec"], 10**9)
    await put(node, CONTROL, SET_TIME)
    assert (await now())[0] > time
    await put(node, CONTROL, SET_RATE)
    await check_rate(1.5)
    # The host sees the same clock, and can set it, too.
    requests = [ControlRequest(operation=Operation.READ, argument=5)]
    requests += [ControlRequest(operation=Operation.SET_RATE, argument=10 << NS)]
    await send(*(each.encode() for each in requests), topic=0)
    receiver = MessageReceiver()
    frames = [bytes(sink.recv_nowait().tdata) for _ in range(sink.count())]
    came = [message for message in map(receiver.take, frames) if message]
    answers = [ControlResponse.decode(each.packet) for each in came if each.topic == 0]
    assert [each.value for each in answers] == [15 << NS, 0]
    assert [each.packet for each in came if each.topic == 2] == [good] * 4
    assert await word(node, AT["rate"]) == 10 << NS
    # A reset answers what was asked before, and takes nothing before it is over.
    reads = [cocotb.start_soon(word(node, ID)) for _ in range(6)]
    writes = [cocotb.start_soon(put(node, CONTROL, RESET))]
    writes += [cocotb.start_soon(put(node, ENABLE, number % 4)) for number in range(6)]
    await with_timeout(Combine(*reads, *writes), 100, "us")
    assert await word(node, ENABLE) == 1
    assert await latched(*names) == [0] * 6
    assert (await now())[0] < get_sim_time("ns") - first
    assert await word(node, AT["new_sec"]) == 0
    assert await word(node, AT["rate"]) == 10 << NS
    sender = MessageSender()
    await send(good)
    assert (await latched(*names))[:4] == [1, 0, 1, 5]


@cocotb.test()
async def messages_are_sent(dut):
    clock, tx, sink = await begin(dut, "tx")
    chosen, sent = random.Random(2), []
    await put(tx, ENABLE, 1)
    for _ in range(5 + ROUNDS // 100):
        values = random_values(chosen)
        while await word(tx, STATUS) & 1:
            pass
        # In any pieces and order; words under way do not change the message of the commit before.
        data = struct.pack(FORM, *values)
        cuts = sorted({0, SIZE, *(chosen.randrange(SIZE) for _ in range(5))})
        spans = list(pairwise(cuts))
        chosen.shuffle(spans)
        for first, last in spans:
            await tx.write(WORDS + first, data[first:last])
        await put(tx, CONTROL, COMMIT)
        sent.append(packet(values))
    for expected in sent:
        frame = await with_timeout(sink.recv(), 100, "us")
        assert bytes(frame.tdata) == expected
    assert dut.tx_irq.value == 1
    await put(tx, EVENTS, 1)
    await ClockCycles(clock, 3)
    assert dut.tx_irq.value == 0
    # The sink is full, so a commit finds the serializer busy.
    sink.clear_pause_generator()
    sink.pause = True
    busy = 0
    for number in range(12):
        busy += await word(tx, STATUS) & 1
        for place in (0, SIZE - 8):
            await tx.write(WORDS + place, bytes([number]))
        await put(tx, CONTROL, COMMIT)
    assert busy > 1
    done, errors, skipped = await counters(tx)
    sink.pause = False
    # The last commits were too early: the message before them stays as it was.
    for number in range(12 - skipped):
        data = bytearray(struct.pack(FORM, *values))
        data[0] = data[SIZE - 8] = number
        expected = packet(struct.unpack(FORM, data))
        assert bytes((await with_timeout(sink.recv(), 100, "us")).tdata) == expected
    assert skipped >= busy and errors == 0 and done <= len(sent) + 12 - skipped
    await ClockCycles(clock, 50)
    assert sink.empty()
    # A reset clears registers, and messages go on.
    await put(tx, CONTROL, RESET)
    assert await counters(tx) == [0, 0, 0]
    assert await word(tx, ENABLE) == await word(tx, EVENTS) == await word(tx, WORDS) == 0
    await put(tx, CONTROL, COMMIT)
    zeros = packet(struct.unpack(FORM, bytes(SIZE)))
    assert bytes((await with_timeout(sink.recv(), 100, "us")).tdata) == zeros
    assert await counters(tx) == [1, 0, 0]


@cocotb.test()
async def messages_are_shown(dut):
    clock, rx, source = await begin(dut, "rx")
    chosen = random.Random(3)

    async def send(data):
        await source.send(AxiStreamFrame(data))
        await with_timeout(source.wait(), 100, "us")
        await ClockCycles(clock, 20)

    async def shown():
        got = await with_timeout(rx.read(WORDS, END - WORDS), 100, "us")
        assert got.resp == AxiResp.OKAY
        return bytes(got.data)[:SIZE]

    assert await word(rx, STATUS) == 0
    await put(rx, ENABLE, 2)
    good = skipped = bad = 0
    last, newest, is_new = bytes(SIZE), bytes(SIZE), False
    for _ in range(5 + ROUNDS // 100):
        choice = chosen.random()
        values = random_values(chosen)
        data = packet(values, "x" * chosen.randrange(20))
        if choice < 0.2:
            await send(data[: chosen.randrange(1, len(data) - 1)])
            bad += 1
            assert dut.rx_irq.value == 1
            await put(rx, EVENTS, 3)
            assert await word(rx, STATUS) >> 8 != 0
        else:
            await send(data)
            good, skipped = good + 1, skipped + is_new
            newest, is_new = struct.pack(FORM, *values), True
            assert await word(rx, STATUS) >> 8 == 0
            assert await word(rx, EVENTS) == 1
            assert dut.rx_irq.value == 0
        assert await shown() == last
        assert await word(rx, STATUS) & 1 == is_new
        if chosen.random() < 0.6:
            # One read at once with the commit and after it: words of one message, old or new.
            await put(rx, CONTROL, COMMIT)
            last, is_new = newest, False
            assert await shown() == last
    assert await counters(rx) == [good, bad, skipped]
    for address in (WORDS, STATUS, ID, MESSAGES):
        await put(rx, address, 0xFFFF_FFFF)
    assert await shown() == last
    # Reads and writes at the same time do not disturb each other.
    reads = [cocotb.start_soon(word(rx, ID)) for _ in range(20)]
    writes = [cocotb.start_soon(put(rx, ENABLE, number % 4)) for number in range(20)]
    await with_timeout(Combine(*reads, *writes), 100, "us")
    assert {each.result() for each in reads} == {int.from_bytes(b"FIRM", "little")}
    await put(rx, CONTROL, RESET)
    assert await counters(rx) == [0, 0, 0]
    assert await word(rx, STATUS) == await word(rx, ENABLE) == 0
    assert await shown() == bytes(SIZE)
