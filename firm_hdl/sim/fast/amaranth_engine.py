"""Amaranth's simulator as an engine: a thread that speaks the protocol of `server.h`."""

from __future__ import annotations

import itertools
import select
import socket
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from amaranth.hdl import Cat, Fragment, Signal
from amaranth.hdl._ir import Design
from amaranth.sim import Simulator, SimulatorContext

from firm_hdl.sim.fast import protocol
from firm_hdl.sim.fast.channel import Channel
from firm_hdl.sim.fast.protocol import Answer, Done, Order, Reason
from firm_hdl.sim.fast.top import Top

__all__ = ["AmaranthEngine"]

_PERIOD = 1e-6
_END_SECONDS = 10.0
# Cycles between two looks at the socket.
_BURST = 16
_FLUSH_TRANSFERS = 1 << 12


class AmaranthEngine(Channel):
    """A thread that simulates a design by Amaranth's simulator."""

    engine = "amaranth"

    def __init__(self, top: Top, design: Design | None = None):
        self._top = top
        own, other = socket.socketpair()
        try:
            self._design = design or top.prepare(name="top", divides=True)
            server = _Server(top, self._design, other)
        except BaseException:
            own.close()
            other.close()
            raise
        super().__init__(own)
        self._thread = threading.Thread(target=server.serve, name="simulation", daemon=True)
        self._thread.start()

    def again(self) -> AmaranthEngine:
        return AmaranthEngine(self._top, self._design)

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
    clock: _Clock
    pattern: list[bool] = field(default_factory=list)
    queue: deque[int] = field(default_factory=deque)
    is_offered: bool = False
    offered: int = 0
    records: list[bytes] = field(default_factory=list)

    def is_stalled(self) -> bool:
        return bool(self.pattern) and self.pattern[self.clock.cycle % len(self.pattern)]


@dataclass(slots=True)
class _Clock:
    """A clock, as `Clock` of ``server.h``."""

    is_positive: bool
    period: int = 1
    next: int = 1
    cycle: int = 0
    quiet: int = 0


class _Prepared(Fragment):
    """A design that a simulator need not prepare."""

    def __init__(self, design: Design):
        super().__init__()
        self._design = design

    def prepare(self, *_: object) -> Design:
        return self._design


class _Server:
    """The other side of the protocol. Bits of words: those of the streams, by number."""

    def __init__(self, top: Top, design: Design, other: socket.socket):
        self.top, self.socket = top, other
        domains = list(top.clocks.values())
        self.clocks = [_Clock(domain.clk_edge == "pos") for domain in domains]
        self.base, self.periods = 0, (1,) * len(domains)
        self.streams = [
            _Stream(number, each.is_input, each.bytes, top.payloads[number], clock)
            for (number, each), clock in zip(
                enumerate(top.ports.streams),
                (self.clocks[place] for place in top.clock_of),
                strict=True,
            )
        ]
        plain = list(zip(top.ports.plain, top.plain, strict=True))
        self.inputs = [signal for port, signal in plain if port.is_input]
        self.outputs = [(port, signal) for port, signal in plain if not port.is_input]
        driven = [
            top.valids[s.number] if s.is_input else top.readies[s.number] for s in self.streams
        ]
        # The clocks and what is driven change together, so the simulator settles less often.
        self.edge = Cat(*driven, *(domain.clk for domain in domains))
        # Clocks between their edges.
        self.level = sum((not clock.is_positive) << n for n, clock in enumerate(self.clocks))
        # For each clock: its streams.
        self.members = [
            sum(1 << s.number for s in self.streams if s.clock is clock) for clock in self.clocks
        ]
        self.handshakes = Cat(
            top.readies[s.number] if s.is_input else top.valids[s.number] for s in self.streams
        )
        self.simulator = Simulator(_Prepared(design))
        self.work: Callable[[SimulatorContext], object] = _nothing
        self.values = [0] * len(self.inputs)
        self.received = bytearray()
        self.conditions: list[list[int]] = []
        self.live: tuple[int, int, int] | None = None
        self._start()

    def _start(self) -> None:
        self.driven = 0
        self.is_applied = False
        for clock, period in zip(self.clocks, self.periods, strict=True):
            clock.period = clock.next = period
            clock.cycle = clock.quiet = 0
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
                    is_active = not self._is_quiet(quiet)
                    burst = _BURST if is_active else cycles
                    self._do(lambda ctx, burst=burst: self._steps(ctx, burst))  # type: ignore[misc]
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
                self.live = protocol.read_live(body)
                self._be_active()
            case Order.HALT:
                self.live = None
                self._send_done(Reason.HALTED)
            case Order.RESET:
                self.simulator.reset()
                self._do(_nothing)
                self._start()
            case Order.CLOCKS:
                self.base, self.periods = protocol.read_clocks(body)
                self._start()

    def _is_quiet(self, cycles: int) -> bool:
        """Return whether there was no transfer in so many cycles of each clock."""
        return all(clock.quiet >= cycles for clock in self.clocks)

    def _be_active(self) -> None:
        for clock in self.clocks:
            clock.quiet = 0

    def _run(self, cycles: int, quiet: int, conditions: list[tuple[int, int, int]]) -> None:
        self.conditions = [list(each) for each in conditions]
        self._be_active()
        ended = [Reason.CYCLES]
        self._do(lambda ctx: ended.append(self._run_cycles(ctx, cycles, quiet)))
        self.conditions = []
        self._send_done(ended[-1])

    def _run_cycles(self, ctx: SimulatorContext, cycles: int, quiet: int) -> Reason:
        base = self.clocks[self.base]
        end = base.cycle + cycles
        for count in itertools.count():
            if self.conditions and not any(left for _, _, left in self.conditions):
                return Reason.CONDITIONS
            if quiet and self._is_quiet(quiet):
                return Reason.QUIET
            if base.cycle == end:
                break
            self._steps(ctx, 1)
            if count % 256 == 0:
                self._check_open()
        return Reason.CYCLES

    def _check_open(self) -> None:
        if select.select([self.socket], [], [], 0)[0] and not self.socket.recv(1, socket.MSG_PEEK):
            raise _ClosedError

    def _steps(self, ctx: SimulatorContext, count: int) -> None:
        """Simulate steps: the times at which clocks have edges."""
        for _ in range(count):
            self._apply(ctx)
            self._finish_step(ctx)

    def _apply(self, ctx: SimulatorContext) -> None:
        """Apply the inputs of a step, with all clocks between their edges."""
        if self.is_applied:
            return
        driven = 0
        for stream in self.streams:
            if not stream.is_input:
                driven |= (not stream.is_stalled()) << stream.number
                continue
            if not stream.is_offered and stream.queue and not stream.is_stalled():
                stream.is_offered = True
                if stream.queue[0] != stream.offered:
                    stream.offered = stream.queue[0]
                    ctx.set(stream.payload, stream.offered)
            driven |= stream.is_offered << stream.number
        for signal, value in zip(self.inputs, self.values, strict=True):
            if ctx.get(signal) != value:
                ctx.set(signal, value)
        self.driven = driven
        ctx.set(self.edge, self.level << len(self.streams) | driven)
        self.is_applied = True

    def _finish_step(self, ctx: SimulatorContext) -> None:
        now = min(clock.next for clock in self.clocks)
        edges = moved = 0
        for number, clock in enumerate(self.clocks):
            if clock.next == now:
                edges |= 1 << number
                moved |= self.members[number]
        moved &= ctx.get(self.handshakes) & self.driven
        if has_moved := bool(moved):
            self._be_active()
        while moved:
            stream = self.streams[(moved & -moved).bit_length() - 1]
            moved &= moved - 1
            bits = stream.offered if stream.is_input else ctx.get(stream.payload)
            self._note(stream.number, bits)
            if stream.is_input:
                stream.is_offered = False
                stream.queue.popleft()
            else:
                head = stream.clock.cycle.to_bytes(protocol.CYCLE_BYTES, "little")
                stream.records.append(head + bits.to_bytes(stream.size, "little"))
                if len(stream.records) >= _FLUSH_TRANSFERS:
                    self._flush()
        ctx.set(self.edge, (self.level ^ edges) << len(self.streams) | self.driven)
        for clock in self.clocks:
            if clock.next == now:
                clock.next += clock.period
                clock.cycle += 1
                clock.quiet += not has_moved
        self.is_applied = False

    def _note(self, number: int, bits: int) -> None:
        for condition in self.conditions:
            stream, bit, left = condition
            if stream == number and left:
                condition[2] -= bit == protocol.ALL_TRANSFERS or bits >> bit & 1

    def _wake(self) -> None:
        """Inputs have changed within a cycle."""
        self.is_applied = False
        self._be_active()

    def _send_values(self, ctx: SimulatorContext) -> None:
        self._apply(ctx)
        values = b"".join(ctx.get(s).to_bytes(p.bytes, "little") for p, s in self.outputs)
        self.socket.sendall(protocol.message(Answer.VALUES, values))

    def _send_done(self, reason: Reason) -> None:
        self._flush()
        queued = tuple(len(stream.queue) for stream in self.streams)
        result = Done(reason=reason, cycle=self.clocks[self.base].cycle, queued=queued)
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
