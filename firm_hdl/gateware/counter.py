"""A counter of words or elements that tells a cycle ahead that one is left."""

from __future__ import annotations

from amaranth.hdl import Module, Mux, Signal, Value

from firm_hdl.gateware.positions import any_of, pick

__all__ = ["Counter"]


class Counter:
    """Count words or elements down to the last one. Not a component: logic of one module.

    The number itself follows a cycle later, so that nothing wide depends on a late decision.
    Its users say when it is loaded and when it counts, and then :meth:`add_logic`.

    Parameters
    ----------
    most : int
        The largest number that is loaded.
    start : int or None
        The number after a reset. Without one, the counter is loaded before it counts.

    Attributes
    ----------
    value, less : Signal
        `value - less` words or elements are left, of which one is subtracted if `pending`.
    last : Signal
        One is left.
    """

    def __init__(self, most: int, name: str, start: int | None = None):
        bits = max(3, most.bit_length())
        self.value = Signal(bits, name=f"{name}_value", init=start or 0, reset_less=start is None)
        self.less = Signal(name=f"{name}_less")
        self.last = Signal(name=f"{name}_last", init=start in (None, 1))
        self.pending = Signal(name=f"{name}_pending", reset_less=start is None)
        self.name = name
        self._loads: list[tuple[Value, Value | int, Value | int, Value | int]] = []
        self._defaults: list[tuple[Value, Value | int, Value | int, Value | int]] = []
        self._downs: list[Value] = []

    def load(self, on: Value, count: int) -> None:
        """Load a constant if `on`; at most one of the conditions of all loads is high."""
        self._loads.append((on, count, int(count == 1), 0))

    def load_by_default(
        self, on: Value, value: Value, last: Value, less: Value | int = 0
    ) -> None:
        """Load a number if `on`, unless a constant is loaded; at most one condition is high.

        Parameters
        ----------
        last : Value
            The number minus `less` is 1, if it is not 0.
        """
        self._defaults.append((on, value, last, less))

    def down(self, on: Value) -> None:
        """Count one if `on`, unless the counter is loaded."""
        self._downs.append(on)

    def add_logic(self, m: Module) -> None:
        value, pending = self.value, self.pending
        loads, holds, down = (
            Signal(name=f"{self.name}_{name}") for name in ("loads", "holds", "down")
        )
        m.d.comb += [
            loads.eq(any_of([on for on, *_ in self._loads])),
            holds.eq(~loads & ~any_of([on for on, *_ in self._defaults])),
            down.eq(any_of(self._downs)),
        ]
        cases = [*self._loads, *((on & ~loads, *rest) for on, *rest in self._defaults)]
        high = value[3:].any()
        two, three, four = (~high & (value[:3] == k) for k in (2, 3, 4))
        next_is_last = Mux(pending, Mux(self.less, four, three), Mux(self.less, three, two))
        now = (value - pending)[: len(value)]
        m.d.sync += [
            pending.eq(holds & down),
            value.eq(pick([(holds, now), *((on, count) for on, count, _, _ in cases)], len(value))),
            self.last.eq(
                pick(
                    [
                        (holds, Mux(down, next_is_last, self.last)),
                        *((on, last) for on, _, last, _ in cases),
                    ],
                    1,
                )
            ),
            self.less.eq(pick([(holds, self.less), *((on, less) for on, *_, less in cases)], 1)),
        ]

