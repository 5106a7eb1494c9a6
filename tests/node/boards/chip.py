# amaranth: UnusedElaboratable=no
"""A chip for the board `zynq`: memory, a model of the DMA, and a node behind its streams."""

from __future__ import annotations

import mmap
import selectors
import socket
import threading
from contextlib import suppress
from pathlib import Path

from amaranth.hdl import Module, ResetInserter, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.fifo import SyncFIFOBuffered
from amaranth.lib.wiring import In, Out

from firm_hdl.gateware import PacketSignature
from firm_hdl.node import Node
from firm_hdl.node.boards.zynq import ZynqBoard
from firm_hdl.sim.fast import FastSimulation
from tests.node.boards.dma_model import AxiDma, Streams
from tests.node.boards.remote import (
    ADDRESS,
    CALL,
    MEMORY,
    SOCKET,
    VALUE,
    open_devices,
)

__all__ = ["Chip", "ServedChip", "SimulatedStreams"]


class DmaStreams(wiring.Component):
    """The side of a DMA that faces a node, with the node.

    Members
    -------
    mm2s : In(PacketSignature(bus_bytes))
        Packets for the node.
    sent : Out(stream.Signature(1))
        The end of one has left.
    buffers : In(stream.Signature(1))
        Each lets one packet out. Without one, the DMA makes `tready` low "after taking in four
        beats of streaming data" (PG021, "Typical System Interconnect").
    s2mm : Out(PacketSignature(bus_bytes))
        Packets of the node.
    aresetn : In(1)
        The resets of both channels, which drop all that is in them.
    """

    def __init__(self, node, bus_bytes):
        self._node = node
        super().__init__(
            {
                "mm2s": In(PacketSignature(bus_bytes)),
                "sent": Out(stream.Signature(1)),
                "buffers": In(stream.Signature(1)),
                "s2mm": Out(PacketSignature(bus_bytes)),
                "aresetn": In(1, init=1),
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.node = self._node
        link, beat = self._node.link, self.mm2s.payload
        pieces, frames = link.pieces_in, link.frames_out
        m.d.comb += [
            link.mm2s_aresetn.eq(self.aresetn),
            link.s2mm_aresetn.eq(self.aresetn),
            pieces.payload.data.eq(Value.cast(beat.data)),
            pieces.payload.keep.eq((1 << beat.count) - 1),
            pieces.payload.last.eq(beat.last),
            pieces.valid.eq(self.mm2s.valid & self.aresetn),
            self.mm2s.ready.eq(pieces.ready | ~self.aresetn),
            self.sent.valid.eq(self.mm2s.valid & self.mm2s.ready & beat.last),
        ]
        width = len(Value.cast(frames.payload))
        fifo = SyncFIFOBuffered(width=width, depth=4)
        m.submodules.fifo = ResetInserter(~self.aresetn)(fifo)
        has_buffer = Signal()
        m.d.comb += [
            fifo.w_data.eq(Value.cast(frames.payload)),
            fifo.w_en.eq(frames.valid),
            frames.ready.eq(fifo.w_rdy),
            Value.cast(self.s2mm.payload).eq(fifo.r_data),
            self.s2mm.valid.eq(fifo.r_rdy & has_buffer),
            fifo.r_en.eq(self.s2mm.valid & self.s2mm.ready),
            self.buffers.ready.eq(~has_buffer | ~self.aresetn),
        ]
        with m.If(~self.aresetn | (fifo.r_en & self.s2mm.payload.last)):
            m.d.sync += has_buffer.eq(0)
        with m.Elif(self.buffers.valid):
            m.d.sync += has_buffer.eq(1)
        return m


class SimulatedStreams(Streams):
    """The streams of a DMA with a node in simulation, which runs on its own."""

    def __init__(self, description, **options):
        design = DmaStreams(Node(description), description.bus_bytes)
        self.sim = FastSimulation(design, **options)
        self.sim.go_live()
        self.has_sent = True

    def send(self, packet):
        self.has_sent = False
        self.sim.send_packets("mm2s", [packet])

    def let_packet_come(self):
        self.sim.send("buffers", [0])

    def receive(self):
        self.has_sent |= bool(self.sim.receive("sent"))
        return self.sim.receive_packets("s2mm")

    def fileno(self):
        return self.sim.fileno()

    def reset(self):
        """Drop all that is on the way."""
        self.sim.halt()
        self.sim.set("aresetn", 0)
        self.sim.run(16)
        while self.sim.queued("mm2s") or self.sim.queued("buffers"):
            self.sim.run(1000)
        self.receive()
        self.has_sent = True
        self.sim.set("aresetn", 1)
        self.sim.go_live()


class Chip:
    """A DMA and the memory that it shares with a processor, without coherent caches.

    Parameters
    ----------
    streams : Streams
    seen : memoryview
        The memory as the processor sees it.
    bits : int
        Width of the length register in the device tree; 0 if it has none.
    parameters
        Of an :class:`.AxiDma`.

    Attributes
    ----------
    interrupts : socket or None
        Gets each interrupt.
    """

    def __init__(self, streams, seen, *, address=ADDRESS, bits=14, **parameters):
        self.streams, self.seen, self.address, self.bits = streams, seen, address, bits
        self.memory = memoryview(bytearray(len(seen)))
        self.dma = AxiDma(self.memory, address, streams, **{"length_bits": bits or 14} | parameters)
        self.is_enabled = False
        self.interrupts = None

    def call(self, op, a=0, b=0):
        """Do an order of the processor; return the answer."""
        self._step()
        value = 0
        match op:
            case b"r":
                value = self.dma.read(a)
            case b"w":
                self.dma.write(a, b)
            case b"e":
                self.is_enabled = True
            case b"p":
                value = self.bits
            case b"d" | b"D" | b"c":
                assert a % 64 == b % 64 == 0
                # What the processor has written is in its caches until it hands it over.
                if op == b"d":
                    self.memory[a : a + b] = self.seen[a : a + b]
                elif op == b"c":
                    self.seen[a : a + b] = self.memory[a : a + b]
        self._step()
        return value

    def _step(self):
        self.dma.packets += self.streams.receive()
        self.dma.step()
        if self.is_enabled and self.dma.interrupt and self.interrupts:
            # UIO disables the interrupt until it is enabled again.
            self.is_enabled = False
            self.interrupts.send(VALUE.pack(1))

    def close(self):
        """Be left by the processor."""
        self.is_enabled = False
        if self.interrupts:
            self.interrupts.close()
        self.interrupts = None


class ServedChip(Chip):
    """A chip whose thread answers :mod:`tests.node.boards.remote`; a context manager.

    Parameters
    ----------
    folder : Path
        Where its files are.
    """

    def __init__(self, folder, streams, *, size=1 << 18, **parameters):
        self.folder = Path(folder)
        (self.folder / MEMORY).write_bytes(bytes(size))
        with (self.folder / MEMORY).open("r+b") as file:
            super().__init__(streams, memoryview(mmap.mmap(file.fileno(), size)), **parameters)
        self.failure = None
        self._ends, self._end = socket.socketpair()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def board(self, frame_bytes):
        name = "zynq://dma/udmabuf0"
        return ZynqBoard(name, "dma", "udmabuf0", frame_bytes, lambda *_: open_devices(self.folder))

    def __enter__(self):
        self._server = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._server.bind(str(self.folder / SOCKET))
        self._server.listen()
        self._thread.start()
        return self

    def __exit__(self, kind, *_):
        self._end.send(b"x")
        self._thread.join()
        for each in (self._server, self._end, self._ends):
            each.close()
        if isinstance(self.streams, SimulatedStreams):
            self.streams.sim.close()
        if kind is None and self.failure is not None:
            raise self.failure

    def _run(self):
        with selectors.DefaultSelector() as selector:
            for each in (self._server, self._ends):
                selector.register(each, selectors.EVENT_READ)
            if isinstance(self.streams, SimulatedStreams):
                selector.register(self.streams, selectors.EVENT_READ)
            try:
                while True:
                    for key, _ in selector.select():
                        if key.fileobj is self._ends:
                            return
                        if key.fileobj is self._server:
                            selector.register(self._server.accept()[0], selectors.EVENT_READ)
                        elif key.fileobj is not self.streams:
                            self._answer(selector, key.fileobj)
                    self._step()
            except Exception as error:
                self.failure = error
            finally:
                # Who waits for an answer sees that there is none.
                for key in list(selector.get_map().values()):
                    if key.fileobj not in (self._server, self._ends, self.streams):
                        key.fileobj.close()

    def _answer(self, selector, wire):
        call = b""
        with suppress(ConnectionResetError):
            call = wire.recv(CALL.size)
        if not call:
            selector.unregister(wire)
            wire.close()
            if wire is self.interrupts:
                self.close()
            return
        op, a, b = CALL.unpack(call)
        value = self.call(op, a, b)
        if op == b"i":
            self.interrupts = wire
        wire.send(VALUE.pack(value))
