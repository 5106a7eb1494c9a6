"""Commands that describe types: ``list``, ``show``, ``md5``, ``hash``, ``proto``, ``metrics``."""

from __future__ import annotations

import argparse
import json

from firm_hdl.arguments import TYPE_HELP, add_json, add_types_or_all, add_wire
from firm_hdl.cli.types import library_of, names_of, print_unusable
from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import DEFAULT_DISTRO, Library

__all__ = ["add_hash", "add_list", "add_md5", "add_metrics", "add_proto", "add_show"]


def add_list(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl list``."""
    command.add_argument(
        "--only-path",
        action="store_true",
        help="list the types of --path alone, and not those of the distribution",
    )
    add_json(command)
    command.set_defaults(run=_list, usage_error=command.error)


def _list(args: argparse.Namespace) -> None:
    if args.only_path and not args.path:
        args.usage_error("--only-path needs --path")
    if args.only_path:
        library = Library(args.distro or DEFAULT_DISTRO, args.path, origins=())
    else:
        library = library_of(args)
    problems = library.problems()
    print_unusable(library)
    kinds = library.kinds()
    args.document["distro"] = library.distro
    args.document["types"] = [{"name": name, "kind": kind} for name, kind in kinds.items()]
    lines = [] if args.as_json else list(kinds)
    _print_all(lines, DefinitionError(problems) if problems else None)


def add_show(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl show``."""
    command.add_argument("type", metavar="TYPE", help=TYPE_HELP)
    command.set_defaults(run=_show)


def _show(args: argparse.Namespace) -> None:
    from firm_hdl.frontend import show

    print(show(library_of(args), args.type), end="")


def add_md5(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl md5``."""
    add_types_or_all(command)
    command.set_defaults(run=_md5)


def _md5(args: argparse.Namespace) -> None:
    from firm_hdl.identity.command import md5_lines

    if args.distro is None and not args.bag:
        args.distro = "noetic"
    _print_all(*md5_lines(library_of(args), names_of(args)))


def add_hash(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl hash``."""
    add_types_or_all(command)
    command.set_defaults(run=_hash)


def _hash(args: argparse.Namespace) -> None:
    from firm_hdl.identity.command import hash_lines

    _print_all(*hash_lines(library_of(args), names_of(args)))


def add_proto(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl proto``."""
    add_types_or_all(command)
    command.add_argument("--no-quotes", action="store_true", help="print no quotes around the text")
    command.set_defaults(run=_proto)


def _proto(args: argparse.Namespace) -> None:
    from firm_hdl.identity.command import proto_texts

    texts, wrong = proto_texts(library_of(args), names_of(args), quotes=not args.no_quotes)
    if len(texts) == 1 and not args.all:
        print(*texts.values(), sep="", end="")
    else:
        print("\n".join(f"# {name}\n{text}" for name, text in texts.items()), end="")
    if wrong is not None:
        raise wrong


def add_metrics(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl metrics``."""
    from firm_hdl.metrics import FORMATS

    add_types_or_all(command)
    command.add_argument("--format", choices=list(FORMATS), help="default: table")
    add_wire(command)
    add_json(command)
    command.set_defaults(run=_metrics)


def _metrics(args: argparse.Namespace) -> None:
    from firm_hdl.metrics.analysis import metrics_text

    if args.as_json and args.format not in (None, "json"):
        args.usage_error(f"--json and --format {args.format} exclude each other")
    names, form = names_of(args), "json" if args.as_json else args.format or "table"
    text, wrong = metrics_text(library_of(args), names, form, args.wire)
    if args.as_json:
        args.document["messages"] = json.loads(text)
    else:
        print(text, end="")
    if wrong is not None:
        raise wrong


def _print_all(lines: list[str], wrong: Exception | None) -> None:
    """Print the lines of the types that can be used, then raise the errors of the others."""
    print("".join(f"{line}\n" for line in lines), end="")
    if wrong is not None:
        raise wrong
