"""A counter of words or elements with a registered flag for the last one."""

from __future__ import annotations

from dataclasses import dataclass, replace

from amaranth.hdl import Const, Module, Mux, Signal, Value

from firm_hdl.gateware.positions import any_of, named, pick
from firm_hdl.names.attributes import REMARK

__all__ = ["Counter"]


@dataclass(frozen=True, slots=True)
class _Load:
    """A load: the condition, the number as `value - less`, and the flags `last` and `double`."""

    on: Value
    value: Value | int
    less: Value | int
    last: Value | int
    double: Value | None = None


class Counter:
    """Count words or elements down to the last one. Not a component: logic of one module.

    The number is loaded a cycle after the flags, because a length is read from its memory late. A
    count of the first cycle is still to be subtracted then (`pending`)::

        cycle          | 0          | 1            | 2            | 3
        state          | length 3   | body         | body         | body
        last, double   | 0, 0       |              |              |
        value - less   |            | (old)        | 3            | 2
        pending        |            | 0            | 1            | 1
        down           |            | 1            | 1            | 1
        last           | (old)      | 0            | 0            | 1

    `last` is updated at once, the number one cycle later, so that no wide logic depends on a late
    signal. Call `load`, `preload` and `down` as often as needed, then `add_logic` once.

    * `most`: the largest number that is loaded.
    * `start`: the number after a reset. If `None`, the counter has to be loaded before it counts.
    """

    def __init__(self, most: int, name: str, start: int | None = None):
        bits = max(3, most.bit_length())
        # The number of words or elements left is `value - less - pending`. `pending` is the count
        # of the cycle before, if it is still to be subtracted.
        self.value = Signal(
            bits,
            name=f"{name}_value",
            init=start or 0,
            reset_less=start is None,
            attrs={REMARK: "the number left is value - less - pending"},
        )
        self.less: Value = Const(0, 1)
        # One word or element is left. A register.
        self.last = Signal(
            name=f"{name}_last", init=start in (None, 1), attrs={REMARK: "one is left"}
        )
        self.pending = Signal(
            name=f"{name}_pending",
            reset_less=start is None,
            attrs={REMARK: "a count of the cycle before, not subtracted yet"},
        )
        self.name = name
        self._loads: list[_Load] = []
        self._defaults: list[_Load] = []
        self._downs: list[Value] = []

    def load(self, on: Value, count: int) -> None:
        """Load a constant if `on`; at most one of the conditions of all loads is high."""
        self._loads.append(_Load(on, count, 0, int(count == 1)))

    def preload(
        self,
        on: Value,
        value: Value,
        last: Value,
        double: Value | None = None,
        less: Value | int = 0,
    ) -> None:
        """Load a number in every cycle of the step that begins the loop or run (`on`).

        A constant that is loaded in the same cycle wins. At most one of the conditions is high.

        * `value`, `less`: the number is `value - less`. If `double` is given, both are valid one
          cycle after `on`, `last` and `double`.
        * `last`: the number is 1, if it is not 0.
        * `double`: the number is 2, if it is more than 1.
        """
        self._defaults.append(_Load(on, value, less, last, double))
        if isinstance(less, Value) and isinstance(self.less, Const):
            self.less = Signal(name=f"{self.name}_less")

    def down(self, on: Value) -> None:
        """Count down by one if `on`, unless the counter is loaded."""
        self._downs.append(on)

    def add_logic(self, m: Module) -> None:
        """Add the registers; after all calls of `load`, `preload` and `down`."""
        loads, down = Signal(name=f"{self.name}_loads"), Signal(name=f"{self.name}_down")
        keeps = Signal(name=f"{self.name}_keeps")
        m.d.comb += [
            loads.eq(any_of([load.on for load in self._loads])),
            down.eq(any_of(self._downs)),
            keeps.eq(~loads & ~any_of([load.on for load in self._defaults])),
        ]
        preloads = [
            replace(each, on=named(m, f"{self.name}_preloads_{k}", each.on & ~loads))
            for k, each in enumerate(self._defaults)
        ]
        cases = [*self._loads, *preloads]
        last = [(each.on, each.last) for each in cases]
        next_is_last = self._next_is_last(m, loads)
        stays_last = named(m, f"{self.name}_last_unless_loaded", Mux(down, next_is_last, self.last))
        m.d.sync += [
            self.pending.eq(keeps & down),
            self.last.eq(pick([(keeps, stays_last), *last], 1)),
        ]
        self._load_value(m, loads, preloads)

    def _next_is_last(self, m: Module, loads: Value) -> Value:
        """Return whether one is left after the counter has counted down by one."""
        is_small = Signal(name=f"{self.name}_is_small")
        two, three, four = (Signal(name=f"{self.name}_is_{k}") for k in (2, 3, 4))
        # Two are left if `value - less - pending` is 2. So `value` is 2, 3 or 4, and no subtraction
        # comes before the comparison.
        m.d.comb += is_small.eq(~self.value[3:].any())
        for k, each in enumerate((two, three, four), 2):
            m.d.comb += each.eq(is_small & (self.value[:3] == k))
        by_value = named(
            m,
            f"{self.name}_was_second",
            Mux(self.pending, Mux(self.less, four, three), Mux(self.less, three, two)),
            "two are left before this count",
        )
        delayed = [each for each in self._defaults if each.double is not None]
        if not delayed:
            return by_value
        second, fresh = (
            Signal(name=f"{self.name}_{name}", attrs={REMARK: remark})
            for name, remark in (
                ("second", "of a number that is just loaded: it was 2"),
                ("fresh", "the number is loaded in this cycle, so second counts"),
            )
        )
        m.d.sync += [
            # If `fresh`, the value is still to be loaded, so the flag `double` decides.
            fresh.eq(~loads & any_of([each.on for each in delayed])),
            second.eq(pick([(each.on, each.double) for each in delayed], 1)),
        ]
        return Mux(fresh, second, by_value)

    def _load_value(self, m: Module, loads: Value, preloads: list[_Load]) -> None:
        """Add the logic that loads or decrements the value."""
        value = self.value
        cases = list(self._loads)
        for k, each in enumerate(preloads):
            on = each.on
            if each.double is not None:
                on = Signal(
                    name=f"{self.name}_comes_{k}",
                    attrs={REMARK: "a length that was looked up in the cycle before is loaded"},
                )
                m.d.sync += on.eq(each.on)
                on = named(m, f"{self.name}_takes_{k}", on & ~loads)
            cases.append(replace(each, on=on))
        keeps = named(m, f"{self.name}_value_keeps", ~any_of([each.on for each in cases]))
        counted = (value - self.pending)[: len(value)]
        m.d.sync += value.eq(
            pick([(keeps, counted), *((c.on, c.value) for c in cases)], len(value))
        )
        if isinstance(self.less, Signal):
            m.d.sync += self.less.eq(
                pick([(keeps, self.less), *((c.on, c.less) for c in cases)], 1)
            )
