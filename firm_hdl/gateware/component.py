"""The base class of components that users construct."""

from __future__ import annotations

from typing import Any, TypeVar

from amaranth.lib import wiring

__all__ = ["Component"]


Self = TypeVar("Self", bound="Component")


class Component(wiring.Component):
    """A component of Amaranth that is not missed if its constructor raises.

    Amaranth warns of each component that was made and never elaborated. A constructor calls
    `__init__` of this class last, and only a component that was made so far has to be used.
    """

    is_closed = True
    """What is inside is firm-hdl's own: checks of a user's connections end here."""

    def __new__(cls: type[Self], *args: Any, src_loc_at: int = 0, **options: Any) -> Self:
        self: Self = super().__new__(cls, src_loc_at=src_loc_at + 1)
        self._MustUse__used = True
        return self

    def __init__(self, signature: Any) -> None:
        super().__init__(signature, src_loc_at=1)
        self._MustUse__used = False
