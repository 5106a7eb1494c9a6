"""``firm-hdl``, the command: arguments in, text out, and everything else is somebody else's.

Exit status: 0 if all went well; 1 if a definition or what was asked for cannot be used, which
standard error explains; 2 if the command was called wrongly; 130 if it was interrupted.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from typing import TypeAlias

import firm_hdl
from firm_hdl.equivalence.command import add_prove_arguments, run_prove
from firm_hdl.errors import DefinitionError
from firm_hdl.export.build import BuildError, Built, build, load_all, plan_of
from firm_hdl.export.timing import describe, timing
from firm_hdl.export.vhdl_user_build import PORTS
from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS, Library, open_library, show
from firm_hdl.identity.command import hash_lines, md5_lines, proto_text
from firm_hdl.metrics import FORMATS
from firm_hdl.metrics.command import metrics_text
from firm_hdl.plan import BUS_BYTES, DEFAULT_MAX_MESSAGE_BYTES, to_yaml
from firm_hdl.terminal import printable_streams
from firm_hdl.verify.command import add_verify_arguments, run_verify
from firm_hdl.verify.cover_command import add_cover_arguments, run_cover
from firm_hdl.verify.golden_command import add_golden_arguments, run_golden
from firm_hdl.verify.report.command import add_report_arguments, run_report
from firm_hdl.verify.stimuli import stimuli

__all__ = ["main"]

_Commands: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"


@printable_streams()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status."""
    given = _parser().parse_args(arguments)
    if hasattr(sys.stdout, "reconfigure"):
        # A comment in a definition may have characters that the terminal has not.
        sys.stdout.reconfigure(errors="backslashreplace")
    run: Callable[[argparse.Namespace], int | None] = given.run
    try:
        status = run(given)
        sys.stdout.flush()
    except DefinitionError as error:
        print(error, file=sys.stderr)
        return 1
    except BuildError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except BrokenPipeError:
        # Nobody reads on, and Python would complain about that once more at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except OSError as error:
        where = f"'{error.filename}': " if error.filename is not None else ""
        print(f"error: {where}{error.strerror or error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130
    return status or 0


def _build(given: argparse.Namespace) -> None:
    def report(built: Built) -> None:
        state = "current" if built.was_current else "wrote"
        print(f"{state:8}{built.folder}{os.sep}", flush=True)

    done = build(
        given.types,
        given.out,
        library=_library(given),
        wire=given.wire,
        bus_bytes=given.bus_bytes,
        max_message_bytes=given.max_message_bytes,
        ports=given.ports,
        force=given.force,
        stimuli=stimuli,
        report=report,
    )
    for built in done:
        print(built.description)


def _list(given: argparse.Namespace) -> None:
    for name in _library(given).interfaces():
        print(name)


def _show(given: argparse.Namespace) -> None:
    print(show(_library(given), given.type), end="")


def _plan(given: argparse.Namespace) -> None:
    for index, message in enumerate(load_all(_library(given), [given.type])):
        plan = plan_of(message, given.wire, given.bus_bytes, given.max_message_bytes)
        print("---\n" * bool(index) + to_yaml(plan), end="")


def _info(given: argparse.Namespace) -> None:
    for message in load_all(_library(given), given.types):
        plan = plan_of(message, given.wire, given.bus_bytes, given.max_message_bytes)
        print(describe(message.name, plan, timing(plan)))


def _md5(given: argparse.Namespace) -> None:
    if given.distro is None and not given.bag:
        given.distro = "noetic"
    print("\n".join(md5_lines(_library(given), given.types)))


def _hash(given: argparse.Namespace) -> None:
    print("\n".join(hash_lines(_library(given), given.types)))


def _proto(given: argparse.Namespace) -> None:
    print(proto_text(_library(given), given.type, quotes=not given.no_quotes), end="")


def _metrics(given: argparse.Namespace) -> None:
    if given.all == bool(given.types):
        given.usage_error("name either types or --all")
    names = None if given.all else given.types
    text, wrong = metrics_text(_library(given), names, given.format, given.wire)
    print(text, end="")
    if wrong is not None:
        raise wrong


def _library(given: argparse.Namespace) -> Library:
    return open_library(given.distro, given.path, given.bag)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="firm-hdl",
        description="Generate hardware that reads and writes ROS messages.",
    )
    parser.add_argument("--version", action="version", version=f"firm-hdl {firm_hdl.__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)

    text = "write the converters of message types"
    command = _command(commands, "build", _build, text, bags=True)
    command.add_argument("types", nargs="+", metavar="TYPE", help="such as sensor_msgs/msg/Imu")
    _add_options(command)
    command.add_argument("--out", default="vhdl_out", help="folder to write to (%(default)s)")
    command.add_argument(
        "--ports",
        choices=PORTS,
        default="records",
        help="whether the VHDL has records, or plain vectors only; default: %(default)s",
    )
    command.add_argument("--force", action="store_true", help="write even what is current")

    _command(commands, "list", _list, "list all messages, services and actions", bags=True)

    text = "print a type as ROS's own tools do"
    command = _command(commands, "show", _show, text, bags=True)
    command.add_argument("type", metavar="TYPE")

    text = "print what converters do in each cycle, as YAML"
    command = _command(commands, "plan", _plan, text, bags=True)
    command.add_argument("type", metavar="TYPE")
    _add_options(command)

    text = "say how many cycles and which clock types need"
    command = _command(commands, "info", _info, text, bags=True)
    command.add_argument("types", nargs="+", metavar="TYPE")
    _add_options(command)

    _add_test_commands(commands)
    _add_identity_commands(commands)
    return parser


def _add_test_commands(commands: _Commands) -> None:
    text = "test converters against real ROS parts"
    command = commands.add_parser("verify", help=text, description=f"T{text[1:]}.")
    command.set_defaults(run=run_verify)
    add_verify_arguments(command)

    text = "write a report of results of verify, as HTML, Markdown or JSON"
    command = commands.add_parser("report", help=text, description=f"W{text[1:]}.")
    command.set_defaults(run=run_report)
    add_report_arguments(command)

    text = "prove that the VHDL is the circuit that Amaranth elaborated"
    command = _command(commands, "prove", run_prove, text, bags=True)
    add_prove_arguments(command)
    _add_options(command)

    text = "compare plans with golden ones, by meaning"
    command = _command(commands, "golden", run_golden, text, bags=True)
    add_golden_arguments(command)
    _add_options(command)

    text = "choose few types that have all features"
    command = _command(commands, "cover", run_cover, text, bags=True)
    add_cover_arguments(command)
    _add_options(command)


def _add_identity_commands(commands: _Commands) -> None:
    text = "print the md5 sums of ROS 1 types"
    command = _command(commands, "md5", _md5, text, bags=True)
    command.add_argument("types", nargs="+", metavar="TYPE")

    text = "print the type hashes (RIHS01) of ROS 2 types"
    command = _command(commands, "hash", _hash, text, bags=True)
    command.add_argument("types", nargs="+", metavar="TYPE")

    text = "print an example of a type as ROS's own tools do"
    command = _command(commands, "proto", _proto, text, bags=True)
    command.add_argument("type", metavar="TYPE")
    command.add_argument("--no-quotes", action="store_true", help="print no quotes around it")

    text = "print figures of message types: depth, leaves, sizes, alignment, features"
    command = _command(commands, "metrics", _metrics, text, bags=True)
    command.add_argument("types", nargs="*", metavar="TYPE")
    command.add_argument("--all", action="store_true", help="all types that there are")
    command.add_argument(
        "--format", choices=list(FORMATS), default="table", help="default: %(default)s"
    )
    _add_wire(command)
    command.set_defaults(usage_error=command.error)


def _command(
    commands: _Commands,
    name: str,
    run: Callable[[argparse.Namespace], int | None],
    text: str,
    *,
    bags: bool = False,
) -> argparse.ArgumentParser:
    """Add a command. With `bags`, its `distro` may be `None`: then `_library` finds it out."""
    command = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
    command.set_defaults(run=run)
    command.add_argument(
        "--distro",
        choices=list(DISTROS),
        default=None if bags else DEFAULT_DISTRO,
        help=f"default: {DEFAULT_DISTRO}" + (", or that of the recording" if bags else ""),
    )
    origins = command.add_mutually_exclusive_group()
    origins.add_argument(
        "--path",
        action="append",
        default=[],
        metavar="DIR",
        help="folder with ROS packages, searched before the distribution's types; repeatable",
    )
    if bags:
        origins.add_argument(
            "--bag",
            action="append",
            default=[],
            metavar="FILE",
            help="recording (.bag, .mcap, .db3) whose types are used, and no others; repeatable",
        )
    return command


def _add_wire(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--wire", choices=["ros1", "cdr"], help="wire format; default: the distribution's own"
    )


def _add_options(command: argparse.ArgumentParser) -> None:
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


def _message_bytes(text: str) -> int:
    try:
        number = int(text, 0)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
    if not 1 <= number < 1 << 32:
        raise argparse.ArgumentTypeError(f"must be from 1 to {(1 << 32) - 1}, not {number}")
    return number
