"""Acceptance: every case of a type through simulated converters, against the oracle.

For each case of :mod:`firm_hdl.cases.make`, the loopback of deserializer and serializer must
return the packet byte for byte. Every leaf must transfer what the oracle says, and every status
must be ``OK``. Cases run once without stalls and with all packets back to back, and once with every
stream stalled. The golden model (:mod:`firm_hdl.plan.interpret`) must agree in both directions.
Then broken packets are sent, each followed by a good one. Hardware and golden model must agree on
the results. If a simulator of exported text is asked for, it replays all runs, cycle by cycle
(:mod:`firm_hdl.verify.ts3.circuit`).
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace
from itertools import chain
from typing import Any

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.damage import broken_and_good, stalls_for
from firm_hdl.cases.directed import bare_packets
from firm_hdl.cases.effort import (
    all_cases,
    cases_to_disturb,
    digest,
    figures,
    is_large,
    message_limit,
    packets_to_simulate,
    too_large,
)
from firm_hdl.cases.make import Case
from firm_hdl.cases.oracle import RosbagsOracle
from firm_hdl.cases.user_oracle import Judge, judge_of
from firm_hdl.cases.wide_oracle import WideOracle
from firm_hdl.model import Message
from firm_hdl.plan import Edge, build_plan
from firm_hdl.plan.edges import edges
from firm_hdl.plan.interpret import decode, encode
from firm_hdl.sim.stalls import Stalls
from firm_hdl.verify.references.clients import WIDE_REFERENCES, may_stand_in
from firm_hdl.verify.results.records import PlanCoverage, Record, Test
from firm_hdl.verify.results.verdict import NotJudged
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.system import Trial
from firm_hdl.verify.systems.tasks import library_of
from firm_hdl.verify.ts3.circuit import Circuit
from firm_hdl.verify.ts3.compare import (
    Expected,
    packet_differences,
    run_differences,
    transfer_differences,
)
from firm_hdl.verify.ts3.confirm import confirm
from firm_hdl.verify.ts3.task import command_of
from firm_hdl.wire import Wire, lay_out

__all__ = [
    "Acceptance",
    "accept_message",
    "accepted",
    "confirm_cases",
    "type_and_oracle",
    "with_commands",
]

WAVEFORM_FOLDER = "waveforms"
"""The folder that the command for a waveform writes to."""


def accepted(options: CaseOptions, test: Test) -> Record:
    """Run all cases of the type of a test. An exception goes into the record."""
    with Trial.of(test) as trial:
        message, judge = type_and_oracle(options, trial)
        accept_message(message, judge.oracle, judge.name, options, trial)
    return with_commands(options, trial.end())


def type_and_oracle(options: CaseOptions, trial: Trial) -> tuple[Message, Judge]:
    """Return the type of a test, and its oracle.

    Raises `DefinitionError`. Raises `NotJudgedError` if no oracle can judge the type.
    """
    test = trial.record.test
    message = library_of(test.distro, options).message(test.type)
    judge = judge_of(
        message,
        None if options.paths or options.bags else test.distro,
        stand_in=not options.bags and may_stand_in(message, options.references),
    )
    trial.record.note = judge.note
    return message, judge


def with_commands(options: CaseOptions, record: Record) -> Record:
    """Return the record with the commands that repeat its test."""
    test = record.test
    waveform = replace(options, vcd=WAVEFORM_FOLDER, simulator="python")
    return replace(
        record,
        command=command_of(options, test.type, distro=test.distro),
        waveform_command=command_of(waveform, test.type, distro=test.distro),
    )


def accept_message(
    message: Message, oracle: RosbagsOracle, name: str, options: CaseOptions, trial: Trial
) -> None:
    """Run all cases of a message type that the oracle knows by `name`, and add to the trial."""
    wire: Any = options.wire or message.wire
    run = Acceptance(message, wire, options, trial)
    cases = all_cases(oracle, name, run.plan, seed=options.seed, most=options.most_cases)
    bare = bare_packets(run.plan, cases)
    record = trial.record
    record.cases = len(cases)
    record.metrics = figures(message, run.plan, [case.packet for case in cases])
    confirm_cases(message, run.plan.wire, cases, options, trial, oracle)
    trial.watch.enter("testing")
    taken = run.check_golden_model(cases, bare)
    if not options.simulated:
        return
    if options.most_cases is None:
        packets = [*(case.sent for case in cases), *(packet for _, packet in bare)]
        numbers = set(packets_to_simulate(run.plan, packets, taken))
        if len(numbers) < len(taken):
            record.add_note(f"simulated in part: {len(numbers)} of {len(taken)} packets")
            run.cover(taken[number] for number in numbers)
        bare = [pair for number, pair in enumerate(bare, len(cases)) if number in numbers]
        cases = [case for number, case in enumerate(cases) if number in numbers]
    run.check_circuit(cases, None, bare)
    if is_large(run.plan, cases):
        cases = cases_to_disturb(run.plan, cases)
        if not cases:
            record.add_note("neither stalled nor damaged")
    if options.stalled and cases:
        run.circuit.interrupt([case.sent for case in cases])
        run.check_circuit(cases, stalls_for(f"{options.seed}/{name}"))
    if options.broken and cases:
        run.check_damaged(cases)
    run.circuit.crosscheck()


def confirm_cases(
    message: Message,
    wire: Wire,
    cases: Sequence[Case],
    options: CaseOptions,
    trial: Trial,
    oracle: RosbagsOracle,
) -> None:
    """Compare other libraries' packets, and add to the trial.

    If the oracle is a :class:`.WideOracle`, one of the libraries must support the wide text.
    """
    found = confirm(message, wire, cases, options.references)
    if cases:
        trial.record.written_by = ("rosbags", *found.by)
    trial.known = found.known
    trial.failures += found.failures
    if isinstance(oracle, WideOracle) and not set(WIDE_REFERENCES) & set(found.by):
        trial.failures.append(
            f"{WIDE_REFERENCES[0]} could not write wide text, which rosbags has not"
        )
    if options.references and found.unable:
        # These libraries were asked for by name.
        trial.obstacle = NotJudged("; ".join(found.unable.values()))


class Acceptance:
    """The runs of one type.

    * `trial`: receives failures and figures.
    * `max_message_bytes`: the limit of the converters; `None`: `message_limit` of the type.

    Raises `NotJudgedError` if the type is too large to simulate.
    """

    circuit: Circuit  # Only if the circuit is to be simulated.

    def __init__(
        self,
        message: Message,
        wire: Wire,
        options: CaseOptions,
        trial: Trial,
        max_message_bytes: int | None = None,
    ):
        self._options, self._trial = options, trial
        layout = lay_out(message, wire)
        if max_message_bytes is None:
            max_message_bytes = message_limit(layout.least_bytes)
        self.plan = build_plan(
            layout, bus_bytes=options.bus_bytes, max_message_bytes=max_message_bytes
        )
        if reason := too_large(self.plan, layout.least_bytes):
            raise NotJudgedError(reason)
        trial.record.shape = digest(self.plan)
        self._random = random.Random(f"{options.seed}/{message.name}/broken")
        if options.simulated:
            self.circuit = Circuit(message, self.plan, options, trial)

    def check_golden_model(
        self, cases: Sequence[Case], bare: Sequence[tuple[Case, bytes]]
    ) -> list[AbstractSet[Edge]]:
        """Check the golden model against the oracle; return the decisions of each packet.

        The golden model alone is judged if the circuit is not to be simulated.
        """
        failures, plan = self._trial.failures, self.plan
        leaves = {leaf.path: number for number, leaf in enumerate(plan.leaves)}
        taken: list[AbstractSet[Edge]] = []
        for case, packet in chain(((case, case.sent) for case in cases), bare):
            where = f"golden model, {case.what}"
            decoded = decode(plan, packet)
            taken.append(decoded.edges)
            if decoded.status != case.status:
                failures.append(f"{where}: status {decoded.status}")
            failures += transfer_differences(where, plan, decoded.streams, [case.transfers])
        for case in cases:
            where = f"golden model, {case.what}"
            streams = {leaves[path]: list(items) for path, items in case.transfers.items()}
            try:
                packet, status = encode(plan, streams)
            except ValueError as error:
                failures.append(f"{where}: {error}")
                continue
            failures += packet_differences(where, [packet], [case.packet])
            if status != "OK":
                failures.append(f"{where}: status {status} when encoding")
        self.cover(taken)
        if not self._options.simulated:
            self._trial.judged += len(taken)
        return taken

    def cover(self, taken: Iterable[AbstractSet[Edge]]) -> None:
        """Store which decisions of the plan some packets take."""
        possible = edges(self.plan)
        missing = sorted(possible.difference(*taken))
        self._trial.record.coverage = PlanCoverage(
            taken=len(possible) - len(missing),
            possible=len(possible),
            missing=tuple(f"step {edge.step}: {edge.way}" for edge in missing),
        )

    def check_circuit(
        self,
        cases: Sequence[Case],
        stalls: Stalls | None,
        bare: Sequence[tuple[Case, bytes]] = (),
    ) -> None:
        """Check the hardware against the oracle; `bare` packets must come out as their cases do."""
        sent = [case.sent for case in cases] + [packet for _, packet in bare]
        where = "hardware" if stalls is None else f"hardware, {stalls}"
        seen = self.circuit.send(where, sent, stalls)
        if seen is None:
            return
        if stalls is None:
            self._trial.record.beats = seen.beats_in
        judged = [*cases, *(case for case, _ in bare)]
        wanted = Expected(
            packets=[case.packet for case in judged],
            transfers=[case.transfers for case in judged],
            statuses=[case.status for case in judged],
            sent_statuses=["OK"] * len(judged),
        )
        names = [case.what for case in judged]
        self._trial.failures += run_differences(where, self.plan, seen, wanted, names)
        self._trial.judged += len(seen.packets)

    def check_damaged(self, cases: Sequence[Case]) -> None:
        """Check the hardware against the golden model with damaged packets."""
        packets = broken_and_good(self.plan, cases, self._random)
        stalls = stalls_for(self._random.random()) if self._options.stalled else None
        where = f"hardware, broken packets, {stalls}"
        seen = self.circuit.send(where, packets, stalls)
        if seen is None:
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
        self._trial.failures += run_differences(where, self.plan, seen, wanted, names)
