"""What ``firm-hdl`` can do: each command's arguments, and the function that runs it.

A command imports what it needs when it is asked for, and no sooner, so that the others need not
wait for it.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from firm_hdl.export.build import Built
    from firm_hdl.frontend import Library
    from firm_hdl.model import Message
    from firm_hdl.plan import Plan

__all__ = ["COMMANDS", "Command"]

Run: TypeAlias = "Callable[[argparse.Namespace], int | None]"


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """A command.

    Attributes
    ----------
    help : str
        What it does, in a line.
    add : callable
        Adds its arguments to its parser, and sets ``run``.
    """

    help: str
    add: Callable[[argparse.ArgumentParser], None]


def _build(given: argparse.Namespace) -> None:
    from firm_hdl.export.build import build

    def packets_of(message: Message, plan: Plan) -> list[bytes]:
        # This imports NumPy and rosbags, which a build that is refused need not wait for.
        from firm_hdl.verify.cases.stimuli import stimuli

        return stimuli(message, plan)

    def report(built: Built) -> None:
        state = "current" if built.was_current else "wrote"
        print(f"{state:8}{built.folder}{os.sep}", flush=True)
        for old, new in sorted(built.renamed.items()):
            print(f"        your own {old} there is {new} now", flush=True)

    done = build(
        given.types,
        given.out,
        library=_library(given),
        wire=given.wire,
        bus_bytes=given.bus_bytes,
        max_message_bytes=given.max_message_bytes,
        window_words=given.window_words,
        ports=given.ports,
        force=given.force,
        stimuli=packets_of,
        report=report,
    )
    for built in done:
        print(built.description)


def _list(given: argparse.Namespace) -> None:
    for name in _library(given).interfaces():
        print(name)


def _show(given: argparse.Namespace) -> None:
    from firm_hdl.frontend import show

    print(show(_library(given), given.type), end="")


def _planned(message: Message, given: argparse.Namespace) -> Plan:
    from firm_hdl.export.build import plan_of

    return plan_of(
        message, given.wire, given.bus_bytes, given.max_message_bytes, given.window_words
    )


def _plan(given: argparse.Namespace) -> None:
    from firm_hdl.export.build import load_all
    from firm_hdl.plan import to_yaml

    for index, message in enumerate(load_all(_library(given), [given.type])):
        plan = _planned(message, given)
        print("---\n" * bool(index) + to_yaml(plan), end="")


def _info(given: argparse.Namespace) -> None:
    from firm_hdl.export.build import load_all
    from firm_hdl.plan.timing import describe, timing

    for message in load_all(_library(given), given.types):
        plan = _planned(message, given)
        print(describe(message.name, plan, timing(plan)))


def _md5(given: argparse.Namespace) -> None:
    from firm_hdl.identity.command import md5_lines

    if given.distro is None and not given.bag:
        given.distro = "noetic"
    _print_all(*md5_lines(_library(given), _names(given)))


def _hash(given: argparse.Namespace) -> None:
    from firm_hdl.identity.command import hash_lines

    _print_all(*hash_lines(_library(given), _names(given)))


def _proto(given: argparse.Namespace) -> None:
    from firm_hdl.identity.command import proto_texts

    texts, wrong = proto_texts(_library(given), _names(given), quotes=not given.no_quotes)
    if len(texts) == 1 and not given.all:
        print(*texts.values(), sep="", end="")
    else:
        print("\n".join(f"# {name}\n{text}" for name, text in texts.items()), end="")
    if wrong is not None:
        raise wrong


def _print_all(lines: list[str], wrong: Exception | None) -> None:
    """Print what there is to say of good types, and then what is wrong with the others."""
    print("".join(f"{line}\n" for line in lines), end="")
    if wrong is not None:
        raise wrong


def _metrics(given: argparse.Namespace) -> None:
    from firm_hdl.frontend import open_library
    from firm_hdl.metrics.command import metrics_text

    if given.all and not given.types:
        # The distribution's own, too: they are what one's own are compared with.
        names = open_library(given.distro, given.path, given.bag).interfaces()
    else:
        names = _names(given)
    text, wrong = metrics_text(_library(given), names, given.format, given.wire, bar=given.all)
    print(text, end="")
    if wrong is not None:
        raise wrong


def _names(given: argparse.Namespace) -> list[str]:
    """Give the types that a command is to do: those named, or all of the folders or recordings."""
    from firm_hdl.frontend import all_names

    if given.all == bool(given.types):
        given.usage_error("name either types or --all")
    if not given.all:
        return list(given.types)
    return all_names(given.distro, given.path, given.bag)


def _library(given: argparse.Namespace) -> Library:
    from firm_hdl.frontend import open_library

    return open_library(given.distro, given.path, given.bag, depends=given.depends)


def _add_build(command: argparse.ArgumentParser) -> None:
    from firm_hdl.export.vhdl.backend import PORTS

    _add_types(command)
    _add_options(command)
    _add_window(command)
    command.add_argument("--out", default="vhdl_out", help="folder to write to (%(default)s)")
    command.add_argument(
        "--ports",
        choices=PORTS,
        default="records",
        help="whether the VHDL has records, or plain vectors only; default: %(default)s",
    )
    command.add_argument("--force", action="store_true", help="write even what is current")
    command.set_defaults(run=_build)


def _add_list(command: argparse.ArgumentParser) -> None:
    command.set_defaults(run=_list)


def _add_show(command: argparse.ArgumentParser) -> None:
    command.add_argument("type", metavar="TYPE")
    command.set_defaults(run=_show)


def _add_plan(command: argparse.ArgumentParser) -> None:
    command.add_argument("type", metavar="TYPE")
    _add_options(command)
    _add_window(command)
    command.set_defaults(run=_plan)


def _add_info(command: argparse.ArgumentParser) -> None:
    _add_types(command)
    _add_options(command)
    _add_window(command)
    command.set_defaults(run=_info)


def _add_md5(command: argparse.ArgumentParser) -> None:
    _add_types_or_all(command)
    command.set_defaults(run=_md5)


def _add_hash(command: argparse.ArgumentParser) -> None:
    _add_types_or_all(command)
    command.set_defaults(run=_hash)


def _add_proto(command: argparse.ArgumentParser) -> None:
    _add_types_or_all(command)
    command.add_argument("--no-quotes", action="store_true", help="print no quotes around it")
    command.set_defaults(run=_proto)


def _add_metrics(command: argparse.ArgumentParser) -> None:
    from firm_hdl.metrics import FORMATS

    _add_types_or_all(command, "all types that there are")
    command.add_argument(
        "--format", choices=list(FORMATS), default="table", help="default: %(default)s"
    )
    _add_wire(command)
    command.set_defaults(run=_metrics)


def _add_verify(command: argparse.ArgumentParser) -> None:
    from firm_hdl.verify.command import add_verify_arguments, run_verify

    add_verify_arguments(command)
    command.set_defaults(run=run_verify)


def _add_report(command: argparse.ArgumentParser) -> None:
    from firm_hdl.verify.report.command import add_report_arguments, run_report

    add_report_arguments(command)
    command.set_defaults(run=run_report)


def _add_prove(command: argparse.ArgumentParser) -> None:
    from firm_hdl.equivalence.command import add_prove_arguments, run_prove

    add_prove_arguments(command)
    _add_options(command)
    command.set_defaults(run=run_prove)


def _add_golden(command: argparse.ArgumentParser) -> None:
    from firm_hdl.verify.ts2.golden_command import add_golden_arguments, run_golden

    add_golden_arguments(command)
    _add_options(command)
    command.set_defaults(run=run_golden)


def _add_cover(command: argparse.ArgumentParser) -> None:
    from firm_hdl.covering.command import add_cover_arguments, run_cover

    add_cover_arguments(command)
    _add_options(command)
    command.set_defaults(run=run_cover)


def _add_types(command: argparse.ArgumentParser) -> None:
    command.add_argument("types", nargs="+", metavar="TYPE", help="such as sensor_msgs/msg/Imu")


def _add_types_or_all(
    command: argparse.ArgumentParser,
    which: str = "all types; with --path, all in those folders; with --bag, all in the recordings",
) -> None:
    command.add_argument("types", nargs="*", metavar="TYPE", help="such as sensor_msgs/msg/Imu")
    command.add_argument("--all", action="store_true", help=which)
    command.set_defaults(usage_error=command.error)


def _with_origins(
    add: Callable[[argparse.ArgumentParser], None],
) -> Callable[[argparse.ArgumentParser], None]:
    """Let a command be told where definitions are."""

    def added(command: argparse.ArgumentParser) -> None:
        _add_origins(command)
        add(command)

    return added


def _add_origins(command: argparse.ArgumentParser) -> None:
    """Add where definitions come from. `distro` may be `None`: then `_library` finds it out."""
    from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS

    command.add_argument(
        "--distro",
        choices=list(DISTROS),
        help=f"default: {DEFAULT_DISTRO}, or that of the recording",
    )
    origins = command.add_mutually_exclusive_group()
    origins.add_argument(
        "--path",
        action="append",
        default=[],
        metavar="DIR",
        help="folder with ROS packages, searched before the distribution's types; repeatable",
    )
    origins.add_argument(
        "--bag",
        action="append",
        default=[],
        metavar="FILE",
        help="recording (.bag, .mcap, .db3) whose types are used, and no others; repeatable",
    )
    command.add_argument(
        "--depends",
        action="append",
        default=[],
        metavar="DIR",
        help="folder with ROS packages that others need, searched behind --path; no part of --all; "
        "repeatable",
    )


def _add_wire(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--wire", choices=["ros1", "cdr"], help="wire format; default: the distribution's own"
    )


def _add_options(command: argparse.ArgumentParser) -> None:
    from firm_hdl.plan import BUS_BYTES, DEFAULT_MAX_MESSAGE_BYTES

    _add_wire(command)
    command.add_argument(
        "--bus-bytes",
        type=int,
        choices=BUS_BYTES,
        default=8,
        metavar="N",
        help=f"bytes per beat: {', '.join(map(str, BUS_BYTES))}; default: %(default)s",
    )
    command.add_argument(
        "--max-message-bytes",
        type=_message_bytes,
        default=DEFAULT_MAX_MESSAGE_BYTES,
        metavar="N",
        help="longest message to accept; default: %(default)s",
    )


def _add_window(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--window-words",
        type=int,
        choices=(1, 2),
        default=1,
        metavar="N",
        help="bus words that are converted in one cycle: 1, or 2 for many short fields at a lower "
        "clock rate; default: %(default)s",
    )


def _message_bytes(text: str) -> int:
    try:
        number = int(text, 0)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
    if not 1 <= number < 1 << 32:
        raise argparse.ArgumentTypeError(f"must be from 1 to {(1 << 32) - 1}, not {number}")
    return number


COMMANDS: dict[str, Command] = {
    "build": Command(help="write the converters of message types", add=_with_origins(_add_build)),
    "list": Command(help="list all messages, services and actions", add=_with_origins(_add_list)),
    "show": Command(help="print a type as ROS's own tools do", add=_with_origins(_add_show)),
    "plan": Command(
        help="print what converters do in each cycle, as YAML", add=_with_origins(_add_plan)
    ),
    "info": Command(
        help="say how many cycles and which clock types need", add=_with_origins(_add_info)
    ),
    "verify": Command(help="test converters against real ROS parts", add=_add_verify),
    "report": Command(
        help="write a report of results of verify, as HTML, Markdown or JSON", add=_add_report
    ),
    "prove": Command(
        help="prove that the VHDL is the circuit that Amaranth elaborated",
        add=_with_origins(_add_prove),
    ),
    "golden": Command(
        help="compare plans with golden ones, by meaning", add=_with_origins(_add_golden)
    ),
    "cover": Command(help="choose few types that have all features", add=_with_origins(_add_cover)),
    "md5": Command(help="print the md5 sums of ROS 1 types", add=_with_origins(_add_md5)),
    "hash": Command(
        help="print the type hashes (RIHS01) of ROS 2 types", add=_with_origins(_add_hash)
    ),
    "proto": Command(
        help="print an example of a type as ROS's own tools do", add=_with_origins(_add_proto)
    ),
    "metrics": Command(
        help="print figures of message types: depth, leaves, sizes, alignment, features",
        add=_with_origins(_add_metrics),
    ),
}
"""By name, in the order in which ``--help`` lists them."""
