"""The output of the commands ``md5``, ``hash`` and ``proto``."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from itertools import chain
from typing import TypeVar

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.frontend import Library
from firm_hdl.frontend.names import ACTION_SERVICES
from firm_hdl.identity.md5 import md5sum
from firm_hdl.identity.proto import proto
from firm_hdl.identity.rihs import type_hash
from firm_hdl.model import Action, Dialect, Interface

__all__ = ["hash_lines", "md5_lines", "of_each", "proto_texts"]

_T = TypeVar("_T")


def md5_lines(library: Library, names: Iterable[str]) -> tuple[list[str], DefinitionError | None]:
    """List md5 sums, each with the name of its type. An action gives the sums of its messages.

    Results are those of `of_each`.

    Raises `DefinitionError` if the distribution is of ROS 2.
    """
    _require(library, "ros1", "md5 sums are for ROS 1; for ROS 2, use 'firm-hdl hash'")

    def lines(interface: Interface) -> list[str]:
        summed = interface.messages if isinstance(interface, Action) else (interface,)
        return [f"{md5sum(item)}  {item.name}" for item in summed]

    found, wrong = of_each(library, names, lines)
    return list(chain.from_iterable(found)), wrong


def hash_lines(library: Library, names: Iterable[str]) -> tuple[list[str], DefinitionError | None]:
    """List type hashes, each with the name of its type. Results are those of `of_each`.

    Raises `DefinitionError` if the distribution is of ROS 1.
    """
    _require(library, "ros2", "type hashes are for ROS 2; for ROS 1, use 'firm-hdl md5'")

    def line(interface: Interface) -> str:
        try:
            return f"{type_hash(interface)}  {interface.name}"
        except ValueError as error:
            raise DefinitionError.of(f"{library.distro}: {error}") from None

    return of_each(library, names, line)


def proto_texts(
    library: Library, names: Iterable[str], *, quotes: bool
) -> tuple[dict[str, str], DefinitionError | None]:
    """Give the texts of `proto` by type, and the errors of the types that have none.

    Each text has a line end after its last line.
    """

    def text(interface: Interface) -> tuple[str, str]:
        return interface.name, proto(interface, quotes=quotes) + "\n"

    found, wrong = of_each(library, names, text)
    return dict(found), wrong


def of_each(
    library: Library, names: Iterable[str], make: Callable[[Interface], _T]
) -> tuple[list[_T], DefinitionError | None]:
    """Load messages, services and actions, each once, and make something of each.

    * `names`: as for `Library.interface`; also the services that ROS 2 derives from an action.
    * `make`: may raise DefinitionError, too.

    Returns what was made, and the errors of all other types.
    """
    made: dict[tuple[type, str], _T] = {}
    problems: dict[str, Diagnostic] = {}
    for name in names:
        try:
            interface = _interface(library, name)
            # In ROS 1, a message and a service may have the same name.
            key = type(interface), interface.name
            if key not in made:
                made[key] = make(interface)
        except DefinitionError as error:
            problems.update((str(problem), problem) for problem in error.diagnostics)
    return list(made.values()), DefinitionError(problems.values()) if problems else None


def _interface(library: Library, name: str) -> Interface:
    for suffix in ACTION_SERVICES:
        if library.dialect == "ros2" and name.endswith(suffix):
            with suppress(DefinitionError):
                action = library.interface(name.removesuffix(suffix))
                if isinstance(action, Action):
                    full = action.name + suffix
                    return next(service for service in action.services if service.name == full)
    return library.interface(name)


def _require(library: Library, dialect: Dialect, message: str) -> None:
    if library.dialect != dialect:
        raise DefinitionError.of(f"{library.distro}: {message}")
