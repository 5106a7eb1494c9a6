"""What a proof is about: a block, all that its surroundings may do, and claims.

A scene is an Amaranth design. Its inputs are the choices of the surroundings: a solver tries all of
them, in every cycle. Its outputs are the claims, one bit each, which is 1 in a cycle that breaks
the claim. So a claim holds if its output is 0 for ever, and a counterexample is a list of inputs,
which any simulator can play.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from amaranth.hdl import Elaboratable, Module, Mux, ShapeLike, Signal, Value

__all__ = ["Build", "Scene"]

Build: TypeAlias = "Callable[[Scene], None]"
"""Adds a block, its surroundings and its claims to a scene."""


class Scene(Elaboratable):
    """A design with free inputs, and claims as outputs.

    Parameters
    ----------
    build : callable
        Called with the scene when it is elaborated.

    Attributes
    ----------
    m : Module
        Where `build` adds submodules and logic.
    inputs : list of Signal
    claims : dict of str to Signal
        By name of the claim: 1 in a cycle that breaks it, while all that was assumed holds.
    first : Signal
        High in the first cycle.
    is_configured : bool
        Registers without a reset begin with their initial values, as after the configuration of an
        FPGA. Else they begin with any value, as after a reset. `build` may set it.
    """

    def __init__(self, build: Build):
        self.m = Module()
        self.inputs: list[Signal] = []
        self.claims: dict[str, Signal] = {}
        self.first = Signal(init=1, name="first")
        self.is_configured = False
        self._assumed: list[Value] = []
        self._wrong: dict[str, Value] = {}
        build(self)
        self._finish()

    def elaborate(self, platform: object) -> Module:
        return self.m

    @property
    def ports(self) -> list[Signal]:
        """Inputs, then claims."""
        return [*self.inputs, *self.claims.values()]

    def free(self, shape: ShapeLike, name: str) -> Signal:
        """Return a signal that has any value in each cycle."""
        signal = Signal(shape, name=name)
        self.inputs.append(Value.cast(signal))
        return signal

    def rigid(self, shape: ShapeLike, name: str) -> Signal:
        """Return a signal that has any value, the same in each cycle."""
        choice = Value.cast(self.free(shape, f"{name}_choice"))
        kept, value = Signal(len(choice), name=f"{name}_kept"), Signal(shape, name=name)
        self.m.d.comb += Value.cast(value).eq(Mux(self.first, choice, kept))
        self.m.d.sync += kept.eq(value)
        return value

    def was(self, value: Value, name: str) -> Signal:
        """Return the value of the cycle before; 0 in the first one."""
        before = Signal(len(Value.cast(value)), name=f"{name}_before")
        self.m.d.sync += before.eq(value)
        return before

    def assume(self, condition: Value) -> None:
        """Look only at runs in which a condition holds in every cycle up to the present one."""
        self._assumed.append(condition)

    def claim(self, name: str, holds: Value) -> None:
        """Claim that a condition holds in every cycle. Claims of one name are one claim."""
        wrong = ~Value.cast(holds).bool()
        self._wrong[name] = self._wrong[name] | wrong if name in self._wrong else wrong

    def _finish(self) -> None:
        self.m.d.sync += self.first.eq(0)
        allowed: Value | None = None
        if self._assumed:
            kept = Signal(init=1, name="allowed_before")
            allowed = kept
            for condition in self._assumed:
                allowed = allowed & condition
            self.m.d.sync += kept.eq(allowed)
        for name, wrong in self._wrong.items():
            signal = Signal(name=f"claim_{name.replace(' ', '_')}")
            self.m.d.comb += signal.eq(wrong if allowed is None else wrong & allowed)
            self.claims[name] = signal
