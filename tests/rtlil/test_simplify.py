"""A simplified module is equivalent to the original, for all values of its inputs.

The reference runs statements one by one, in the order that RTLIL defines.
"""

from __future__ import annotations

import random
from itertools import product
from types import MappingProxyType

import pytest

from firm_hdl.rtlil.ir import (
    Assign,
    Bits,
    Case,
    Cell,
    Module,
    Process,
    Slice,
    Spec,
    Statement,
    Switch,
    Wire,
    spec_width,
)
from firm_hdl.rtlil.simplify import simplified
from tests.depth import by_depth
from tests.rtlil.test_evaluate import value_of

INPUTS = {"s": 3, "t": 2}
WIDTHS = {**INPUTS, "$k": 3, "y": 4, "z": 4}
Values = dict[str, int]


def run(body: tuple[Statement, ...], values: Values) -> None:
    for statement in body:
        if isinstance(statement, Assign):
            given = value_of(statement.value, values)
            for chunk in statement.target:
                assert isinstance(chunk, Slice)
                mask = (1 << chunk.width) - 1
                rest = values.get(chunk.wire, 0) & ~(mask << chunk.low)
                values[chunk.wire] = rest | (given & mask) << chunk.low
                given >>= chunk.width
        else:
            width = spec_width(statement.selector)
            bits = f"{value_of(statement.selector, values):0{width}b}" if width else ""
            for case in statement.cases:
                if not case.patterns or any(fits(each, bits) for each in case.patterns):
                    run(case.body, values)
                    break


def fits(pattern: str, bits: str) -> bool:
    assert len(pattern) == len(bits)
    return all(mark in ("-", bit) for mark, bit in zip(pattern, bits, strict=True))


def settled(module: Module, inputs: Values) -> Values:
    """Run processes and connections until nothing changes; return the named wires."""
    values = {**dict.fromkeys(WIDTHS, 0), **inputs}
    for _ in range(6):
        for item in module.items:
            assert isinstance(item, Process)
            run(item.body, values)
        for target, value in module.connections:
            run((Assign(target=target, value=value),), values)
    return {name: value for name, value in values.items() if not name.startswith("$")}


def module_of(*items: Process | Cell, **wires: Wire) -> Module:
    own_wires = {
        name: Wire(name=name, width=width, signed=False, direction=None, attributes={})
        for name, width in WIDTHS.items()
    }
    return Module(
        name="m",
        attributes={},
        wires={**own_wires, **wires},
        memories={},
        items=items,
        connections=(),
    )


def process(*body: Statement) -> Process:
    return Process(name="p", body=body, line=1)


class Maker:
    """Random statements that drive one wire."""

    def __init__(self, seed: int, wire: str) -> None:
        self.random = random.Random(seed)
        self.wire = wire

    def bits(self, width: int, marks: str = "01") -> str:
        return "".join(self.random.choice(marks) for _ in range(width))

    def value(self, width: int) -> Spec:
        chunks: list[Bits | Slice] = []
        while (left := width - spec_width(tuple(chunks))) > 0:
            name = self.random.choice([*INPUTS, "$k", "", ""])
            if name:
                size = self.random.randint(1, min(left, WIDTHS[name]))
                chunks.append(Slice(name, self.random.randint(0, WIDTHS[name] - size), size))
            else:
                chunks.append(Bits(self.bits(self.random.randint(1, left))))
        return tuple(chunks)

    def assign(self, low: int, width: int) -> Assign:
        return Assign(target=(Slice(self.wire, low, width),), value=self.value(width))

    def body(self, depth: int) -> tuple[Statement, ...]:
        found: list[Statement] = []
        for _ in range(self.random.randint(0, 2)):
            if depth and self.random.random() < 0.6:
                found.append(self.switch(depth - 1))
            else:
                low = self.random.randint(0, 3)
                found.append(self.assign(low, self.random.randint(1, 4 - low)))
        return tuple(found)

    def switch(self, depth: int) -> Switch:
        selector = self.value(self.random.randint(1, 3))
        width = spec_width(selector)
        marks = self.random.choice(("01", "01-"))
        cases = [
            Case(
                patterns=tuple(self.bits(width, marks) for _ in range(self.random.randint(1, 2))),
                body=self.body(depth),
            )
            for _ in range(self.random.randint(1, 4))
        ]
        if self.random.random() < 0.4:
            cases.append(Case(patterns=(), body=self.body(depth)))
        return Switch(selector=selector, cases=tuple(cases))

    def process(self) -> Process:
        return process(self.assign(0, 4), *self.body(3), *self.body(3))


@pytest.mark.sampled(4)
@pytest.mark.parametrize("start", range(0, by_depth(200, 400), 100))
def test_a_simplified_module_does_the_same(start: int) -> None:
    for seed in range(start, start + 100):
        constant = Bits(f"{seed % 8:03b}")
        known = process(Assign(target=(Slice("$k", 0, 3),), value=(constant,)))
        module = module_of(Maker(seed, "y").process(), known)
        less = simplified(module)
        assert len(less.items) < len(module.items)
        for s, t in product(range(8), range(4)):
            inputs = {"s": s, "t": t}
            assert settled(less, inputs) == settled(module, inputs), seed


def test_the_reference_sees_a_difference() -> None:
    maker = Maker(3, "y")
    one, other = (module_of(process(maker.assign(0, 4))) for _ in range(2))
    assert settled(one, {"s": 5, "t": 2}) != settled(other, {"s": 5, "t": 2})


Y, S = Slice("y", 0, 4), Slice("s", 0, 3)


def body_of(*statements: Statement) -> tuple[Statement, ...]:
    (item,) = simplified(module_of(process(*statements))).items
    assert isinstance(item, Process)
    return item.body


@pytest.mark.parametrize("body", [(), (Assign(target=(), value=()),)])
def test_a_process_that_drives_nothing_stays(body: tuple[Statement, ...]) -> None:
    module = module_of(process(*body))
    assert simplified(module) == module


def test_cases_without_effect_are_removed() -> None:
    default = Assign(target=(Y,), value=(Slice("t", 0, 2), Slice("s", 0, 2)))
    other = Assign(target=(Y,), value=(Bits("1010"),))
    # A constant bit of the selector decides, and is removed from the selector.
    switch = Switch(
        selector=(Slice("s", 0, 1), Bits("1")),
        cases=(
            Case(patterns=("00", "01"), body=(other,)),
            Case(patterns=("11", "01"), body=(other,)),
        ),
    )
    assert body_of(default, switch) == (
        default,
        Switch(selector=(Slice("s", 0, 1),), cases=(Case(patterns=("1",), body=(other,)),)),
    )
    # An arm that always matches ends the list; a single such arm is no choice.
    always = Switch(
        selector=(S,),
        cases=(Case(patterns=("---",), body=(other,)), Case(patterns=(), body=(default,))),
    )
    choice = Switch(selector=(S,), cases=(Case(patterns=("001",), body=(default,)),))
    assert simplified(module_of(process(default, always))).items == ()
    # A value that the target has already is not assigned again, and empty arms are removed.
    assert (
        simplified(
            module_of(
                process(
                    other,
                    Switch(
                        selector=(S,),
                        cases=(
                            Case(patterns=("001",), body=(other,)),
                            Case(patterns=("010",), body=()),
                        ),
                    ),
                )
            )
        ).items
        == ()
    )
    assert body_of(other, choice) == (other, choice)


def test_neighbouring_parts_are_assigned_at_once() -> None:
    default = Assign(target=(Y,), value=(Slice("t", 0, 2), Slice("s", 0, 2)))

    def part(low: int, width: int, value: Spec) -> Assign:
        return Assign(target=(Slice("y", low, width),), value=value)

    def inside(*parts: Assign) -> tuple[Statement, ...]:
        switch = Switch(selector=(S,), cases=(Case(patterns=("001",), body=parts),))
        (_, found) = body_of(default, switch)
        assert isinstance(found, Switch)
        return found.cases[0].body

    low, high = part(0, 2, (Bits("01"),)), part(2, 2, (Bits("11"),))
    assert inside(low, high) == (Assign(target=(Y,), value=(Bits("1101"),)),)
    assert inside(high, low) == (high, low)
    # The second part gets the value of the first, which says nothing about its own.
    assert inside(low, part(2, 2, (Bits("01"),))) == (Assign(target=(Y,), value=(Bits("0101"),)),)
    apart = part(3, 1, (Bits("1"),))
    assert inside(low, apart) == (low, apart)


def register(kind: str, data: Spec, init: object, **parameters: Bits) -> Module:
    attributes = {} if init is None else {"init": init}
    wire = Wire(
        name="y", width=4, signed=False, direction=None, attributes=MappingProxyType(attributes)
    )
    ports = {"CLK": (Slice("t", 0, 1),), "D": data, "Q": (Y,)}
    cell = Cell(kind=kind, name="c", parameters=parameters, ports=ports, attributes={}, line=1)
    return simplified(module_of(cell, y=wire))


NINE = Bits("1001")


@pytest.mark.parametrize("kind", ["$dff", "$adff"])
@pytest.mark.parametrize("data", [(NINE,), (Y,)])
def test_a_register_that_never_changes_is_a_constant(kind: str, data: Spec) -> None:
    more = {"ARST_VALUE": NINE} if kind == "$adff" else {}
    found = register(kind, data, NINE, **more)
    assert found.items == ()
    assert found.connections == (((Y,), (NINE,)),)


@pytest.mark.parametrize(
    ("kind", "data", "init", "more"),
    [
        ("$dff", (Bits("1000"),), NINE, {}),
        ("$dff", (Slice("z", 0, 4),), NINE, {}),
        ("$dff", (NINE,), None, {}),
        ("$adff", (NINE,), NINE, {"ARST_VALUE": Bits("0000")}),
        ("$dffe", (NINE,), NINE, {}),
    ],
)
def test_other_registers_stay(kind: str, data: Spec, init: object, more: dict[str, Bits]) -> None:
    (cell,) = register(kind, data, init, **more).items
    assert isinstance(cell, Cell) and cell.ports["Q"] == (Y,)


def test_an_arm_that_always_matches_ends_the_list() -> None:
    default = Assign(target=(Y,), value=(Slice("t", 0, 2), Slice("s", 0, 2)))
    one, other, more = (Assign(target=(Y,), value=(Bits(text),)) for text in ("1010", "0101", "11"))
    first = Case(patterns=("001",), body=(one,))
    for total in (("---",), ("010", "---"), ()):
        switch = Switch(
            selector=(S,),
            cases=(
                first,
                Case(patterns=total, body=(other,)),
                Case(patterns=("100",), body=(more,)),
            ),
        )
        expected = Switch(selector=(S,), cases=(first, Case(patterns=(), body=(other,))))
        assert body_of(default, switch) == (default, expected)


def test_value_that_may_have_changed_is_assigned_again() -> None:
    one, other = (Assign(target=(Y,), value=(Bits(text),)) for text in ("1010", "0101"))
    switch = Switch(selector=(S,), cases=(Case(patterns=("001",), body=(other,)),))
    assert body_of(one, switch, one) == (one, switch, one)
    assert body_of(one, one, switch) == (one, switch)
    varying = Assign(target=(Y,), value=(Slice("t", 0, 2), Slice("s", 0, 2)))
    assert body_of(varying, one, one, switch) == (varying, one, switch)


def test_values_are_inserted_at_all_ports_of_an_instance_but_not_evaluated() -> None:
    """The names of an instance's ports may be those of an operator's ports."""
    known = process(Assign(target=(Slice("$k", 0, 3),), value=(Bits("101"),)))
    ports: dict[str, Spec] = {
        "A": (Slice("$k", 0, 3),),
        "B": (Bits("1"),),
        "Y": (Slice("$k", 1, 2),),
    }
    unit = Cell(kind="unit", name="u", parameters={}, ports=ports, attributes={}, line=1)
    (found,) = simplified(module_of(known, unit)).items
    assert isinstance(found, Cell)
    assert found.ports == {"A": (Bits("101"),), "B": (Bits("1"),), "Y": (Bits("10"),)}
