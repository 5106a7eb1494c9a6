"""The output of the commands ``md5``, ``hash`` and ``proto``."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.frontend import Library
from firm_hdl.frontend.names import ACTION_SERVICES
from firm_hdl.identity.md5 import md5sum
from firm_hdl.identity.proto import TooLargeError, proto
from firm_hdl.identity.rihs import type_hash
from firm_hdl.model import Action, Dialect, Interface, Message, Service

__all__ = ["hash_lines", "load_interfaces", "md5_lines", "proto_texts"]


def md5_lines(library: Library, names: Iterable[str]) -> tuple[list[str], DefinitionError | None]:
    """List md5 sums, each with the name of its type. An action gives the sums of its messages.

    Returns
    -------
    tuple of list and DefinitionError or None
        The lines of the types that could be loaded, and the errors of the others.

    Raises
    ------
    DefinitionError
        If the distribution is of ROS 2.
    """
    _require(library, "ros1", "md5 sums are for ROS 1; for ROS 2, use 'firm-hdl hash'")
    summed: list[Message | Service] = []

    def on_loaded(interface: Interface) -> None:
        summed.extend(interface.messages if isinstance(interface, Action) else (interface,))

    wrong = _each(library, names, on_loaded)
    return [f"{md5sum(item)}  {item.name}" for item in summed], wrong


def hash_lines(library: Library, names: Iterable[str]) -> tuple[list[str], DefinitionError | None]:
    """List type hashes, each with the name of its type.

    Returns
    -------
    tuple of list and DefinitionError or None
        The lines of the types that have a hash, and the errors of the others.

    Raises
    ------
    DefinitionError
        If the distribution is of ROS 1.
    """
    _require(library, "ros2", "type hashes are for ROS 2; for ROS 1, use 'firm-hdl md5'")
    lines: list[str] = []

    def on_loaded(interface: Interface) -> None:
        try:
            lines.append(f"{type_hash(interface)}  {interface.name}")
        except ValueError as error:
            problem = Diagnostic(message=f"{library.distro}: {error}")
            raise DefinitionError([problem]) from None

    wrong = _each(library, names, on_loaded)
    return lines, wrong


def proto_texts(
    library: Library, names: Iterable[str], *, quotes: bool
) -> tuple[dict[str, str], DefinitionError | None]:
    """Give the texts of `proto` for types, each with a line end after its last line.

    Returns
    -------
    tuple of dict and DefinitionError or None
        The texts by name of type, and the errors of the other types. A text that would be too long
        is an error, too.
    """
    texts: dict[str, str] = {}

    def on_loaded(interface: Interface) -> None:
        try:
            texts[interface.name] = proto(interface, quotes=quotes) + "\n"
        except TooLargeError as error:
            raise DefinitionError([Diagnostic(message=str(error))]) from None

    wrong = _each(library, names, on_loaded)
    return texts, wrong


def _each(
    library: Library, names: Iterable[str], on_loaded: Callable[[Interface], None]
) -> DefinitionError | None:
    try:
        load_interfaces(library, names, on_loaded=on_loaded)
    except DefinitionError as error:
        return error
    return None


def load_interfaces(
    library: Library,
    names: Iterable[str],
    *,
    on_loaded: Callable[[Interface], None] | None = None,
) -> list[Interface]:
    """Load messages, services and actions, each once.

    Parameters
    ----------
    library : Library
    names : iterable of str
        As for `Library.interface`; also the services that ROS 2 derives from an action.
    on_loaded : callable or None
        Called with each interface that could be loaded. It may raise DefinitionError, too.

    Raises
    ------
    DefinitionError
        With the errors of all names.
    """
    interfaces: dict[tuple[type, str], Interface] = {}
    problems: dict[str, Diagnostic] = {}
    for name in names:
        try:
            interface = _interface(library, name)
            # In ROS 1, a message and a service may have the same name.
            key = type(interface), interface.name
            if key not in interfaces and on_loaded is not None:
                on_loaded(interface)
        except DefinitionError as error:
            problems.update((str(problem), problem) for problem in error.diagnostics)
        else:
            interfaces[key] = interface
    if problems:
        raise DefinitionError(problems.values())
    return list(interfaces.values())


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
        message = f"{library.distro}: {message}"
        raise DefinitionError([Diagnostic(message=message)])
