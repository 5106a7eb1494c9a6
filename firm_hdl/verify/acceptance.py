"""Acceptance: every case of a type through simulated converters, against the oracle.

For each case of :mod:`firm_hdl.verify.cases` the loopback of deserializer and serializer must give
the packet back byte for byte, every leaf must have transferred what the oracle says, and every
status must be ``OK``: once with nothing stalled and all packets back to back, and once with every
stream stalled. The golden model (:mod:`firm_hdl.plan.interpret`) must agree in both directions.
Then packets are broken, each between two good ones, and hardware and golden model must agree on
what is left of them. If a simulator of exported text is asked for, all of that is replayed in it,
cycle by cycle (:mod:`firm_hdl.verify.crosscheck`).
"""

from __future__ import annotations

import os
import random
import resource
import time
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import chain
from typing import Any

from firm_hdl.export.names import identifier
from firm_hdl.frontend import Library
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.model import Message
from firm_hdl.plan import Edge, Payload, Plan, build_plan
from firm_hdl.plan.edges import edges
from firm_hdl.plan.interpret import decode, encode
from firm_hdl.sim.harness import Harness
from firm_hdl.sim.record import Seen
from firm_hdl.sim.stalls import Stalls
from firm_hdl.verify.cases import Case, make_cases
from firm_hdl.verify.crosscheck import Crosscheck
from firm_hdl.verify.directed import Coverage, bare_packets, more_cases
from firm_hdl.verify.figures import digest, figures
from firm_hdl.verify.options import Options, Result
from firm_hdl.verify.oracle import Oracle, Transfers
from firm_hdl.verify.simulators import simulator
from firm_hdl.verify.user_oracle import NotJudgedError, judge_of
from firm_hdl.wire import Wire, lay_out

__all__ = [
    "Options",
    "Result",
    "accept",
    "accept_message",
    "broken_packets",
    "library_of",
    "stalls_for",
]

MAX_MESSAGE_BYTES = 1 << 16
"""Small enough that a length over what it leaves room for can be completed in simulation."""


LARGE = 300_000
"""Beats times leaves, to which simulation time is roughly proportional, of a large type's cases."""

LARGE_STRIDE = 4


def accept(distro: str, name: str, options: Options | None = None) -> Result:
    """Run all cases of an embedded type. Nothing is raised: what goes wrong is in the result.

    Parameters
    ----------
    distro : str
    name : str
        ``package/Type`` or ``package/msg/Type``.
    """
    options = options or Options()
    result = Result(distro=distro, name=name, command=options.command(distro, name))
    began, began_cpu = time.perf_counter(), _cpu_seconds()
    try:
        message = library_of(distro, options.paths).message(name)
        judge = judge_of(message, None if options.paths else distro)
        result.note = judge.note
        prepared = time.perf_counter() - began
        accept_message(message, judge.oracle, judge.name, options, result)
        result.setup_seconds += prepared
    except NotJudgedError as error:
        result.not_judged = str(error)
    except Exception as error:  # Whatever it is, the other types are to go on.
        result.failures.append(f"{type(error).__name__}: {error}")
    result.seconds = time.perf_counter() - began
    result.cpu_seconds = _cpu_seconds() - began_cpu
    return result


def _cpu_seconds() -> float:
    """Return the processor time of this thread, and of programs that it has waited for."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.thread_time() + children.ru_utime + children.ru_stime


@cache
def library_of(distro: str, paths: tuple[str, ...]) -> Library:
    """Return a library, which is opened once in a process."""
    return Library(distro, paths)


def accept_message(
    message: Message, oracle: Oracle, name: str, options: Options, result: Result
) -> None:
    """Run all cases of a message type that the oracle knows by `name`, and add to `result`."""
    began = time.perf_counter()
    wire: Any = options.wire or message.wire
    run = _Acceptance(message, wire, options, result)
    cases = run.cases(oracle, name)
    bare = bare_packets(run.plan, cases)
    result.cases = len(cases)
    result.metrics = figures(message, run.plan, [case.packet for case in cases])
    result.setup_seconds = time.perf_counter() - began
    run.golden(cases, bare)
    if not options.simulated:
        return
    run.good(cases, None, bare)
    if run.is_large(cases):
        cases = cases[::LARGE_STRIDE]
    if options.stalled:
        run.good(cases, stalls_for(f"{options.seed}/{name}"))
    if options.broken:
        run.broken(cases)
    run.crosscheck()


def stalls_for(seed: str | float) -> Stalls:
    """Draw stalls: rare and long, frequent and short, or in between."""
    rng = random.Random(seed)
    probability, most = rng.choice(((0.05, 30), (0.2, 6), (0.5, 2), (0.8, 1), (0.3, 12)))
    return Stalls(probability, 1, most, seed=rng.getrandbits(32))


def broken_packets(plan: Plan, cases: Sequence[Case], rng: random.Random) -> Iterator[bytes]:
    """Yield packets that are cut, too long, just not too long, or of a wrong representation."""
    for case in cases:
        packet = case.packet
        kind = rng.choice(("cut", "cut", "long", "slack", "header"))
        if kind == "header" and plan.header_bytes:
            yield bytes((0, rng.choice((0, 2, 3, 7)))) + packet[2:]
        elif kind == "cut" and packet:
            yield packet[: rng.randrange(len(packet))]
        elif kind == "long":
            yield packet + rng.randbytes(plan.slack_bytes + rng.randint(1, 2 * plan.bus_bytes))
        else:
            # As many as are allowed, or one more.
            yield packet + rng.randbytes(plan.slack_bytes + rng.randint(0, 1))


class _Acceptance:
    """The runs of one type."""

    def __init__(self, message: Message, wire: Wire, options: Options, result: Result):
        self.options = options
        self.result = result
        self.message = message
        self.settings: dict[str, Any] = {
            "wire": wire,
            "bus_bytes": options.bus_bytes,
            "max_message_bytes": MAX_MESSAGE_BYTES,
        }
        self.plan = build_plan(
            lay_out(message, wire),
            bus_bytes=options.bus_bytes,
            max_message_bytes=MAX_MESSAGE_BYTES,
        )
        result.wire, result.shape = self.plan.wire, digest(self.plan)
        self.runs = 0
        self.rng = random.Random(f"{options.seed}/{message.name}/broken")
        if not options.simulated:
            return
        rx, tx = self.converters()
        other = simulator(options.simulator)
        self.cross = (
            None if other is None else Crosscheck(other, (rx, tx), self.converters, message.name)
        )
        probes = () if self.cross is None else self.cross.trace.probes
        self.harness = Harness(rx, tx, message=message, gated=options.stalled, probes=probes)

    def cases(self, oracle: Oracle, name: str) -> list[Case]:
        """Make the cases, and those that the plan's other decisions need if there is no limit."""
        options, plan = self.options, self.plan
        cases = list(
            make_cases(
                oracle,
                name,
                wire=plan.wire,
                bus_bytes=plan.bus_bytes,
                seed=options.seed,
                most=options.most_cases,
            )
        )
        if options.most_cases is None:
            cases += more_cases(oracle, name, plan, cases, seed=options.seed)
        return cases

    def converters(self) -> tuple[Deserializer, Serializer]:
        return Deserializer(self.message, **self.settings), Serializer(
            self.message, **self.settings
        )

    def is_large(self, cases: Sequence[Case]) -> bool:
        """Whether a type takes minutes to simulate; it is stalled and broken less often."""
        beats = sum(len(case.packet) for case in cases) // self.options.bus_bytes
        return beats * len(self.plan.leaves) > LARGE

    def fail(self, what: str) -> None:
        self.result.failures.append(what)

    def golden(self, cases: Sequence[Case], bare: Sequence[tuple[Case, bytes]]) -> None:
        """Check the golden model against the oracle, and note which decisions packets take."""
        taken: set[Edge] = set()
        for case, packet in chain(((case, case.packet) for case in cases), bare):
            decoded = decode(self.plan, packet)
            taken |= decoded.edges
            if decoded.status != "OK":
                self.fail(f"golden model, {case.what}: status {decoded.status}")
            self.transfers("golden model, " + case.what, decoded.streams, [case.transfers])
        for case in cases:
            streams = {self.leaf(path): list(items) for path, items in case.transfers.items()}
            try:
                packet, status = encode(self.plan, streams)
            except ValueError as error:
                self.fail(f"golden model, {case.what}: {error}")
                continue
            self.packets("golden model, " + case.what, [packet], [case.packet])
            if status != "OK":
                self.fail(f"golden model, {case.what}: status {status} when encoding")
        possible = edges(self.plan)
        self.result.coverage = Coverage(possible=possible, taken=possible & taken)

    def leaf(self, path: tuple[str, ...]) -> int:
        for number, leaf in enumerate(self.plan.leaves):
            if leaf.path == path:
                return number
        raise AssertionError(f"The plan has no leaf {'.'.join(path)}")

    def send(self, where: str, packets: Sequence[bytes], stalls: Stalls | None) -> Seen:
        observe = None if self.cross is None else self.cross.start(where)
        began = time.perf_counter()
        try:
            seen = self.harness.run(
                packets=packets, stalls=stalls, observe=observe, vcd=self.waveform()
            )
        finally:
            self.result.simulation_seconds += time.perf_counter() - began
        self.result.packets += len(packets)
        self.result.simulated_cycles += self.harness.bench.cycles
        if self.cross is not None:
            self.cross.done(seen)
        return seen

    def waveform(self) -> str | None:
        """Return the file for the waveform of the next run, if it is to have one."""
        if self.options.vcd is None:
            return None
        self.runs += 1
        os.makedirs(self.options.vcd, exist_ok=True)
        base = identifier(f"{self.message.name}_{self.plan.wire}_{self.plan.bus_bytes}")
        return os.path.join(self.options.vcd, f"{base}_run{self.runs}.vcd")

    def crosscheck(self) -> None:
        """Compare everything that was sent with another simulator, if there is one."""
        if self.cross is not None:
            began = time.perf_counter()
            self.result.comparison = self.cross.compare()
            self.result.simulation_seconds += time.perf_counter() - began
            self.result.failures += self.result.comparison.failures

    def good(
        self,
        cases: Sequence[Case],
        stalls: Stalls | None,
        bare: Sequence[tuple[Case, bytes]] = (),
    ) -> None:
        """Check the hardware against the oracle; `bare` packets are to come out as their cases."""
        sent = [case.packet for case in cases] + [packet for _, packet in bare]
        cases = [*cases, *(case for case, _ in bare)]
        where = "hardware" if stalls is None else f"hardware, {stalls}"
        try:
            seen = self.send(where, sent, stalls)
        except AssertionError as error:
            self.fail(f"{where}: {type(error).__name__}: {error}")
            return
        if stalls is None:
            self.result.beats, self.result.cycles = seen.beats_in, seen.cycles
        self.packets(where, seen.packets, [case.packet for case in cases])
        self.transfers(where, seen.transfers, [case.transfers for case in cases])
        for what, statuses in (("status", seen.statuses), ("sent_status", seen.sent_statuses)):
            names = [status.name for status in statuses]
            if set(names) - {"OK"}:
                self.fail(f"{where}: {what} is {' '.join(names)}")
        if any(seen.marked):
            self.fail(f"{where}: packet_error is {seen.marked}")

    def broken(self, cases: Sequence[Case]) -> None:
        """Check the hardware against the golden model on packets that are wrong."""
        some = list(cases[:: max(1, len(cases) // 5)])
        broken = list(broken_packets(self.plan, some, self.rng))
        packets = list(chain.from_iterable(zip(broken, (c.packet for c in some), strict=True)))
        stalls = stalls_for(self.rng.random()) if self.options.stalled else None
        where = f"hardware, broken packets, {stalls}"
        expected = [decode(self.plan, packet) for packet in packets]
        try:
            seen = self.send(where, packets, stalls)
        except AssertionError as error:
            self.fail(f"{where}: {type(error).__name__}: {error}")
            return
        for number, (status, golden) in enumerate(zip(seen.statuses, expected, strict=True)):
            if status.name != golden.status:
                self.fail(
                    f"{where}: packet {number} ({packets[number].hex()}): status is {status.name}, "
                    f"golden model says {golden.status}"
                )
        by_path = [
            {self.plan.leaves[leaf].path: got for leaf, got in golden.streams.items()}
            for golden in expected
        ]
        self.transfers(where, seen.transfers, by_path)
        self.packets(where, seen.packets, [encode(self.plan, g.streams)[0] for g in expected])

    def packets(self, where: str, got: Sequence[bytes], wanted: Sequence[bytes]) -> None:
        """Compare packets, and report the first that differs."""
        for number, (one, other) in enumerate(zip(got, wanted, strict=True)):
            if one != other:
                at = next(
                    (n for n, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), -1
                )
                self.fail(
                    f"{where}: packet {number} of {len(wanted)} differs at byte {at}: "
                    f"{one.hex()} instead of {other.hex()}"
                )
                return

    def transfers(
        self, where: str, got: dict[int, list[Payload]], wanted: Sequence[Transfers]
    ) -> None:
        """Compare transfers, and report the first that differs of each leaf."""
        joined: dict[tuple[str, ...], list[Payload]] = {}
        for each in wanted:
            for path, payloads in each.items():
                joined.setdefault(path, []).extend(payloads)
        for number, leaf in enumerate(self.plan.leaves):
            mine, right = got.get(number, []), joined.pop(leaf.path, [])
            if mine == right:
                continue
            pairs = enumerate(zip(mine, right, strict=False))
            at = next((n for n, (a, b) in pairs if a != b), min(len(mine), len(right)))
            self.fail(
                f"{where}: leaf {leaf}, transfer {at} of {len(right)}: "
                f"{mine[at : at + 1]} instead of {right[at : at + 1]}"
            )
        if joined:
            self.fail(f"{where}: no leaves {', '.join('.'.join(path) for path in joined)}")
