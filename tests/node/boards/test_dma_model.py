"""The model of the DMA, against sentences of its manual, PG021 (v7.1), by the page that has them.

The pages of the sections are those of docs.amd.com: "MM2S_DMASR (MM2S DMA Status Register)" etc.
"""

from __future__ import annotations

import pytest

from tests.node.boards.dma_model import (
    COMPLETED,
    DEC_ERR,
    DESCRIPTOR,
    EOF,
    ERR,
    HALTED,
    IDLE,
    INT_ERR,
    IOC,
    RESET,
    RS,
    SG,
    SG_DEC_ERR,
    SG_INT_ERR,
    SG_SLV_ERR,
    SLV_ERR,
    SOF,
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
    """ "Width of Buffer Length Register"; "Address Width"."""
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


# With a scatter-gather engine. Descriptors are at the begin of memory, and buffers from 4096 on.
CURDESC, TAILDESC = 0x08, 0x10
STATUS = 0x0001_0000 | SG


@pytest.fixture
def engine():
    sent = []
    made = AxiDma(memoryview(bytearray(range(256)) * 256), BASE, Streams(sent.append), has_sg=True)
    made.sent = sent
    return made


def describe(dma, number, control, *, status=0, address=None, following=None):
    """Write a descriptor, whose successor is the next one."""
    place = BASE + 4096 + 256 * number if address is None else address
    after = BASE + 64 * (number + 1) if following is None else following
    DESCRIPTOR.pack_into(dma.memory, 64 * number, after, place, control, status)


def status_of(dma, number):
    return DESCRIPTOR.unpack_from(dma.memory, 64 * number)[3]


def point(dma, at, number):
    address = BASE + 64 * number
    dma.write(at, address & 0xFFFF_FFFF)
    dma.write(at + 4, address >> 32)


def begin(dma, at, tail, threshold=1):
    """Let a channel run from the first descriptor on."""
    point(dma, at + CURDESC, 0)
    dma.write(at + DMACR, RS | IOC | ERR | threshold << 16)
    point(dma, at + TAILDESC, tail)


@CHANNELS
def test_registers_of_an_engine_after_a_reset(engine, at):
    """DMASR.SGIncld, IRQThresholdSts "0x01"; SA and LENGTH are of Direct Register Mode only."""
    assert engine.read(at + DMASR) == STATUS | HALTED
    assert [engine.read(at + each) for each in (0x08, 0x0C, 0x10, 0x14)] == [0, 0, 0, 0]
    for each in (ADDRESS, LENGTH):
        with pytest.raises(AssertionError, match="reserved"):
            engine.write(at + each, 16)
    with pytest.raises(AssertionError, match="aligned"):
        engine.write(at + CURDESC, 32)


@CHANNELS
def test_the_engine_pauses_at_the_tail(engine, at):
    """TAILDESC: "AXI DMA SG engine pauses descriptor fetching after completing operations on
    descriptor whose current descriptor pointer matches the tail descriptor pointer. [...] If the
    channel is halted, a write has no effect except to reposition the pause point."
    """
    engine.packets += [b"a" * 16, b"b" * 16, b"c" * 16]
    for number in range(3):
        describe(engine, number, 16 | SOF | EOF if not at else 16)
    point(engine, at + TAILDESC, 2)
    engine.step()
    assert engine.read(at + DMASR) == STATUS | HALTED and not status_of(engine, 0)
    begin(engine, at, 1)
    # CURDESC: "read only" while RS is 1.
    point(engine, at + CURDESC, 2)
    for done in (1, 2, 2, 2):
        assert engine.read(at + DMASR) & IDLE == 0 or done == 2
        engine.step()
        assert [bool(status_of(engine, each) & COMPLETED) for each in range(3)] == [
            each < done for each in range(3)
        ]
    assert engine.read(at + DMASR) == STATUS | IDLE | IOC
    assert engine.read(at + CURDESC) == BASE + 64 & 0xFFFF_FFFF and engine.read(at + 0x0C) == 1
    point(engine, at + TAILDESC, 2)
    assert not engine.read(at + DMASR) & IDLE
    engine.step()
    assert status_of(engine, 2) & COMPLETED and engine.read(at + DMASR) & IDLE


def test_the_upper_half_of_the_tail_starts_the_engine(engine):
    """VHDL of the core: `tailpntr_updated`, by the upper half if addresses have more than 32 bits.

    With 32 bits, by the only half.
    """
    describe(engine, 0, 16 | SOF | EOF)
    point(engine, CURDESC, 0)
    engine.write(DMACR, RS | 1 << 16)
    engine.write(TAILDESC, BASE & 0xFFFF_FFFF)
    engine.step()
    assert not engine.sent
    engine.write(TAILDESC + 4, BASE >> 32)
    engine.step()
    assert len(engine.sent) == 1
    engine.write(DMACR, RESET)
    engine.address_bits, engine.base = 32, 0x2000_0000
    describe(engine, 0, 16 | SOF | EOF, address=0x2000_1000)
    engine.write(CURDESC, 0x2000_0000)
    engine.write(DMACR, RS | 1 << 16)
    engine.write(TAILDESC, 0x2000_0000)
    engine.step()
    assert len(engine.sent) == 2


def test_packets_in_pieces(engine):
    """CONTROL of MM2S has TXSOF and TXEOF; STATUS of S2MM has RXSOF, RXEOF and the bytes."""
    describe(engine, 0, 8 | SOF)
    describe(engine, 1, 4 | EOF)
    begin(engine, 0x00, 1)
    for _ in range(2):
        engine.step()
    assert engine.sent == [bytes(range(8)) + bytes(range(4))]
    assert [status_of(engine, each) for each in range(2)] == [COMPLETED | 8, COMPLETED | 4]
    assert engine.read(DMASR) == STATUS | IDLE | IOC
    describe(engine, 0, 16)
    describe(engine, 1, 16)
    begin(engine, 0x30, 1)
    engine.packets.append(bytes(range(20)))
    for _ in range(2):
        engine.step()
    assert [status_of(engine, each) for each in range(2)] == [
        *(COMPLETED | 16 | SOF, COMPLETED | 4 | EOF)
    ]
    assert bytes(engine.memory[4096:4112]) == bytes(range(16))
    assert bytes(engine.memory[4352:4356]) == bytes(range(16, 20))


@CHANNELS
def test_the_threshold_counts_packets(engine, at):
    """DMACR.IRQThreshold: "When IOC (Interrupt On Complete) interrupt events occur, an internal
    counter counts down from the Interrupt Threshold setting."
    """
    engine.packets += [b"a", b"b", b"c"]
    for number in range(3):
        describe(engine, number, 16 | SOF | EOF if not at else 16)
    begin(engine, at, 2, threshold=2)
    for left, interrupt in ((1, False), (2, True), (1, True)):
        engine.step()
        assert engine.read(at + DMASR) >> 16 == left and engine.interrupt == interrupt


@CHANNELS
@pytest.mark.parametrize(
    ("given", "bit"),
    [
        # SGIntErr: "if a descriptor with the Complete bit already set is fetched".
        ({"status": COMPLETED}, SG_INT_ERR),
        ({"following": BASE + (1 << 20)}, SG_DEC_ERR),
        ({"fails": "descriptor"}, SG_SLV_ERR),
        # DMAIntErr: "if the buffer length specified in the fetched descriptor is set to 0".
        ({"control": 0}, INT_ERR),
        ({"address": BASE + (1 << 20)}, DEC_ERR),
        ({"fails": ""}, SLV_ERR),
    ],
)
def test_errors_of_the_engine(engine, at, given, bit):
    """CURDESC: "On error detection, [it] is updated to reflect the descriptor associated with the
    detected error." Its STATUS has DMAIntErr, DMASlvErr and DMADecErr from bit 28 on.
    """
    name = "S2MM" if at else "MM2S"
    values = {"control": 16 | SOF | EOF if not at else 16} | given
    if (fails := values.pop("fails", None)) is not None:
        engine.fails[f"{name} {fails}".strip()] = bit
    describe(engine, 0, **values)
    begin(engine, at, 3)
    engine.packets.append(bytes(16))
    engine.step()
    if bit == SG_DEC_ERR:
        engine.step()
        assert engine.read(at + CURDESC) == (BASE + (1 << 20)) & 0xFFFF_FFFF
    assert engine.read(at + DMASR) == STATUS | HALTED | ERR | bit | IOC * (bit == SG_DEC_ERR)
    assert engine.read(0x30 - at + DMASR) & HALTED and engine.interrupt
    if bit in (INT_ERR, SLV_ERR, DEC_ERR):
        assert status_of(engine, 0) == bit << 24
    # Errors are read only: a reset alone clears them, of both channels.
    engine.write(at + DMASR, 0xFFFF_FFFF)
    assert engine.read(at + DMASR) == STATUS | HALTED | bit
    engine.write(0x30 - at + DMACR, RESET)
    assert engine.read(at + DMASR) == STATUS | HALTED
