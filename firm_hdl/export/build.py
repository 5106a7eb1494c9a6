"""From names of types to folders of files.

Everything that can be wrong with a definition or an option is found before the first file is
written. A folder appears, or is replaced, as a whole; one that is current is left alone.
"""

from __future__ import annotations

import dataclasses
import hashlib
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from firm_hdl.errors import DefinitionError, Diagnostic, UserError
from firm_hdl.export.folder import clear_up, is_current, is_empty, read_manifest, replace
from firm_hdl.export.manifest import MANIFEST, inputs_of, make_manifest, module_name, to_json
from firm_hdl.export.packaging import packaging
from firm_hdl.export.top import DIRECTIONS, MAX_INPUT_BITS, Direction, Top, ports_of
from firm_hdl.export.verilog import WAIVERS, to_verilog, waivers
from firm_hdl.export.vhdl.backend import FOLDER, Ports, to_vhdl
from firm_hdl.export.vhdl.tree import tree_of
from firm_hdl.frontend import DEFAULT_DISTRO, Library
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.model import Message
from firm_hdl.names.identifiers import identifier
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Plan, build_plan, to_yaml
from firm_hdl.plan.timing import Timing, describe, timing
from firm_hdl.wire import Wire, lay_out, refusals
from firm_hdl.wire.picture import to_svg

__all__ = ["BuildError", "Built", "build", "check_size", "load_all", "plan_of"]


class BuildError(UserError):
    """Something that cannot be built, or cannot be written; the text says why."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Built:
    """One type's folder.

    Attributes
    ----------
    name : str
        The type's.
    folder : Path
    was_current : bool
        Whether there was nothing to do.
    description : str
        What the converters cost, for people; see :func:`firm_hdl.plan.timing.describe`.
    renamed : mapping of str to str
        What a user's own files in the folder are called now, where they had the name of one that
        was written.
    """

    name: str
    folder: Path
    was_current: bool
    description: str
    renamed: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Task:
    message: Message
    plan: Plan
    folder: Path
    inputs: dict[str, Any]
    stimuli: Sequence[bytes]
    window_words: int


def build(
    types: Iterable[str],
    out: str | os.PathLike[str] = "vhdl_out",
    *,
    distro: str = DEFAULT_DISTRO,
    paths: Iterable[str | os.PathLike[str]] = (),
    library: Library | None = None,
    wire: Wire | None = None,
    bus_bytes: int = 8,
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
    window_words: int = 1,
    ports: Ports = "records",
    force: bool = False,
    stimuli: Callable[[Message, Plan], Sequence[bytes]] | None = None,
    report: Callable[[Built], None] | None = None,
) -> list[Built]:
    """Write the converters of types, each into a folder of its own below ``out/distro``.

    Parameters
    ----------
    types : iterable of str
        As for `Library.interface`. All messages of services and actions are built.
    out : path
        Made if need be.
    distro, paths
        As for `Library`.
    library : Library or None
        What to take the types from, instead of `distro` and `paths`.
    wire, bus_bytes, max_message_bytes, window_words
        As for the converters.
    ports : "records" or "flat"
        Whether the VHDL has a layer with records; "flat" is for tools that dislike them.
    force : bool
        Whether to write folders that are current, too.
    stimuli : callable or None
        Gives the packets for a type's test bench in VHDL; without it, users write their own.
    report : callable or None
        Called with each type when it is done.

    Raises
    ------
    DefinitionError
        With what is wrong with any of the types. Nothing was written.
    BuildError
        If a type cannot be built with these options, and nothing was written; or if writing fails,
        and all folders are whole, old or new.
    """
    if library is None:
        library = Library(distro, paths)
    tasks = []
    for message in load_all(library, types):
        plan = plan_of(message, wire, bus_bytes, max_message_bytes, window_words)
        check_size(plan)
        packets = list(stimuli(message, plan)) if stimuli is not None else []
        tasks.append(_task(library, message, plan, Path(out), ports, packets, window_words))
    _check_folders(tasks)
    _check_packages(tasks)
    return [_done(task, force, report) for task in tasks]


def _done(task: _Task, force: bool, report: Callable[[Built], None] | None) -> Built:
    built = _do(task, force)
    if report is not None:
        report(built)
    return built


def _task(
    library: Library,
    message: Message,
    plan: Plan,
    out: Path,
    ports: Ports,
    packets: Sequence[bytes],
    window_words: int,
) -> _Task:
    inputs = inputs_of(
        message,
        plan,
        distro=library.distro,
        definition_sha256=library.definition_hash(message),
        ports=ports,
    )
    if window_words != 1:
        inputs["options"]["window_words"] = window_words
    inputs["stimuli_sha256"] = _digest(packets)
    name = f"{identifier(message.name)}_{plan.wire}_{plan.bus_bytes}"
    folder = out / library.distro / name
    return _Task(
        message=message,
        plan=plan,
        folder=folder,
        inputs=inputs,
        stimuli=packets,
        window_words=window_words,
    )


def _digest(packets: Sequence[bytes]) -> str:
    return hashlib.sha256("".join(f"{packet.hex()}\n" for packet in packets).encode()).hexdigest()


def load_all(library: Library, types: Iterable[str]) -> list[Message]:
    """Load messages that are to be put on a wire, each once.

    A service or an action stands for all messages that it has.

    Raises
    ------
    DefinitionError
        With the problems of all of them, fields that no wire has included.
    """
    messages: dict[str, Message] = {}
    problems: dict[str, Diagnostic] = {}
    for name in types:
        try:
            found = library.interface(name).messages
        except DefinitionError as error:
            wrong = list(error.diagnostics)
        else:
            wrong = [each for message in found for each in refusals(message)]
            messages.update((message.name, message) for message in found)
        problems.update((str(problem), problem) for problem in wrong)
    if problems:
        raise DefinitionError(problems.values())
    return list(messages.values())


def plan_of(
    message: Message,
    wire: Wire | None,
    bus_bytes: int,
    max_message_bytes: int,
    window_words: int = 1,
) -> Plan:
    """Plan a type's converters; options that do not fit the type are a `BuildError`."""
    try:
        return build_plan(
            lay_out(message, wire),
            bus_bytes=bus_bytes,
            max_message_bytes=max_message_bytes,
            window_words=window_words,
        )
    except ValueError as error:
        raise BuildError(f"{message.name}: {error}") from None


def check_size(plan: Plan) -> None:
    """Refuse what Amaranth would stop at with an assertion."""
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
        # Some file systems do not tell upper from lower case.
        other = owners.setdefault(str(task.folder).lower(), task.message.name)
        if other != task.message.name:
            raise BuildError(
                f"{task.message.name}: its folder '{task.folder}' is that of {other}, too"
            )
        found = read_manifest(task.folder)
        if found is not None:
            other = str(found["inputs"].get("message"))
            if other != task.message.name:
                raise BuildError(f"{task.message.name}: '{task.folder}' holds {other}")
        elif task.folder.exists() and not is_empty(task.folder):
            raise BuildError(f"'{task.folder}' is not a folder that firm-hdl made; move it away")


def _check_packages(tasks: list[_Task]) -> None:
    """Refuse two types in ROS whose VHDL package has one name, in messages built side by side.

    Within a message, the second one gets a number. A design with both messages compiles the files
    of one name once, so the name has to mean the same in all folders.
    """
    owners: dict[Path, tuple[str, Path]] = {}
    for task in (task for task in tasks if task.inputs["options"]["ports"] == "records"):
        for package in tree_of(task.message, task.plan).packages:
            file, owner = task.folder.parent / package.name, package.message.name
            if file not in owners:
                owners[file] = _owner(file, tasks) or (owner, task.folder)
            other, folder = owners[file]
            if other != owner:
                raise BuildError(
                    f"{task.message.name}: the VHDL package '{package.name}' would be that of "
                    f"{owner}, and in '{folder}' it is that of {other}; build one of them into "
                    "another folder (--out), and compile it into another library"
                )


def _owner(file: Path, tasks: list[_Task]) -> tuple[str, Path] | None:
    """Find whose package it is in the folder of a message that is not built now."""
    made_anew = {task.folder for task in tasks}
    for path in sorted(file.parent.glob(f"[!.]*/{FOLDER}/{file.name}.vhd")):
        folder = path.parent.parent
        found = None if folder in made_anew else read_manifest(folder)
        with suppress(AttributeError, KeyError, TypeError):  # If that is no manifest of ours.
            for each in (found or {"vhdl": {"shared_packages": []}})["vhdl"]["shared_packages"]:
                if each["name"] == file.name and each["message"]:
                    return str(each["message"]), folder
    return None


def _do(task: _Task, force: bool) -> Built:
    figures = timing(task.plan)
    try:
        return _written(task, figures, force)
    except OSError as error:
        where = error.filename or task.folder
        raise BuildError(f"'{where}' cannot be written: {error.strerror}") from None


def _written(task: _Task, figures: Timing, force: bool) -> Built:
    clear_up(task.folder)
    built = Built(
        name=task.message.name,
        folder=task.folder,
        was_current=not force and is_current(task.folder, task.inputs),
        description=describe(task.message.name, task.plan, figures),
    )
    if not built.was_current:
        built = dataclasses.replace(built, renamed=replace(task.folder, _files(task, figures)))
    return built


def _files(task: _Task, figures: Timing) -> dict[str, str]:
    """Write all files of a folder."""
    files, vhdl = _texts(task)

    def manifest() -> dict[str, Any]:
        return make_manifest(
            task.message,
            task.plan,
            figures,
            inputs=task.inputs,
            folder=task.folder.name,
            files=files,
            vhdl=vhdl,
        )

    files.update((f"{FOLDER}/{name}", text) for name, text in packaging(manifest()).items())
    # Once more, now that all files are known.
    return {**files, MANIFEST: to_json(manifest())}


def _texts(task: _Task) -> tuple[dict[str, str], dict[str, Any]]:
    """Write what a manifest is about; also what it says of the VHDL."""
    message, plan, name = task.message, task.plan, task.folder.name
    tops: dict[Direction, Top] = {}
    files = {WAIVERS: waivers(module_name(name, direction) for direction in DIRECTIONS)}
    for direction in DIRECTIONS:
        converter = Deserializer if direction == "deserializer" else Serializer
        tops[direction] = Top(
            converter(
                message,
                wire=plan.wire,
                bus_bytes=plan.bus_bytes,
                max_message_bytes=plan.max_message_bytes,
                window_words=task.window_words,
            )
        )
        module = module_name(name, direction)
        header = _header(task, module, f"the {direction}")
        files[f"{module}.v"] = to_verilog(tops[direction], module=module, header=header)
    files["plan.yaml"] = to_yaml(plan)
    files["layout.svg"] = to_svg(lay_out(message, plan.wire), f"{message.name} on {plan.wire}")
    vhdl = to_vhdl(
        message,
        plan,
        tops,
        name=name,
        header=_header(task, name, "converters"),
        stimuli=task.stimuli,
        ports=task.inputs["options"]["ports"],
        window_words=task.window_words,
    )
    files.update((f"{FOLDER}/{file}", text) for file, text in vhdl.files.items())
    return files, vhdl.manifest


def _header(task: _Task, name: str, what: str) -> str:
    return (
        f"{name}: {what} of {task.message.name}, made by "
        f"firm-hdl {task.inputs['generator']['firm-hdl']}.\n"
        f"{task.inputs['distro']}, wire {task.plan.wire}, bus of {task.plan.bus_bytes} bytes, "
        f"messages of at most {task.plan.max_message_bytes} bytes\n"
        f"definition (SHA-256): {task.inputs['definition_sha256']}\n"
        f"What each port means: {MANIFEST}.\n"
    )
