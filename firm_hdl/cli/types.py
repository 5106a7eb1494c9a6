"""The types that a command works on, and the library of their definitions."""

from __future__ import annotations

import argparse
import sys

from firm_hdl.arguments import check_types_or_all
from firm_hdl.frontend import Library, all_names, open_library

__all__ = ["library_of", "names_of", "print_unusable"]


def names_of(args: argparse.Namespace) -> list[str]:
    """Return the types to work on: the named types, or all types of the folders or recordings."""
    check_types_or_all(args)
    if not args.all:
        return list(args.types)
    if args.bag:
        library = library_of(args)
        print_unusable(library)
        return library.interfaces()
    return all_names(args.distro, args.path, ())


def library_of(args: argparse.Namespace) -> Library:
    """Open the library in which a command searches for types."""
    return open_library(args.distro, args.path, args.bag, depends=args.depends)


def print_unusable(library: Library) -> None:
    """Name the topics of recordings whose types cannot be used."""
    for sentence in library.unusable.values():
        print(f"note: {sentence}", file=sys.stderr)
