"""The types that a command works on, and the library of their definitions."""

from __future__ import annotations

import argparse

from firm_hdl.frontend import Library, all_names, open_library

__all__ = ["library_of", "names_of"]


def names_of(given: argparse.Namespace) -> list[str]:
    """Give the types to work on: those named, or all types of the folders or recordings."""
    if given.all == bool(given.types):
        given.usage_error("name either types or --all")
    if not given.all:
        return list(given.types)
    return all_names(given.distro, given.path, given.bag)


def library_of(given: argparse.Namespace) -> Library:
    """Open the library in which a command looks types up."""
    return open_library(given.distro, given.path, given.bag, depends=given.depends)
