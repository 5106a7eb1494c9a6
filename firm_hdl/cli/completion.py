"""Completion of commands, options and types in shells, by argcomplete."""

from __future__ import annotations

import argparse
import os
from typing import Any

from argcomplete import autocomplete
from argcomplete.completers import FilesCompleter
from argcomplete.shell_integration import shellcode

from firm_hdl.export.options import EXTRAS
from firm_hdl.frontend import Library, open_library
from firm_hdl.frontend.spelling import SUFFIXES
from firm_hdl.node.bitstream import board_names

__all__ = ["called_in", "complete", "shell_code"]


def shell_code(shell: str) -> str:
    """Return the code that a shell has to run before it completes the command."""
    return shellcode(["firm-hdl"], shell=shell)


def called_in(line: str) -> list[str]:
    """Return the words of a line that are to be completed, without the command itself."""
    return line.split()[1:]


def complete(parser: argparse.ArgumentParser) -> None:
    """Answer the shell, and end this process."""
    _add_completers(parser)
    autocomplete(parser)


def _add_completers(parser: argparse.ArgumentParser) -> None:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for sub in action.choices.values():
                _add_completers(sub)
        elif action.dest in ("type", "types"):
            action.completer = _types  # type: ignore[attr-defined]
        elif action.dest == "extras":
            action.completer = _extras  # type: ignore[attr-defined]
        elif action.dest == "target":
            action.completer = _boards  # type: ignore[attr-defined]


def _boards(prefix: str, **_: Any) -> list[str]:
    """List the boards that a bitstream can be made for; a file can be one, too."""
    names = [name for name in ("list", *board_names()) if name.startswith(prefix)]
    return [*names, *FilesCompleter(["yaml"])(prefix)]


def _extras(prefix: str, **_: Any) -> list[str]:
    """List the words of ``--with`` that can follow those, and their commas, so far."""
    before, comma, _last = prefix.rpartition(",")
    words = [each for each in (*EXTRAS, "all") if each not in before.split(",")]
    return [f"{before}{comma}{each}" for each in words]


def _types(prefix: str, parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """List the types that begin with a text, in the folders and of the distribution so far."""
    files = FilesCompleter([suffix.lstrip(".") for suffix in SUFFIXES])
    found = [name for name in _library(parsed_args).interfaces() if name.startswith(prefix)]
    return [*found, *files(prefix)]


def _library(args: argparse.Namespace) -> Library:
    distro = getattr(args, "distro", None)
    # Of several distributions, the last one counts here.
    distro = distro[-1] if isinstance(distro, list) else distro
    folders = [path for path in getattr(args, "path", None) or () if os.path.isdir(path)]
    return open_library(distro, folders, getattr(args, "bag", None) or ())
