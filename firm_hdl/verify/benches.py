"""The generated test benches of many types, in GHDL.

For each type, what ``firm-hdl build`` writes goes to a temporary folder. GHDL analyses all of its
VHDL with warnings as errors; then the folder's own script runs the bench, which sends the packets
of rosbags through both converters with random stalls. The packets that came out, and every transfer
of every leaf, have to be what rosbags says. Types of fixed size have a second bench, of the record
view.
"""

from __future__ import annotations

import json
import shlex
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tqdm import tqdm

from firm_hdl.export.build import BuildError, Built, build, check_size, plan_of
from firm_hdl.export.manifest import MANIFEST
from firm_hdl.export.vhdl_bench import RUN_SCRIPT
from firm_hdl.frontend import DISTROS
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Plan
from firm_hdl.sim.payloads import encoder_of
from firm_hdl.verify.acceptance import library_of
from firm_hdl.verify.cases import Case
from firm_hdl.verify.processes import ToolError, in_processes, run_tool
from firm_hdl.verify.runner import Task
from firm_hdl.verify.simulators import find_ghdl
from firm_hdl.verify.stimuli import stimulus_cases
from firm_hdl.verify.user_oracle import NotJudgedError, judge_of
from firm_hdl.wire import Wire

__all__ = ["BenchResult", "BenchRun", "run_bench", "run_benches"]

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
        parts = [f"firm-hdl verify --systems bench --distro {distro}"]
        parts += [f"--path {shlex.quote(path)}" for path in self.paths]
        parts += [f"--wire {self.wire}"] if self.wire else []
        return " ".join([*parts, f"--bus-bytes {self.bus_bytes}", name])


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchResult:
    """What became of a type's bench.

    Attributes
    ----------
    failure : str
        What is wrong; empty if nothing is.
    not_judged : str
        Why there was nothing to run; empty if there was.
    packets, transfers : int
        Packets and leaf transfers that were right.
    seconds : float
    """

    failure: str = ""
    not_judged: str = ""
    packets: int = 0
    transfers: int = 0
    seconds: float = 0.0


def run_bench(distro: str, name: str, run: BenchRun) -> BenchResult:
    """Build a type and run its bench. Nothing is raised: what goes wrong is in the result."""
    began = time.perf_counter()
    failure = not_judged = ""
    packets = transfers = 0
    try:
        with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
            packets, transfers = _run_bench(distro, name, run, Path(folder))
    except NotJudgedError as error:
        not_judged = str(error)
    except (AssertionError, ToolError) as error:
        failure = str(error)
    except Exception as error:  # Whatever it is, the other types are to go on.
        failure = f"{type(error).__name__}: {error}"
    return BenchResult(
        failure=failure,
        not_judged=not_judged,
        packets=packets,
        transfers=transfers,
        seconds=time.perf_counter() - began,
    )


def _run_bench(distro: str, name: str, run: BenchRun, folder: Path) -> tuple[int, int]:
    library = library_of(distro, run.paths)
    message = library.message(name)
    plan = plan_of(message, run.wire, run.bus_bytes, DEFAULT_MAX_MESSAGE_BYTES)
    try:
        check_size(plan)
    except BuildError as error:
        raise NotJudgedError(str(error)) from None
    cases = list(stimulus_cases(judge_of(message, None if run.paths else distro), plan))
    if not cases:
        raise NotJudgedError("it has no packet that is short enough")
    built = build(
        [name],
        folder,
        library=library,
        wire=run.wire,
        bus_bytes=run.bus_bytes,
        stimuli=lambda *_: [case.packet for case in cases],
    )
    vhdl, entities = _analyse(built[0], run.ghdl)
    right = "".join(f"{case.packet.hex()}\n" for case in cases)
    transfers = 0
    for entity in entities:
        work = vhdl / f"work_{entity}"
        environment = {"GHDL": run.ghdl, "WORK": str(work), "BENCH": entity}
        names = [f"-g{what}={what}.txt" for what in ("results", "transfers")]
        said = run_tool(["sh", str(vhdl / RUN_SCRIPT), *names], vhdl, environment=environment)
        if not said.startswith("PASS "):
            raise ToolError(said)
        _compare("packets that came out", (work / "results.txt").read_text(), right)
        if entity == entities[0]:
            transfers = _check_transfers(plan, cases, (work / "transfers.txt").read_text())
    return len(cases) * len(entities), transfers


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


def run_benches(
    tasks: Sequence[Task],
    *,
    paths: Iterable[str] = (),
    wire: Wire | None = None,
    widths: Iterable[int] = (8,),
    jobs: int | None = None,
) -> bool:
    """Run the benches of many types, and print a table; return whether nothing failed.

    Raises
    ------
    SimulatorMissingError
    """
    ghdl = find_ghdl()
    # Each distribution's bench of its own, even if another has the same type: its header differs.
    work = [(distro, task.name) for task in tasks for distro in task.same]
    is_well = True
    for width in widths:
        run = BenchRun(paths=tuple(paths), wire=wire, bus_bytes=width, ghdl=ghdl)
        is_well &= _run_all(work, run, jobs)
    return is_well


def _run_all(work: Sequence[tuple[str, str]], run: BenchRun, jobs: int | None) -> bool:
    began = time.perf_counter()
    results: dict[tuple[str, str], BenchResult] = {}
    bar = tqdm(total=len(work), unit="type", desc=f"{run.bus_bytes}-byte bus", disable=None)
    with bar:
        for (distro, name), result in _results(work, run, jobs):
            results[distro, name] = result
            if result.failure:
                tqdm.write(
                    f"FAIL {name} ({distro})\n    {result.failure[:2000]}\n"
                    f"    again: {run.command(distro, name)}"
                )
            if result.not_judged:
                tqdm.write(f"not judged: {name} ({distro}): {result.not_judged}")
            bar.update()
    _table(results, run.bus_bytes)
    print(f"{time.perf_counter() - began:.0f} s")
    return not any(result.failure for result in results.values())


def _results(
    work: Sequence[tuple[str, str]], run: BenchRun, jobs: int | None
) -> Iterator[tuple[tuple[str, str], BenchResult]]:
    tasks = [((distro, name), (distro, name, run)) for distro, name in work]
    for key, result in in_processes(run_bench, tasks, jobs):
        yield key, BenchResult(failure=str(result)) if isinstance(result, Exception) else result


def _table(results: dict[tuple[str, str], BenchResult], bus_bytes: int) -> None:
    columns = ("types", "pass", "fail", "not judged", "packets", "transfers", "seconds")
    print(f"{f'{bus_bytes}-byte bus':12} " + " ".join(f"{name:>10}" for name in columns))
    for distro in DISTROS:
        mine = [result for key, result in results.items() if key[0] == distro]
        if not mine:
            continue
        counts: Counter[str] = Counter(
            "fail" if each.failure else "not judged" if each.not_judged else "pass"
            for each in mine
        )
        row = [
            len(mine),
            counts["pass"],
            counts["fail"],
            counts["not judged"],
            sum(each.packets for each in mine),
            sum(each.transfers for each in mine),
            round(sum(each.seconds for each in mine)),
        ]
        print(f"{distro:12} " + " ".join(f"{number:>10}" for number in row))
