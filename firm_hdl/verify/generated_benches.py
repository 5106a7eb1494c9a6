"""A test system that runs the generated VHDL test benches of many types, in GHDL.

The output of ``firm-hdl build`` goes to a temporary folder. GHDL analyses all of its VHDL with
warnings as errors. Then the folder's own script runs the bench. The bench sends the packets of
rosbags through both converters with random stalls. The packets at the output, and every transfer
of every leaf, have to match those of rosbags. Types of fixed size have a second bench for the
record view.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.make import Case
from firm_hdl.cases.stimuli import stimulus_cases
from firm_hdl.cases.user_oracle import check_wire, judge_of
from firm_hdl.cases.wide_oracle import WideOracle
from firm_hdl.export.build import BuildError, Built, build, check_size, plan_of
from firm_hdl.export.manifest import MANIFEST
from firm_hdl.export.options import Options as BuildOptions
from firm_hdl.export.vhdl.bench import RUN_SCRIPT
from firm_hdl.jobs.processes import ToolError, made_by, run_tool
from firm_hdl.jobs.programs import find_ghdl, version_of
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Plan
from firm_hdl.sim.payloads import encoder_of
from firm_hdl.verify.references.clients import WIDE_REFERENCES, may_stand_in
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.records import Record, Test
from firm_hdl.verify.results.verdict import first_difference
from firm_hdl.verify.systems.options import CaseOptions, Request
from firm_hdl.verify.systems.system import (
    Stopwatch,
    Trial,
    TypesSystem,
    as_test,
    failure_of,
    run_and_record,
    run_tests,
)
from firm_hdl.verify.systems.tasks import TypeUnderTest, library_of
from firm_hdl.verify.ts3.confirm import confirm

__all__ = ["Benches", "judge_bench"]

WARNINGS = ("--warn-error", "--warn-unused", "--warn-body", "--warn-default-binding")


def judge_bench(given: tuple[CaseOptions, str], test: Test) -> Record:
    """Build a type and run its bench. Errors are not raised, but are in the record.

    * `given`: how to build the type (its paths and wire), and the command of GHDL.
    """
    options, ghdl = given
    with (
        Trial.of(test) as trial,
        tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder,
    ):
        try:
            packets, transfers = _packets_and_transfers(
                test, options, ghdl, Path(folder), trial.watch
            )
        except (AssertionError, ToolError) as error:
            trial.failures.append(str(error))
        else:
            # The cases of the verdict are the packets that came out as the oracle wrote them.
            trial.judged = trial.record.packets = packets
            trial.record.metrics = {"transfers": float(transfers)}
    return trial.end()


def _packets_and_transfers(
    test: Test, options: CaseOptions, ghdl: str, folder: Path, watch: Stopwatch
) -> tuple[int, int]:
    """Return the numbers of correct packets and of correct transfers of leaves."""
    library = library_of(test.distro, options)
    message = library.message(test.type)
    check_wire(message)
    plan = plan_of(message, options.wire, test.bus_bytes, DEFAULT_MAX_MESSAGE_BYTES)
    try:
        check_size(plan)
    except BuildError as error:
        raise NotJudgedError(str(error)) from None
    cases = _cases(message, plan, None if options.paths else test.distro)
    built = build(
        [test.type],
        folder,
        library=library,
        options=BuildOptions(wire=options.wire, bus_bytes=test.bus_bytes),
        stimuli=lambda *_: [case.packet for case in cases],
    )
    vhdl, entities = _analyse(built[0], ghdl)
    right = "".join(f"{case.packet.hex()}\n" for case in cases)
    transfers = 0
    for entity in entities:
        watch.enter("simulation")
        work = _simulate(entity, vhdl, ghdl)
        watch.enter("testing")
        _compare("packets that came out", made_by(entity, work / "results.txt").read_text(), right)
        if entity == entities[0]:
            transfers = _check_transfers(
                plan, cases, made_by(entity, work / "transfers.txt").read_text()
            )
    return len(cases) * len(entities), transfers


def _cases(message: Message, plan: Plan, distro: str | None) -> list[Case]:
    """Choose the packets of a bench. For wide text, another library has to confirm their bytes."""
    judge = judge_of(message, distro, stand_in=may_stand_in(message, WIDE_REFERENCES))
    cases = list(stimulus_cases(judge, plan))
    if not cases:
        raise NotJudgedError("it has no packet that is short enough")
    if isinstance(judge.oracle, WideOracle):
        found = confirm(message, plan.wire, cases, WIDE_REFERENCES)
        if found.failures:
            raise AssertionError(found.failures[0])
        if not found.by:
            raise AssertionError(f"{WIDE_REFERENCES[0]} could not write the type's wide text")
    return cases


def _simulate(entity: str, vhdl: Path, ghdl: str) -> Path:
    """Run a bench with the script beside it; return the folder with the files that it wrote."""
    work = vhdl / f"work_{entity}"
    environment = {"GHDL": ghdl, "WORK": str(work), "BENCH": entity}
    names = [f"-g{what}={what}.txt" for what in ("results", "transfers")]
    output = run_tool(["sh", str(vhdl / RUN_SCRIPT), *names], vhdl, environment=environment)
    if not output.startswith("PASS "):
        raise ToolError(output.strip() or f"{entity} ended without a word: it has not passed")
    return work


def _analyse(built: Built, ghdl: str) -> tuple[Path, list[str]]:
    """Analyse all files in a temporary folder. Any message of GHDL is an error.

    Returns the folder of the VHDL, and the entities to run.
    """
    manifest = json.loads((built.folder / MANIFEST).read_text(encoding="utf-8"))["vhdl"]
    vhdl = built.folder.resolve() / str(manifest["folder"])
    files = [str(vhdl / name) for name in [*manifest["files"], *manifest["bench"]["files"]]]
    with tempfile.TemporaryDirectory(dir=vhdl.parent) as work:
        output = run_tool([ghdl, "-a", "--std=08", *WARNINGS, *files], Path(work))
    if output:
        raise ToolError(output)
    return vhdl, list(manifest["bench"]["entities"])


def _check_transfers(plan: Plan, cases: Sequence[Case], text: str) -> int:
    """Compare the transfers that the bench wrote with the oracle's; return their number."""
    shown: dict[str, list[str]] = {}
    for line in text.splitlines():
        _, name, *rest = line.split(" ")
        shown.setdefault(name, []).append(" ".join(rest))
    for leaf in plan.leaves:
        encode = encoder_of(leaf)
        width = (1 if leaf.primitive.kind == "bool" else 8 * leaf.primitive.bytes) * leaf.lanes
        right = []
        for case in cases:
            for payload in case.transfers.get(leaf.path, ()):
                bits = encode(payload)
                last = " *" if bits >> width else ""
                right.append(f"{bits & (1 << width) - 1:0{-(-width // 4)}X}{last}")
        _compare(f"transfers of {leaf}", "\n".join(shown.pop(str(leaf), [])), "\n".join(right))
    if shown:
        raise AssertionError(f"transfers of leaves that there are not: {', '.join(shown)}")
    return text.count("\n")


def _compare(what: str, got: str, right: str) -> None:
    if got == right:
        return
    received, wanted = got.splitlines(), right.splitlines()
    at = first_difference(received, wanted)
    raise AssertionError(
        f"{what}: number {at} of {len(wanted)} is {received[at : at + 1]} "
        f"instead of {wanted[at : at + 1]}"
    )


class Benches(TypesSystem):
    """The test system of generated benches. A test is the bench of a type of one distribution.

    * `request`: `paths`, `wire`, `widths` and `jobs` are used.

    Raises `ProgramMissingError`.
    """

    name = "bench"
    passes = "benches pass"

    def __init__(self, tasks: Sequence[TypeUnderTest], request: Request):
        # Equal types of several distributions each have a bench, because the headers of the
        # generated files differ.
        each = [replace(task, distro=name, same=(name,)) for task in tasks for name in task.same]
        super().__init__(each, request)
        self._ghdl = find_ghdl()

    def _tests(self, options: CaseOptions) -> list[Test]:
        return [as_test(self.name, task, options, simulator="ghdl") for task in self._tasks]

    @property
    def options(self) -> Mapping[str, Any]:
        """What GHDL says of its version: results of another one are another run's."""
        return {"ghdl": version_of(self._ghdl)}

    def records(self, writer: ResultsWriter | None) -> list[Record]:
        """Run all benches."""
        given, jobs = (self._request, self._ghdl), self._request.jobs
        return run_and_record(
            self.tests,
            writer,
            lambda left: run_tests(judge_bench, given, left, self._command, jobs=jobs),
            lambda record: failure_of(f"{record.test.type} ({record.test.distro})", record),
            label="benches",
        )
