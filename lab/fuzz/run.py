"""Fuzz one type on one bus: export, compile, run, and judge what the program says."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from firm_hdl.jobs.processes import ToolError, cpu_seconds
from firm_hdl.model import Wire
from lab.fuzz.build import build, find_tools
from lab.fuzz.circuits import CIRCUITS, Alter, CircuitName, circuits_of, unaltered
from lab.fuzz.table import Table, table_of
from lab.fuzz.types import message_of

__all__ = ["Failure", "FuzzTask", "Outcome", "judged", "run_task"]


@dataclass(frozen=True, slots=True, kw_only=True)
class FuzzTask:
    """What to send through the circuits of a type.

    Attributes
    ----------
    room : int
        Bytes that `max_message_bytes` is more than the shortest packet. Lengths may claim as much.
    packets : int
        For each circuit.
    first : int
        Number of the first packet.
    """

    type: str
    bus_bytes: int
    room: int
    seed: int
    packets: int
    first: int = 0
    circuits: tuple[CircuitName, ...] = CIRCUITS

    def command(self, failure: Failure) -> str:
        """Return the command that repeats a failure."""
        command = f"python -m lab.fuzz --types {self.type} --bus-bytes {self.bus_bytes}"
        command += f" --room {self.room} --seed {self.seed}"
        if failure.circuit:
            command += f" --circuits {failure.circuit}"
        if failure.packet is not None:
            return f"{command} --only-packet {failure.packet}"
        return f"{command} --packets {self.packets}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Failure:
    """A rule that was broken, or a tool that was no help.

    Attributes
    ----------
    circuit : str
        Empty if there is none.
    packet : int or None
    hex : str
        The packet.
    cycle : int or None
        Since the reset before the packet.
    """

    rule: str
    circuit: str = ""
    packet: int | None = None
    hex: str = ""
    expected: str = ""
    came: str = ""
    cycle: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What became of a task.

    Attributes
    ----------
    build_seconds : float
        Processor time of the export and of the compilers.
    run_seconds : float
        Processor time of the program.
    by_circuit : list of dict
        What the program said of each circuit.
    """

    task: FuzzTask
    wire: Wire
    failures: tuple[Failure, ...] = ()
    packets: int = 0
    bad: int = 0
    discarded: int = 0
    resets: int = 0
    cycles: int = 0
    transfers: int = 0
    build_seconds: float = 0.0
    run_seconds: float = 0.0
    statuses: dict[str, int] = field(default_factory=dict)
    damages: dict[str, int] = field(default_factory=dict)
    by_circuit: list[dict[str, Any]] = field(default_factory=list)

    def as_json(self) -> dict[str, Any]:
        return asdict(self)


def run_task(
    task: FuzzTask,
    *,
    alter: Alter = unaltered,
    alter_table: Callable[[Table], Table] = lambda table: table,
) -> Outcome:
    """Run a task.

    Parameters
    ----------
    alter, alter_table : callable
        For tests, which plant faults in the Verilog, and in what the decoder knows.
    """
    message = message_of(task.type)
    wire = message.wire
    outcome = Outcome(task=task, wire=wire)
    started = cpu_seconds()
    try:
        with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
            least = table_of(message, wire=wire, bus_bytes=task.bus_bytes, max_message_bytes=0)
            most = least.least_bytes + task.room
            table = table_of(message, wire=wire, bus_bytes=task.bus_bytes, max_message_bytes=most)
            circuits = circuits_of(
                message, table, max_message_bytes=most, names=task.circuits, alter=alter
            )
            program = build(circuits, alter_table(table), Path(folder), find_tools())
            outcome = replace(outcome, build_seconds=cpu_seconds() - started)
            said = program.run(
                task.circuits, seed=task.seed, first=task.first, packets=task.packets
            )
    except ToolError as error:
        return replace(outcome, failures=(Failure(rule=f"a tool failed: {error}"),))
    return judged(outcome, said)


def judged(outcome: Outcome, said: list[dict[str, Any]]) -> Outcome:
    """Add up what the program said of the circuits."""
    statuses: Counter[str] = Counter()
    damages: Counter[str] = Counter()
    for each in said:
        statuses.update(each["statuses"])
        damages.update(each["damages"])
    names = ("packets", "bad", "discarded", "resets", "cycles", "transfers")
    return replace(
        outcome,
        **{name: sum(each[name] for each in said) for name in names},
        run_seconds=sum(each["seconds"] for each in said),
        statuses=dict(statuses),
        damages=dict(damages),
        by_circuit=said,
        failures=tuple(
            failure for each in said if (failure := _failure(outcome.task, each)) is not None
        ),
    )


def _failure(task: FuzzTask, said: dict[str, Any]) -> Failure | None:
    """Return the rule that a circuit broke; the program's own numbers must agree, too."""
    circuit = said["circuit"]
    if "failure" in said:
        return Failure(circuit=circuit, **said["failure"])
    with_status = sum(said["statuses"].values())
    if said["packets"] < task.packets or not with_status:
        return Failure(circuit=circuit, rule="too few packets were sent")
    if with_status + said["discarded"] != said["packets"]:
        return Failure(
            circuit=circuit,
            rule="not every packet has exactly one status",
            expected=str(said["packets"] - said["discarded"]),
            came=str(with_status),
        )
    return None
