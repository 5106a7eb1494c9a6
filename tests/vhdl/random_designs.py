"""Random Amaranth designs with every operator, statement, memory and clock domain of the language.

A design depends on its seed only. Its signals form layers: a combinational signal reads signals of
earlier layers, so that there are no combinational loops. Registers are read anywhere.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from amaranth.hdl import (
    Array,
    Cat,
    ClockDomain,
    Const,
    Elaboratable,
    Module,
    Mux,
    Shape,
    Signal,
    Value,
    signed,
    unsigned,
)
from amaranth.lib.memory import Memory

__all__ = ["DOMAINS", "RandomDesign"]

DOMAINS = ("sync", "neg", "areset", "free", "drop")
"""Rising edge; falling edge; asynchronous reset; each edge without reset."""

_NAMES = (
    "type range signal a A x__y _z q_ resize clk_2 value unsigned rtl top work p_sync count next "
    "a.b data[0] choice_1 true in"
).split()
_MAX_WIDTH = 70


@dataclass(eq=False)
class RandomDesign(Elaboratable):
    """A random design.

    Attributes
    ----------
    inputs, outputs : list of Signal
        Ports; the inputs include clocks and resets.
    clocks : list of Signal
    """

    seed: int
    size: int = 12
    inputs: list[Signal] = field(default_factory=list)
    outputs: list[Signal] = field(default_factory=list)
    clocks: list[Signal] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._random = random.Random(self.seed)
        self._pool: list[Value] = []
        self._names = list(_NAMES)
        self._random.shuffle(self._names)
        self.domains = {
            name: ClockDomain(
                name,
                clk_edge="neg" if name in ("neg", "drop") else "pos",
                async_reset=name == "areset",
                reset_less=name in ("free", "drop"),
            )
            for name in DOMAINS
        }
        for domain in self.domains.values():
            self.clocks.append(domain.clk)
            self.inputs.append(domain.clk)
            if domain.rst is not None:
                self.inputs.append(domain.rst)
        for _ in range(self._random.randint(2, 5)):
            self.inputs.append(self._signal("i"))
            self._pool.append(self.inputs[-1])
        self._module = self._build()

    @property
    def ports(self) -> list[Signal]:
        """The inputs and the outputs."""
        return [*self.inputs, *self.outputs]

    def elaborate(self, platform: object) -> Module:
        """Return the module."""
        return self._module

    def _build(self) -> Module:
        tree = [Module()]
        for name, domain in self.domains.items():
            setattr(tree[0].domains, name, domain)
        for index in range(self._random.randint(0, 3)):
            child = Module()
            parent = self._random.choice(tree)
            setattr(
                parent.submodules, self._random.choice(["core", "unit", "Sub"]) + str(index), child
            )
            tree.append(child)
        registers = [
            (self._signal("r", domain=domain), domain)
            for domain in self._random.choices(DOMAINS, k=self._random.randint(1, self.size // 2))
        ]
        self._pool += [register for register, _ in registers]
        kinds: list[Callable[[Module], None]] = [self._memory, self._fsm]
        kinds += [self._combinational] * self.size
        self._random.shuffle(kinds)
        for kind in kinds[: self.size]:
            kind(self._random.choice(tree))
        for register, domain in registers:
            self._drive(self._random.choice(tree), domain, register)
        inputs = {id(signal) for signal in self.inputs}
        for index, value in enumerate(v for v in self._pool if id(v) not in inputs):
            output = Signal(value.shape(), name=f"o{index}")
            tree[0].d.comb += output.eq(value)
            self.outputs.append(output)
        return tree[0]

    def _shape(self) -> Shape:
        width = self._random.choice([0, 1, 1, 1, 2, 3, 4, 5, 8, 9, 16, 31, 32, 33, 40])
        return signed(width) if width and self._random.random() < 0.4 else unsigned(width)

    def _signal(self, prefix: str, shape: Shape | None = None, domain: str = "comb") -> Signal:
        shape = self._shape() if shape is None else shape
        name = f"{prefix}{len(self._pool)}"
        if prefix != "i" and self._names and self._random.random() < 0.3:
            name = self._names.pop()
        init = self._random.getrandbits(shape.width) if shape.width else 0
        if shape.signed and init >> (shape.width - 1):
            init -= 1 << shape.width
        # When an asynchronous reset rises, Amaranth 0.5.10's simulator clocks memories, and
        # signals without reset; its netlist does not.
        reset_less = domain != "areset" and self._random.random() < 0.2
        return Signal(shape, name=name, init=init, reset_less=reset_less)

    def _leaf(self) -> Value:
        if self._random.random() < 0.2:
            shape = self._shape()
            return Const(self._random.getrandbits(41) - (1 << 40), shape)
        return self._random.choice(self._pool)

    def _expression(self, depth: int = 3) -> Value:
        if depth == 0 or self._random.random() < 0.15:
            return self._leaf()
        choice = self._random.choice(_OPERATORS)
        value = choice(self, depth - 1)
        if len(value) > _MAX_WIDTH:
            value = value[: self._random.randint(1, _MAX_WIDTH)]
        return value

    def _matches(self, depth: int) -> Value:
        value = self._narrow(depth, 6)
        return value.matches(*(self._pattern(value) for _ in range(self._random.randint(0, 3))))

    def _selectable(self, depth: int) -> Value:
        """Return a value that a part may be selected of.

        Beyond the top bit of an operator's result, Amaranth 0.5.10's simulator reads the bits of
        Python's integer, and its netlist reads zeros.
        """
        return self._leaf() if self._random.random() < 0.5 else Cat(self._expression(depth))

    def _narrow(self, depth: int, width: int) -> Value:
        return self._expression(depth)[:width]

    def _condition(self) -> Value:
        value = self._expression(1)
        # Amaranth warns of signed conditions.
        return value.bool() if value.shape().signed else value

    def _combinational(self, module: Module) -> None:
        signal = self._signal("c")
        self._drive(module, "comb", signal)
        self._pool.append(signal)

    def _drive(self, module: Module, domain: str, target: Signal) -> None:
        for _ in range(self._random.randint(1, 2)):
            self._statement(module, domain, target, 2)

    def _statement(self, module: Module, domain: str, target: Signal, depth: int) -> None:
        kind = self._random.random()
        if depth == 0 or kind < 0.4:
            module.d[domain] += self._assignment(target)
        elif kind < 0.7:
            with module.If(self._condition()):
                self._statement(module, domain, target, depth - 1)
            if self._random.random() < 0.5:
                with module.Elif(self._condition()):
                    self._statement(module, domain, target, depth - 1)
            if self._random.random() < 0.5:
                with module.Else():
                    self._statement(module, domain, target, depth - 1)
        else:
            self._switch(module, domain, target, depth)

    def _switch(self, module: Module, domain: str, target: Signal, depth: int) -> None:
        selector = self._narrow(1, self._random.randint(1, 4))
        with module.Switch(selector):
            for _ in range(self._random.randint(1, 5)):
                patterns = [self._pattern(selector) for _ in range(self._random.randint(1, 2))]
                with module.Case(*patterns):
                    if self._random.random() < 0.9:
                        self._statement(module, domain, target, depth - 1)
            if self._random.random() < 0.5:
                with module.Default():
                    self._statement(module, domain, target, depth - 1)

    def _pattern(self, selector: Value) -> str | int:
        width = len(selector)
        if self._random.random() < 0.5 or not width:
            return "".join(self._random.choice("01-") for _ in range(width))
        value = self._random.getrandbits(width)
        if selector.shape().signed and value >> (width - 1):
            value -= 1 << width
        return value

    def _assignment(self, target: Signal) -> Any:
        value = self._expression()
        kind = self._random.random()
        width = len(target)
        if kind < 0.6 or width < 2:
            return target.eq(value)
        if kind < 0.75:
            low = self._random.randrange(width)
            return target[low : self._random.randint(low, width)].eq(value)
        if kind < 0.85:
            return target.bit_select(self._narrow(1, 6), self._random.randint(1, width)).eq(value)
        if kind < 0.95:
            return target.word_select(self._narrow(1, 3), self._random.randint(1, width)).eq(value)
        middle = self._random.randrange(1, width)
        return Array([target[:middle], target[middle:]])[self._narrow(1, 2)].eq(value)

    def _memory(self, module: Module) -> None:
        width, depth = self._random.choice([1, 4, 8, 12]), self._random.choice([1, 2, 3, 6, 8, 9])
        shape = signed(width) if self._random.random() < 0.2 else unsigned(width)
        low = -(1 << width - 1) if shape.signed else 0
        count = self._random.randint(0, depth)
        init = [low + self._random.getrandbits(width) for _ in range(count)]
        memory = Memory(shape=shape, depth=depth, init=init)
        module.submodules += memory
        # Amaranth 0.5.10's simulator resets read ports; its netlist does not.
        domain = self._random.choice(["free", "drop"])
        writes = []
        for _ in range(self._random.randint(0, 2)):
            granularity = None
            if not shape.signed and self._random.random() < 0.5:
                granularity = self._random.choice([n for n in (1, 2, 4, 8) if width % n == 0])
            port = memory.write_port(domain=domain, granularity=granularity)
            module.d.comb += [
                port.en.eq(self._expression(1)),
                port.addr.eq(self._expression(1)),
                Value.cast(port.data).eq(self._expression(1)),
            ]
            writes.append(port)
        for _ in range(self._random.randint(1, 2)):
            place = self._random.choice(["comb", domain, domain, "free"])
            transparent = [w for w in writes if place == domain and self._random.random() < 0.5]
            read = memory.read_port(domain=place, transparent_for=transparent)
            module.d.comb += read.addr.eq(self._expression(1))
            if place != "comb":
                module.d.comb += read.en.eq(self._expression(1))
            signal = self._signal("m", shape)
            module.d.comb += signal.eq(read.data)
            self._pool.append(signal)

    def _fsm(self, module: Module) -> None:
        domain = self._random.choice(DOMAINS[:3])
        signal = self._signal("f")
        states = [f"S{i}" for i in range(self._random.randint(2, 5))]
        with module.FSM(domain=domain, name=f"fsm{len(self._pool)}"):
            for state in states:
                with module.State(state):
                    module.d.comb += self._assignment(signal)
                    with module.If(self._condition()):
                        module.next = self._random.choice(states)
                    with module.Elif(self._condition()):
                        module.next = self._random.choice(states)
        self._pool.append(signal)


_OPERATORS: list[Callable[[RandomDesign, int], Value]] = [
    lambda d, n: d._expression(n) + d._expression(n),
    lambda d, n: d._expression(n) - d._expression(n),
    lambda d, n: d._expression(n) * d._expression(n),
    lambda d, n: d._expression(n) // d._expression(n),
    lambda d, n: d._expression(n) % d._expression(n),
    lambda d, n: -d._expression(n),
    lambda d, n: +d._expression(n),
    lambda d, n: ~d._expression(n),
    lambda d, n: abs(d._expression(n)),
    lambda d, n: d._expression(n) & d._expression(n),
    lambda d, n: d._expression(n) | d._expression(n),
    lambda d, n: d._expression(n) ^ d._expression(n),
    lambda d, n: d._expression(n) == d._expression(n),
    lambda d, n: d._expression(n) != d._expression(n),
    lambda d, n: d._expression(n) < d._expression(n),
    lambda d, n: d._expression(n) <= d._expression(n),
    lambda d, n: d._expression(n) > d._expression(n),
    lambda d, n: d._expression(n) >= d._expression(n),
    lambda d, n: d._expression(n) << d._narrow(n, d._random.randint(1, 5)),
    lambda d, n: d._expression(n) >> d._expression(n).as_unsigned(),
    lambda d, n: d._expression(n).shift_left(d._random.randint(0, 9)),
    lambda d, n: d._expression(n).shift_right(d._random.randint(0, 9)),
    lambda d, n: d._expression(n).rotate_left(d._random.randint(0, 9)),
    lambda d, n: d._expression(n).any(),
    lambda d, n: d._expression(n).all(),
    lambda d, n: d._expression(n).xor(),
    lambda d, n: d._expression(n).bool(),
    lambda d, n: Mux(d._expression(n), d._expression(n), d._expression(n)),
    lambda d, n: Cat(d._expression(n), d._expression(n), d._leaf()),
    lambda d, n: d._expression(n).replicate(d._random.randint(0, 3)),
    lambda d, n: Cat(d._expression(n), d._leaf(), Const(1, 1)).as_signed(),
    lambda d, n: d._expression(n).as_unsigned(),
    lambda d, n: d._expression(n)[d._random.randint(0, 4) : d._random.randint(5, 20)],
    lambda d, n: d._selectable(n).bit_select(
        d._expression(n).as_unsigned(), d._random.randint(0, 9)
    ),
    lambda d, n: d._selectable(n).word_select(d._narrow(n, 4), d._random.randint(1, 9)),
    lambda d, n: Array(d._expression(n) for _ in range(d._random.randint(1, 5)))[d._narrow(n, 3)],
    lambda d, n: d._matches(n),
]
