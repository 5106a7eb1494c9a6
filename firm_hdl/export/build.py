"""Build folders of files from names of types.

All errors in definitions and options are found before the first file is written. A folder that is
current stays unchanged. A folder has the files of each language and form that the options ask for:
each is written by a function `write`, which also makes its entries of the manifest.
"""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from firm_hdl.export import ip, readme, registers, systemverilog, verilog, vhdl
from firm_hdl.export.backend import BuildError, Converters
from firm_hdl.export.folder import build_folder, check_folder
from firm_hdl.export.manifest import (
    converter_facts,
    converter_sections,
    digest,
    inputs_of,
    manifest_of,
)
from firm_hdl.export.options import Options
from firm_hdl.export.top import DIRECTIONS, MAX_INPUT_BITS, ports_of
from firm_hdl.export.vhdl.backend import check_packages
from firm_hdl.frontend import Library, load_all
from firm_hdl.jobs.executors import ExecutorError, run_each
from firm_hdl.model import Message
from firm_hdl.names.identifiers import identifier
from firm_hdl.plan import Plan, build_plan
from firm_hdl.timing import Timing, describe, timing
from firm_hdl.wire import Wire, lay_out

__all__ = ["BuildError", "Built", "build", "check_size", "plan_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Built:
    """The folder of one type."""

    name: str  # The type.
    folder: Path
    was_current: bool  # The folder was current, and nothing was written.
    description: str  # Size and timing of the converters, as text; see `firm_hdl.timing.describe`.
    # Outdated files that the user changed, and that stay; paths in the folder.
    kept: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class _Task:
    converters: Converters
    folder: Path

    @property
    def name(self) -> str:
        """Name of the message type."""
        return self.converters.message.name

    @property
    def out(self) -> Path:
        """The path that the user named."""
        return self.folder.parents[1]


def build(
    types: Iterable[str],
    out: str | os.PathLike[str] = "vhdl_out",
    *,
    library: Library | None = None,
    options: Options | None = None,
    force: bool = False,
    stimuli: Callable[[Message, Plan], Sequence[bytes]] | None = None,
    report: Callable[[Built], None] | None = None,
    jobs: int | None = 1,
) -> list[Built]:
    """Write the converters of types, each type into its own folder below ``out/distro``.

    * `types`: as for `Library.interface`. All messages of services and actions are built.
    * `out`: created if it does not exist.
    * `library`: library that has the types; `None`: that of the default distribution.
    * `options`: options of the converters; `None`: the defaults.
    * `force`: write folders that are current, too.
    * `stimuli`: returns the packets for the VHDL test bench of a type. `None`: users write a file
      of packets themselves.
    * `report`: called with each type when it is done.
    * `jobs`: number of processes (`None`: one per processor); 1 writes everything in this process.
      The number does not change the files.

    Raises `DefinitionError`: with all errors in the definitions. Nothing was written. Raises
    `BuildError` if a type cannot be built with these options; nothing was written. Also if
    something of the user's is in the place of a file, or writing fails; the next build completes
    the folder.
    """
    library = Library() if library is None else library
    options = Options() if options is None else options
    tasks = []
    for message in load_all(library, types):
        plan = plan_of(message, options.wire, options.bus_bytes, options.max_message_bytes)
        check_size(plan)
        packets = list(stimuli(message, plan)) if stimuli is not None else []
        converters = _converters(library, message, plan, options, packets)
        folder = Path(out, library.distro, converters.name)
        tasks.append(_Task(converters=converters, folder=folder))
    _check_folders(tasks)
    check_packages({task.folder: task.converters for task in tasks})
    return _build_all(tasks, force, jobs, report)


def _build_all(
    tasks: Sequence[_Task], force: bool, jobs: int | None, report: Callable[[Built], None] | None
) -> list[Built]:
    found: dict[int, Built] = {}
    for number, built in _build_each(tasks, force, 1 if len(tasks) == 1 else jobs):
        found[number] = built
        if report is not None:
            report(built)
    return [found[number] for number in range(len(tasks))]


def _build_each(
    tasks: Sequence[_Task], force: bool, jobs: int | None
) -> Iterator[tuple[int, Built]]:
    """Build types in any order; yield number and folder of each. Stop at the first error."""
    if jobs == 1:
        yield from ((number, _build_one(task, force)) for number, task in enumerate(tasks))
        return
    work = [(number, (task, force)) for number, task in enumerate(tasks)]
    with closing(run_each(_build_one, work, jobs=jobs)) as results:
        for number, result in results:
            if isinstance(result, ExecutorError):
                raise BuildError(f"{tasks[number].name}: {result}")
            if isinstance(result, Exception):
                raise result
            yield number, result


def _converters(
    library: Library, message: Message, plan: Plan, options: Options, packets: Sequence[bytes]
) -> Converters:
    facts = {
        **converter_facts(message, plan),
        "distro": library.distro,
        "definition_sha256": library.definition_hash(message),
        "options": {
            "wire": plan.wire,
            "bus_bytes": plan.bus_bytes,
            "max_message_bytes": plan.max_message_bytes,
            "ports": options.ports,
            "extras": sorted(options.extras),
            **options.facts,
        },
        "stimuli_sha256": digest("".join(f"{packet.hex()}\n" for packet in packets)),
    }
    return Converters(
        message=message,
        plan=plan,
        name=f"{identifier(message.name)}_{plan.wire}_{plan.bus_bytes}",
        options=options,
        inputs=inputs_of(facts),
        stimuli=packets,
        registers=registers.register_maps(message, plan) if options.registers else {},
    )


def plan_of(message: Message, wire: Wire | None, bus_bytes: int, max_message_bytes: int) -> Plan:
    """Plan a type's converters; raise a `BuildError` if the options do not fit the type."""
    try:
        return build_plan(
            lay_out(message, wire), bus_bytes=bus_bytes, max_message_bytes=max_message_bytes
        )
    except ValueError as error:
        raise BuildError(f"{message.name}: {error}") from None


def check_size(plan: Plan) -> None:
    """Refuse converters with more input bits than Amaranth can elaborate."""
    for direction in DIRECTIONS:
        bits = sum(p.width for p in ports_of(plan, direction) if p.direction == "in")
        if bits > MAX_INPUT_BITS:
            raise BuildError(
                f"{plan.message}: its {direction} has {bits} input bits on a bus of "
                f"{plan.bus_bytes} bytes, and Amaranth elaborates at most {MAX_INPUT_BITS}"
            )


def _check_folders(tasks: list[_Task]) -> None:
    owners: dict[str, str] = {}
    for task in tasks:
        # Some file systems do not distinguish upper and lower case.
        other = owners.setdefault(str(task.folder).lower(), task.name)
        if other != task.name:
            raise BuildError(f"{task.name}: its folder '{task.folder}' is also that of {other}")
        found = check_folder(task.out, task.folder)
        if found and found["inputs"].get("message") != task.name:
            other = found["inputs"].get("message")
            raise BuildError(f"{task.name}: '{task.folder}' is the folder of {other}")


def _build_one(task: _Task, force: bool) -> Built:
    converters = task.converters
    figures = timing(converters.plan)
    kept = build_folder(
        task.out, task.folder, converters.inputs, lambda: _files(converters, figures), force=force
    )
    return Built(
        name=task.name,
        folder=task.folder,
        was_current=kept is None,
        description=describe(task.name, converters.plan, figures),
        kept=kept or (),
    )


def _files(converters: Converters, figures: Timing) -> tuple[dict[str, str], dict[str, Any]]:
    """Write all files of a folder; return them and the manifest."""
    options = converters.options
    converters = dataclasses.replace(
        converters,
        circuits=converters.make_circuits(),
        register_circuits=registers.register_circuits(converters),
    )
    message, plan, extras = converters.message, converters.plan, converters.options.extras
    outputs = {"Verilog": verilog.write(converters), "VHDL": vhdl.write(converters)}
    if converters.registers:
        outputs["registers"] = registers.write(converters)
    if options.ip:
        texts = {name: text for each in outputs.values() for name, text in each.files.items()}
        outputs["IP"] = ip.write(converters, texts)
    if "systemverilog" in extras:
        outputs["SystemVerilog"] = systemverilog.write(converters)
    sections = {
        **converter_sections(message, plan, figures),
        **{key: value for output in outputs.values() for key, value in output.manifest.items()},
    }
    if "documents" in extras:
        # Not before it is asked for: it simulates.
        from firm_hdl.export import datasheet

        shown = {"SystemVerilog": systemverilog.write(converters), **outputs}
        languages = ("VHDL", "Verilog", "SystemVerilog")
        instances = {language: shown[language].instances for language in languages}
        outputs["documents"] = datasheet.write(converters, sections, instances)
    outputs["readme"] = readme.write(converters, sections)
    files = {name: text for output in outputs.values() for name, text in output.files.items()}
    return files, manifest_of(converters.inputs, files, sections)
