# amaranth: UnusedElaboratable=no
"""The accelerator of a node: its class is found, made, and its ports are matched."""

from __future__ import annotations

import importlib
import os
import sys
import sysconfig
import traceback
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any

import amaranth
from amaranth.hdl import DriverConflict, Fragment
from amaranth.hdl._xfrm import DomainCollector
from amaranth.lib import wiring
from amaranth.lib.wiring import In

from firm_hdl.errors import DefinitionError, Diagnostic, UserError
from firm_hdl.node.description import Description
from firm_hdl.node.gateware.converters import message_groups
from firm_hdl.node.gateware.streams import time_layout
from firm_hdl.rtlil.connections import check_connections

__all__ = [
    "accelerator_signature",
    "check_accelerator",
    "conflicts_reported",
    "elaborate_accelerator",
    "load_accelerator",
    "other_members",
]

_OTHERS = (f"{Path(amaranth.__file__).parent}/", f"{Path(__file__).parents[1]}/", "<frozen")
"""How the names of files begin whose code is not the user's."""

_PYTHON = f"{sysconfig.get_path('stdlib')}/"

_imported: dict[str, str] = {}
"""Modules that came from a folder of a description, with the folder."""

OF_THE_NODE = ("subscribe", "publish", "serve", "time")


def accelerator_signature(description: Description, **others: wiring.Member) -> wiring.Signature:
    """Return the ports of an accelerator for a description.

    Parameters
    ----------
    others : members
        More members, such as pins; they come out of the node as `io`.

    Returns
    -------
    Signature
        `subscribe`, `publish` and `serve` with a member for each topic, as far as the description
        has such topics, and `time`, the clock of the node.
    """
    groups = {name: In(group) for name, group in message_groups(description).items()}
    return wiring.Signature({**groups, "time": In(time_layout()), **others})


def load_accelerator(description: Description) -> Any:
    """Make the accelerator that a description names: its class is called with the description.

    An accelerator in VHDL or Verilog becomes a :class:`firm_hdl.node.hdl.HdlAccelerator`.

    The module is searched in the folder of the description first, then where Python searches.

    Raises `DefinitionError`: at the name in the description, if there is no such module or class,
    or it cannot be made, or its ports do not match. A :class:`UserError` of the class gives its own
    text as reason.
    """
    if description.hdl is not None:
        from firm_hdl.node.hdl import HdlAccelerator

        return HdlAccelerator(description)
    module, _, path = description.accelerator.partition(":")
    # Python remembers what it found in a folder by its name, and "." is another one later.
    folder = os.path.abspath(description.folder)
    with _reported(description, f"'{module}'"):
        try:
            with _searched_first(folder):
                found: Any = importlib.import_module(module)
        except ImportError as error:
            hint = f"; write '{module[:-3]}:{path}'" if module.endswith(".py") else ""
            reason = f"{_place(error)}: {error}{hint}"
            raise UserError(f"cannot import '{module}'{reason}") from None
    top = module.partition(".")[0]
    there = PathFinder.find_spec(top, [folder])
    if top != "firm_hdl" and there and there.origin:
        file = getattr(sys.modules[top], "__file__", None) or ""
        if not (os.path.exists(file) and os.path.samefile(file, there.origin)):
            other = f"another module, {file or 'of Python itself'}"
            raise _refused(description, f"'{top}' is the name of {other}, too; rename yours")
    with _reported(description, f"'{module}'"):
        for name in path.split("."):
            if not hasattr(found, name):
                raise UserError(f"'{module}' has no '{path}'")
            found = getattr(found, name)
    with _reported(description, f"'{description.accelerator}'"):
        accelerator = found(description)
        check_accelerator(description, accelerator)
    return accelerator


def check_accelerator(description: Description, accelerator: Any) -> None:
    """Check that the ports of an accelerator are those of a description.

    Raises `UserError` if a member is missing, or has another shape or direction.
    """
    signature = getattr(accelerator, "signature", None)
    if not isinstance(signature, wiring.Signature):
        raise UserError("an accelerator is a component of amaranth.lib.wiring")
    wanted = accelerator_signature(description)
    found = signature.members
    for name, member in wanted.members.items():
        if name == "time":
            # Who does not stamp messages needs no clock.
            if name in found and found[name] != member:
                raise UserError("the accelerator's 'time' must be In(time_layout())")
            continue
        if name not in found or not found[name].is_signature:
            raise UserError(f"the accelerator has no '{name}' with the ports of its topics")
        # Members of a signature that is an input are those of the flipped one.
        ports = found[name].signature.members
        for port, topic in member.signature.members.items():
            if port not in ports:
                raise UserError(f"the accelerator has no '{name}.{port}'")
            if ports[port] != topic:
                raise UserError(
                    f"the accelerator's '{name}.{port}' is {ports[port]!r}, and should be {topic!r}"
                )
        if more := sorted(set(ports) - set(member.signature.members)):
            raise UserError(f"the description has no topic for '{name}.{more[0]}'")


def elaborate_accelerator(description: Description, accelerator: Any, platform: object) -> Fragment:
    """Elaborate an accelerator, with all that is inside it.

    Raises `DefinitionError`: at the name in the description: if the code of the accelerator raises
    an exception, if it connects a stream twice, or if it uses a clock domain that it does not have.
    """
    own = f"'{description.accelerator}'"
    with _reported(description, own) if description.accelerator else nullcontext():
        fragment = Fragment.get(accelerator, platform)
        try:
            check_connections(fragment)
        except wiring.ConnectionError as error:
            raise UserError(str(error)) from None
    collector = DomainCollector()
    collector(fragment)
    # Amaranth would make ports of the node of such a clock, which no list of ports has.
    if others := sorted(collector.used_domains - collector.defined_domains - {"comb", "sync"}):
        raise _refused(
            description,
            f"the accelerator uses the clock domain '{others[0]}', which it does not have; the "
            "node has 'sync' only",
        )
    return fragment


@contextmanager
def conflicts_reported(description: Description) -> Iterator[None]:
    """Report two drivers of a signal as a mistake of the accelerator.

    Amaranth finds them in the whole design, and says where both are.

    Raises `DefinitionError`: at the name of the accelerator in the description.
    """
    try:
        yield
    except DriverConflict as error:
        if not description.accelerator:
            raise
        raise _refused(description, f"'{description.accelerator}': {error}") from error


def other_members(accelerator: Any) -> dict[str, wiring.Member]:
    """Return the members of an accelerator that are not of the node, such as pins."""
    members = accelerator.signature.members
    return {name: member for name, member in members.items() if name not in OF_THE_NODE}


@contextmanager
def _searched_first(folder: str) -> Iterator[None]:
    """Search a folder for modules first, and none in the folders of other descriptions."""
    for name in [name for name, where in _imported.items() if where != folder]:
        del _imported[name]
        sys.modules.pop(name, None)
    before, known = list(sys.path), set(sys.modules)
    sys.path.insert(0, folder)
    importlib.invalidate_caches()
    try:
        yield
    finally:
        sys.path[:] = before
        for name in set(sys.modules) - known:
            file = getattr(sys.modules[name], "__file__", None)
            if file and Path(file).is_relative_to(folder):
                _imported[name] = folder


@contextmanager
def _reported(description: Description, name: str) -> Iterator[None]:
    """Report whatever the user's code raises, with its place.

    Raises `DefinitionError`: at the name in the description. A :class:`UserError` gives its own
    text.
    """
    try:
        yield
    except UserError as error:
        raise _refused(description, str(error)) from None
    except KeyboardInterrupt:
        raise
    except SyntaxError as error:
        message = f"{name} has a mistake at {error.filename}:{error.lineno}: {error.msg}"
        raise _refused(description, message) from None
    except BaseException as error:
        try:
            text = str(error)
        except Exception:
            text = "its text cannot be read"
        message = f"{name} raised {type(error).__name__}{_place(error)}: {text}"
        raise _refused(description, message) from error


def _place(error: BaseException) -> str:
    """Say where the user's code was, as far as it was reached."""
    frames = [
        f"{frame.filename}:{frame.lineno}"
        for frame in traceback.extract_tb(error.__traceback__)
        if _is_of_user(frame.filename)
    ]
    return f" at {frames[-1]}" if frames else ""


def _is_of_user(file: str) -> bool:
    # Packages are installed in folders of Python's own.
    is_of_python = file.startswith(_PYTHON) and "-packages/" not in file
    return not (is_of_python or file.startswith(_OTHERS))


def _refused(description: Description, message: str) -> DefinitionError:
    return DefinitionError([Diagnostic(message=message, span=description.accelerator_span)])
