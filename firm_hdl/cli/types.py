"""Which types a command is about, and where their definitions are."""

from __future__ import annotations

import argparse

from firm_hdl.frontend import Library, all_names, open_library

__all__ = ["library_of", "names_of"]


def names_of(given: argparse.Namespace) -> list[str]:
    """Give the types that a command is to do: those named, or all of the folders or recordings."""
    if given.all == bool(given.types):
        given.usage_error("name either types or --all")
    if not given.all:
        return list(given.types)
    return all_names(given.distro, given.path, given.bag)


def library_of(given: argparse.Namespace) -> Library:
    """Open the library that a command is to look types up in."""
    return open_library(given.distro, given.path, given.bag, depends=given.depends)
