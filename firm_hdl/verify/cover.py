"""Which types are worth testing: a small set with everything in it that the whole set has.

Features of a type are the constructs of its plan and of its definition. The subset is chosen
greedily: each time the type that adds most, the cheaper of two; that is within a logarithmic factor
of the smallest set (Chvatal, 1979), and the same on every run.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from firm_hdl.model import Array, Field, Message, Primitive, Sequence, Text
from firm_hdl.plan import Plan
from firm_hdl.plan.shape import constructs

__all__ = ["Chosen", "choose", "features"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Chosen:
    """A type of a covering set.

    Attributes
    ----------
    name : str
    adds : tuple of str
        The features that no type chosen before has.
    """

    name: str
    adds: tuple[str, ...]


def features(message: Message, plan: Plan) -> frozenset[str]:
    """Name what a type is made of: in its definition and in its plan."""
    found = set(constructs(plan))
    pending = [message]
    seen = {message.name}
    while pending:
        current = pending.pop()
        found.update(_own(current))
        for child in current.children:
            if child.name not in seen:
                seen.add(child.name)
                pending.append(child)
    return frozenset(found)


def _own(message: Message) -> Iterator[str]:
    if not message.fields:
        yield "empty message"
    for constant in message.constants:
        yield f"constant {constant.type if isinstance(constant.type, Primitive) else 'string'}"
    for item in message.fields:
        yield from _field(item)


def _field(item: Field) -> Iterator[str]:
    kind = item.type
    if item.default is not None:
        yield f"default of {_kind(kind.element if isinstance(kind, Array | Sequence) else kind)}"
    match kind:
        case Array():
            yield f"array of {_kind(kind.element)}"
        case Sequence():
            bound = "" if kind.bound is None else "bounded "
            yield f"{bound}sequence of {_kind(kind.element)}"
        case _:
            yield f"field {_kind(kind)}"


def _kind(kind: Primitive | Text | Message) -> str:
    match kind:
        case Primitive():
            return kind.name
        case Text():
            bound = "" if kind.bound is None else "bounded "
            return f"{bound}{'wstring' if kind.wide else 'string'}"
        case _:
            return "message" if kind.fields else "empty message"


def choose(types: Mapping[str, Iterable[str]], costs: Mapping[str, float]) -> list[Chosen]:
    """Choose types that together have every feature.

    Parameters
    ----------
    types : mapping of str to iterable of str
        Features by name of type.
    costs : mapping of str to float
        What each costs to test, above zero: of types that add equally much per cost, the first by
        name is taken.
    """
    left = {name: set(found) for name, found in types.items()}
    missing = set().union(*left.values()) if left else set()
    chosen = []
    while missing:
        best = min(left, key=lambda name: (-len(left[name]) / costs[name], name))
        adds = left.pop(best)
        chosen.append(Chosen(name=best, adds=tuple(sorted(adds))))
        missing -= adds
        for found in left.values():
            found -= adds
    return chosen
