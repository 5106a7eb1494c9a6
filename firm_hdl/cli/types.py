"""The types that a command works on, and the library of their definitions."""

from __future__ import annotations

import argparse

from firm_hdl.arguments import check_types_or_all
from firm_hdl.frontend import Library, all_names, open_library

__all__ = ["library_of", "names_of"]


def names_of(args: argparse.Namespace) -> list[str]:
    """Return the types to work on: the named types, or all types of the folders or recordings."""
    check_types_or_all(args)
    if not args.all:
        return list(args.types)
    return all_names(args.distro, args.path, args.bag)


def library_of(args: argparse.Namespace) -> Library:
    """Open the library in which a command searches for types."""
    return open_library(args.distro, args.path, args.bag, depends=args.depends)
