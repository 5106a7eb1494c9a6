"""The types that a command works on, and the library of their definitions."""

from __future__ import annotations

import argparse
import os
import sys

from firm_hdl.arguments import check_types_or_all
from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.frontend import Library, all_names, open_library
from firm_hdl.frontend.spelling import SUFFIXES, package_of_file, spelled

__all__ = ["library_of", "names_of", "print_unusable", "take_spellings"]


def take_spellings(args: argparse.Namespace) -> None:
    """Write the types of a command as ``package/kind/Name``, or as ``package/Name``.

    A file of a definition gives its type, and its package becomes the first folder of ``--path``.

    Raises `DefinitionError` if a file is in no package, or two files are in different packages of
    one name.
    """
    given = [args.type] if hasattr(args, "type") else list(getattr(args, "types", ()))
    folders: dict[str, str] = {}
    names, wrong = [], []
    for text in given:
        if os.path.isdir(text) and not os.path.basename(text)[:1].isupper():
            message = f"'{text}' is a folder: name it with --path, and one of its types"
            wrong.append(Diagnostic(message=message))
            continue
        is_file = text.endswith(SUFFIXES) and (os.path.isfile(text) or spelled(text) == text)
        if not is_file:
            names.append(spelled(text))
            continue
        try:
            folder, name = package_of_file(text)
        except DefinitionError as error:
            wrong += error.diagnostics
            continue
        names.append(name)
        package = name.partition("/")[0]
        if not os.path.samefile(folder, other := folders.setdefault(package, folder)):
            message = f"package '{package}' is in '{other}' and in '{folder}'; name one at a time"
            wrong.append(Diagnostic(message=message))
    if folders and getattr(args, "bag", None):
        message = "with --bag, types are those of the recording, and no files are read"
        wrong.append(Diagnostic(message=message))
    if wrong:
        raise DefinitionError(wrong)
    if folders:
        args.path = [*folders.values(), *args.path]
    if hasattr(args, "type"):
        args.type = names[0]
    elif given:
        args.types = names


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
