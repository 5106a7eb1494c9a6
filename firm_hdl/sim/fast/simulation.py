"""A simulated design as an object: send and receive transfers while an engine runs it.

Payloads and packets are the bytes of the protocol here, many at a time.
"""

from __future__ import annotations

import random
import select
import time
from collections import deque
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from amaranth.lib import wiring

from firm_hdl.gateware.limits import check_integer
from firm_hdl.sim.bench import DeadlineError
from firm_hdl.sim.fast import protocol
from firm_hdl.sim.fast.channel import Channel
from firm_hdl.sim.fast.compilers import COMPILER_OPTIONS, Report
from firm_hdl.sim.fast.engines import EngineName, check_engine, start
from firm_hdl.sim.fast.ports import StreamPort, ports_of
from firm_hdl.sim.fast.protocol import CYCLE_BYTES, Answer, Done, Order, Reason
from firm_hdl.sim.fast.top import ClockDomainError, Top
from firm_hdl.sim.payloads import as_packets
from firm_hdl.sim.stalls import StallPlan, Stalls, check_stalls, stalls_of

__all__ = ["FastSimulation", "Packet", "Transfer"]


class Transfer(NamedTuple):
    """A transfer: the cycle, counted from 0 at the start or reset, and the payload as bits."""

    cycle: int
    bits: int


class Packet(NamedTuple):
    """A packet that came: its bytes, and the cycle of its last beat."""

    data: bytes
    cycle: int


def packed(payloads: Iterable[int], size: int) -> bytes:
    """Return payloads, given as bits, as `size` bytes each."""
    return b"".join(bits.to_bytes(size, "little") for bits in payloads)


def unpacked(records: bytes, size: int) -> list[Transfer]:
    """Return the transfers of a message TRANSFERS, whose payloads have `size` bytes."""
    step = CYCLE_BYTES + size
    return [
        Transfer(
            int.from_bytes(records[at : at + CYCLE_BYTES], "little"),
            int.from_bytes(records[at + CYCLE_BYTES : at + step], "little"),
        )
        for at in range(0, len(records), step)
    ]


def packed_packets(packets: Iterable[bytes], bus_bytes: int, *, counts: bool = False) -> bytes:
    """Return the beats of packets, as bytes of the protocol.

    The payload of a beat has `bus_bytes` bytes of data, then a byte: `count` in its lowest bits,
    and `last` above. Lanes that are not valid have random bytes, and with `counts` so has `count`
    in beats that are not the last. Noise depends on the packet alone, so runs can be repeated.
    """
    return b"".join(_beats(packet, bus_bytes, counts) for packet in packets)


def _beats(packet: bytes, bus_bytes: int, counts: bool) -> bytes:
    noise = random.Random(packet)
    beats = max(1, -(-len(packet) // bus_bytes))
    padding = noise.randbytes(beats * bus_bytes - len(packet))
    rows = np.full((beats, bus_bytes + 1), bus_bytes, np.uint8)
    rows[:, :bus_bytes] = np.frombuffer(packet + padding, np.uint8).reshape(beats, bus_bytes)
    if counts:
        rows[:, bus_bytes] = [noise.randint(0, bus_bytes) for _ in range(beats)]
    rows[-1, bus_bytes] = bus_bytes - len(padding) | 1 << bus_bytes.bit_length()
    return rows.tobytes()


@dataclass(slots=True)
class PacketJoiner:
    """Join the transfers of a packet stream to packets."""

    bus_bytes: int
    # Bytes of the packet that has begun and not yet ended.
    partial: bytearray = field(default_factory=bytearray)

    def add(self, records: bytes) -> list[Packet]:
        """Add the records of a message TRANSFERS; return the packets that end in them."""
        width = self.bus_bytes
        rows = np.frombuffer(records, np.uint8).reshape(-1, CYCLE_BYTES + width + 1)
        cycles = rows[:, :CYCLE_BYTES].copy().view("<u8").ravel()
        data = rows[:, CYCLE_BYTES : CYCLE_BYTES + width]
        tail = rows[:, CYCLE_BYTES + width]
        counts = tail & ((1 << width.bit_length()) - 1)
        valid = np.arange(width) < counts[:, None]
        # Number of bytes up to the end of each beat.
        ends = np.cumsum(np.minimum(counts, width), dtype=np.int64)
        whole = data[valid].tobytes()
        packets, start = [], 0
        for index in np.flatnonzero(tail >> width.bit_length()):
            end = int(ends[index])
            packets.append(Packet(bytes(self.partial) + whole[start:end], int(cycles[index])))
            self.partial.clear()
            start = end
        self.partial += whole[start:]
        return packets


class Arrivals:
    """Transfers and packets by stream, in the order in which they came.

    The transfers of a packet stream are joined to packets when its packets are asked for. From then
    on, they are no longer there as transfers.

    * `ignored`: streams whose transfers are not kept.
    """

    def __init__(self, streams: Sequence[StreamPort], ignored: Collection[str]):
        self._streams = streams
        self._sizes = {each.name: CYCLE_BYTES + each.bytes for each in streams}
        self._ignored = ignored
        self._records: dict[str, list[bytes]] = {}
        widths = {each.name: each.bus_bytes for each in streams if each.bus_bytes}
        self._joiners = {name: PacketJoiner(width) for name, width in widths.items()}
        self._packets: dict[str, deque[Packet]] = {name: deque() for name in widths}

    def __bool__(self) -> bool:
        """Return whether a transfer or a packet waits."""
        return any(self._records.values()) or any(self._packets.values())

    def keep(self, number: int, records: bytes) -> None:
        """Keep the records of a message TRANSFERS."""
        name = self._streams[number].name
        if name not in self._ignored:
            self._records.setdefault(name, []).append(records)

    def count(self, name: str) -> int:
        """Return how many transfers wait; of a packet stream, how many packets."""
        if name in self._packets:
            self._join(name)
            return len(self._packets[name])
        return sum(map(len, self._records.get(name, ()))) // self._sizes[name]

    def take_transfers(self, name: str) -> list[Transfer]:
        """Take all transfers of a stream."""
        records = b"".join(self._records.pop(name, ()))
        return unpacked(records, self._sizes[name] - CYCLE_BYTES)

    def take_packets(self, name: str) -> list[Packet]:
        """Take all packets of a packet stream."""
        self._join(name)
        packets = list(self._packets[name])
        self._packets[name].clear()
        return packets

    def _join(self, name: str) -> None:
        if records := b"".join(self._records.pop(name, ())):
            self._packets[name].extend(self._joiners[name].add(records))


LIMIT = 1_000_000
QUIET = 1000
STALL_CYCLES = 1 << 14
# Bytes of a message to the engine, which it copies.
_MOST_BYTES = 1 << 22


class FastSimulation:
    """A design that runs in an engine: Verilator, up to a million cycles per second, or Amaranth's.

    The design is a component whose members are streams and plain values, in any nesting. A stream
    or value is named by the members on the way to it: ``"packets_in"``, ``"message.linear.x"``.
    Each clock domain of the design has a clock, unless the design drives it; resets are never high.
    A stream transfers at the edges of its own clock. Numbers of cycles, and :attr:`cycle`, are
    those of the first clock; the cycle of a transfer or of a stall is one of the stream's own.

    What is sent on an input stream waits in a queue, and is offered as soon as the design takes it.
    An output stream is always ready, and what came waits until it is received. `stalls` change
    both. With the same calls, both engines have the same transfers in the same cycles, except while
    the simulation is live.

    Use it from one thread, and close it; ``with FastSimulation(design) as sim:`` does.

    Parameters
    ----------
    design : wiring.Component
        Or what a `DomainRenamer` made of one. It must not be a part of another design.
    clocks : mapping of str to int, or None
        The period of each clock, by its domain, in any unit: ``{"sync": 10, "link": 8}``. The first
        one gives the cycles. `None`: all have the same period, and `sync` is the first one, if the
        design has it.
    engine : {"auto", "verilator", "amaranth"}
        ``"verilator"`` compiles the design with Verilator and a C++ compiler: the environment's
        ``CXX``, g++, clang++, or that of the Python package `ziglang`. That takes seconds to a
        minute, and once only, because programs are kept (:mod:`firm_hdl.sim.fast.compilers`).
        ``"amaranth"`` is Amaranth's simulator in a thread, hundreds of times slower. ``"auto"``
        takes Verilator if it and a compiler are installed.
    stalls : Stalls, mapping or None
        Stalls of all streams, or of streams by name. See :meth:`stall`.
    options : sequence of str
        Options of the compiler. ``["-O1"]`` compiles in less time.
    cache : Path or None
        Folder of compiled programs, which are run. Other users must not be able to write it.
        `None`: the user's cache.
    ignored : collection of str
        Output streams whose transfers are not kept. A stream that is not received in a live
        simulation would take more and more memory.
    report : callable or None
        Called with a line of text at each stage of a compilation.
    modules : mapping of str to str, or None
        Verilog by file name, ``.v`` or ``.sv``: modules of which the design has an
        `amaranth.hdl.Instance`. Only for Verilator.
    wave : Path or None
        A file that is written, up to 1 GiB: ``.fst`` is FST, any other VCD. A cycle of the fastest
        clock takes 10 ns there. Only for Verilator.

    Attributes
    ----------
    ports : Ports
        Streams and plain values.
    engine : {"verilator", "amaranth"}
        Which engine runs.
    clocks : dict of str to int
        The period of each clock, by its domain.
    cycle : int
        Number of the next cycle, as of the last run, halt or reset.
    is_live : bool

    Raises
    ------
    TypeError, ValueError
        If the design or a name is not what it has to be.
    ProgramMissingError
        If the engine is ``"verilator"`` and there is no Verilator, or no compiler.
    BuildError
        If the design cannot be compiled.
    ClockDomainError
        If a stream is in a domain whose clock the design drives, or `clocks` has other domains.
    """

    def __init__(
        self,
        design: wiring.Component,
        *,
        engine: EngineName = "auto",
        clocks: Mapping[str, int] | None = None,
        stalls: StallPlan = None,
        options: Sequence[str] = COMPILER_OPTIONS,
        cache: Path | None = None,
        ignored: Collection[str] = (),
        report: Report | None = None,
        modules: Mapping[str, str] | None = None,
        wave: Path | None = None,
    ):
        self.ports = ports_of(design)
        top = Top(design, self.ports)
        check_engine(engine)
        check_stalls(stalls, [port.name for port in self.ports.streams])
        for option, texts in (("ignored=", ignored), ("options=", options)):
            if isinstance(texts, str) or not isinstance(texts, Iterable):
                raise TypeError(f"{option} must be a list of texts, not {texts!r}")
        for name in ignored:
            self.ports.stream(name, is_input=False)
        self._ignored = frozenset(ignored)
        self.cycle = 0
        self.is_live = False
        self._clear()
        self._stalls = stalls
        self._channel: Channel = start(
            top,
            engine,
            options=options,
            cache=cache,
            report=report,
            modules=modules,
            wave=wave,
        )
        self.engine: Literal["verilator", "amaranth"] = self._channel.engine
        self._open = top.open
        try:
            self.clocks = _periods([each.name for each in top.clocks.values()], clocks)
            self._prepare(stalls)
        except BaseException:
            self.close()
            raise

    def restart(self) -> None:
        """Start the engine again, also after it has ended; nothing is compiled for it."""
        self.close()
        self.cycle, self.is_live = 0, False
        self._clear()
        self._channel = self._channel.again()
        self._prepare(self._stalls)

    def _prepare(self, stalls: StallPlan) -> None:
        if len(self.clocks) > 1:
            # An engine has the clocks in the order of their names.
            periods = [self.clocks[name] for name in sorted(self.clocks)]
            base = sorted(self.clocks).index(next(iter(self.clocks)))
            self._channel.send(protocol.clocks(base, periods))
        for port in self.ports.inputs:
            if port.init is not None:
                self.set(port.name, port.init)
        for each in self.ports.streams:
            if pattern := stalls_of(stalls, each.name):
                self.stall(each.name, pattern)

    def __enter__(self) -> FastSimulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the engine. A simulation that is closed can only be used after :meth:`restart`."""
        self._channel.close()

    # Inputs.

    def send(self, name: str, payloads: Iterable[object]) -> None:
        """Put payloads into the queue of an input stream.

        Parameters
        ----------
        payloads : iterable
            As `ctx.set` of a testbench takes them. An integer is the bits of a payload. On a stream
            of 8 bits, `bytes` are many payloads.
        """
        port = self.ports.stream(name, is_input=True)
        if isinstance(payloads, str) or not isinstance(payloads, Iterable):
            raise TypeError(f"Payloads must be a list, not {payloads!r}")
        if isinstance(payloads, bytes | bytearray) and port.bytes == 1 and port.width == 8:
            self._send(port, bytes(payloads))
        else:
            self._send(port, packed(map(port.bits, payloads), port.bytes))

    def send_packets(self, name: str, packets: Iterable[bytes], *, counts: bool = False) -> None:
        """Put packets into the queue of a packet stream, back to back.

        Lanes that are not valid are random; with `counts`, what a deserializer ignores is, too.
        """
        port = self.ports.stream(name, is_input=True, is_packets=True)
        self._send(port, packed_packets(as_packets(packets), port.bus_bytes, counts=counts))

    def set(self, name: str, value: object) -> None:
        """Set a plain input, from the current cycle on."""
        number, port = self.ports.plain_port(name, is_input=True)
        body = port.bits(value).to_bytes(port.bytes, "little")
        self._channel.send(protocol.numbered(Order.SET, number, body))

    def stall(self, name: str, pattern: Iterable[bool] | Stalls) -> None:
        """Stall a stream: in a cycle with a stall, nothing new is offered, or nothing is taken.

        Parameters
        ----------
        pattern : iterable of bool, or Stalls
            Whether the stream is stalled in cycle 0, 1 and so on; it is repeated. No cycles: no
            stalls. A pattern from a :class:`.Stalls` has its first 16,384 cycles.

        Raises
        ------
        ValueError
            If the pattern has only stalls, or the stream is an output that is always ready.
        """
        port = self.ports.stream(name)
        if isinstance(pattern, Stalls):
            pattern = islice(pattern.cycles(name), len(pattern.pattern) or STALL_CYCLES)
        if isinstance(pattern, str) or not isinstance(pattern, Iterable):
            raise TypeError(f"The pattern of {name!r} must be a list of bool, not {pattern!r}")
        bits = [bool(bit) for bit in pattern]
        if bits and all(bits):
            raise ValueError(f"The pattern of {name!r} would stall for ever")
        if not port.is_input and port.is_always_ready and any(bits):
            raise ValueError(f"Stream {name!r} is always ready, and cannot be stalled")
        self._channel.send(protocol.stall(port.number, bits))

    # Outputs.

    def receive(self, name: str) -> list[Any]:
        """Take all payloads that came on an output stream, as `ctx.get` would return them."""
        port = self.ports.stream(name, is_input=False)
        return [port.view(each.bits) for each in self.transfers(name)]

    def transfers(self, name: str) -> list[Transfer]:
        """Take all transfers that came on an output stream: cycles, and payloads as bits.

        On a packet stream, ask either for transfers or for packets: what was joined to packets is
        not there as transfers any more.
        """
        self.ports.stream(name, is_input=False)
        self._poll()
        return self._arrivals.take_transfers(name)

    def receive_packets(self, name: str) -> list[bytes]:
        """Take all complete packets that came on a packet stream."""
        return [packet.data for packet in self.packets(name)]

    def packets(self, name: str) -> list[Packet]:
        """Take all complete packets that came on a packet stream, with the cycles of their ends."""
        self.ports.stream(name, is_input=False, is_packets=True)
        self._poll()
        return self._arrivals.take_packets(name)

    def get(self, name: str) -> Any:
        """Return the value of a plain output in the current cycle."""
        number, port = self.ports.plain_port(name, is_input=False)
        self._channel.send(protocol.message(Order.GET))
        body = self._answer(Answer.VALUES)
        at = sum(each.bytes for each in self.ports.outputs[:number])
        return port.view(int.from_bytes(body[at : at + port.bytes], "little"))

    def queued(self, name: str) -> int:
        """Return how many payloads of an input stream the last run or halt had not taken."""
        return self._queued[self.ports.stream(name, is_input=True).number]

    # Time.

    def run(self, cycles: int) -> None:
        """Run a number of cycles."""
        self._run(cycles, 0, {})

    def run_until(self, counts: Mapping[str, int], *, limit: int = LIMIT) -> None:
        """Run until so many transfers wait to be received on output streams.

        Parameters
        ----------
        counts : mapping of str to int
            Transfers by stream; packets if it is a packet stream.
        limit : int
            Most cycles.

        Raises
        ------
        DeadlineError
            If they do not come in `limit` cycles.
        """
        if not isinstance(counts, Mapping):
            raise TypeError(f"Counts must be a dict of numbers by stream, not {counts!r}")
        missing = self._missing(counts)
        if missing and self._run(limit, 0, missing).reason != Reason.CONDITIONS:
            left = ", ".join(f"{n} on {name!r}" for name, n in self._missing(counts).items())
            raise DeadlineError(f"Did not come in {limit} cycles: {left}{self._waits()}")

    def run_until_idle(self, *, quiet: int = QUIET, limit: int = LIMIT) -> None:
        """Run until no stream has transferred in `quiet` cycles, and all that was sent is taken.

        Raises
        ------
        DeadlineError
            If something that was sent is not taken, or there are more than `limit` cycles.
        """
        result = self._run(limit, quiet, {})
        over = zip(self.ports.streams, result.queued, strict=True)
        left = [f"{count} on {port.name!r}" for port, count in over if count]
        if left:
            waiting = ", ".join(left) + self._waits()
            raise DeadlineError(f"Not taken up to cycle {self.cycle}: {waiting}")
        if result.reason != Reason.QUIET:
            raise DeadlineError(f"There are still transfers after {limit} cycles")

    def reset(self) -> None:
        """Go back to the state of the start. All that was sent or came is discarded.

        Stalls, and the values of plain inputs, stay.
        """
        self._not_live()
        # An answer, so that nothing from before the reset can come later.
        self._channel.send(protocol.message(Order.RESET) + protocol.message(Order.HALT))
        self._done()
        self._clear()

    # Live simulation.

    def go_live(self, *, quiet: int = 4096, nap_cycles: int = 1000, nap_ms: int = 10) -> None:
        """Let the engine run on its own, as fast as it can, until :meth:`halt`.

        Parameters
        ----------
        quiet : int
            After so many cycles without a transfer, the engine sleeps. What is sent wakes it up.
        nap_cycles, nap_ms : int
            A sleeping engine runs `nap_cycles` cycles every `nap_ms` milliseconds, for timers of
            the design. A transfer wakes it up.
        """
        self._not_live()
        for number in (quiet, nap_cycles, nap_ms):
            check_integer("A number of go_live", number)
        self.is_live = True
        self._channel.send(protocol.live(quiet, nap_ms, nap_cycles))

    def wait(self, seconds: float) -> bool:
        """Wait until something has come on an output stream; return whether it has.

        What came before and was not received counts, ignored streams do not.
        """
        end = time.monotonic() + seconds
        self._poll()
        while not self._arrivals:
            left = end - time.monotonic()
            if left <= 0 or not self.is_live:
                return False
            select.select([self.fileno()], [], [], left)
            self._poll()
        return True

    def fileno(self) -> int:
        """Return the file descriptor that can be read when something came in a live simulation.

        What was already read waits, so receive everything before the next `select`.
        """
        return self._channel.fileno()

    def halt(self) -> None:
        """End a live simulation between two cycles. What came can be received."""
        self._channel.send(protocol.message(Order.HALT))
        self._done()
        self.is_live = False

    # Inside.

    def _clear(self) -> None:
        self._arrivals = Arrivals(self.ports.streams, self._ignored)
        self._queued: Sequence[int] = [0] * len(self.ports.streams)

    def _send(self, port: StreamPort, payloads: bytes) -> None:
        step = max(1, _MOST_BYTES // port.bytes) * port.bytes
        for at in range(0, len(payloads), step):
            order = protocol.numbered(Order.SEND, port.number, payloads[at : at + step])
            self._channel.send(order)

    def _waits(self) -> str:
        """Describe streams of the design that can never transfer, as the end of an error."""
        return f"; no logic drives `ready` of {', '.join(self._open)}" if self._open else ""

    def _missing(self, counts: Mapping[str, int]) -> dict[str, int]:
        """Return how many transfers or packets must still come, by stream."""
        missing = {}
        for name, count in counts.items():
            self.ports.stream(name, is_input=False)
            check_integer(f"The number on {name!r}", count)
            if name in self._ignored:
                raise ValueError(f"Stream {name!r} is ignored")
            if (here := self._arrivals.count(name)) < count:
                missing[name] = count - here
        return missing

    def _run(self, cycles: int, quiet: int, counts: Mapping[str, int]) -> Done:
        self._not_live()
        for what, number in (("cycles", cycles), ("quiet cycles", quiet)):
            check_integer(f"The number of {what}", number)
            if number < 0:
                raise ValueError(f"The number of {what} must be at least 0, not {number}")
        ports = [(self.ports.stream(name), count) for name, count in counts.items()]
        every = protocol.ALL_TRANSFERS
        conditions = [
            (p.number, every if p.last_bit is None else p.last_bit, count) for p, count in ports
        ]
        self._channel.send(protocol.run(cycles, quiet, conditions))
        return self._done()

    def _done(self) -> Done:
        result = protocol.read_done(self._answer(Answer.DONE))
        self.cycle, self._queued = result.cycle, result.queued
        return result

    def _not_live(self) -> None:
        if self.is_live:
            raise RuntimeError("The simulation is live; halt it first")

    def _answer(self, kind: Answer) -> bytes:
        try:
            while True:
                found = self._channel.receive(None)
                for index, (came, body) in enumerate(found):
                    if came == kind:
                        # An engine that is live may already have sent more.
                        self._keep(found[:index] + found[index + 1 :])
                        return body
                self._keep(found)
        except KeyboardInterrupt:
            # The answer would be taken for that of the next call.
            self.close()
            raise

    def _poll(self) -> None:
        if self.is_live:
            self._keep(self._channel.receive(0.0))

    def _keep(self, messages: Iterable[tuple[int, bytes]]) -> None:
        for kind, body in messages:
            assert kind == Answer.TRANSFERS, kind
            self._arrivals.keep(*protocol.read_number(body))


def _periods(names: list[str], given: Mapping[str, int] | None) -> dict[str, int]:
    """Return the periods of the clocks with these names, that which gives the cycles first."""
    if given is None:
        return dict.fromkeys(sorted(names, key=lambda name: (name != "sync", name)), 1)
    if not isinstance(given, Mapping):
        raise TypeError(f"clocks= must be a dict of periods by clock domain, not {given!r}")
    if set(given) != set(names):
        raise ClockDomainError(
            f"clocks= must have the domains {_listed(names)}, not {_listed(given)}"
        )
    for name, period in given.items():
        if not isinstance(period, int) or isinstance(period, bool):
            raise TypeError(f"The period of {name!r} must be an integer, not {period!r}")
        if not 1 <= period < 1 << 32:
            raise ValueError(f"The period of {name!r} must be from 1 to {(1 << 32) - 1}")
    return dict(given)


def _listed(names: Iterable[str]) -> str:
    return ", ".join(repr(name) for name in sorted(names)) or "none"
