"""Commands that describe types: ``list``, ``show``, ``md5``, ``hash``, ``proto``, ``metrics``."""

from __future__ import annotations

import argparse

from firm_hdl.arguments import add_types_or_all, add_wire
from firm_hdl.cli.types import library_of, names_of

__all__ = ["add_hash", "add_list", "add_md5", "add_metrics", "add_proto", "add_show"]


def add_list(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl list``."""
    command.set_defaults(run=_list)


def _list(given: argparse.Namespace) -> None:
    for name in library_of(given).interfaces():
        print(name)


def add_show(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl show``."""
    command.add_argument("type", metavar="TYPE")
    command.set_defaults(run=_show)


def _show(given: argparse.Namespace) -> None:
    from firm_hdl.frontend import show

    print(show(library_of(given), given.type), end="")


def add_md5(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl md5``."""
    add_types_or_all(command)
    command.set_defaults(run=_md5)


def _md5(given: argparse.Namespace) -> None:
    from firm_hdl.identity.command import md5_lines

    if given.distro is None and not given.bag:
        given.distro = "noetic"
    _print_all(*md5_lines(library_of(given), names_of(given)))


def add_hash(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl hash``."""
    add_types_or_all(command)
    command.set_defaults(run=_hash)


def _hash(given: argparse.Namespace) -> None:
    from firm_hdl.identity.command import hash_lines

    _print_all(*hash_lines(library_of(given), names_of(given)))


def add_proto(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl proto``."""
    add_types_or_all(command)
    command.add_argument("--no-quotes", action="store_true", help="print no quotes around it")
    command.set_defaults(run=_proto)


def _proto(given: argparse.Namespace) -> None:
    from firm_hdl.identity.command import proto_texts

    texts, wrong = proto_texts(library_of(given), names_of(given), quotes=not given.no_quotes)
    if len(texts) == 1 and not given.all:
        print(*texts.values(), sep="", end="")
    else:
        print("\n".join(f"# {name}\n{text}" for name, text in texts.items()), end="")
    if wrong is not None:
        raise wrong


def add_metrics(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl metrics``."""
    from firm_hdl.metrics import FORMATS

    add_types_or_all(command, "all types that there are")
    command.add_argument(
        "--format", choices=list(FORMATS), default="table", help="default: %(default)s"
    )
    add_wire(command)
    command.set_defaults(run=_metrics)


def _metrics(given: argparse.Namespace) -> None:
    from firm_hdl.frontend import open_library
    from firm_hdl.metrics.command import metrics_text

    if given.all and not given.types:
        # The distribution's types, too: a user compares his own types with them.
        names = open_library(given.distro, given.path, given.bag).interfaces()
    else:
        names = names_of(given)
    text, wrong = metrics_text(library_of(given), names, given.format, given.wire, bar=given.all)
    print(text, end="")
    if wrong is not None:
        raise wrong


def _print_all(lines: list[str], wrong: Exception | None) -> None:
    """Print the lines of the types that could be loaded, then raise the errors of the others."""
    print("".join(f"{line}\n" for line in lines), end="")
    if wrong is not None:
        raise wrong
