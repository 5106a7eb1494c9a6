"""Acceptance: every case of a type through simulated converters, against the oracle.

For each case of :mod:`firm_hdl.verify.cases.make` the loopback of deserializer and serializer must
give the packet back byte for byte, every leaf must have transferred what the oracle says, and every
status must be ``OK``: once with nothing stalled and all packets back to back, and once with every
stream stalled. The golden model (:mod:`firm_hdl.plan.interpret`) must agree in both directions.
Then packets are broken, each between two good ones, and hardware and golden model must agree on
what is left of them. If a simulator of exported text is asked for, all of that is replayed in it,
cycle by cycle (:mod:`firm_hdl.verify.simulators.crosscheck`).
"""

from __future__ import annotations

import os
import random
import time
from collections.abc import Callable, Iterable, Sequence
from collections.abc import Set as AbstractSet
from itertools import chain
from typing import Any

from firm_hdl.errors import described
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.jobs.processes import cpu_seconds
from firm_hdl.model import Message
from firm_hdl.names.identifiers import identifier
from firm_hdl.plan import Edge, Payload, build_plan
from firm_hdl.plan.edges import edges
from firm_hdl.plan.interpret import decode, encode
from firm_hdl.sim.bench import DeadlineError
from firm_hdl.sim.harness import Harness
from firm_hdl.sim.record import Seen
from firm_hdl.sim.stalls import Stalls
from firm_hdl.verify.cases.damage import DAMAGES, broken_packets, stalls_for
from firm_hdl.verify.cases.directed import Coverage, bare_packets, more_cases
from firm_hdl.verify.cases.effort import (
    LARGE_STRIDE,
    LARGE_WORK,
    MOST_CASE_BYTES,
    chosen,
    message_limit,
    some_cases,
    too_large,
    within,
    work_of,
)
from firm_hdl.verify.cases.figures import digest, figures
from firm_hdl.verify.cases.make import Case, make_cases
from firm_hdl.verify.references.choice import WIDE_REFERENCES, may_stand_in
from firm_hdl.verify.references.oracle import Oracle, Transfers
from firm_hdl.verify.references.user_oracle import Judge, judge_of
from firm_hdl.verify.references.wide_oracle import WideOracle
from firm_hdl.verify.results.verdict import NotJudged, NotJudgedError
from firm_hdl.verify.simulators import simulator
from firm_hdl.verify.simulators.crosscheck import Crosscheck
from firm_hdl.verify.systems.libraries import library_of
from firm_hdl.verify.ts3.compare import (
    Expected,
    packet_differences,
    run_differences,
    transfer_differences,
)
from firm_hdl.verify.ts3.confirm import confirm
from firm_hdl.verify.ts3.options import Options, Result
from firm_hdl.wire import Wire, lay_out

__all__ = [
    "Acceptance",
    "Options",
    "Result",
    "accept",
    "accept_message",
    "measured",
]

FULL_CYCLES = 60
"""After so many cycles in which nothing leaves, converters are full of any packets."""


def accept(distro: str, name: str, options: Options | None = None) -> Result:
    """Run all cases of an embedded type. Nothing is raised: what goes wrong is in the result.

    Parameters
    ----------
    distro : str
    name : str
        ``package/Type`` or ``package/msg/Type``.
    """

    def run(message: Message, judge: Judge, options: Options, result: Result) -> None:
        accept_message(message, judge.oracle, judge.name, options, result)

    return measured(distro, name, options or Options(), run)


def measured(
    distro: str,
    name: str,
    options: Options,
    run: Callable[[Message, Judge, Options, Result], None],
) -> Result:
    """Find a type and its oracle, run something on it, and return what became of it, and when.

    Parameters
    ----------
    run : callable
        Adds to the result. It may raise anything, which goes to the result as well.
    """
    result = Result(distro=distro, name=name, command=options.command(distro, name))
    began, began_cpu = time.perf_counter(), cpu_seconds()
    try:
        message = library_of(distro, options.paths, options.bags).message(name)
        judge = judge_of(
            message,
            None if options.paths or options.bags else distro,
            stand_in=not options.bags and may_stand_in(message, options.references),
        )
        result.note = judge.note
        prepared = time.perf_counter() - began
        run(message, judge, options, result)
        result.setup_seconds += prepared
    except NotJudgedError as error:
        result.obstacle = NotJudged(str(error) or type(error).__name__)
    except Exception as error:  # Whatever it is, the other types are to go on.
        result.failures.append(described(error))
    result.seconds = time.perf_counter() - began
    result.cpu_seconds = cpu_seconds() - began_cpu
    return result


def accept_message(
    message: Message, oracle: Oracle, name: str, options: Options, result: Result
) -> None:
    """Run all cases of a message type that the oracle knows by `name`, and add to `result`."""
    began = time.perf_counter()
    wire: Any = options.wire or message.wire
    run = Acceptance(message, wire, options, result)
    cases = run.cases(oracle, name)
    bare = bare_packets(run.plan, cases)
    result.cases = len(cases)
    result.metrics = figures(message, run.plan, [case.packet for case in cases])
    run.confirm(cases, is_needed=isinstance(oracle, WideOracle))
    result.setup_seconds = time.perf_counter() - began
    taken = run.golden(cases, bare)
    if not options.simulated:
        return
    if options.most_cases is None:
        cases, bare = run.affordable(cases, bare, taken)
    run.good(cases, None, bare)
    if run.is_large(cases):
        cases = run.disturbed(cases)
    if options.stalled and cases:
        run.interrupted(cases)
        run.good(cases, stalls_for(f"{options.seed}/{name}"))
    if options.broken and cases:
        run.broken(cases)
    run.crosscheck()


def size_of(cases: Sequence[Case]) -> int:
    """Return the size of packets together, in bytes."""
    return sum(len(case.packet) for case in cases)


class Acceptance:
    """The runs of one type.

    Parameters
    ----------
    message : Message
    wire : "ros1" or "cdr"
    options : Options
    result : Result
        Takes failures and figures.
    max_message_bytes : int or None
        Of the converters; `None`: what the type needs.

    Raises
    ------
    NotJudgedError
        If the type is too large to simulate.
    """

    def __init__(
        self,
        message: Message,
        wire: Wire,
        options: Options,
        result: Result,
        max_message_bytes: int | None = None,
    ):
        self.options = options
        self.result = result
        self.message = message
        layout = lay_out(message, wire)
        if max_message_bytes is None:
            max_message_bytes = message_limit(layout.min_bytes)
        self.settings: dict[str, Any] = {
            "wire": wire,
            "bus_bytes": options.bus_bytes,
            "max_message_bytes": max_message_bytes,
        }
        self.plan = build_plan(
            layout, bus_bytes=options.bus_bytes, max_message_bytes=max_message_bytes
        )
        if reason := too_large(self.plan, layout.min_bytes):
            raise NotJudgedError(reason)
        self.leaves = {leaf.path: number for number, leaf in enumerate(self.plan.leaves)}
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
        made = make_cases(
            oracle,
            name,
            wire=plan.wire,
            bus_bytes=plan.bus_bytes,
            seed=options.seed,
            most=options.most_cases,
        )
        cases = list(some_cases(made))
        if options.most_cases is None and size_of(cases) < MOST_CASE_BYTES:
            cases += more_cases(oracle, name, plan, cases, seed=options.seed)
        return cases

    def converters(self) -> tuple[Deserializer, Serializer]:
        return Deserializer(self.message, **self.settings), Serializer(
            self.message, **self.settings
        )

    def confirm(self, cases: Sequence[Case], *, is_needed: bool) -> None:
        """Have other libraries write the cases; `is_needed`: rosbags' word is not enough."""
        found = confirm(self.message, self.plan.wire, cases, self.options.references)
        self.result.written_by, self.result.known = found.by, found.known
        self.result.failures += found.failures
        if is_needed and not set(WIDE_REFERENCES) & set(found.by):
            self.fail(f"{WIDE_REFERENCES[0]} could not write wide text, which rosbags has not")
        if self.options.references and found.unable:
            # They were asked for by name.
            self.result.obstacle = NotJudged("; ".join(found.unable.values()))

    def is_large(self, cases: Sequence[Case]) -> bool:
        """Whether a type takes long to simulate; it is stalled and broken less often."""
        return work_of(self.plan, size_of(cases)) > LARGE_WORK

    def disturbed(self, cases: Sequence[Case]) -> list[Case]:
        """Choose what to stall and damage of a large type's cases; nothing if all are too large."""
        found = within(self.plan, cases[::LARGE_STRIDE], LARGE_WORK)
        if not found:
            self.say("neither stalled nor damaged")
        return found

    def affordable(
        self,
        cases: Sequence[Case],
        bare: Sequence[tuple[Case, bytes]],
        taken: Sequence[AbstractSet[Edge]],
    ) -> tuple[list[Case], list[tuple[Case, bytes]]]:
        """Choose what to simulate; `taken`: decisions of cases, then of bare packets."""
        packets = [*(case.sent for case in cases), *(packet for _, packet in bare)]
        numbers = set(chosen(self.plan, packets, taken))
        if len(numbers) < len(packets):
            self.say(f"simulated in part: {len(numbers)} of {len(packets)} packets")
            self.cover(taken[number] for number in numbers)
        some = [case for number, case in enumerate(cases) if number in numbers]
        rest = [pair for number, pair in enumerate(bare, len(cases)) if number in numbers]
        return some, rest

    def say(self, what: str) -> None:
        """Add to the note."""
        self.result.note = "; ".join(filter(None, [self.result.note, what]))

    def fail(self, what: str) -> None:
        self.result.failures.append(what)

    def golden(
        self, cases: Sequence[Case], bare: Sequence[tuple[Case, bytes]]
    ) -> list[AbstractSet[Edge]]:
        """Check the golden model against the oracle; return the decisions of each packet."""
        taken: list[AbstractSet[Edge]] = []
        for case, packet in chain(((case, case.sent) for case in cases), bare):
            decoded = decode(self.plan, packet)
            taken.append(decoded.edges)
            if decoded.status != case.status:
                self.fail(f"golden model, {case.what}: status {decoded.status}")
            self.transfers("golden model, " + case.what, decoded.streams, [case.transfers])
        for case in cases:
            streams = {self.leaves[path]: list(items) for path, items in case.transfers.items()}
            try:
                packet, status = encode(self.plan, streams)
            except ValueError as error:
                self.fail(f"golden model, {case.what}: {error}")
                continue
            self.packets("golden model, " + case.what, [packet], [case.packet])
            if status != "OK":
                self.fail(f"golden model, {case.what}: status {status} when encoding")
        if not self.options.simulated:
            self.result.judged += len(taken)
        self.cover(taken)
        return taken

    def cover(self, taken: Iterable[AbstractSet[Edge]]) -> None:
        """Note which decisions of the plan some packets take."""
        possible = edges(self.plan)
        reached = possible.intersection(chain.from_iterable(taken))
        self.result.coverage = Coverage(possible=possible, taken=reached)

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
            self.result.comparison = found = self.cross.compare()
            self.result.simulation_seconds += time.perf_counter() - began
            title = self.cross.simulator.title
            # The simulator was asked for, so its silence is one of the failures.
            silent = isinstance(found.verdict, NotJudged)
            self.result.failures += [
                f"{title}: {detail}" if silent else detail for detail in found.verdict.details
            ]

    def good(
        self,
        cases: Sequence[Case],
        stalls: Stalls | None,
        bare: Sequence[tuple[Case, bytes]] = (),
    ) -> None:
        """Check the hardware against the oracle; `bare` packets are to come out as their cases."""
        sent = [case.sent for case in cases] + [packet for _, packet in bare]
        cases = [*cases, *(case for case, _ in bare)]
        names = [case.what for case in cases]
        where = "hardware" if stalls is None else f"hardware, {stalls}"
        try:
            seen = self.send(where, sent, stalls)
        except AssertionError as error:
            self.fail(f"{where}: {type(error).__name__}: {error}")
            return
        if stalls is None:
            self.result.beats, self.result.cycles = seen.beats_in, seen.cycles
        wanted = Expected(
            packets=[case.packet for case in cases],
            transfers=[case.transfers for case in cases],
            statuses=[case.status for case in cases],
            sent_statuses=["OK"] * len(cases),
        )
        self.result.failures += run_differences(where, self.plan, seen, wanted, names)
        self.result.judged += len(seen.packets)

    def broken(self, cases: Sequence[Case]) -> None:
        """Check the hardware against the golden model on packets that are wrong."""
        some = list(cases[:: max(1, len(cases) // len(DAMAGES))])
        broken = list(broken_packets(self.plan, some, self.rng))
        packets = list(chain.from_iterable(zip(broken, (c.packet for c in some), strict=True)))
        stalls = stalls_for(self.rng.random()) if self.options.stalled else None
        where = f"hardware, broken packets, {stalls}"
        try:
            seen = self.send(where, packets, stalls)
        except AssertionError as error:
            self.fail(f"{where}: {type(error).__name__}: {error}")
            return
        golden = [decode(self.plan, packet) for packet in packets]
        sent = [encode(self.plan, decoded.streams) for decoded in golden]
        wanted = Expected(
            packets=[packet for packet, _ in sent],
            transfers=[
                {self.plan.leaves[leaf].path: got for leaf, got in decoded.streams.items()}
                for decoded in golden
            ],
            statuses=[decoded.status for decoded in golden],
            sent_statuses=[status for _, status in sent],
        )
        names = [packet.hex() for packet in packets]
        self.result.failures += run_differences(where, self.plan, seen, wanted, names)

    def interrupted(self, cases: Sequence[Case]) -> None:
        """Fill the circuits and stop, for another simulator to meet that with a reset."""
        if self.cross is None:
            return
        blocked = Stalls.bits("0" * (2 * FULL_CYCLES) + "1")
        stalls = dict.fromkeys(("packets_out", "status", "sent_status"), blocked)
        where = "hardware, nothing taken"
        packets, observe = [case.sent for case in cases], self.cross.start(where)
        try:
            self.harness.run(packets=packets, stalls=stalls, limit=FULL_CYCLES, observe=observe)
        except DeadlineError:
            # As it is meant to end.
            pass
        except AssertionError as error:
            self.fail(f"{where}: {type(error).__name__}: {error}")
        self.result.simulated_cycles += self.harness.bench.cycles

    def packets(
        self, where: str, got: Sequence[bytes], wanted: Sequence[bytes], names: Sequence[str] = ()
    ) -> None:
        """Compare packets; `names` are those of the messages."""
        self.result.failures += packet_differences(where, got, wanted, names)

    def transfers(
        self,
        where: str,
        got: dict[int, list[Payload]],
        wanted: Sequence[Transfers],
        names: Sequence[str] = (),
    ) -> None:
        """Compare transfers; `names` are those of the messages."""
        self.result.failures += transfer_differences(where, self.plan, got, wanted, names)
