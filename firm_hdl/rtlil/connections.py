"""The streams of the components of a design, and whether one is connected twice.

All of this holds for any component of `amaranth.lib.wiring` that has streams, whoever wrote it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from amaranth.hdl import Fragment, Signal
from amaranth.hdl._ast import Assign
from amaranth.lib import stream, wiring

__all__ = ["check_connections", "components_of", "streams_of"]


def check_connections(design: Fragment) -> None:
    """Check that no stream of a component is connected twice: the last connection would count.

    Raises `wiring.ConnectionError`.
    """
    sources: dict[int, list[Signal]] = {}
    stack = [design]
    while stack:
        fragment = stack.pop()
        stack += [inner for inner, _, _ in fragment.subfragments]
        for each in fragment.statements.get("comb", ()):
            if isinstance(each, Assign) and isinstance(each.lhs, Signal):
                # A constant may be there for cases that the next assignment leaves out.
                sources.setdefault(id(each.lhs), []).extend(
                    [each.rhs] if isinstance(each.rhs, Signal) else []
                )
    for place, component in components_of(design):
        for name, port in streams_of(component):
            if any(len(sources.get(id(signal), ())) > 1 for signal in (port.valid, port.ready)):
                raise wiring.ConnectionError(
                    f"Stream {'.'.join([*place, *name])!r} is connected twice: "
                    "only the last connection would count"
                )


def components_of(
    fragment: Fragment, place: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], wiring.Component]]:
    """Yield components with the names on the way to them, without those inside of firm-hdl's.

    A component whose `is_closed` is true is yielded, and those in it are not.
    """
    for origin in fragment.origins or ():
        if isinstance(origin, wiring.Component):
            yield place, origin
        if getattr(origin, "is_closed", False):
            return
    for number, (inner, name, _) in enumerate(fragment.subfragments):
        yield from components_of(inner, (*place, name or f"U${number}"))


def streams_of(component: wiring.Component) -> Iterator[tuple[list[str], Any]]:
    """Yield the streams of a component with the names on the way to them."""
    for path, _, _ in component.signature.flatten(component):
        if path[-1] == "ready":
            port: Any = component
            for part in path[:-1]:
                port = port[part] if isinstance(part, int) else getattr(port, part)
            if isinstance(port, stream.Interface | wiring.FlippedInterface):
                yield [str(part) for part in path[:-1]], port
