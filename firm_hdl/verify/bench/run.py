"""The generated test benches of a type, in GHDL.

What ``firm-hdl build`` writes goes to a temporary folder. GHDL analyses all of its VHDL with
warnings as errors; then the folder's own script runs the bench, which sends the packets
of rosbags through both converters with random stalls. The packets that came out, and every transfer
of every leaf, have to be what rosbags says. Types of fixed size have a second bench, of the record
view.
"""

from __future__ import annotations

import json
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from firm_hdl.errors import described
from firm_hdl.export.backend import Options
from firm_hdl.export.build import BuildError, Built, build, check_size, plan_of
from firm_hdl.export.manifest import MANIFEST
from firm_hdl.export.vhdl.bench import RUN_SCRIPT
from firm_hdl.jobs.processes import ToolError, cpu_seconds, made_by, run_tool
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Plan
from firm_hdl.sim.payloads import encoder_of
from firm_hdl.verify.cases.make import Case
from firm_hdl.verify.cases.stimuli import stimulus_cases
from firm_hdl.verify.references.choice import WIDE_REFERENCES, may_stand_in
from firm_hdl.verify.references.user_oracle import check_wire, judge_of
from firm_hdl.verify.references.wide_oracle import WideOracle
from firm_hdl.verify.results.verdict import Failed, NotJudged, NotJudgedError, Passed, Verdict
from firm_hdl.verify.systems.again import command_again
from firm_hdl.verify.systems.libraries import library_of
from firm_hdl.verify.ts3.confirm import confirm
from firm_hdl.wire import Wire

__all__ = ["BenchResult", "BenchRun", "run_bench"]

WARNINGS = ("--warn-error", "--warn-unused", "--warn-body", "--warn-default-binding")


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchRun:
    """What to run a bench with.

    Attributes
    ----------
    paths : tuple of str
        Folders with ROS packages, searched before the distribution's own types.
    wire : "ros1", "cdr" or None
    bus_bytes : int
    ghdl : str
        Its command.
    """

    paths: tuple[str, ...] = ()
    wire: Wire | None = None
    bus_bytes: int = 8
    ghdl: str

    def command(self, distro: str, name: str) -> str:
        """Return the command that runs one type again."""
        return command_again(
            name,
            systems="bench",
            distro=distro,
            path=self.paths,
            wire=self.wire,
            bus_bytes=self.bus_bytes,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchResult:
    """What became of a type's bench.

    Attributes
    ----------
    verdict : Verdict
        Cases are packets that came out as the oracle has them.
    packets, transfers : int
        Packets and leaf transfers that were right.
    seconds, cpu_seconds : float
        By the clock on the wall, and of all processors.
    setup_seconds, simulation_seconds : float
        Until GHDL had analysed everything, and while it ran.
    """

    verdict: Verdict
    packets: int = 0
    transfers: int = 0
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    setup_seconds: float = 0.0
    simulation_seconds: float = 0.0


def run_bench(distro: str, name: str, run: BenchRun) -> BenchResult:
    """Build a type and run its bench. Nothing is raised: what goes wrong is in the result."""
    began, began_cpu = time.perf_counter(), cpu_seconds()
    verdict: Verdict
    packets = transfers = 0
    simulation: list[tuple[float, float]] = []
    try:
        with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
            packets, transfers = _run_bench(distro, name, run, Path(folder), simulation)
        verdict = Passed(packets)
    except NotJudgedError as error:
        verdict = NotJudged(str(error) or type(error).__name__)
    except (AssertionError, ToolError) as error:
        verdict = Failed((str(error),))
    except Exception as error:  # Whatever it is, the other types are to go on.
        verdict = Failed((described(error),))
    return BenchResult(
        verdict=verdict,
        packets=packets,
        transfers=transfers,
        seconds=time.perf_counter() - began,
        cpu_seconds=cpu_seconds() - began_cpu,
        setup_seconds=(simulation[0][0] if simulation else time.perf_counter()) - began,
        simulation_seconds=sum(end - start for start, end in simulation),
    )


def _run_bench(
    distro: str, name: str, run: BenchRun, folder: Path, simulation: list[tuple[float, float]]
) -> tuple[int, int]:
    """Return numbers of packets and transfers; add when each simulation began and ended."""
    library = library_of(distro, run.paths)
    message = library.message(name)
    check_wire(message)
    plan = plan_of(message, run.wire, run.bus_bytes, DEFAULT_MAX_MESSAGE_BYTES)
    try:
        check_size(plan)
    except BuildError as error:
        raise NotJudgedError(str(error)) from None
    cases = _cases(message, plan, None if run.paths else distro)
    built = build(
        [name],
        folder,
        library=library,
        options=Options(wire=run.wire, bus_bytes=run.bus_bytes),
        stimuli=lambda *_: [case.packet for case in cases],
    )
    vhdl, entities = _analyse(built[0], run.ghdl)
    right = "".join(f"{case.packet.hex()}\n" for case in cases)
    transfers = 0
    for entity in entities:
        began = time.perf_counter()
        work = _simulate(entity, vhdl, run.ghdl)
        simulation.append((began, time.perf_counter()))
        _compare("packets that came out", made_by(entity, work / "results.txt").read_text(), right)
        if entity == entities[0]:
            transfers = _check_transfers(
                plan, cases, made_by(entity, work / "transfers.txt").read_text()
            )
    return len(cases) * len(entities), transfers


def _cases(message: Message, plan: Plan, distro: str | None) -> list[Case]:
    """Choose the packets of a bench; wide text needs somebody else who writes the same bytes."""
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
    """Run a bench by the script that is beside it; return the folder of what it wrote."""
    work = vhdl / f"work_{entity}"
    environment = {"GHDL": ghdl, "WORK": str(work), "BENCH": entity}
    names = [f"-g{what}={what}.txt" for what in ("results", "transfers")]
    said = run_tool(["sh", str(vhdl / RUN_SCRIPT), *names], vhdl, environment=environment)
    if not said.startswith("PASS "):
        raise ToolError(said.strip() or f"{entity} ended without a word: it has not passed")
    return work


def _analyse(built: Built, ghdl: str) -> tuple[Path, list[str]]:
    """Analyse everything in a folder of its own; GHDL must have nothing to say.

    Returns
    -------
    folder, benches
        Where the VHDL is, and the entities to run.
    """
    manifest = json.loads((built.folder / MANIFEST).read_text(encoding="utf-8"))["vhdl"]
    vhdl = built.folder.resolve() / str(manifest["folder"])
    files = [str(vhdl / name) for name in [*manifest["files"], *manifest["bench"]["files"]]]
    with tempfile.TemporaryDirectory(dir=vhdl.parent) as work:
        said = run_tool([ghdl, "-a", "--std=08", *WARNINGS, *files], Path(work))
    if said:
        raise ToolError(said)
    return vhdl, list(manifest["bench"]["entities"])


def _check_transfers(plan: Plan, cases: Sequence[Case], text: str) -> int:
    """Compare what the bench wrote of each leaf with the oracle; return how many transfers."""
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
    mine, wanted = got.splitlines(), right.splitlines()
    pairs = enumerate(zip(mine, wanted, strict=False))
    at = next((n for n, (a, b) in pairs if a != b), min(len(mine), len(wanted)))
    raise AssertionError(
        f"{what}: number {at} of {len(wanted)} is {mine[at : at + 1]} "
        f"instead of {wanted[at : at + 1]}"
    )
