"""rosbags as the oracle of types with wide text, which it does not have.

A `wstring` of today's ROS 2 middlewares is a count and that many numbers of four bytes. A message
whose only field is a sequence of ``uint32`` has the same bytes. So rosbags gets such a message in
place of a wstring. Fast CDR, which supports wstring, confirms that the bytes are those of a wstring
(:mod:`firm_hdl.verify.ts3.confirm`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from firm_hdl.cases.oracle import RosbagsOracle, Transfers
from firm_hdl.model import FieldType, Message, String, type_text

__all__ = ["STAND_IN_NOTE", "WIDE_MEMBER", "WideOracle", "fit_units", "stand_in_type", "stand_ins"]

WIDE_MEMBER = "units_of_wide_text"
"""The member of the message that stands for a wide text."""

STAND_IN_NOTE = "rosbags has no wstring, and was given a message of numbers in its place"

_PACKAGE = "firm_hdl_wide"


def stand_in_type(kind: FieldType, text: String) -> str:
    """Return the type that replaces a wide text, or an array or a sequence of wide texts."""
    return type_text(kind, f"{_PACKAGE}/{_base_name(text)}")


def stand_ins(messages: Iterable[Message]) -> dict[str, str]:
    """Return definitions of the types that replace wide texts in messages, by rosbags' names."""
    found: dict[str, str] = {}
    for message in messages:
        for item in message.fields:
            kind = item.element_type
            if isinstance(kind, String) and kind.wide:
                bound = "" if kind.bound is None else f"<={kind.bound}"
                found[f"{_PACKAGE}/msg/{_base_name(kind)}"] = f"uint32[{bound}] {WIDE_MEMBER}\n"
    return found


def _base_name(text: String) -> str:
    return "Text" if text.bound is None else f"Text{text.bound}"


class WideOracle(RosbagsOracle):
    """rosbags with messages of numbers for wide texts."""

    __slots__ = ()

    def write(self, value: object, name: str, wire: str) -> bytes:
        """Serialize an object, after its numbers were made units of wide text by `fit_units`."""
        return super().write(_fitted(value), name, wire)

    def transfers(self, value: object, name: str, wire: str, bus_bytes: int) -> Transfers:
        """Return what the leaves of a deserializer transfer for an object."""
        found = super().transfers(value, name, wire, bus_bytes)
        return {
            tuple(part for part in path if part != WIDE_MEMBER): items
            for path, items in found.items()
        }


def fit_units(numbers: Any) -> Any:
    """Map numbers to units of 16 bits that are not NUL, because a NUL would end the text."""
    return numbers % 0xFFFF + 1


def _fitted(value: Any) -> Any:
    members = {}
    for name, member in vars(value).items():
        if name == WIDE_MEMBER:
            members[name] = fit_units(member)
        elif isinstance(member, list):
            members[name] = [_fitted(each) if _is_message(each) else each for each in member]
        elif _is_message(member):
            members[name] = _fitted(member)
    return replace(value, **members)


def _is_message(value: Any) -> bool:
    return hasattr(value, "__dataclass_fields__")
