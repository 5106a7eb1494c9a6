"""The contract of decoding, restated primitive by primitive over the message model.

It shares only the limits of lengths, and what they claim, with layout and plan. It has no steps
or bus words.
"""

from __future__ import annotations

from typing import Any

from firm_hdl.model import PRIMITIVES, Array, Message, Primitive, Sequence, String
from firm_hdl.plan import Payload, Plan

__all__ = ["Reference"]

LENGTH = PRIMITIVES["ros2"]["uint32"]
OCTET = PRIMITIVES["ros2"]["uint8"]


class Reference:
    """Decode a packet.

    Attributes
    ----------
    transfers : list of (path, payload)
        In wire order.
    status : str
    gaps : list of (path, bytes)
        The padding before each primitive, or of each first item.
    """

    def __init__(self, plan: Plan, message: Message, packet: bytes):
        self.cdr = plan.wire == "cdr"
        self.packet = packet
        self.lanes = {str(leaf): leaf.lanes for leaf in plan.leaves}
        self.limits = {str(plan.leaves[n]): length.limit for n, length in plan.lengths.items()}
        self.charges = {str(plan.leaves[n]): length.charge for n, length in plan.lengths.items()}
        self.budget = 0
        self.position = 0
        self.status = "OK"
        self.transfers: list[tuple[str, Payload]] = []
        self.gaps: list[tuple[tuple[str, ...], int]] = []
        if self.cdr:
            self.header()
        self.message(message, ())
        if self.status == "OK" and len(packet) - self.position > (3 if self.cdr else 0):
            self.status = "TRAILING"

    def header(self) -> None:
        for index, expected in enumerate((0, 1, None, None)):
            if self.status == "OK" and len(self.packet) <= index:
                self.status = "TRUNCATED"
            elif self.status == "OK" and expected not in (None, self.packet[index]):
                self.status = "ENCAPSULATION"
        self.position = 4

    def read(self, item: Primitive) -> int:
        """Return a primitive's value, 0 if it is missing or after an error."""
        if self.status != "OK":
            return 0
        end = self.position + item.bytes
        if end > len(self.packet):
            self.status = "TRUNCATED"
            return 0
        data = self.packet[self.position : end]
        self.position = end
        if item.kind == "bool":
            return int(data != b"\0")
        return int.from_bytes(data, "little", signed=item.signed and item.kind == "int")

    def align(self, item: Primitive, path: tuple[str, ...]) -> None:
        # The 4 bytes of the header do not count.
        gap = -(self.position - 4) % item.bytes if self.cdr else 0
        self.gaps.append((path, gap))
        self.position += gap

    def send(self, path: tuple[str, ...], payload: Payload) -> None:
        self.transfers.append((".".join(path), payload))

    def scalar(self, item: Primitive, path: tuple[str, ...]) -> None:
        self.align(item, path)
        self.send(path, self.read(item))

    def message(self, message: Message, path: tuple[str, ...]) -> None:
        if not message.fields and self.cdr:
            self.scalar(OCTET, (*path, "structure_needs_at_least_one_member"))
        elif not message.fields:
            self.send((*path, "trigger"), 1)
        for item in message.fields:
            self.field(item.type, (*path, item.name))

    def field(self, kind: Any, path: tuple[str, ...]) -> None:
        match kind:
            case Primitive():
                self.scalar(kind, path)
            case Message():
                self.message(kind, path)
            case String(wide=wide):
                terminated = self.cdr and not wide
                count, nul = self.length(path, terminated)
                self.items(LENGTH if wide else OCTET, count, path, aligned=not wide)
                if nul and self.read(OCTET) != 0:
                    self.status = "STRING"
            case Array(element=element, count=count):
                self.elements(element, count, path)
            case Sequence(element=element):
                count, _ = self.length(path, False)
                self.elements(element, count, path)

    def elements(self, element: Any, count: int, path: tuple[str, ...]) -> None:
        if isinstance(element, Primitive):
            self.items(element, count, path)
            return
        for _ in range(count):
            self.field(element, (*path, "item"))

    def length(self, path: tuple[str, ...], terminated: bool) -> tuple[int, bool]:
        path = (*path, "length")
        self.align(LENGTH, path)
        wire = self.read(LENGTH)
        count = max(0, wire - 1) if terminated else wire
        if count > self.limits[".".join(path)] or not self.pay(path, wire):
            self.status = "LENGTH"
            wire = count = 0
        self.send(path, count)
        return count, terminated and wire > 0

    def pay(self, path: tuple[str, ...], wire: int) -> bool:
        """Take what a nested length claims from the budget; return whether the budget suffices."""
        charge = self.charges[".".join(path)]
        if charge is None:
            return True
        if charge.budget is not None:
            self.budget = charge.budget
        if wire >= charge.charged_from:
            self.budget -= wire * charge.bytes - charge.padding_credit
        return self.budget >= 0

    def items(
        self, item: Primitive, count: int, path: tuple[str, ...], *, aligned: bool = True
    ) -> None:
        path = (*path, "items")
        if count and aligned:
            self.align(item, path)
        numbers = [self.read(item) for _ in range(count)]
        lanes = self.lanes[".".join(path)]
        for first in range(0, count, lanes):
            word = numbers[first : first + lanes]
            word += [0] * (lanes - len(word))
            self.send(path, (tuple(word), first + lanes >= count))
