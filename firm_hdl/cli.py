"""``firm-hdl``, the command: arguments in, text out, and everything else is somebody else's.

Exit status: 0 if all went well; 1 if a definition or what was asked for cannot be used, which
standard error explains; 2 if the command was called wrongly; 130 if it was interrupted.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence

import firm_hdl
from firm_hdl.errors import DefinitionError
from firm_hdl.export.build import BuildError, Built, build, load_all, plan_of
from firm_hdl.export.timing import describe, timing
from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS, Library, show
from firm_hdl.plan import BUS_BYTES, DEFAULT_MAX_MESSAGE_BYTES, to_yaml
from firm_hdl.verify.golden_command import add_golden_arguments, run_cover, run_golden
from firm_hdl.verify.stimuli import stimuli

__all__ = ["main"]


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
        distro=given.distro,
        paths=given.path,
        wire=given.wire,
        bus_bytes=given.bus_bytes,
        max_message_bytes=given.max_message_bytes,
        force=given.force,
        stimuli=stimuli,
        report=report,
    )
    for built in done:
        print(built.description)


def _list(given: argparse.Namespace) -> None:
    for name in _library(given).names():
        print(name)


def _show(given: argparse.Namespace) -> None:
    print(show(_library(given), given.type), end="")


def _plan(given: argparse.Namespace) -> None:
    message = _library(given).message(given.type)
    plan = plan_of(message, given.wire, given.bus_bytes, given.max_message_bytes)
    print(to_yaml(plan), end="")


def _info(given: argparse.Namespace) -> None:
    for message in load_all(_library(given), given.types):
        plan = plan_of(message, given.wire, given.bus_bytes, given.max_message_bytes)
        print(describe(message.name, plan, timing(plan)))


def _library(given: argparse.Namespace) -> Library:
    return Library(given.distro, given.path)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="firm-hdl",
        description="Generate hardware that reads and writes ROS messages.",
    )
    parser.add_argument("--version", action="version", version=f"firm-hdl {firm_hdl.__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)

    command = _command(commands, "build", _build, "write the converters of message types")
    command.add_argument("types", nargs="+", metavar="TYPE", help="such as sensor_msgs/msg/Imu")
    _add_options(command)
    command.add_argument("--out", default="vhdl_out", help="folder to write to (%(default)s)")
    command.add_argument("--force", action="store_true", help="write even what is current")

    _command(commands, "list", _list, "list all message types")

    command = _command(commands, "show", _show, "print a type as ROS's own tools do")
    command.add_argument("type", metavar="TYPE")

    command = _command(commands, "plan", _plan, "print what converters do in each cycle, as YAML")
    command.add_argument("type", metavar="TYPE")
    _add_options(command)

    command = _command(commands, "info", _info, "say how many cycles and which clock types need")
    command.add_argument("types", nargs="+", metavar="TYPE")
    _add_options(command)

    command = _command(commands, "golden", run_golden, "compare plans with golden ones, by meaning")
    add_golden_arguments(command)
    _add_options(command)

    command = _command(commands, "cover", run_cover, "choose few types that have all features")
    command.add_argument("types", nargs="*", metavar="TYPE", help="to choose from; default: all")
    _add_options(command)
    return parser


def _command(
    commands: argparse._SubParsersAction[argparse.ArgumentParser],
    name: str,
    run: Callable[[argparse.Namespace], int | None],
    text: str,
) -> argparse.ArgumentParser:
    command = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
    command.set_defaults(run=run)
    command.add_argument(
        "--distro", choices=list(DISTROS), default=DEFAULT_DISTRO, help="default: %(default)s"
    )
    command.add_argument(
        "--path",
        action="append",
        default=[],
        metavar="DIR",
        help="folder with ROS packages, searched before the distribution's types; repeatable",
    )
    return command


def _add_options(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--wire", choices=["ros1", "cdr"], help="wire format; default: the distribution's own"
    )
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
