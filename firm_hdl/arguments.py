"""Command line arguments that several commands take, each defined once.

The parser of a command is made before its modules are imported, so no heavy module is imported
here.
"""

from __future__ import annotations

import argparse
from typing import get_args

from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS
from firm_hdl.model import Wire

__all__ = [
    "TYPE_HELP",
    "add_bus_bytes",
    "add_depends",
    "add_engine",
    "add_jobs",
    "add_json",
    "add_options",
    "add_origins",
    "add_path",
    "add_types_or_all",
    "add_wire",
    "check_types_or_all",
    "number_between",
    "positive",
    "seconds",
]

TYPE_HELP = "such as sensor_msgs/msg/Imu, or a file of a package: .msg, .srv, .action or .idl"
"""What is taken as a type."""


def positive(text: str) -> int:
    """Read a number that is at least 1, for `argparse`."""
    return number_between(text, 1, None)


def number_between(text: str, minimum: int, maximum: int | None) -> int:
    """Read a number between limits, both included, for `argparse`.

    * `text`: the number in decimal, or with a prefix such as ``0x``.

    Raises `argparse.ArgumentTypeError` if the text is not a number, or the number is out of range.
    """
    try:
        number = int(text, 0)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
    if number < minimum or (maximum is not None and number > maximum):
        limits = f"at least {minimum}" if maximum is None else f"from {minimum} to {maximum}"
        raise argparse.ArgumentTypeError(f"must be {limits}, not {number}")
    return number


def seconds(text: str) -> float:
    """Read a finite number of seconds above 0, for `argparse`.

    Raises `argparse.ArgumentTypeError` if the text is no such number.
    """
    try:
        found = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
    if not 0 < found < float("inf"):
        raise argparse.ArgumentTypeError(f"must be above 0, not {text}")
    return found


def add_types_or_all(
    command: argparse.ArgumentParser,
    which: str = "all types; with --path, all in those folders; with --bag, all in the recordings",
) -> None:
    """Add names of types, and ``--all`` as the alternative."""
    command.add_argument("types", nargs="*", metavar="TYPE", help=TYPE_HELP)
    command.add_argument("--all", action="store_true", help=which)
    command.set_defaults(usage_error=command.error)


def check_types_or_all(given: argparse.Namespace) -> None:
    """Refuse arguments that have both names of types and ``--all``, or neither."""
    if given.all == bool(given.types):
        given.usage_error("name either types or --all")


def add_origins(command: argparse._ActionsContainer) -> None:
    """Add the origins of definitions. ``--distro`` overrides the distribution of a recording."""
    command.add_argument(
        "--distro",
        choices=list(DISTROS),
        help=f"default: {DEFAULT_DISTRO}, or that of the recording",
    )
    origins = command.add_mutually_exclusive_group()
    add_path(origins)
    origins.add_argument(
        "--bag",
        action="append",
        default=[],
        metavar="FILE",
        help="recording (.bag, .mcap, .db3) whose types are used; what it lacks comes from "
        "--depends, or from --distro if given; repeatable",
    )
    add_depends(command)


def add_json(command: argparse._ActionsContainer) -> None:
    """Add ``--json``: the command fills `document` of its arguments instead of printing."""
    command.add_argument(
        "--json",
        dest="as_json",
        action="store_true",
        help="print one object of JSON to standard output, and nothing else",
    )


def add_path(command: argparse._ActionsContainer) -> None:
    """Add ``--path``."""
    command.add_argument(
        "--path",
        action="append",
        default=[],
        metavar="DIR",
        help="folder with ROS packages, searched before the distribution's types; repeatable",
    )


def add_engine(command: argparse._ActionsContainer, use: str) -> None:
    """Add ``--engine``, what runs a fast simulation.

    * `use`: when the option counts, such as ``"run --board sim"``.
    """
    command.add_argument(
        "--engine",
        choices=["auto", "verilator", "amaranth"],
        default="auto",
        help=f"for {use}: compiled with Verilator, or Amaranth's slow simulator (%(default)s: "
        "the former if there are Verilator and a C++ compiler)",
    )


def add_depends(command: argparse._ActionsContainer) -> None:
    """Add ``--depends``."""
    command.add_argument(
        "--depends",
        action="append",
        default=[],
        metavar="DIR",
        help="folder with ROS packages that others depend on, searched after --path or --bag; not "
        "part of --all; repeatable",
    )


def add_wire(command: argparse._ActionsContainer) -> None:
    """Add ``--wire``."""
    command.add_argument(
        "--wire", choices=get_args(Wire), help="wire format; default: the distribution's own"
    )


def add_jobs(command: argparse._ActionsContainer) -> None:
    """Add ``--jobs``."""
    command.add_argument(
        "--jobs", type=positive, metavar="N", help="processes; default: one per processor"
    )


def add_bus_bytes(command: argparse._ActionsContainer) -> None:
    """Add ``--bus-bytes``."""
    from firm_hdl.plan import BUS_BYTES

    command.add_argument(
        "--bus-bytes",
        type=int,
        choices=BUS_BYTES,
        default=8,
        metavar="N",
        help=f"bytes per beat: {', '.join(map(str, BUS_BYTES))}; default: %(default)s",
    )


def add_options(command: argparse._ActionsContainer) -> None:
    """Add the options of a converter: wire format, bus width, longest message."""
    from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES

    add_wire(command)
    add_bus_bytes(command)
    command.add_argument(
        "--max-message-bytes",
        type=_message_bytes,
        default=DEFAULT_MAX_MESSAGE_BYTES,
        metavar="N",
        help="longest message to accept; default: %(default)s",
    )


def _message_bytes(text: str) -> int:
    return number_between(text, 1, (1 << 32) - 1)
