"""A board through an AXI DMA: the driver against a model of the DMA, with a node behind it."""

from __future__ import annotations

import errno
import os
import re
import socket

import pytest

from firm_hdl.node.boards import BoardError
from firm_hdl.node.boards.devices import DmaBuffer, Uio
from firm_hdl.node.boards.zynq import ZynqBoard
from tests.node.accelerators import echo_text
from tests.node.boards.chip import Chip
from tests.node.boards.dma_model import (
    DEC_ERR,
    INT_ERR,
    SG_DEC_ERR,
    SG_INT_ERR,
    SG_SLV_ERR,
    SLV_ERR,
    SgChannel,
    Streams,
)
from tests.node.boards.remote import ADDRESS, Buffer, Registers
from tests.node.bridge.fakes import FakeGraph, FakeNode, bridge_of, run_until
from tests.node.samples import read

BUFFER_BYTES = 256
MEMORY = read(echo_text(link=f"{{kind: axi_dma, buffer_bytes: {BUFFER_BYTES}}}"))
HEARD = MEMORY.topics[0]


class LocalChip(Chip):
    """A chip that runs with each access to it; `node` takes frames and returns others."""

    def __init__(self, node=None, size=4096, **parameters):
        self.node = node or FakeNode(MEMORY.fingerprint)
        super().__init__(Streams(self.take), memoryview(bytearray(size)), **parameters)
        self.opened = []

    @property
    def is_ring(self):
        return isinstance(self.dma.s2mm, SgChannel)

    def take(self, frame):
        self.dma.packets += self.node.take(frame)

    def open(self, uio, buffer):
        self.opened.append((uio, buffer))
        own, self.interrupts = socket.socketpair()
        return Registers(self, own), Buffer(self, self.seen, self.address)

    def board(self):
        name = "zynq://uio0/udmabuf0"
        return ZynqBoard(name, "uio0", "udmabuf0", BUFFER_BYTES, self.open)


@pytest.fixture(params=[False, True], ids=["registers", "descriptors"])
def chip(request):
    # The last of three buffers is above 4 GiB.
    return LocalChip(has_sg=request.param, address=(1 << 32) - 2 * BUFFER_BYTES)


def bridged(chip):
    """Return a bridge to a chip, which is ready, and what it says."""
    graph = FakeGraph()
    made, said = bridge_of(chip.board(), graph, MEMORY)
    assert run_until(made, lambda: graph.opened, 10), said
    return made, said


def test_messages_go_through_memory(chip):
    made, _ = bridged(chip)
    texts = [bytes([n]) * (n * 37 % 240) for n in range(100)]
    for text in texts:
        made.graph.say(HEARD, text)
    assert run_until(made, lambda: len(made.graph.got) == 100, 10)
    made.run(seconds=0)
    assert [packet for _, packet in made.graph.got] == texts and made.side.has_read_last
    assert not made.counters.dropped and not made.side.on_the_way and made.side.restarts == 0
    # The DMA was reset at the end, so it writes no memory any more.
    assert chip.opened == [("uio0", "udmabuf0")] and chip.dma.resets == 2


def transfers(chip, count=20):
    """Let the DMA go on without the driver."""
    for _ in range(count):
        chip.dma.step()


@pytest.mark.parametrize(
    ("channel", "bit", "text"),
    [
        ("MM2S", DEC_ERR, "the DMA has stopped (MM2S: DMADecErr: no memory has this address)"),
        ("MM2S", SLV_ERR, "the DMA has stopped (MM2S: DMASlvErr: the memory refused an access)"),
        ("S2MM", DEC_ERR, "the DMA has stopped (S2MM: DMADecErr: no memory has this address)"),
        ("S2MM", SLV_ERR, "the DMA has stopped (S2MM: DMASlvErr: the memory refused an access)"),
        ("S2MM", INT_ERR, "a frame was longer than its buffer"),
        ("MM2S", 0, "the DMA has stopped (no DMASR has an error), and is reset"),
    ],
)
def test_each_error_of_the_dma_is_said_counted_and_survived(chip, channel, bit, text):
    made, said = bridged(chip)
    if bit == INT_ERR:
        chip.dma.packets.append(bytes(BUFFER_BYTES + 1))
    elif not bit:
        # Another program has written DMACR.
        chip.dma.write(0x00, 1 << 16)
    else:
        chip.dma.fails[channel] = bit
    made.graph.say(HEARD, b"lost")
    assert run_until(made, lambda: made.side.restarts == 1 and made.side.is_ready, 10), said
    assert any(text in line for line in said), said
    made.graph.say(HEARD, b"again")
    assert run_until(made, lambda: made.graph.got and made.graph.got[-1][1] == b"again", 10)
    made.run(seconds=0)
    # The transfer that fails may be that of a request, and then the message waits.
    lost = 2 - len(made.graph.got)
    # In a ring, messages wait with a request.
    most = 2 if chip.is_ring else 1
    assert lost <= made.counters.dropped.total() <= most
    assert made.side.on_the_way["DMA errors"] == 1


@pytest.mark.parametrize("channel", ["MM2S", "S2MM"])
@pytest.mark.parametrize(
    ("bit", "text"),
    [
        (SG_INT_ERR, "SGIntErr: a descriptor was not handed over"),
        (SG_SLV_ERR, "SGSlvErr: the memory refused an access to a descriptor"),
        (SG_DEC_ERR, "SGDecErr: no memory has the address of a descriptor"),
    ],
)
def test_each_error_of_an_engine_is_said_counted_and_survived(channel, bit, text):
    chip = LocalChip(has_sg=True)
    made, said = bridged(chip)
    chip.dma.fails[f"{channel} descriptor"] = bit
    made.graph.say(HEARD, b"lost")
    assert run_until(made, lambda: made.side.restarts == 1 and made.side.is_ready, 10), said
    assert any(f"the DMA has stopped ({channel}: {text})" in line for line in said), said
    made.graph.say(HEARD, b"again")
    assert run_until(made, lambda: made.graph.got and made.graph.got[-1][1] == b"again", 10)
    made.run(seconds=0)
    assert made.side.on_the_way["DMA errors"] == 1


def test_frames_come_in_a_ring_without_the_driver():
    """A scatter-gather engine receives as many as it has buffers, and goes on around the ring."""
    chip = LocalChip(has_sg=True)
    board = chip.board()
    board.open()
    # 4096 bytes are 6 descriptors and buffers of 320 bytes in each direction.
    frames = [bytes([number]) * (1 + number * 7) for number in range(20)]
    for first in (0, 6, 12, 18):
        chip.dma.packets += frames[first : first + 8]
        transfers(chip)
        assert len(chip.dma.packets) == (2 if first < 18 else 0)
        chip.dma.packets.clear()
        assert board.receive() == frames[first : first + 6]
    assert board.receive() == []
    came = []
    chip.node.take = lambda frame: came.append(frame) or []
    chip.dma.streams.has_sent = False
    board.send(frames)
    assert came == frames[:1]
    chip.dma.streams.has_sent = True
    transfers(chip)
    assert came == frames[:6]
    for _ in range(10):
        transfers(chip)
        board.receive()
    assert came == frames
    board.close()


def test_what_came_before_an_error_is_received(chip):
    board = chip.board()
    board.open()
    chip.dma.packets += [b"first", b"second", bytes(BUFFER_BYTES + 1)]
    transfers(chip, 10 * chip.is_ring)
    assert board.receive() == [b"first", b"second"]
    with pytest.raises(BoardError, match="a frame was longer than its buffer"):
        board.receive()
    assert board.counters == {"DMA errors": 1}
    board.close()


def test_a_node_that_sends_all_the_time_holds_up_nothing():
    """Both directions go on as long as the DMA is fast enough, without an interrupt for each."""
    chip, came = LocalChip(), []
    chip.node.take = lambda frame: came.append(frame) or []
    board = chip.board()
    board.open()
    assert board.send([b"a", b"b"]) and came == [b"a", b"b"]
    chip.dma.streams.has_sent = False
    assert board.send([b"c", b"d", b"e"]) and came[2:] == [b"c"]
    chip.dma.streams.has_sent = True
    chip.dma.packets += [b"packet"] * 3
    assert len(board.receive()) == 3 and came[2:] == [b"c", b"d", b"e"]
    board.close()


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({"size": 767}, "'udmabuf0' has 767 bytes, and 768 are needed: 3 buffers for frames of up"),
        ({"bits": 8}, "the DMA has lengths of 8 bits, up to 255 bytes, and frames have up to 256"),
        # It is 14 bits in the device tree, or not there.
        ({"length_bits": 8}, "the DMA has lengths of 8 bits, up to 255 bytes, and frames have"),
        ({"address": ADDRESS + 32}, "'udmabuf0' begins at 0x130000020, which is no multiple of 64"),
        ({"has_sg": True, "size": 1279}, "1280 are needed for a DMA with a scatter-gather engine"),
        (
            {"has_sg": True, "address_bits": 32},
            "the DMA has too few bits for the address 0x1300000",
        ),
        ({"has_s2mm": False}, "'uio0' is no AXI DMA with a channel S2MM: its DMACR is 0x00000000"),
        ({"address_bits": 32}, "the DMA has too few bits for the address 0x130000100"),
    ],
)
def test_a_dma_that_does_not_fit_is_an_error(parameters, text):
    with pytest.raises(BoardError, match=re.escape(text)):
        LocalChip(**parameters).board().open()


def test_a_dma_without_a_clock_is_an_error(chip):
    chip.dma.read = lambda offset: 0x0001_0006
    with pytest.raises(BoardError, match="the reset of the DMA does not end; does its clock run"):
        chip.board().open()


def test_a_node_that_takes_nothing_fills_the_board(chip):
    board = chip.board()
    board.open()
    chip.dma.mm2s.step = lambda: None
    assert board.has_room
    for _ in range(300):
        board.send([bytes(BUFFER_BYTES)])
    assert not board.has_room and board.receive() == []
    board.close()


@pytest.fixture
def system(tmp_path):
    """Return a root with the devices of a DMA and of a buffer, as far as files can be devices."""
    files = {
        "dev/uio3": bytes(4096),
        "dev/udmabuf0": bytes(1024),
        "sys/class/uio/uio3/name": b"dma\n",
        "sys/class/uio/uio3/maps/map0/size": b"0x0000000000001000\n",
        "sys/class/uio/uio3/device/of_node/xlnx,sg-length-width": b"\0\0\0\x0e",
        "sys/class/u-dma-buf/udmabuf0/size": b"1024\n",
        "sys/class/u-dma-buf/udmabuf0/phys_addr": b"0x0000000070400000\n",
        "sys/class/u-dma-buf/udmabuf0/dma_coherent": b"0\n",
        "sys/class/u-dma-buf/udmabuf0/sync_for_cpu": b"",
        "sys/class/u-dma-buf/udmabuf0/sync_for_device": b"",
    }
    for name, content in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(content)
    return tmp_path


@pytest.mark.parametrize("name", ["uio3", "dma"])
def test_registers_of_uio(system, name):
    uio = Uio(name, system)
    uio.write(0x34, 0x1234_5678)
    assert uio.read(0x34) == 0x1234_5678
    assert (system / "dev/uio3").read_bytes()[0x34:0x38] == (0x1234_5678).to_bytes(4, "little")
    assert uio.tree_value("xlnx,sg-length-width") == 14 and uio.tree_value("other") is None
    # The kernel's "Userspace I/O HOWTO": a read gives 32 bits, and writing 1 enables interrupts.
    os.lseek(uio.fileno(), 0, os.SEEK_SET)
    uio.enable_interrupt()
    assert (system / "dev/uio3").read_bytes()[:4] == b"\1\0\0\0"
    uio.take_interrupt()
    assert os.lseek(uio.fileno(), 0, os.SEEK_CUR) == 8
    with pytest.raises(BoardError, match="uio3' is used by another program"):
        Uio(name, system)
    # A device that is gone cannot be read any more, and its registers are left alone.
    folder = os.open(system, os.O_RDONLY)
    os.dup2(folder, uio.fileno())
    os.close(folder)
    with pytest.raises(BoardError, match="'uio3' is gone: "):
        uio.take_interrupt()
    uio.write(0x34, 0)
    uio.close()
    assert (system / "dev/uio3").read_bytes()[0x34:0x38] == (0x1234_5678).to_bytes(4, "little")
    Uio(name, system).close()


def test_a_buffer_and_its_caches(system):
    """The number is that of the page of u-dma-buf: offset, and size | direction << 2 | 1."""
    folder = system / "sys/class/u-dma-buf/udmabuf0"
    buffer = DmaBuffer("udmabuf0", system)
    assert (buffer.address, buffer.size, len(buffer.data)) == (0x7040_0000, 1024, 1024)
    buffer.data[64:67] = b"abc"
    buffer.to_device(64, 128, is_written=False)
    assert (folder / "sync_for_device").read_text() == "0x0000004000000085"
    buffer.to_device(256, 256, is_written=True)
    assert (folder / "sync_for_device").read_text() == "0x0000010000000109"
    buffer.to_processor(256, 256)
    assert (folder / "sync_for_cpu").read_text() == "0x0000010000000109"
    with pytest.raises(BoardError, match="udmabuf0' is used by another program"):
        DmaBuffer("udmabuf0", system)
    buffer.close()
    assert (system / "dev/udmabuf0").read_bytes()[64:67] == b"abc"
    (folder / "dma_coherent").write_text("1\n")
    (folder / "sync_for_cpu").write_text("")
    buffer = DmaBuffer("udmabuf0", system)
    buffer.to_processor(256, 256)
    assert (folder / "sync_for_cpu").read_text() == ""
    buffer.close()


def test_devices_that_are_missing_or_closed_to_us(system, monkeypatch):
    def says(text, make):
        with pytest.raises(BoardError, match=re.escape(text)):
            make()

    says("there is no UIO device 'uio0'; there is uio3 (dma)", lambda: Uio("uio0", system))
    says("cannot read", lambda: DmaBuffer("udmabuf1", system))
    (system / "sys/class/u-dma-buf/udmabuf0/size").write_text("many\n")
    says("udmabuf0/size' has no number", lambda: DmaBuffer("udmabuf0", system))
    (system / "sys/class/u-dma-buf/udmabuf0/size").write_text("2048\n")
    says("cannot map", lambda: DmaBuffer("udmabuf0", system))
    (system / "sys/class/uio/uio3/maps/map0/size").write_text("0x2000\n")
    says("cannot map the registers of", lambda: Uio("uio3", system))
    (system / "dev/uio3").unlink()
    says("No such file or directory", lambda: Uio("uio3", system))
    (system / "dev/uio3").symlink_to("uio3")
    says("cannot open", lambda: Uio("uio3", system))
    says("there is no UIO device 'uio0'; there is none", lambda: Uio("uio0", system / "none"))

    def refuse(*_):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))

    monkeypatch.setattr(os, "open", refuse)
    says("dev/uio3': Permission denied", lambda: Uio("uio3", system))
