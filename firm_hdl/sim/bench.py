"""A fast bench for whole designs: one testbench that drives and observes all streams.

A bench packs all signals that it drives into a few wide signals, and all signals that it reads in
every cycle into one. It also drives the clock. So the simulator settles once per clock edge. A
payload is read only if its transfer happens or waits. This is several times faster than one
testbench per stream, which matters for thousands of cases. For users' own testbenches, see
:mod:`firm_hdl.sim.streams`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field
from typing import TypeVar

from amaranth.hdl import Cat, ClockDomain, Elaboratable, Module, Signal, Value
from amaranth.lib import stream
from amaranth.sim import Simulator, SimulatorContext

from firm_hdl.garbage import search_put_off
from firm_hdl.gateware.limits import check_integer
from firm_hdl.rtlil.connections import check_connections
from firm_hdl.sim.design import check_domains
from firm_hdl.sim.levels import divided
from firm_hdl.sim.stalls import StallPlan, check_stalls, stalls_of
from firm_hdl.sim.watch import StreamRules

__all__ = ["RESET_CYCLES", "Bench", "DeadlineError", "Job", "Ports", "RunOptions", "in_chunks"]


T = TypeVar("T")

WORD_BITS = 2048
CHUNK = 24
HALF_PERIOD = 5e-7
LIMIT = 1_000_000
RESET_CYCLES = 2
"""Cycles of a reset between two runs of a bench that keeps its state."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RunOptions:
    """The conditions of a run.

    Attributes
    ----------
    stalls : Stalls, mapping or None
        Stalls of all streams, or of streams by name.
    deadline : int
        Most cycles in a row without any transfer, in addition to the longest stall.
    limit : int or None
        Most cycles in total. `None`: 1,000,000; for a :class:`.Harness`, many more than any valid
        packets take.
    settle : int
        Cycles without any transfer after which a finished run ends.
    vcd : path or None
        File for a waveform, which makes the run slow.
    observe : callable or None
        Called with the values of the bench's probes, before the first clock edge and then in each
        cycle after all signals have settled.
    """

    stalls: StallPlan = None
    deadline: int = 1000
    limit: int | None = None
    settle: int = 4
    vcd: str | os.PathLike[str] | None = None
    observe: Callable[[list[int]], None] | None = None

    def __post_init__(self) -> None:
        check_stalls(self.stalls)
        check_integer("deadline=", self.deadline)
        check_integer("settle=", self.settle)
        if self.limit is not None:
            check_integer("limit=", self.limit)


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """One run of a bench."""

    sources: dict[str, Iterable[int]]  # Payloads to send, as bits, by the name of the stream.
    # Functions by the name of a stream. They are called at each transfer of the stream, with the
    # cycle and the payload's bits.
    takes: dict[str, Callable[[int, int], None]]
    # Returns whether everything expected has come; called after each cycle with a transfer.
    finished: Callable[[], bool]
    outstanding: Callable[[], str]  # Returns a text of what has not come yet, for the error.
    options: RunOptions = RunOptions()


class DeadlineError(AssertionError):
    """Expected transfers did not come before the deadline."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ports:
    """The streams of a design that a bench drives and observes. All names differ."""

    # Streams that the bench drives.
    sources: Mapping[str, stream.Interface] = field(default_factory=dict)
    # Streams that the bench receives from. Always ready unless stalled.
    sinks: Mapping[str, stream.Interface] = field(default_factory=dict)
    # Streams inside the design that the bench only watches.
    taps: Mapping[str, stream.Interface] = field(default_factory=dict)
    # A bit for each tap, in order: the design connects the stream through while the bit is high.
    # While a transfer of the tap waits, the bench keeps the bit high, because `valid` must not fall
    # before the transfer.
    gates: Signal | None = None
    # Values to observe in place of the payload of a sink or tap.
    payloads: Mapping[str, Value] = field(default_factory=dict)


class Bench:
    """A design with streams to the outside, ready to run jobs.

    * `design`: has ``sync`` as its only clock domain.
    * `ports`: its streams.
    * `probes`: values that runs may observe.
    * `keeps_state`: between runs, only reset the design, as in hardware: memories and registers
      without a reset keep their values. Otherwise each run starts with all initial values.

    Raises `ClockDomainError` if the design has another clock domain than `sync`.
    """

    @search_put_off()
    def __init__(
        self,
        design: Elaboratable,
        ports: Ports,
        *,
        probes: Sequence[Value] = (),
        keeps_state: bool = False,
    ):
        self.sources, self.sinks = ports.sources, ports.sinks
        self.taps, self.gates = ports.taps, ports.gates
        # Sinks and taps first, because only they are checked and observed.
        self.ports = [*self.sinks.values(), *self.taps.values(), *self.sources.values()]
        self.names = [*self.sinks, *self.taps, *self.sources]  # Names of all streams.
        if len(set(self.names)) != len(self.names):
            raise ValueError(f"Names of streams must differ, not {', '.join(self.names)}")
        self.payloads = [Value.cast(port.payload) for port in self.ports]
        for name, value in ports.payloads.items():
            self.payloads[self.names.index(name)] = value
        self.words: list[Signal] = []
        # By source: the word and the bit where its payload starts.
        self.places: dict[str, tuple[int, int]] = {}
        self.job: Job | None = None
        self.cycles = 0  # Number of cycles of the last run, even if that run failed.
        self._keeps_state = keeps_state
        self._error: AssertionError | None = None
        top = self._top(design)
        # Probes become signals: the simulator compiles the drivers of signals, but interprets
        # expressions.
        self.probes = [_gathered(top, [value]) for value in probes]
        self._circuit = top
        fragment = divided(top)
        check_connections(fragment)
        check_domains(fragment, "A bench")
        self._simulator = Simulator(fragment)
        # A waveform shows the modules as they were written, so it needs a second simulator.
        self._for_waveforms: Simulator | None = None
        self._started: set[Simulator] = set()

    def run(self, job: Job) -> int:
        """Run a job from reset; return the number of cycles, including those of the settling.

        Raises `ValueError` if the job asks for a waveform, and the bench keeps its state, or for
        stalls of a stream that does not exist.
        """
        check_stalls(job.options.stalls, self.names)
        vcd = job.options.vcd
        if vcd is not None and self._keeps_state:
            raise ValueError("A bench that keeps its state writes no waveforms")
        simulator = self._simulator
        if vcd is not None:
            simulator = self._for_waveforms = self._for_waveforms or Simulator(self._circuit)
        if simulator not in self._started:
            # Added only here, because Python warns of a testbench that never starts.
            simulator.add_testbench(self._testbench)
            self._started.add(simulator)
        elif not self._keeps_state:
            simulator.reset()
        self.job = job
        self._delay = HALF_PERIOD if vcd is not None else 0.0
        if self._keeps_state:
            self._error = None
            # The testbench waits at the end of each job.
            simulator.advance()
            if self._error is not None:
                raise self._error
            return self.cycles
        with nullcontext() if vcd is None else simulator.write_vcd(os.fspath(vcd)):
            simulator.run()
        return self.cycles

    def _top(self, design: Elaboratable) -> Module:
        m = Module()
        m.submodules.design = design
        m.domains.sync = domain = ClockDomain("sync", reset_less=not self._keeps_state)
        self.clock, self.reset = domain.clk, domain.rst
        self.handshakes = Signal(2 * len(self.ports))
        bits = [port.valid for port in self.ports] + [port.ready for port in self.ports]
        m.d.comb += self.handshakes.eq(Cat(_gathered(m, chunk) for chunk in in_chunks(bits)))
        # The first word starts with all control bits, from bit 0 up: `ready` of the sinks, then the
        # gates, then `valid` of the sources. Payloads of the sources fill it and the other words.
        control = [port.ready for port in self.sinks.values()]
        control += [] if self.gates is None else [self.gates]
        control += [port.valid for port in self.sources.values()]
        layout: list[list[Value]] = [control]
        sizes = [sum(map(len, control))]
        for name, port in self.sources.items():
            payload = Value.cast(port.payload)
            if sizes[-1] + len(payload) > WORD_BITS:
                layout.append([])
                sizes.append(0)
            self.places[name] = len(layout) - 1, sizes[-1]
            layout[-1].append(payload)
            sizes[-1] += len(payload)
        for index, (parts, size) in enumerate(zip(layout, sizes, strict=True)):
            word = Signal(size, name=f"word_{index}")
            m.d.comb += Cat(*parts).eq(word)
            self.words.append(word)
        return m

    async def _testbench(self, ctx: SimulatorContext) -> None:
        if not self._keeps_state:
            await self._run_job(ctx)
            return
        while True:
            try:
                await self._run_job(ctx)
            except AssertionError as error:
                self._error = error
            await ctx.delay(HALF_PERIOD)
            self._reset(ctx)

    def _reset(self, ctx: SimulatorContext) -> None:
        """End the last cycle of a run, and reset the design without changing its inputs."""
        for is_reset in (0, *[1] * RESET_CYCLES):
            ctx.set(self.clock, 0)
            ctx.set(self.reset, is_reset)
            ctx.set(self.clock, 1)
        ctx.set(self.clock, 0)
        ctx.set(self.reset, 0)
        for word in self.words:
            ctx.set(word, 0)

    async def _run_job(self, ctx: SimulatorContext) -> None:
        assert self.job is not None
        drive = _Drive(self, self.job)
        watch = _Watch(self, self.job, ctx)
        observe = self.job.options.observe
        if observe is not None:
            observe([ctx.get(probe) for probe in self.probes])
        fired = held = self.cycles = 0
        # The clock and the first word change together. Words reach the design only through
        # assignments, so registers still sample the values from before the edge.
        edge = Cat(self.clock, self.words[0])
        while True:
            changed = drive.next(fired, held)
            if changed & 1:
                ctx.set(edge, drive.words[0] << 1 | 1)
            else:
                ctx.set(self.clock, 1)
            if changed > 1:
                for index in range(1, len(self.words)):
                    if changed >> index & 1:
                        ctx.set(self.words[index], drive.words[index])
            if self._delay:
                await ctx.delay(self._delay)
            if observe is not None:
                observe([ctx.get(probe) for probe in self.probes])
            self.cycles += 1
            fired, held = watch.next()
            if watch.over:
                break
            ctx.set(self.clock, 0)
            if self._delay:
                await ctx.delay(self._delay)


def in_chunks(items: Sequence[T]) -> Iterator[Sequence[T]]:
    """Yield items in groups, each of a good size for one module.

    The simulator evaluates all combinational assignments of a module again whenever one of their
    inputs changes. Hundreds of assignments in one module are therefore slow, and so are hundreds
    of modules.
    """
    for start in range(0, len(items), CHUNK):
        yield items[start : start + CHUNK]


def _gathered(m: Module, bits: Sequence[Value]) -> Signal:
    """Return the concatenation of bits, as a signal of a separate module."""
    part = Module()
    together = Cat(*bits)
    gathered = Signal(len(together))
    part.d.comb += gathered.eq(together)
    m.submodules += part
    return gathered


@dataclass(slots=True)
class _Source:
    """A stream on which the bench sends: the offered payload, and the payloads after it."""

    valid: int
    word: int
    at: int
    payloads: Iterator[int]
    stalled: Iterator[bool] | None
    payload: int = 0


class _Drive:
    """The inputs of a run: the values of the bench's words in each cycle."""

    def __init__(self, bench: Bench, job: Job):
        self.words = [0] * len(bench.words)
        self.always, self.changing = 0, []
        taken = [*bench.sinks, *(bench.taps if bench.gates is not None else ())]
        self.gates = (1 << len(taken)) - (1 << len(bench.sinks))
        for index, name in enumerate(taken):
            if stalls := stalls_of(job.options.stalls, name):
                self.changing.append((1 << index, stalls.cycles(name)))
            else:
                self.always |= 1 << index
        # Sources are the last ones in bit masks of ports.
        self.first = len(bench.ports) - len(bench.sources)
        self.sources = []
        for index, (name, (word, at)) in enumerate(bench.places.items()):
            stalls = stalls_of(job.options.stalls, name)
            source = _Source(
                valid=1 << (len(taken) + index),
                word=word,
                at=at,
                payloads=iter(job.sources.get(name, ())),
                stalled=stalls.cycles(name) if stalls else None,
            )
            self.sources.append(source)
        self.idle = list(self.sources)
        self.control = 0

    def next(self, fired: int, held: int) -> int:
        """Go to the next cycle; return the words that change, as a bit mask.

        * `fired`: bit mask of the ports that transferred in this cycle.
        * `held`: bit mask of the ports whose offered transfer was not taken.
        """
        held &= self.gates & self.control
        control = self.control
        changed = 0
        fired >>= self.first
        while fired:
            low = fired & -fired
            source = self.sources[low.bit_length() - 1]
            fired ^= low
            control &= ~source.valid
            self.idle.append(source)
        if self.idle:
            control, changed = self._offer(control)
        control |= self.always
        for bit, stalled in self.changing:
            control = control & ~bit if next(stalled) else control | bit
        control |= held
        if control != self.control:
            self.words[0] ^= control ^ self.control
            self.control = control
            changed |= 1
        return changed

    def _offer(self, control: int) -> tuple[int, int]:
        """Let every idle source offer its next payload, unless it is stalled or has no more."""
        changed = 0
        idle = []
        for source in self.idle:
            if source.stalled is not None and next(source.stalled):
                idle.append(source)
                continue
            payload = next(source.payloads, None)
            if payload is None:
                continue
            if payload != source.payload:
                self.words[source.word] ^= (payload ^ source.payload) << source.at
                source.payload = payload
                changed |= 1 << source.word
            control |= source.valid
        self.idle = idle
        return control, changed


class _Watch:
    """The observations of a run: handshakes, payloads, stream rules, and deadlines."""

    def __init__(self, bench: Bench, job: Job, ctx: SimulatorContext):
        self.job = job
        self.get = ctx.get
        self.payloads = bench.payloads
        self.handshakes = bench.handshakes
        self.names = bench.names
        self.count = len(bench.ports)
        self.watched = (1 << (self.count - len(bench.sources))) - 1
        self.takes = [job.takes.get(name) for name in bench.names]
        self.rules = StreamRules(bench.names)
        stalls = [stalls_of(job.options.stalls, name) for name in bench.names]
        self.deadline = job.options.deadline + max(each.longest for each in stalls)
        self.limit = LIMIT if job.options.limit is None else job.options.limit
        self.cycle = 0
        self.quiet = 0
        self.settled = 0
        self.finished = job.finished()
        self.over = False

    def payload(self, number: int) -> int:
        """Return the bits of a port's payload in this cycle."""
        value: int = self.get(self.payloads[number])
        return value

    def next(self) -> tuple[int, int]:
        """Check one cycle; return bit masks of the ports that transfer, and that only offer."""
        both: int = self.get(self.handshakes)
        ready = both >> self.count
        valid = both & ((1 << self.count) - 1)
        fired = valid & ready
        self.rules.check(self.cycle, valid & self.watched, ready, self.payload)
        rest = fired
        while rest:
            low = rest & -rest
            number = low.bit_length() - 1
            rest ^= low
            if take := self.takes[number]:
                take(self.cycle, self.get(self.payloads[number]))
        if fired:
            self.quiet = self.settled = 0
            self.finished = self.job.finished()
        else:
            self._rest(valid)
        self.cycle += 1
        if self.cycle > self.limit:
            raise DeadlineError(
                f"No end after {self.limit} cycles; outstanding: {self.job.outstanding()}"
            )
        return fired, valid & ~ready

    def _rest(self, valid: int) -> None:
        """Count a cycle without transfers; `valid` is the bit mask of the ports that offer one."""
        self.quiet += 1
        self.settled = 0 if valid & self.watched else self.settled + 1
        self.over = self.finished and self.settled >= self.job.options.settle
        if self.quiet > self.deadline and not self.over:
            waiting = [name for bit, name in enumerate(self.names) if valid >> bit & 1]
            raise DeadlineError(
                f"No transfer in {self.quiet} cycles up to cycle {self.cycle}; "
                f"outstanding: {self.job.outstanding()}; "
                f"offered and not taken: {', '.join(waiting) or 'nothing'}"
            )
