"""A counter of words or elements that tells a cycle ahead that one is left."""

from __future__ import annotations

from dataclasses import dataclass, replace

from amaranth.hdl import Module, Mux, Signal, Value

from firm_hdl.gateware.positions import any_of, pick

__all__ = ["Counter"]


@dataclass(frozen=True, slots=True)
class _Load:
    """A number that is loaded: when, the number, what it subtracts, and whether it is the last."""

    on: Value
    value: Value | int
    less: Value | int
    last: Value | int
    double: Value | None = None


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
        self._loads: list[_Load] = []
        self._defaults: list[_Load] = []
        self._downs: list[Value] = []

    def load(self, on: Value, count: int) -> None:
        """Load a constant if `on`; at most one of the conditions of all loads is high."""
        self._loads.append(_Load(on, count, 0, int(count == 1)))

    def load_by_default(
        self,
        on: Value,
        value: Value,
        last: Value,
        double: Value | None = None,
        less: Value | int = 0,
    ) -> None:
        """Load a number if `on`, unless a constant is loaded; at most one condition is high.

        Parameters
        ----------
        value, less : Value
            With `double`, they come one cycle after `on`, `last` and `double`.
        last : Value
            The number is 1, if it is not 0.
        double : Value or None
            The number is 2, if it is more than 1.
        """
        self._defaults.append(_Load(on, value, less, last, double))

    def down(self, on: Value) -> None:
        """Count one if `on`, unless the counter is loaded."""
        self._downs.append(on)

    def add_logic(self, m: Module) -> None:
        """Add the registers; after all calls of `load`, `load_by_default` and `down`."""
        loads, down = Signal(name=f"{self.name}_loads"), Signal(name=f"{self.name}_down")
        keeps = Signal(name=f"{self.name}_keeps")
        m.d.comb += [
            loads.eq(any_of([load.on for load in self._loads])),
            down.eq(any_of(self._downs)),
            keeps.eq(~loads & ~any_of([load.on for load in self._defaults])),
        ]
        cases = [*self._loads, *(replace(each, on=each.on & ~loads) for each in self._defaults)]
        last = [(each.on, each.last) for each in cases]
        next_is_last = self._next_is_last(m, loads)
        m.d.sync += [
            self.pending.eq(keeps & down),
            self.last.eq(pick([(keeps, Mux(down, next_is_last, self.last)), *last], 1)),
        ]
        self._load_value(m, loads)

    def _next_is_last(self, m: Module, loads: Value) -> Value:
        """Return whether one is left when the counter has counted one."""
        high = self.value[3:].any()
        two, three, four = (~high & (self.value[:3] == k) for k in (2, 3, 4))
        known = Mux(self.pending, Mux(self.less, four, three), Mux(self.less, three, two))
        late = [each for each in self._defaults if each.double is not None]
        if not late:
            return known
        second, fresh = Signal(name=f"{self.name}_second"), Signal(name=f"{self.name}_fresh")
        m.d.sync += [
            # The number itself comes in this cycle.
            fresh.eq(~loads & any_of([each.on for each in late])),
            second.eq(pick([(each.on, each.double) for each in late], 1)),
        ]
        return Mux(fresh, second, known)

    def _load_value(self, m: Module, loads: Value) -> None:
        """Load or count the number."""
        value = self.value
        cases = list(self._loads)
        for k, each in enumerate(self._defaults):
            on = each.on
            if each.double is not None:
                on = Signal(name=f"{self.name}_comes_{k}")
                m.d.sync += on.eq(each.on & ~loads)
            cases.append(replace(each, on=on & ~loads))
        keeps = ~any_of([each.on for each in cases])
        now = (value - self.pending)[: len(value)]
        m.d.sync += [
            value.eq(pick([(keeps, now), *((c.on, c.value) for c in cases)], len(value))),
            self.less.eq(pick([(keeps, self.less), *((c.on, c.less) for c in cases)], 1)),
        ]
