"""Which types of recordings are replayed."""

from __future__ import annotations

from collections.abc import Sequence

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.frontend import open_library
from firm_hdl.verify.systems.tasks import TypeUnderTest, UnknownTypeError
from firm_hdl.verify.ts3.recording import topics_of
from firm_hdl.wire import Wire, too_large

__all__ = ["collect_recorded"]


def collect_recorded(
    distro: str | None,
    names: Sequence[str],
    bags: Sequence[str],
    *,
    wire: Wire | None,
    problems: dict[str, Diagnostic],
) -> list[TypeUnderTest]:
    """List the types to replay: those that are named, or all that there are topics of.

    Parameters
    ----------
    distro : str or None
        By whose rules definitions are read; `None`: the recordings' own.
    names : sequence of str
        None: all types.
    wire : Wire or None
        The wire format that is asked for.
    problems : dict
        Takes what is wrong with the definition of one of all types, by its text.

    Raises
    ------
    DefinitionError
        If a recording cannot be used, or the definition of a type that is named: it must not be
        too large to be laid out (:func:`firm_hdl.wire.too_large`).
    UnknownTypeError
        If there is no topic of a type that is named, or the recording is of another wire format.
    """
    library = open_library(distro, bags=bags)
    if wire not in (None, there := "ros1" if library.dialect == "ros1" else "cdr"):
        raise UnknownTypeError(f"'{bags[0]}' has messages of {there}, not of {wire}")
    found: dict[str, None] = {}
    wrong: dict[str, Diagnostic] = {} if names else problems
    for kind in dict.fromkeys(topic.type for bag in bags for topic in topics_of(bag)):
        try:
            found[library.message(kind).name] = None
        except DefinitionError as error:
            wrong.update((str(problem), problem) for problem in error.diagnostics)
    wanted = list(dict.fromkeys(library.message(name).name for name in names)) or list(found)
    if missing := [name for name in wanted if name not in found]:
        raise UnknownTypeError(
            f"There is no topic of {', '.join(missing)}, only of {', '.join(sorted(found))}"
        )
    if large := [each for name in names for each in too_large(library.message(name))]:
        raise DefinitionError(large)
    return [
        TypeUnderTest(distro=library.distro, name=name, same=(library.distro,)) for name in wanted
    ]
