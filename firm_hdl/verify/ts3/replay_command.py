"""``firm-hdl verify --bag``: what it takes, and which types of the recordings are replayed."""

from __future__ import annotations

import argparse

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.frontend import open_library
from firm_hdl.verify.systems.tasks import Task, UnknownTypeError
from firm_hdl.verify.ts3.options import LONGEST
from firm_hdl.verify.ts3.recording import topics_of
from firm_hdl.verify.ts3.replay import MOST_MESSAGES
from firm_hdl.wire import refusals

__all__ = ["add_replay_arguments", "check_replay", "collect_recorded"]


def add_replay_arguments(group: argparse._ArgumentGroup) -> None:
    """Add the arguments of replays, all but those that other tests have as well."""
    group.add_argument(
        "--bag",
        action="append",
        default=[],
        metavar="FILE",
        help="replay the messages of a recording (.bag, .mcap, .db3), with its definitions and no "
        f"others, {MOST_MESSAGES} of each type at most (--cases N: N of each); without TYPE, all "
        "types that it has topics of; repeatable",
    )
    group.add_argument(
        "--max-message-bytes",
        type=_size,
        metavar="N",
        help=f"leave out longer messages of recordings; default: {LONGEST}",
    )


def check_replay(given: argparse.Namespace) -> None:
    """Refuse what recordings cannot be combined with; without types, all are meant."""
    if not given.bag:
        if given.max_message_bytes is not None:
            given.refuse("--max-message-bytes needs --bag")
        return
    if given.path:
        given.refuse("argument --bag: not allowed with argument --path")
    if set(given.systems) != {"ts3"}:
        given.refuse("--bag is of ts3 alone")
    if given.sut:
        given.refuse("--bag is for firm-hdl's own converters, not for --sut")
    if given.share_circuits:
        given.refuse("--bag replays the messages of each type: not with --share-circuits")
    if len(given.distro or ()) > 1:
        given.refuse("--bag takes one --distro")
    if not given.types:
        given.all = True


def collect_recorded(given: argparse.Namespace) -> list[Task]:
    """List the types to replay: those that are named, or all that there are topics of.

    What is wrong with the definition of one of all types goes to ``given.problems``.

    Raises
    ------
    DefinitionError
        If a recording cannot be used, or the definition of a type that is named: it has to fit a
        wire (:func:`firm_hdl.wire.refusals`).
    UnknownTypeError
        If there is no topic of a type that is named, or the recording is of another wire format.
    """
    library = open_library(next(iter(given.distro or ()), None), bags=given.bag)
    if given.wire not in (None, wire := "ros1" if library.dialect == "ros1" else "cdr"):
        raise UnknownTypeError(f"'{given.bag[0]}' has messages of {wire}, not of {given.wire}")
    found: dict[str, None] = {}
    problems: dict[str, Diagnostic] = given.problems if given.all else {}
    for kind in dict.fromkeys(topic.type for bag in given.bag for topic in topics_of(bag)):
        try:
            found[library.message(kind).name] = None
        except DefinitionError as error:
            problems.update((str(problem), problem) for problem in error.diagnostics)
    names = list(dict.fromkeys(library.message(name).name for name in given.types)) or list(found)
    if missing := [name for name in names if name not in found]:
        raise UnknownTypeError(
            f"There is no topic of {', '.join(missing)}, only of {', '.join(sorted(found))}"
        )
    if no_layout := [each for name in given.types for each in refusals(library.message(name))]:
        raise DefinitionError(no_layout)
    return [Task(distro=library.distro, name=name, same=(library.distro,)) for name in names]


def _size(text: str) -> int:
    try:
        number = int(text, 0)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
    if not 1 <= number < 1 << 31:
        raise argparse.ArgumentTypeError(f"must be from 1 to {(1 << 31) - 1}, not {number}")
    return number
