"""What a proof is about: a block, all that its surroundings may do, and claims.

A scene is an Amaranth design. Its inputs are the choices of the surroundings: a solver tries all of
them, in every cycle. Its outputs are the claims, one bit each, which is 1 in a cycle that breaks
the claim. So a claim holds if its output is 0 for ever, and a counterexample is a list of inputs,
which any simulator can play.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from types import FrameType, SimpleNamespace
from typing import Any, TypeAlias

from amaranth.hdl import Cat, Elaboratable, Fragment, Module, Mux, ShapeLike, Signal, Value

__all__ = ["Build", "Scene"]

STARTS = "starts_"
"""Begin of the names of registers of the scene itself, which begin with their values."""

Build: TypeAlias = "Callable[[Scene], None]"
"""Adds a block, its surroundings and its claims to a scene."""


class Scene(Elaboratable):
    """A design with free inputs, and claims as outputs.

    Parameters
    ----------
    build : callable
        Called with the scene when it is elaborated.
    is_step : bool
        The step of an induction: runs begin in any state in which a claim holds.

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

    def __init__(self, build: Build, *, is_step: bool = False):
        self.m, self.is_step = Module(), is_step
        self.inputs: list[Signal] = []
        self.claims: dict[str, Signal] = {}
        self.first = Signal(init=1, name=f"{STARTS}first")
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

    def inside(self, block: Elaboratable) -> dict[str, Any]:
        """Add a block. Return the local names of `elaborate`, of it and its parts, by class.

        The name ``is_in`` stands for a function: whether the state machine is in
        one of states; without any, whether it is in any.
        """
        found: dict[str, Any] = {}

        def watch(frame: FrameType, event: str, _: object) -> None:
            if event == "return" and frame.f_code.co_name == "elaborate":
                names = SimpleNamespace(**frame.f_locals)
                found[type(names.self).__name__] = names

        sys.setprofile(watch)
        try:
            self.m.submodules.block = Fragment.get(block, None)
        finally:
            sys.setprofile(None)
        for names in found.values():
            if fsm := getattr(getattr(names, "m", None), "_generated", {}).get("fsm"):
                names.is_in = partial(_is_in, fsm)
        return found

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
            kept = Signal(init=1, name=f"{STARTS}allowed_before")
            allowed = kept
            for condition in self._assumed:
                allowed = allowed & condition
            self.m.d.sync += kept.eq(allowed)
        for number, (name, wrong) in enumerate(self._wrong.items()):
            signal = Signal(name=f"claim_{name.replace(' ', '_')}")
            if self.is_step:
                held = Signal(name=f"{STARTS}{number}")
                self.m.d.sync += held.eq(self.first & ~wrong)
                wrong = wrong & held
            self.m.d.comb += signal.eq(wrong if allowed is None else wrong & allowed)
            self.claims[name] = signal


def _is_in(fsm: Any, *states: str) -> Value:
    return Cat(fsm.state == fsm.encoding[state] for state in states or fsm.encoding).any()
