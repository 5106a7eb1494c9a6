"""The base class of components that users construct."""

from __future__ import annotations

from typing import Any

from amaranth.lib import wiring

__all__ = ["Component"]


class Component(wiring.Component):
    """A component of Amaranth that is not missed if its constructor raises.

    Amaranth warns of each component that was made and never elaborated. A constructor calls
    `__init__` of this class last, and only a component that was made so far has to be used.
    """

    def __new__(cls, *args: Any, src_loc_at: int = 0, **options: Any) -> Any:
        self = super().__new__(cls, src_loc_at=src_loc_at + 1)
        self._MustUse__used = True
        return self

    def __init__(self, signature: Any) -> None:
        super().__init__(signature, src_loc_at=1)
        self._MustUse__used = False
