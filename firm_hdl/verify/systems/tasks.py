"""The types that test systems run, of distributions or of a user's own folders.

A type that is equal in several distributions is run once, and counts for each.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache

from firm_hdl.errors import DefinitionError, Diagnostic, UserError
from firm_hdl.frontend import Library, all_names, open_library
from firm_hdl.model import Message, closure
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.wire import too_large

__all__ = ["TypeUnderTest", "UnknownTypeError", "collect_own", "collect_tasks", "library_of"]


class UnknownTypeError(UserError):
    """No distribution or recording has a type that was asked for."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TypeUnderTest:
    """A type to test."""

    distro: str
    name: str
    same: tuple[str, ...]  # All distributions with an equal type, `distro` included.


def library_of(distro: str, options: CaseOptions) -> Library:
    """Return the library of a distribution with the folders or recordings of some options.

    It is opened once in a process. Without folders and recordings, it has only the distribution's
    own types, because rosbags knows these. With folders, it searches the active workspace after
    them.
    """
    return _opened(os.getcwd(), distro, options.paths, options.bags, options.depends)


@cache
def _opened(folder: str, distro: str, *origins: tuple[str, ...]) -> Library:
    """Open a library; `folder` is the one that relative paths start from."""
    paths, bags, depends = origins
    if not any(origins):
        return Library(distro)
    return open_library(distro, paths, bags, depends=depends)


def collect_tasks(
    distros: Iterable[str] = (),
    names: Sequence[str] = (),
    *,
    problems: dict[str, Diagnostic] | None = None,
) -> list[TypeUnderTest]:
    """List the types to test, the largest first.

    * `distros`: empty: all distributions.
    * `names`: types as ``package/Type`` or ``package/msg/Type``; empty: all types.
    * `problems`: receives the error about names that no distribution has, by its text, if other
      names exist.

    Raises `UnknownTypeError` if no distribution has a type of a name.
    """
    # This import loads rosbags' types and NumPy, which a user's own definitions do not need.
    from firm_hdl.cases.oracle import DISTRO_STORES, distro_oracle

    wanted = {_full(name) for name in names}
    found: dict[tuple[str, str], list[str]] = defaultdict(list)
    weights: dict[tuple[str, str], int] = {}
    for distro in list(distros) or DISTRO_STORES:
        oracle = distro_oracle(distro)
        for name in oracle.names():
            if not wanted or name in wanted:
                structure = repr(oracle.structure(name))
                found[name, structure].append(distro)
                weights[name, structure] = len(structure)
    if missing := wanted - {name for name, _ in found}:
        which = ", ".join(sorted(missing))
        if problems is None or not found:
            raise UnknownTypeError(f"No distribution has {which}")
        unknown = Diagnostic(message=f"no distribution has {which}")
        problems[str(unknown)] = unknown
    # The largest first, so that no large type runs alone at the end.
    keys = sorted(found, key=lambda key: (-weights[key], key))
    return [TypeUnderTest(distro=found[k][-1], name=k[0], same=tuple(found[k])) for k in keys]


def collect_own(
    distros: Iterable[str],
    names: Sequence[str],
    paths: Sequence[str],
    *,
    depends: Sequence[str] = (),
    problems: dict[str, Diagnostic] | None = None,
) -> list[TypeUnderTest]:
    """List the types in folders to test, the largest first.

    * `distros`: the distributions by whose rules and types the definitions are read, one after the
      other.
    * `names`: types, services or actions; empty: all that are in `paths`. Types that are named must
      not be too large to be laid out (:func:`firm_hdl.wire.too_large`).
    * `depends`: folders with packages that others depend on.
    * `problems`: receives errors in definitions, by their texts. These definitions are left out
      then.

    Raises `DefinitionError`: with all errors, if `problems` is `None` or none of the named types
    can be used.
    """
    found: dict[tuple[str, str], int] = {}
    wrong: dict[str, Diagnostic] = {} if problems is None else problems
    for distro in distros:
        library = library_of(distro, CaseOptions(paths=tuple(paths), depends=tuple(depends)))
        for name in names or all_names(distro, paths, ()):
            try:
                messages = library.interface(name).messages
            except DefinitionError as error:
                wrong.update((str(problem), problem) for problem in error.diagnostics)
                continue
            # A type that is too large is an error if it is named. Otherwise it is not judged.
            if large := [each for message in messages for each in too_large(message) if names]:
                wrong.update((str(problem), problem) for problem in large)
                continue
            found.update(((distro, message.name), _weight(message)) for message in messages)
    if wrong and (problems is None or (names and not found)):
        raise DefinitionError(wrong.values())
    keys = sorted(found, key=lambda key: (-found[key], key))
    return [TypeUnderTest(distro=distro, name=name, same=(distro,)) for distro, name in keys]


def _weight(message: Message) -> int:
    """Estimate the time that a type takes by its number of fields, nested ones included."""
    return sum(len(part.fields) for part in closure([message]))


def _full(name: str) -> str:
    package, _, base = name.rpartition("/")
    return f"{package.removesuffix('/msg')}/msg/{base}"
