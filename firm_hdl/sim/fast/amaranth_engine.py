"""Amaranth's simulator as an engine: a thread that speaks the protocol of `server.h`."""

from __future__ import annotations

import select
import socket
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from amaranth.hdl import Cat, Signal
from amaranth.sim import Simulator, SimulatorContext

from firm_hdl.sim.fast import protocol
from firm_hdl.sim.fast.channel import Channel
from firm_hdl.sim.fast.protocol import Answer, Done, Order, Reason
from firm_hdl.sim.fast.top import Top, check_domains
from firm_hdl.sim.levels import divided

__all__ = ["AmaranthEngine"]

_PERIOD = 1e-6
_END_SECONDS = 10.0
# Cycles between two looks at the socket.
_BURST = 16
_FLUSH_TRANSFERS = 1 << 12


class AmaranthEngine(Channel):
    """A thread that simulates a design by Amaranth's simulator."""

    engine = "amaranth"

    def __init__(self, top: Top):
        self._top = top
        own, other = socket.socketpair()
        try:
            server = _Server(top, other)
        except BaseException:
            own.close()
            other.close()
            raise
        super().__init__(own)
        self._thread = threading.Thread(target=server.serve, name="simulation", daemon=True)
        self._thread.start()

    def again(self) -> AmaranthEngine:
        return AmaranthEngine(self._top)

    def close(self) -> None:
        super().close()
        if self._thread is not threading.current_thread():
            self._thread.join(_END_SECONDS)


class _ClosedError(Exception):
    """The other side closed the socket."""


def _nothing(ctx: SimulatorContext) -> None:
    """Do no work."""


@dataclass(slots=True)
class _Stream:
    """A stream, as `Stream` of ``server.h``."""

    number: int
    is_input: bool
    size: int
    payload: Signal
    pattern: list[bool] = field(default_factory=list)
    queue: deque[int] = field(default_factory=deque)
    is_offered: bool = False
    offered: int = 0
    records: list[bytes] = field(default_factory=list)

    def is_stalled(self, cycle: int) -> bool:
        return bool(self.pattern) and self.pattern[cycle % len(self.pattern)]


class _Server:
    """The other side of the protocol. Bits of words: those of the streams, by number."""

    def __init__(self, top: Top, other: socket.socket):
        self.top, self.socket = top, other
        self.streams = [
            _Stream(number, each.is_input, each.bytes, top.payloads[number])
            for number, each in enumerate(top.ports.streams)
        ]
        plain = list(zip(top.ports.plain, top.plain, strict=True))
        self.inputs = [signal for port, signal in plain if port.is_input]
        self.outputs = [(port, signal) for port, signal in plain if not port.is_input]
        driven = [
            top.valids[s.number] if s.is_input else top.readies[s.number] for s in self.streams
        ]
        # The clock and what is driven change together, so the simulator settles less often.
        self.edge = Cat(top.clock, *driven)
        self.handshakes = Cat(
            top.readies[s.number] if s.is_input else top.valids[s.number] for s in self.streams
        )
        fragment = divided(top)
        check_domains(fragment)
        self.simulator = Simulator(fragment)
        self.work: Callable[[SimulatorContext], object] = _nothing
        self.values = [0] * len(self.inputs)
        self.received = bytearray()
        self.conditions: list[list[int]] = []
        self.live: tuple[int, int, int] | None = None
        self._start()

    def _start(self) -> None:
        self.cycle = self.quiet = self.driven = 0
        self.is_applied = False
        for stream in self.streams:
            stream.queue.clear()
            stream.records.clear()
            stream.is_offered, stream.offered = False, 0

    async def _testbench(self, ctx: SimulatorContext) -> None:
        while True:
            self.work(ctx)
            await ctx.delay(_PERIOD)

    def _do(self, work: Callable[[SimulatorContext], object]) -> None:
        """Do work in the testbench, where signals can be read and changed."""
        self.work = work
        self.simulator.advance()

    def serve(self) -> None:
        """Serve messages until the other side closes the socket."""
        try:
            # Added only here, because Python warns of a testbench that never starts.
            self.simulator.add_testbench(self._testbench)
            self._do(_nothing)
            while True:
                seconds: float | None = None
                if self.live is not None:
                    quiet, milliseconds, cycles = self.live
                    is_active = self.quiet < quiet
                    burst = _BURST if is_active else cycles
                    self._do(lambda ctx, burst=burst: self._cycles(ctx, burst))  # type: ignore[misc]
                    self._flush()
                    seconds = 0.0 if is_active else milliseconds / 1000
                self._receive(seconds)
        except (_ClosedError, OSError):
            pass
        except BaseException as error:
            # The other side raises it; a thread has nobody else to tell.
            text = f"{type(error).__name__}: {error}"
            self._try_send(protocol.message(Answer.FAILED, text.encode()))
        finally:
            self.socket.close()

    def _receive(self, seconds: float | None) -> None:
        if select.select([self.socket], [], [], seconds)[0]:
            data = self.socket.recv(1 << 18)
            if not data:
                raise _ClosedError
            self.received += data
        for kind, body in protocol.messages(self.received):
            self._handle(Order(kind), body)

    def _handle(self, order: Order, body: bytes) -> None:
        match order:
            case Order.SEND:
                number, payloads = protocol.read_number(body)
                stream = self.streams[number]
                size = stream.size
                stream.queue.extend(
                    int.from_bytes(payloads[at : at + size], "little")
                    for at in range(0, len(payloads), size)
                )
                self._wake()
            case Order.SET:
                number, value = protocol.read_number(body)
                self.values[number] = int.from_bytes(value, "little")
                self._wake()
            case Order.STALL:
                number, pattern = protocol.read_stall(body)
                self.streams[number].pattern = pattern
                self._wake()
            case Order.GET:
                self._do(self._send_values)
            case Order.RUN:
                self._run(*protocol.read_run(body))
            case Order.LIVE:
                self.live, self.quiet = protocol.read_live(body), 0
            case Order.HALT:
                self.live = None
                self._send_done(Reason.HALTED)
            case Order.RESET:
                self.simulator.reset()
                self._do(_nothing)
                self._start()

    def _run(self, cycles: int, quiet: int, conditions: list[tuple[int, int, int]]) -> None:
        self.conditions = [list(each) for each in conditions]
        self.quiet = 0
        ended = [Reason.CYCLES]
        self._do(lambda ctx: ended.append(self._run_cycles(ctx, cycles, quiet)))
        self.conditions = []
        self._send_done(ended[-1])

    def _run_cycles(self, ctx: SimulatorContext, cycles: int, quiet: int) -> Reason:
        for count in range(cycles + 1):
            if self.conditions and not any(left for _, _, left in self.conditions):
                return Reason.CONDITIONS
            if quiet and self.quiet >= quiet:
                return Reason.QUIET
            if count < cycles:
                self._cycles(ctx, 1)
            if count % 256 == 0:
                self._check_open()
        return Reason.CYCLES

    def _check_open(self) -> None:
        if select.select([self.socket], [], [], 0)[0] and not self.socket.recv(1, socket.MSG_PEEK):
            raise _ClosedError

    def _cycles(self, ctx: SimulatorContext, count: int) -> None:
        for _ in range(count):
            self._apply(ctx)
            self._finish_cycle(ctx)

    def _apply(self, ctx: SimulatorContext) -> None:
        """Apply the inputs of a cycle, with a low clock."""
        if self.is_applied:
            return
        driven = 0
        for stream in self.streams:
            if not stream.is_input:
                driven |= (not stream.is_stalled(self.cycle)) << stream.number
                continue
            if not stream.is_offered and stream.queue and not stream.is_stalled(self.cycle):
                stream.is_offered = True
                if stream.queue[0] != stream.offered:
                    stream.offered = stream.queue[0]
                    ctx.set(stream.payload, stream.offered)
            driven |= stream.is_offered << stream.number
        for signal, value in zip(self.inputs, self.values, strict=True):
            if ctx.get(signal) != value:
                ctx.set(signal, value)
        self.driven = driven
        ctx.set(self.edge, driven << 1)
        self.is_applied = True

    def _finish_cycle(self, ctx: SimulatorContext) -> None:
        moved = ctx.get(self.handshakes) & self.driven
        self.quiet = 0 if moved else self.quiet + 1
        while moved:
            stream = self.streams[(moved & -moved).bit_length() - 1]
            moved &= moved - 1
            bits = stream.offered if stream.is_input else ctx.get(stream.payload)
            self._note(stream.number, bits)
            if stream.is_input:
                stream.is_offered = False
                stream.queue.popleft()
            else:
                head = self.cycle.to_bytes(protocol.CYCLE_BYTES, "little")
                stream.records.append(head + bits.to_bytes(stream.size, "little"))
                if len(stream.records) >= _FLUSH_TRANSFERS:
                    self._flush()
        ctx.set(self.edge, self.driven << 1 | 1)
        self.cycle += 1
        self.is_applied = False

    def _note(self, number: int, bits: int) -> None:
        for condition in self.conditions:
            stream, bit, left = condition
            if stream == number and left:
                condition[2] -= bit == protocol.ALL_TRANSFERS or bits >> bit & 1

    def _wake(self) -> None:
        """Inputs have changed within a cycle."""
        self.is_applied = False
        self.quiet = 0

    def _send_values(self, ctx: SimulatorContext) -> None:
        self._apply(ctx)
        values = b"".join(ctx.get(s).to_bytes(p.bytes, "little") for p, s in self.outputs)
        self.socket.sendall(protocol.message(Answer.VALUES, values))

    def _send_done(self, reason: Reason) -> None:
        self._flush()
        queued = tuple(len(stream.queue) for stream in self.streams)
        result = Done(reason=reason, cycle=self.cycle, queued=queued)
        self.socket.sendall(protocol.done(result))

    def _flush(self) -> None:
        for stream in self.streams:
            if stream.records:
                message = protocol.transfers(stream.number, b"".join(stream.records))
                stream.records.clear()
                self.socket.sendall(message)

    def _try_send(self, message: bytes) -> None:
        try:
            self.socket.sendall(message)
        except OSError:
            return
