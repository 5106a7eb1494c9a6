"""From names of types to folders of files.

Everything that can be wrong with a definition or an option is found before the first file is
written. A folder appears, or is replaced, as a whole; one that is current is left alone.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.export.manifest import MANIFEST, inputs_of, make_manifest, module_name, to_json
from firm_hdl.export.names import identifier
from firm_hdl.export.picture import to_svg
from firm_hdl.export.timing import describe, timing
from firm_hdl.export.top import DIRECTIONS, MAX_INPUT_BITS, Direction, Top, ports_of
from firm_hdl.export.verilog import to_verilog
from firm_hdl.export.vhdl_user_build import to_vhdl
from firm_hdl.frontend import DEFAULT_DISTRO, Library
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Plan, build_plan, to_yaml
from firm_hdl.wire import Wire, lay_out

__all__ = ["BuildError", "Built", "build", "check_size", "load_all", "plan_of"]


VHDL_FOLDER = "vhdl"
"""Where in a type's folder the VHDL is."""


class BuildError(Exception):
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
        What the converters cost, for people; see :func:`firm_hdl.export.timing.describe`.
    """

    name: str
    folder: Path
    was_current: bool
    description: str


@dataclass(frozen=True, slots=True, kw_only=True)
class _Task:
    message: Message
    plan: Plan
    folder: Path
    inputs: dict[str, Any]
    stimuli: Sequence[bytes]


def build(
    types: Iterable[str],
    out: str | os.PathLike[str] = "vhdl_out",
    *,
    distro: str = DEFAULT_DISTRO,
    paths: Iterable[str | os.PathLike[str]] = (),
    wire: Wire | None = None,
    bus_bytes: int = 8,
    max_message_bytes: int = DEFAULT_MAX_MESSAGE_BYTES,
    force: bool = False,
    stimuli: Callable[[Message, Plan], Sequence[bytes]] | None = None,
    report: Callable[[Built], None] | None = None,
) -> list[Built]:
    """Write the converters of types, each into a folder of its own below ``out/distro``.

    Parameters
    ----------
    types : iterable of str
        As for `Library.message`.
    out : path
        Made if need be.
    distro, paths
        As for `Library`.
    wire, bus_bytes, max_message_bytes
        As for the converters.
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
    library = Library(distro, paths)
    tasks = []
    for message in load_all(library, types):
        plan = plan_of(message, wire, bus_bytes, max_message_bytes)
        check_size(plan)
        name = f"{identifier(message.name)}_{plan.wire}_{plan.bus_bytes}"
        inputs = inputs_of(
            message,
            plan,
            distro=library.distro,
            definition_sha256=library.definition_hash(message.name),
        )
        packets = list(stimuli(message, plan)) if stimuli is not None else []
        inputs["stimuli_sha256"] = _digest(packets)
        folder = Path(out) / library.distro / name
        tasks.append(
            _Task(message=message, plan=plan, folder=folder, inputs=inputs, stimuli=packets)
        )
    _check_folders(tasks)
    built = []
    for task in tasks:
        built.append(_do(task, force))
        if report is not None:
            report(built[-1])
    return built


def _digest(packets: Sequence[bytes]) -> str:
    return hashlib.sha256("".join(f"{packet.hex()}\n" for packet in packets).encode()).hexdigest()


def load_all(library: Library, types: Iterable[str]) -> list[Message]:
    """Load types, each once.

    Raises
    ------
    DefinitionError
        With the problems of all of them.
    """
    messages: dict[str, Message] = {}
    problems: dict[str, Diagnostic] = {}
    for name in types:
        try:
            message = library.message(name)
        except DefinitionError as error:
            problems.update((str(problem), problem) for problem in error.diagnostics)
        else:
            messages[message.name] = message
    if problems:
        raise DefinitionError(problems.values())
    return list(messages.values())


def plan_of(
    message: Message, wire: Wire | None, bus_bytes: int, max_message_bytes: int
) -> Plan:
    """Plan a type's converters; options that do not fit the type are a `BuildError`."""
    try:
        return build_plan(
            lay_out(message, wire), bus_bytes=bus_bytes, max_message_bytes=max_message_bytes
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
        found = _read_manifest(task.folder)
        if found is not None:
            other = str(found.get("inputs", {}).get("message"))
            if other != task.message.name:
                raise BuildError(f"{task.message.name}: '{task.folder}' holds {other}")
        elif task.folder.exists() and not _is_empty(task.folder):
            raise BuildError(f"'{task.folder}' is not a folder that firm-hdl made; move it away")


def _do(task: _Task, force: bool) -> Built:
    figures = timing(task.plan)
    built = Built(
        name=task.message.name,
        folder=task.folder,
        was_current=not force and _is_current(task),
        description=describe(task.message.name, task.plan, figures),
    )
    if built.was_current:
        return built
    files, vhdl = _texts(task)
    manifest = make_manifest(
        task.message,
        task.plan,
        figures,
        inputs=task.inputs,
        folder=task.folder.name,
        files=files,
        vhdl=vhdl,
    )
    try:
        _replace(task.folder, {**files, MANIFEST: to_json(manifest)})
    except OSError as error:
        where = error.filename or task.folder
        raise BuildError(f"'{where}' cannot be written: {error.strerror}") from None
    return built


def _texts(task: _Task) -> tuple[dict[str, str], dict[str, Any]]:
    """Write all files but the manifest; also what the manifest says of the VHDL."""
    message, plan = task.message, task.plan
    options: dict[str, Any] = dict(task.inputs["options"])
    tops: dict[Direction, Top] = {}
    files = {}
    for direction in DIRECTIONS:
        converter = Deserializer if direction == "deserializer" else Serializer
        module = module_name(task.folder.name, direction)
        header = _header(task, module, f"the {direction}")
        tops[direction] = Top(converter(message, **options))
        files[f"{module}.v"] = to_verilog(tops[direction], module=module, header=header)
    files["plan.yaml"] = to_yaml(plan)
    files["layout.svg"] = to_svg(lay_out(message, plan.wire), f"{message.name} on {plan.wire}")
    vhdl = to_vhdl(
        message,
        plan,
        tops,
        name=task.folder.name,
        header=_header(task, task.folder.name, "converters"),
        stimuli=task.stimuli,
    )
    files.update((f"{VHDL_FOLDER}/{name}", text) for name, text in vhdl.files.items())
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


def _read_manifest(folder: Path) -> dict[str, Any] | None:
    try:
        found = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) and "inputs_sha256" in found else None


def _is_empty(folder: Path) -> bool:
    return folder.is_dir() and next(folder.iterdir(), None) is None


def _is_current(task: _Task) -> bool:
    found = _read_manifest(task.folder)
    if found is None or found.get("inputs") != task.inputs:
        return False
    try:
        return all(
            hashlib.sha256((task.folder / name).read_bytes()).hexdigest() == digest
            for name, digest in found["files"].items()
        )
    except (OSError, KeyError, AttributeError):
        return False


def _replace(folder: Path, files: dict[str, str]) -> None:
    """Make a folder have these files; whoever looks sees the old one or the new one."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    staging = folder.with_name(f".{folder.name}.{os.getpid()}.new")
    old = folder.with_name(f".{folder.name}.{os.getpid()}.old")
    try:
        staging.mkdir()
        for name, text in files.items():
            (staging / name).parent.mkdir(exist_ok=True)
            (staging / name).write_text(text, encoding="utf-8", newline="\n")
            if name.endswith(".sh"):
                (staging / name).chmod(0o755)
        if folder.exists():
            _keep_others(folder, staging, files)
            folder.rename(old)
        staging.rename(folder)
    except BaseException:
        if old.exists() and not folder.exists():
            old.rename(folder)
        raise
    finally:
        for leftover in (staging, old):
            with suppress(OSError):
                shutil.rmtree(leftover)


def _keep_others(folder: Path, staging: Path, files: dict[str, str]) -> None:
    """Copy what users have added to a folder."""
    ours = {*files, MANIFEST, *(_read_manifest(folder) or {}).get("files", {})}
    shared = {name.partition("/")[0] for name in ours if "/" in name}
    entries = [
        *(entry for entry in folder.iterdir() if entry.name not in shared),
        *(entry for name in sorted(shared) for entry in _entries(folder / name)),
    ]
    for entry in entries:
        name = entry.relative_to(folder).as_posix()
        if name in ours:
            continue
        (staging / name).parent.mkdir(exist_ok=True)
        if entry.is_dir() and not entry.is_symlink():
            shutil.copytree(entry, staging / name, symlinks=True)
        else:
            shutil.copy2(entry, staging / name, follow_symlinks=False)


def _entries(folder: Path) -> list[Path]:
    return list(folder.iterdir()) if folder.is_dir() else []
