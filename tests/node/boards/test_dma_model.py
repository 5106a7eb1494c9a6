"""The model of the DMA, against sentences of its manual, PG021 (v7.1), by the page that has them.

The pages of the sections are those of docs.amd.com: "MM2S_DMASR (MM2S DMA Status Register)" etc.
"""

from __future__ import annotations

import pytest

from tests.node.boards.dma_model import (
    DEC_ERR,
    ERR,
    HALTED,
    IDLE,
    INT_ERR,
    IOC,
    RESET,
    RS,
    SG,
    SLV_ERR,
    AxiDma,
    Streams,
)

BASE = 0x1_2000_0000
CHANNELS = pytest.mark.parametrize("at", [0x00, 0x30], ids=["MM2S", "S2MM"])
DMACR, DMASR, ADDRESS, ADDRESS_MSB, LENGTH = 0x00, 0x04, 0x18, 0x1C, 0x28


@pytest.fixture
def dma():
    memory = memoryview(bytearray(range(256)) * 256)
    sent = []
    made = AxiDma(memory, BASE, Streams(sent.append))
    made.sent = sent
    return made


def start(dma, at, size=0, offset=0, control=RS | IOC | ERR):
    """Let a channel run, and begin a transfer."""
    dma.write(at + DMACR, control)
    dma.write(at + ADDRESS, BASE + offset & 0xFFFF_FFFF)
    dma.write(at + ADDRESS_MSB, BASE >> 32)
    dma.write(at + LENGTH, size)


@CHANNELS
def test_registers_after_a_reset(dma, at):
    """Default values in "Register Details": Halted 1, Idle 0, bit 1 of DMACR "always read as 1"."""
    assert dma.read(at + DMACR) == 0x0001_0002 and dma.read(at + DMASR) == HALTED
    assert [dma.read(at + each) for each in (ADDRESS, ADDRESS_MSB, LENGTH)] == [0, 0, 0]


@CHANNELS
def test_halted_and_idle(dma, at):
    """DMASR: "When halted (RS= 0 and Halted = 1), [...] writing to the LENGTH register has no
    effect on DMA operations." Idle "is 0 when channel is halted" and "prior to initial transfer".
    """
    dma.write(at + LENGTH, 16)
    dma.packets.append(bytes(16))
    dma.step()
    assert dma.read(at + DMASR) == HALTED and not dma.sent and dma.packets
    dma.write(at + DMACR, RS)
    assert dma.read(at + DMASR) == 0
    # LENGTH: "Writing a non-zero value to this register starts the MM2S transfer."
    dma.write(at + LENGTH, 0)
    dma.step()
    assert dma.read(at + DMASR) == 0
    start(dma, at, 16)
    assert dma.read(at + DMASR) == 0
    dma.step()
    assert dma.read(at + DMASR) == IDLE | IOC
    # DMACR.RS: "0 = Stop".
    dma.write(at + DMACR, 0)
    assert dma.read(at + DMASR) == HALTED | IOC


@CHANNELS
def test_interrupts(dma, at):
    """DMASR.IOC_Irq is R/WC: it is set with each completion, and cleared by writing 1."""
    start(dma, at, 16, control=RS)
    dma.packets.append(bytes(16))
    dma.step()
    assert dma.read(at + DMASR) & IOC and not dma.interrupt
    dma.write(at + DMACR, RS | IOC)
    assert dma.interrupt
    dma.write(at + DMASR, ERR)
    assert dma.interrupt
    dma.write(at + DMASR, IOC)
    assert not dma.interrupt and dma.read(at + DMASR) == IDLE


def test_transfers(dma):
    """S2MM_LENGTH: "At the completion of the S2MM transfer, the number of actual bytes written on
    the S2MM AXI4 interface is updated to the S2MM_LENGTH register."
    """
    start(dma, 0x00, 20, offset=64)
    start(dma, 0x30, 100, offset=1024)
    dma.step()
    assert dma.sent == [bytes(range(64, 84))] and dma.read(0x34) == 0
    dma.packets += [b"first", b"second"]
    dma.step()
    dma.step()
    assert bytes(dma.memory[1024:1030]) == b"first\5" and dma.read(0x58) == 5
    assert list(dma.packets) == [b"second"]


@CHANNELS
@pytest.mark.parametrize("bit", [SLV_ERR, DEC_ERR])
def test_errors_halt_both_channels(dma, at, bit):
    """DMASlvErr: "This error condition causes the AXI DMA to halt gracefully. The DMACR.RS bit is
    set to 0, and when the engine has completely shut down, the DMASR.Halted bit is set to 1."
    """
    if bit == SLV_ERR:
        dma.fails = {"MM2S": bit, "S2MM": bit}
    start(dma, 0x30 - at, 16)
    start(dma, at, 16, offset=0 if bit == SLV_ERR else 1 << 20)
    dma.packets.append(bytes(16))
    (dma.s2mm if at else dma.mm2s).step()
    assert dma.read(at + DMASR) == HALTED | ERR | bit and not dma.read(at + DMACR) & RS
    assert dma.read(0x30 - at + DMASR) == HALTED and not dma.read(0x30 - at + DMACR) & RS
    assert dma.interrupt and not dma.sent
    # Errors are read only, so a reset alone clears them.
    dma.write(at + DMASR, 0xFFFF_FFFF)
    assert dma.read(at + DMASR) == HALTED | bit and not dma.interrupt


def test_a_packet_longer_than_its_buffer(dma):
    """DMASR.DMAIntErr of S2MM: "When Scatter Gather is disabled, this error is flagged if any error
    occurs during Memory write or if the incoming packet is bigger than what is specified in the
    DMA length register."
    """
    start(dma, 0x30, 16)
    dma.packets.append(bytes(17))
    dma.step()
    assert dma.read(0x34) == HALTED | ERR | INT_ERR


@CHANNELS
def test_a_reset_of_a_channel_resets_all(dma, at):
    """DMACR.Reset: "Setting either MM2S_DMACR.Reset = 1 or S2MM_DMACR.Reset = 1 resets the entire
    AXI DMA engine. After completion of a soft reset, all registers and bits are in the Reset
    State."
    """
    for each in (0x00, 0x30):
        start(dma, each, 16)
    dma.packets.append(bytes(16))
    dma.write(at + DMACR, RESET)
    assert dma.resets == 1 and not dma.packets
    for each in (0x00, 0x30):
        assert dma.read(each + DMACR) == 0x0001_0002 and dma.read(each + DMASR) == HALTED


def test_parameters_of_the_core(dma):
    """DMASR.SGIncld; "Width of Buffer Length Register"; "Address Width"."""
    dma.has_sg = True
    assert dma.read(0x04) == HALTED | SG
    dma.address_bits = 32
    start(dma, 0x00, 0x1_0010)
    assert dma.read(0x1C) == 0 and dma.read(0x28) == 0x10


def test_what_the_manual_leaves_undefined_is_a_mistake_of_the_driver(dma):
    start(dma, 0x00, 16)
    with pytest.raises(AssertionError, match="under way"):
        dma.write(0x28, 16)
    dma.step()
    with pytest.raises(AssertionError, match="aligned"):
        start(dma, 0x00, 16, offset=1)
    with pytest.raises(AssertionError, match="reserved"):
        dma.read(0x08)
