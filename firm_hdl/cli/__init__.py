"""``firm-hdl``, the command: arguments in, text out, and everything else is somebody else's.

Exit status: 0 if all went well; 1 if a definition or what was asked for cannot be used, which
standard error explains; 2 if the command was called wrongly; 130 if it was interrupted.

Nothing but Python's own modules is imported before the command is known, and nothing at all outside
of `main`, which turns whatever ends it into words.
"""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence
from contextlib import suppress

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status."""
    try:
        return _run(arguments)
    except KeyboardInterrupt:
        _say("interrupted")
        return 130


def _run(arguments: Sequence[str] | None) -> int:
    from firm_hdl.terminal import printable_streams

    # A process may be started without them.
    sys.stdout = sys.stdout or io.StringIO()
    sys.stderr = sys.stderr or io.StringIO()
    with printable_streams():
        try:
            try:
                return _dispatch(sys.argv[1:] if arguments is None else list(arguments))
            finally:
                # Help, too, which leaves by an exception.
                sys.stdout.flush()
        except OSError as error:
            return _failed(error)


def _dispatch(arguments: list[str]) -> int:
    parser = _parser(arguments)
    if any("\0" in argument for argument in arguments):
        parser.error("an argument has a NUL, which no name and no path has")
    given = parser.parse_args(arguments)
    from firm_hdl.errors import DefinitionError, UserError

    reconfigure = getattr(sys.stdout, "reconfigure", None)
    if reconfigure is not None:
        # A comment in a definition may have characters that the terminal has not.
        reconfigure(errors="backslashreplace")
    try:
        return given.run(given) or 0
    except DefinitionError as error:
        _say(str(error))
    except UserError as error:
        _say(f"error: {error}")
    except MemoryError:
        _say("error: there is not enough memory for this")
    except RecursionError:
        _say("error: something here nests deeper than can be followed")
    return 1


def _failed(error: OSError) -> int:
    """Say what the system would not do; nobody may be there to hear it."""
    if isinstance(error, BrokenPipeError):
        _abandon()
        return 1
    where = f"'{os.fsdecode(error.filename)}': " if error.filename is not None else ""
    _say(f"error: {where}{error.strerror or error}")
    # What is left of the output would not fit at the end, either.
    with suppress(OSError, ValueError):
        sys.stdout.flush()
        return 1
    _abandon()
    return 1


def _abandon() -> None:
    """Send what is left of the output nowhere: Python would try once more at its end."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _say(text: str) -> None:
    with suppress(OSError, ValueError):
        print(text, file=sys.stderr, flush=True)


class _Version(argparse.Action):
    """Print the version, which is not looked up for anything else."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        import firm_hdl

        print(f"firm-hdl {firm_hdl.__version__}")
        parser.exit()


def _parser(arguments: Sequence[str]) -> argparse.ArgumentParser:
    """Make a parser that knows all commands, and the arguments of the one that is called."""
    from firm_hdl.cli.table import COMMANDS

    parser = argparse.ArgumentParser(
        prog="firm-hdl",
        description="Generate hardware that reads and writes ROS messages.",
    )
    parser.add_argument(
        "--version", action=_Version, nargs=0, help="show program's version number and exit"
    )
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    called = next((each for each in arguments if not each.startswith("-")), None)
    for name, command in COMMANDS.items():
        text = command.help
        sub = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
        if name == called:
            command.add(name, sub)
    return parser
