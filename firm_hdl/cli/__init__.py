# PYTHON_ARGCOMPLETE_OK, for shells in which argcomplete completes all commands.
"""The command ``firm-hdl``: it parses arguments, calls other modules, and prints their results.

Exit status: 0 for success; 1 if a definition cannot be used or a request cannot be met, with the
reason on standard error; 2 for wrong arguments; 130 if the command was interrupted.

Before the command is known, only Python's own modules are imported. Other modules are imported
inside `main`, which reports every exception as a message.
"""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

__all__ = ["main", "parser_of_all"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status."""
    try:
        return _run(arguments)
    except KeyboardInterrupt:
        _print_error("interrupted")
        return 130


def _run(arguments: Sequence[str] | None) -> int:
    from firm_hdl.terminal import printable_streams

    # A process may be started without standard output and standard error.
    sys.stdout = sys.stdout or io.StringIO()
    sys.stderr = sys.stderr or io.StringIO()
    with printable_streams():
        try:
            try:
                return _dispatch(sys.argv[1:] if arguments is None else list(arguments))
            finally:
                # Flush also after `--help`, which ends with an exception.
                sys.stdout.flush()
        except OSError as error:
            return _failed(error)


def _dispatch(arguments: list[str]) -> int:
    if "_ARGCOMPLETE" in os.environ:
        # A shell asks for the words that may follow; this process answers, and ends.
        from firm_hdl.cli.completion import called_in, complete

        complete(_parser(called_in(os.environ.get("COMP_LINE", ""))))
    parser = _parser(arguments)
    if arguments and arguments[0].startswith("-") and not _is_known(parser, arguments[0]):
        parser.error(f"{arguments[0]}: options come after the command, as in firm-hdl list --help")
    if any("\0" in argument for argument in arguments):
        parser.error("an argument contains a NUL character")
    args = parser.parse_args(arguments)
    reconfigure = getattr(sys.stdout, "reconfigure", None)
    if reconfigure is not None:
        # A comment in a definition may have characters that the terminal cannot encode.
        reconfigure(errors="backslashreplace")
    words = [args.command, *([args.action] if hasattr(args, "action") else [])]
    args.document = {"format": 1, "command": " ".join(words), "errors": []}
    if not getattr(args, "as_json", False):
        return _called(args)
    import json
    from contextlib import redirect_stdout

    try:
        with redirect_stdout(sys.stderr):
            return _called(args)
    except SystemExit:
        # Wrong arguments: there is no answer, as for those that the parser finds.
        args.document.clear()
        raise
    finally:
        if args.document:
            # Errors come last, because a document may be long.
            args.document["errors"] = args.document.pop("errors")
            print(json.dumps(args.document, indent=1, ensure_ascii=False, allow_nan=False))


def _called(args: argparse.Namespace) -> int:
    """Call the function of a command, and report its errors; return the exit status."""
    from firm_hdl.errors import DefinitionError, Diagnostic, UserError
    from firm_hdl.terminal import progress

    try:
        with progress(args.document["command"]):
            if hasattr(args, "type") or hasattr(args, "types"):
                from firm_hdl.cli.types import take_spellings

                take_spellings(args)
            return args.run(args) or 0
    except DefinitionError as error:
        _print_error(str(error))
        args.document["errors"] += [each.facts() for each in error.diagnostics]
        return 1
    except UserError as error:
        said = str(error)
    except MemoryError:
        said = "there is not enough memory for this"
    except RecursionError:
        said = "the input nests too deeply"
    except (OSError, KeyboardInterrupt) as error:
        said = str(error) or "interrupted"
        args.document["errors"].append(Diagnostic(message=said).facts())
        raise
    _print_error(f"error: {said}")
    args.document["errors"].append(Diagnostic(message=said).facts())
    return 1


def _failed(error: OSError) -> int:
    """Report an error of the operating system, if standard error can still be written to."""
    if isinstance(error, BrokenPipeError):
        _discard_output()
        return 1
    where = f"'{os.fsdecode(error.filename)}': " if error.filename is not None else ""
    _print_error(f"error: {where}{error.strerror or error}")
    # Discard the rest of the output, which would fail again when Python ends.
    with suppress(OSError, ValueError):
        sys.stdout.flush()
        return 1
    _discard_output()
    return 1


def _discard_output() -> None:
    """Discard the rest of the output, which Python would try to write again when it ends."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _print_error(text: str) -> None:
    with suppress(OSError, ValueError):
        print(text, file=sys.stderr, flush=True)


def _is_known(parser: argparse.ArgumentParser, word: str) -> bool:
    """Tell whether a word is an option of the whole command, or the start of one."""
    return any(name.startswith(word) for each in parser._actions for name in each.option_strings)


class _Completion(argparse.Action):
    """Print the code for the completion in a shell."""

    def __call__(self, parser: argparse.ArgumentParser, _: object, shell: Any, *__: object) -> None:
        from firm_hdl.cli.completion import shell_code

        print(shell_code(shell), end="")
        parser.exit()


class _Version(argparse.Action):
    """Print the version, which is looked up for this option only."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        import firm_hdl

        print(f"firm-hdl {firm_hdl.__version__}")
        parser.exit()


def parser_of_all() -> argparse.ArgumentParser:
    """Make a parser with the arguments of all commands, for their reference."""
    return _parser([], with_all=True)


def _parser(arguments: Sequence[str], *, with_all: bool = False) -> argparse.ArgumentParser:
    """Make a parser with all commands, and with the arguments of the command that is called."""
    from firm_hdl.cli.parsing import Parser
    from firm_hdl.cli.table import COMMANDS

    parser = Parser(
        prog="firm-hdl",
        description="Generate hardware that reads and writes ROS messages.",
        examples=(
            "firm-hdl doctor                            what is installed here, and where to read",
            "firm-hdl info geometry_msgs/msg/Twist      what its converters take",
            "firm-hdl build geometry_msgs/msg/Twist     write them",
            "firm-hdl build --help                      all options of a command",
        ),
    )
    parser.add_argument(
        "--version", action=_Version, nargs=0, help="show program's version number and exit"
    )
    parser.add_argument(
        "--print-completion",
        action=_Completion,
        choices=["bash", "zsh", "fish"],
        default=argparse.SUPPRESS,
        help="print the code for completion in a shell, and exit",
    )
    commands = parser.add_subparsers(
        title="commands", metavar="COMMAND", dest="command", required=True
    )
    called = next((each for each in arguments if not each.startswith("-")), None)
    for name, command in COMMANDS.items():
        text = command.help
        sub = commands.add_parser(
            name,
            help=text,
            description=f"{text[0].upper()}{text[1:]}.",
            examples=command.examples,
        )
        if with_all or name == called:
            command.add(name, sub)
    return parser
