# amaranth: UnusedElaboratable=no
"""Combinational paths from inputs to outputs, found in the netlist.

docs/reference/streams.md promises them in "Combinational paths".
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from amaranth.back import rtlil

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.gateware.signatures import leaf_streams
from firm_hdl.plan import Run
from firm_hdl.rtlil import parse
from firm_hdl.rtlil.ir import Assign, Cell, Design, Module, Slice, Spec, Statement
from tests.strategies import make

Bit = tuple[str, int]
Graph = dict[Bit, set[Bit]]

# Cells whose outputs depend only on state. An asynchronous read port depends on its address.
STATE = {"$dff", "$adff", "$memwr_v2", "$meminit_v2"}
BITWISE = {"$not", "$and", "$or", "$xor", "$mux"}


def bits(spec: Spec) -> list[Bit | None]:
    """Return the bits of a value; `None` for constants."""
    found: list[Bit | None] = []
    for chunk in spec:
        if isinstance(chunk, Slice):
            found += [(chunk.wire, chunk.low + k) for k in range(chunk.width)]
        else:
            found += [None] * chunk.width
    return found


class Paths:
    """The combinational paths of a design, by module."""

    def __init__(self, design: Design):
        self.design = design
        self.found: dict[str, Graph] = {}

    def of(self, name: str) -> Graph:
        """Return the inputs on which each bit of an output of a module depends."""
        if name not in self.found:
            module = self.design.modules[name]
            graph = self.graph(module)
            ports = {wire.name: wire.direction for wire in module.wires.values()}
            self.found[name] = {
                (wire.name, k): {
                    bit for bit in reached(graph, (wire.name, k)) if ports[bit[0]] == "input"
                }
                for wire in module.wires.values()
                if wire.direction == "output"
                for k in range(wire.width)
            }
        return self.found[name]

    def graph(self, module: Module) -> Graph:
        """Return the bits on which each bit of a module depends directly."""
        graph: Graph = {}

        def add(target, sources):
            graph.setdefault(target, set()).update(bit for bit in sources if bit is not None)

        for target, value in module.connections:
            for to, bit in zip(bits(target), bits(value), strict=True):
                add(to, [bit])
        for item in module.items:
            if not isinstance(item, Cell):
                for targets, sources in assigned(item.body, []):
                    for to, bit in targets:
                        add(to, [bit, *sources])
            elif item.kind in self.design.modules:
                for (port, k), inputs in self.of(item.kind).items():
                    sources = [bits(item.ports[name])[at] for name, at in inputs]
                    if port in item.ports:
                        add(bits(item.ports[port])[k], sources)
            elif item.kind not in STATE:
                for to, sources in through(item):
                    add(to, sources)
        return graph


def assigned(body: tuple[Statement, ...], selectors: list[Bit | None]) -> Iterator[tuple]:
    """Yield the assignments of a process, and the bits that select them."""
    for statement in body:
        if isinstance(statement, Assign):
            yield zip(bits(statement.target), bits(statement.value), strict=True), selectors
        else:
            for case in statement.cases:
                yield from assigned(case.body, [*selectors, *bits(statement.selector)])


def through(cell: Cell) -> Iterator[tuple[Bit | None, list[Bit | None]]]:
    """Yield the bits of a cell's output, with the inputs that they depend on."""
    if cell.kind == "$memrd_v2":
        assert cell.parameters["CLK_ENABLE"] == 0
        for to in bits(cell.ports["DATA"]):
            yield to, bits(cell.ports["ADDR"])
        return
    inputs = {name: bits(spec) for name, spec in cell.ports.items() if name != "Y"}
    selector = inputs.pop("S", [])
    for k, to in enumerate(bits(cell.ports["Y"])):
        if cell.kind in BITWISE:
            yield to, [*selector, *(each[min(k, len(each) - 1)] for each in inputs.values())]
        else:
            yield to, [*selector, *(bit for each in inputs.values() for bit in each)]


def reached(graph: Graph, start: Bit) -> set[Bit]:
    seen, todo = {start}, [start]
    while todo:
        for bit in graph.get(todo.pop(), ()):
            if bit not in seen:
                seen.add(bit)
                todo.append(bit)
    return seen


def paths(component) -> dict[str, set[str]]:
    """Return the input ports on which each output port depends; others are left out."""
    design = parse(rtlil.convert(component, name="top", emit_src=False))
    found: dict[str, set[str]] = {}
    for (port, _), inputs in Paths(design).of("top").items():
        for name, _ in inputs:
            found.setdefault(port, set()).add(name)
    return found


def names_of(component) -> dict[int, str]:
    """Return the prefixes of the port names of each leaf."""
    streams = leaf_streams(component.message, component.tree)
    return {leaf: port.ready.name.removesuffix("ready") for leaf, port in streams.items()}


def allowed(tx) -> dict[str, set[str]]:
    """Return the documented paths: from `valid` of the leaf and of earlier leaves of a step."""
    plan, names = tx.plan, names_of(tx)
    found: dict[str, set[str]] = {}
    for step in plan.steps:
        if isinstance(step, Run):
            leaves = [step.leaf]
        else:
            leaves = [leaf for leaf in (step.rest,) if leaf is not None]
            leaves += [part.leaf for part in step.parts if part.completes]
        for number, leaf in enumerate(leaves):
            valids = {f"{names[each]}valid" for each in leaves[: number + 1]}
            found.setdefault(f"{names[leaf]}ready", set()).update(valids)
    return found


CASES = [
    ("std_msgs/msg/Header", "lyrical"),
    ("geometry_msgs/msg/Vector3", "lyrical"),
    ("sensor_msgs/Imu", "noetic"),
    ("sensor_msgs/msg/JointState", "lyrical"),
    ("std_msgs/msg/UInt8MultiArray", "lyrical"),
]


@pytest.mark.parametrize(
    ("name", "distro", "bus_bytes"),
    [
        (*CASES[0], 8),
        *(pytest.param(*each, 8, marks=pytest.mark.thorough) for each in CASES[1:]),
        *(pytest.param(*each, 2, marks=pytest.mark.thorough) for each in CASES),
    ],
)
def test_paths_are_those_of_the_interface_page(name, distro, bus_bytes):
    message = load_message(name, distro=distro)
    assert paths(Deserializer(message, bus_bytes=bus_bytes)) == {}
    tx = Serializer(message, bus_bytes=bus_bytes)
    assert paths(tx) == allowed(tx)


def test_a_trigger_after_all_bytes_has_no_other_paths():
    message = make("ros1", {"x": "uint8", "e": (make("ros1", {}, "E"), "[2]")})
    tx = Serializer(message, bus_bytes=2)
    assert paths(Deserializer(message, bus_bytes=2)) == {}
    assert paths(tx) == allowed(tx)


def registers_behind(component, part) -> dict[str, set[str]]:
    """Return the registers of a part that depend on each `ready` that the part gets."""
    design = parse(rtlil.convert(component, name="top", emit_src=False))
    (module,) = (each for name, each in design.modules.items() if name.endswith(part))
    graph = Paths(design).graph(module)
    found: dict[str, set[str]] = {}
    for cell in module.items:
        if isinstance(cell, Cell) and cell.kind == "$dff":
            for data, (name, _) in zip(bits(cell.ports["D"]), bits(cell.ports["Q"]), strict=True):
                for port, _ in reached(graph, data):
                    if port.endswith("__ready"):
                        found.setdefault(port, set()).add(name)
    return found


def test_a_step_looks_at_ready_of_leaves_of_one_transfer_a_cycle_later():
    """Except for `items`, which may transfer in every cycle."""
    rx = Deserializer(load_message("std_msgs/msg/Header"), bus_bytes=8)
    found = registers_behind(rx, "mover")
    assert len(found.pop("message__frame_id__items__ready")) > 10 and found.pop("orders__ready")
    assert len(found) == 4
    assert found == {port: {port.replace("ready", "valid"), "slow"} for port in found}
