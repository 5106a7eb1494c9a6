"""Proofs for the converters of message types, in several processes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from amaranth.back import rtlil as amaranth_rtlil

from firm_hdl.equivalence.circuit import ProofError
from firm_hdl.equivalence.proof import DEFAULT_TIMEOUT, Proof, prove
from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.export.build import check_size, plan_of
from firm_hdl.export.top import DIRECTIONS, Direction, Top
from firm_hdl.frontend import open_library
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.jobs import run_each
from firm_hdl.model import Message
from firm_hdl.names.identifiers import identifier
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES
from firm_hdl.vhdl.convert import Vhdl, convert
from firm_hdl.wire import Wire

__all__ = [
    "Attempt",
    "ProofTask",
    "attempt",
    "both_directions",
    "converter_vhdl",
    "prove_converter",
    "run_tasks",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class ProofTask:
    """The proof of one converter.

    Attributes
    ----------
    distro, paths, bags, depends
        As for `open_library`.
    """

    distro: str
    name: str  # Name of the type.
    direction: Direction
    paths: tuple[str, ...] = ()
    bags: tuple[str, ...] = ()
    depends: tuple[str, ...] = ()
    # As for the converters.
    wire: Wire | None = None
    bus_bytes: int = 8
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES
    timeout: float = DEFAULT_TIMEOUT  # Seconds for each solver.


@dataclass(frozen=True, slots=True, kw_only=True)
class Attempt:
    """The result of a task. Without a proof, `problem` says why."""

    proof: Proof | None
    problem: str = ""

    @property
    def result(self) -> str:
        """The result in one word."""
        return self.proof.result if self.proof is not None else "failed"


def converter_vhdl(
    message: Message,
    direction: Direction,
    *,
    wire: Wire | None = None,
    bus_bytes: int = 8,
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
) -> tuple[str, Vhdl]:
    """Return a converter as RTLIL, and as the VHDL that ``firm-hdl build`` writes for it.

    The VHDL is that of the entity with flat ports, without the comments at the head of the files.

    Raises
    ------
    BuildError
        If the converter cannot be built with these options.
    """
    plan = plan_of(message, wire, bus_bytes, max_message_bytes)
    check_size(plan)
    core = Deserializer if direction == "deserializer" else Serializer
    top = Top(
        core(message, wire=plan.wire, bus_bytes=bus_bytes, max_message_bytes=max_message_bytes)
    )
    base = identifier(f"{identifier(message.name)}_{plan.wire}_{bus_bytes}").lower()
    name = f"{base}_{direction}_flat"
    rtlil: str = amaranth_rtlil.convert(top, name=name, emit_src=False)
    return rtlil, convert(rtlil, name=name)


def prove_converter(
    message: Message,
    direction: Direction,
    *,
    wire: Wire | None = None,
    bus_bytes: int = 8,
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
    timeout: float = DEFAULT_TIMEOUT,
) -> Proof:
    """Prove the VHDL of one converter of a message type.

    Parameters
    ----------
    timeout : float
        Seconds for each solver.

    Raises
    ------
    BuildError
        If the converter cannot be built with these options.
    ProofError
        As for `prove`.
    """
    rtlil, vhdl = converter_vhdl(
        message,
        direction,
        wire=wire,
        bus_bytes=bus_bytes,
        max_message_bytes=max_message_bytes,
    )
    return prove(rtlil, vhdl, timeout=timeout)


def attempt(task: ProofTask) -> Attempt:
    """Run a task; errors become a result without a proof."""
    try:
        library = open_library(task.distro, task.paths, task.bags, depends=task.depends)
        message = library.message(task.name)
        return Attempt(
            proof=prove_converter(
                message,
                task.direction,
                wire=task.wire,
                bus_bytes=task.bus_bytes,
                max_message_bytes=task.max_message_bytes,
                timeout=task.timeout,
            )
        )
    except (ProofError, UserError, DefinitionError, ValueError) as error:
        return Attempt(proof=None, problem=str(error))


def run_tasks(
    tasks: Sequence[ProofTask], jobs: int | None = None
) -> Iterator[tuple[ProofTask, Attempt]]:
    """Run tasks in `jobs` processes (`None`: one per processor); yield results as they finish."""
    work = [(task, (task,)) for task in tasks]
    for task, result in run_each(attempt, work, jobs=jobs):
        if isinstance(result, Exception):
            yield task, Attempt(proof=None, problem=repr(result))
        else:
            yield task, result


def both_directions(name: str, **options: object) -> list[ProofTask]:
    """Return the tasks for both converters of a type."""
    return [
        ProofTask(name=name, direction=direction, **options)  # type: ignore[arg-type]
        for direction in DIRECTIONS
    ]
