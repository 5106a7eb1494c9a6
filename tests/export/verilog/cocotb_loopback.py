"""A cocotb bench: packets pass through both converters, with random pauses.

The Python of a simulator runs this module; :mod:`tests.export.verilog.test_cocotb` starts it.
"""

from __future__ import annotations

import os
import random
from pathlib import Path

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, RisingEdge, with_timeout
from cocotbext.axi import AxiStreamBus, AxiStreamFrame, AxiStreamSink, AxiStreamSource


def pauses(seed):
    chosen = random.Random(seed)
    while True:
        yield chosen.random() < 0.4


def noisy(packet, lanes, noise):
    """Return a frame with random bytes in lanes that are not kept, and random `tkeep` before."""
    ignored = (len(packet) - 1) // lanes * lanes
    keep = [noise.getrandbits(1) for _ in range(ignored)] + [1] * (len(packet) - ignored)
    unkept = noise.randbytes(-len(packet) % lanes)
    return AxiStreamFrame(packet + unkept, tkeep=keep + [0] * len(unkept))


@cocotb.test()
async def packets_come_back(dut):
    packets = [
        bytes.fromhex(line)
        for line in Path(os.environ["PACKETS"]).read_text().splitlines()
        if not line.startswith("#")
    ]
    cocotb.start_soon(Clock(dut.aclk, 10, "ns").start())
    reset = {"reset": dut.aresetn, "reset_active_level": False}
    source = AxiStreamSource(AxiStreamBus.from_prefix(dut, "s_axis"), dut.aclk, **reset)
    sink = AxiStreamSink(AxiStreamBus.from_prefix(dut, "m_axis"), dut.aclk, **reset)
    status = AxiStreamSink(AxiStreamBus.from_prefix(dut, "m_axis_status"), dut.aclk, **reset)
    for number, port in enumerate((source, sink, status)):
        port.set_pause_generator(pauses(number))
    if "SWAP" in os.environ:
        dut.swap.value = int(os.environ["SWAP"])
    dut.aresetn.value = 0
    await ClockCycles(dut.aclk, 2)
    dut.aresetn.value = 1
    await RisingEdge(dut.aclk)
    noise = random.Random(3)
    for packet in packets:
        await source.send(noisy(packet, source.byte_lanes, noise))
    for packet in packets:
        frame = await with_timeout(sink.recv(), 200, "us")
        assert bytes(frame.tdata) == packet
        assert not any(frame.tuser) if isinstance(frame.tuser, list) else not frame.tuser
        assert bytes((await with_timeout(status.recv(), 200, "us")).tdata) == b"\0"
    dut._log.info(f"{len(packets)} packets came back")
