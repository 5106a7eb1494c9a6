"""Progress within a step: leaves are served in wire order, each as soon as it can be.

A step may touch several leaves in one cycle. It must not insist on that: a consumer may hold one
leaf until it has seen an earlier one, a producer may offer one only when the earlier one was
taken. So each leaf of a step has a slot, slots are served in order, and those that were are
remembered until the step completes.
"""

from __future__ import annotations

from amaranth.hdl import Const, Module, Signal, Value

__all__ = ["Slots"]


class Slots:
    """Slots of the steps of a converter. Not a component: logic for one module.

    Parameters
    ----------
    count : int
        Most leaves that a step touches.

    Attributes
    ----------
    able : list of Signal
        Set by the user, per slot: whether the leaf can be served now. Slots that a step does not
        use stay 1.
    go : list of Signal
        Per slot: serve the leaf in this cycle.
    all_served : Signal
        Every slot was served or is being served.
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
            Whether leaves can be served at all.
        complete : Value
            Whether the step completes in this cycle; implies `all_served`.
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
