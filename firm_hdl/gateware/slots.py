"""Progress within a step: leaves are served in wire order, each as soon as it can be.

A step may touch several leaves in one cycle, but it must not require that. A consumer may take one
leaf only after an earlier one, and a producer may offer one only after the earlier one was taken.
So each leaf of a step has a slot. Slots are served in order, and each keeps until the end of the
step whether it was served.
"""

from __future__ import annotations

from amaranth.hdl import Const, Module, Signal, Value

__all__ = ["Slots"]


class Slots:
    """Slots of the steps of a converter. Not a component: logic for one module.

    Parameters
    ----------
    count : int
        Most leaves of one step.

    Attributes
    ----------
    able : list of Signal
        Set by the user, per slot: the leaf can be served in this cycle. Slots that a step does not
        use stay 1.
    go : list of Signal
        Per slot: the leaf is served in this cycle.
    all_served : Signal
        Every slot has been served or is served in this cycle.
    fresh : Signal
        No slot was served before this cycle.
    """

    def __init__(self, count: int):
        self.able = [Signal(name=f"able_{k}", init=1) for k in range(count)]
        self.go = [Signal(name=f"go_{k}") for k in range(count)]
        self.served = [Signal(name=f"served_{k}") for k in range(count)]
        self.all_served = Signal()
        self.fresh = Signal()

    def add_logic(self, m: Module, enable: Value, complete: Value) -> None:
        """Connect the slots.

        Parameters
        ----------
        enable : Value
            High if leaves can be served in this cycle.
        complete : Value
            High if the step completes in this cycle; implies `all_served`.
        """
        before: Value = Const(1)
        for k, (able, go, served) in enumerate(zip(self.able, self.go, self.served, strict=True)):
            m.d.comb += go.eq(enable & ~served & before & able)
            reached = Signal(name=f"reached_{k}")
            m.d.comb += reached.eq(before & (served | able))
            before = reached
            m.d.sync += served.eq((served | go) & ~complete)
        m.d.comb += [
            self.all_served.eq(before),
            self.fresh.eq(~self.served[0] if self.served else 1),
        ]
