"""The messages for measuring cycles: random, with short strings and sequences, from a seed."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from firm_hdl.model import Array, FieldType, Message, Primitive, Sequence, String

__all__ = ["STATED", "Stated", "values"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Stated:
    """Parameters of the messages."""

    count: int = 16  # Number of messages that are measured, after a first one that is not.
    # Fewest and most characters of a string; both are limited by the string's bound.
    characters: tuple[int, int] = (4, 10)
    elements: tuple[int, int] = (3, 8)  # Fewest and most elements of a sequence, limited likewise.
    seed: int = 0

    def __str__(self) -> str:
        return (
            f"{self.count} messages, strings of {self.characters[0]} to {self.characters[1]} "
            f"characters, sequences of {self.elements[0]} to {self.elements[1]} elements, "
            f"seed {self.seed}"
        )


STATED = Stated()


def values(message: Message, stated: Stated = STATED) -> Iterator[dict[str, Any]]:
    """Yield values of a message without end; a seed always gives the same values."""
    chance = random.Random(f"{stated.seed} {message.name}")
    while True:
        yield _of_message(message, stated, chance)


def _of_message(message: Message, stated: Stated, chance: random.Random) -> dict[str, Any]:
    return {field.name: _value(field.type, stated, chance) for field in message.fields}


def _value(kind: FieldType, stated: Stated, chance: random.Random) -> Any:
    match kind:
        case Primitive():
            return _number(kind, chance)
        case String():
            length = _length(stated.characters, kind.bound, chance)
            return "".join(chance.choices("abcdefghijklmnopqrstuvwxyz_", k=length))
        case Array():
            return [_value(kind.element, stated, chance) for _ in range(kind.count)]
        case Sequence():
            length = _length(stated.elements, kind.bound, chance)
            return [_value(kind.element, stated, chance) for _ in range(length)]
        case Message():
            return _of_message(kind, stated, chance)


def _length(between: tuple[int, int], bound: int | None, chance: random.Random) -> int:
    least, most = between
    return chance.randint(*(between if bound is None else (min(least, bound), min(most, bound))))


def _number(kind: Primitive, chance: random.Random) -> float:
    if kind.kind == "bool":
        return chance.random() < 0.5
    if kind.kind == "float":
        return chance.random()
    return chance.getrandbits(8 * kind.bytes - kind.signed)
