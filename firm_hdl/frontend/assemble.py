"""Assemble the model of a service or an action from its messages."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.frontend.interfaces import Unit
from firm_hdl.frontend.names import ACTION_SERVICES, ACTION_WRAPPERS, EVENT, PARTS
from firm_hdl.model import Action, Message, Service

__all__ = ["assemble"]


def assemble(unit: Unit, resolve: Callable[[str], Message | None]) -> Service | Action:
    """Make the model of a service or an action.

    Parameters
    ----------
    unit : Unit
        The file.
    resolve : callable
        Gives a message of the unit by its name without the package.

    Raises
    ------
    DefinitionError
        With the errors of all messages of the service or action.
    """
    messages = _resolve_all(unit, resolve)
    if unit.name.kind == "srv":
        return _service(unit, unit.name.name, messages)
    return _action(unit, messages)


def _resolve_all(unit: Unit, resolve: Callable[[str], Message | None]) -> dict[str, Message]:
    messages: dict[str, Message] = {}
    diagnostics: list[Diagnostic] = list(unit.diagnostics)
    for name in unit.messages:
        try:
            message = resolve(name)
        except DefinitionError as error:
            diagnostics += error.diagnostics
        else:
            assert message is not None
            messages[name] = message
    if diagnostics:
        raise DefinitionError(_in_order(unit, diagnostics))
    return messages


def _in_order(unit: Unit, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Sort by position in the file; diagnostics of other files come last."""

    def place(diagnostic: Diagnostic) -> tuple[bool, int]:
        span = diagnostic.span
        if span is None or span.source != unit.source:
            return True, 0
        return False, span.start

    return sorted(dict.fromkeys(diagnostics), key=place)


def _service(unit: Unit, base: str, messages: dict[str, Message]) -> Service:
    dialect = unit.name.dialect
    request, response = (messages[base + suffix] for suffix in PARTS[dialect, "srv"])
    package = str(unit.name)[: -len(unit.name.name)]
    is_whole = base == unit.name.name
    return Service(
        name=package + base,
        dialect=dialect,
        request=request,
        response=response,
        event=messages.get(base + EVENT),
        comment=request.comment if is_whole else "",
        text=unit.source.text if is_whole else "",
    )


def _action(unit: Unit, messages: dict[str, Message]) -> Action:
    base, dialect = unit.name.name, unit.name.dialect
    goal, result, feedback = (messages[base + suffix] for suffix in PARTS[dialect, "action"])
    services = ACTION_SERVICES if dialect == "ros2" else ()
    return Action(
        name=str(unit.name),
        dialect=dialect,
        goal=goal,
        result=result,
        feedback=feedback,
        services=tuple(_service(unit, base + suffix, messages) for suffix in services),
        wrappers=tuple(messages[base + suffix] for suffix in ACTION_WRAPPERS[dialect]),
        comment=goal.comment,
        text=unit.source.text,
    )
