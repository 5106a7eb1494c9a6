"""The signals and ports of a module's architecture, with their names and initial values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from firm_hdl.rtlil.ir import Bits, Cell, Module, Slice, Value, Wire
from firm_hdl.vhdl.expr import Declared
from firm_hdl.vhdl.graph import Graph
from firm_hdl.vhdl.names import Scope, legal
from firm_hdl.vhdl.text import bit_literal, literal
from firm_hdl.vhdl.uses import INLINE, output

__all__ = ["Names", "Port", "declare", "enumeration", "initial_value", "part_names"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Port:
    """A port of an entity. `inner`: the signal that drives it, if logic cannot assign to it."""

    wire: str
    direction: str
    outer: Declared
    inner: Declared | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Names:
    """All declarations of a module.

    Attributes
    ----------
    ports : tuple of Port
    declared : dict of str to Declared
        Signal or port to read and to assign, for each wire that has a driver.
    signals : dict of str to Declared
        Those that are signals of the architecture, in order.
    aliases : dict of str to Declared
        Signals that only give a value another name.
    memories, labels : dict of str to str
        Identifiers of memories and instances.
    scope : Scope
        Scope of the architecture, for further names.
    """

    ports: tuple[Port, ...]
    declared: dict[str, Declared]
    signals: dict[str, Declared]
    aliases: dict[str, Declared]
    memories: dict[str, str]
    labels: dict[str, str]
    scope: Scope


def declare(
    graph: Graph,
    *,
    entity: str,
    port_names: dict[str, str],
    child_names: Mapping[str, Mapping[str, str]],
    vectors: bool,
) -> Names:
    """Choose the declarations of a module.

    Parameters
    ----------
    port_names : dict of str to str
        Identifiers of the ports by wire.
    child_names : mapping
        Identifiers of the ports of all modules, by module.
    vectors : bool
        Whether ports are `std_logic_vector`.
    """
    scope = Scope([entity, "rtl", *port_names.values()])
    instances = [cell for cell in graph.cells if graph.is_instance(cell)]
    foreign = _foreign_outputs(graph, instances)
    driven = _driven(graph, child_names)
    hints = part_names(graph.module)
    ports, taken = _ports(graph, port_names, driven, foreign, scope, vectors=vectors)
    declared: dict[str, Declared] = {}
    for port in ports:
        declared[port.wire] = port.inner or port.outer
    named: dict[str, str] = {}
    generated: dict[str, str] = {}
    for wire, fallback in driven.items():
        owner = graph.name_of.get(wire, wire)
        if owner in declared:
            declared[wire] = declared[owner]
        elif wire not in declared and owner.startswith("$"):
            generated[wire] = hints.get(wire, fallback)
        elif wire not in declared:
            named[wire] = owner
    aliases = [chunk.wire for (chunk, *_), _ in graph.aliases if isinstance(chunk, Slice)]
    # Names of the design take precedence over generated ones.
    given = scope.give_all({**named, **{wire: wire for wire in aliases}})
    given |= scope.give_all(generated)
    signals = dict(taken)
    for wire in driven:
        if wire in named or wire in generated:
            signals[wire] = Declared(
                name=given[wire], width=graph.width[wire], vector=wire in foreign
            )
    declared.update(signals)
    return Names(
        ports=tuple(ports),
        declared=declared,
        signals=signals,
        aliases={wire: Declared(name=given[wire], width=graph.width[wire]) for wire in aliases},
        memories=scope.give_all({name: name for name in graph.module.memories}),
        labels=scope.give_all({cell.name: cell.name for cell in instances}),
        scope=scope,
    )


def _ports(
    graph: Graph,
    port_names: dict[str, str],
    driven: dict[str, str],
    foreign: frozenset[str],
    scope: Scope,
    *,
    vectors: bool,
) -> tuple[list[Port], dict[str, Declared]]:
    """List the ports, and the inner signals of those that logic cannot assign to.

    A register needs an inner signal for its initial value, as not all tools use that of a port. An
    instance's output needs one if its type differs from that of the port.
    """
    from_submodule = _submodule_outputs(graph)
    source_of = {owner: wire for wire, owner in graph.name_of.items()}
    ports: list[Port] = []
    signals: dict[str, Declared] = {}
    for wire, name in port_names.items():
        declaration = graph.module.wires[wire]
        direction = declaration.direction or ""
        vector = vectors or direction == "inout"
        outer = Declared(name=name, width=declaration.width, vector=vector)
        inner = None
        source = source_of.get(wire, wire)
        if direction == "output" and (source in driven or wire in driven):
            register = source in graph.register_of or source in _read_registers(graph)
            if register:
                inner = Declared(name=scope.give(f"{name}_q"), width=declaration.width)
            elif source in foreign and not vector and declaration.width > 1:
                inner = Declared(name=scope.give(f"{name}_i"), width=declaration.width, vector=True)
            elif source in from_submodule and vector and declaration.width > 1:
                inner = Declared(name=scope.give(f"{name}_i"), width=declaration.width)
        if inner is not None:
            signals[source] = inner
        ports.append(Port(wire=wire, direction=direction, outer=outer, inner=inner))
    return ports, signals


def _read_registers(graph: Graph) -> frozenset[str]:
    return frozenset(
        output(cell)
        for cell in graph.cells
        if cell.kind == "$memrd_v2" and cell.parameters.get("CLK_ENABLE") == 1
    )


def _submodule_outputs(graph: Graph) -> frozenset[str]:
    return frozenset(
        chunk.wire
        for cell in graph.cells
        if graph.is_submodule(cell)
        for port, spec in cell.ports.items()
        if graph.is_output(cell, port)
        for chunk in spec
        if isinstance(chunk, Slice)
    )


def _foreign_outputs(graph: Graph, instances: list[Cell]) -> frozenset[str]:
    return frozenset(
        chunk.wire
        for cell in instances
        if not graph.is_submodule(cell)
        for port, spec in cell.ports.items()
        if graph.is_output(cell, port)
        for chunk in spec
        if isinstance(chunk, Slice)
    )


def part_names(module: Module) -> dict[str, str]:
    """Name generated wires after the named signal of which they are a part."""
    names: dict[str, str] = {}
    for target, value in module.connections:
        to = target[0] if target else None
        if not isinstance(to, Slice) or to.wire.startswith("$") or "." in to.wire or "[" in to.wire:
            continue
        position = 0
        for chunk in value:
            if (
                isinstance(chunk, Slice)
                and len(value) > 1
                and chunk.wire.startswith(("$", "port$"))
                and chunk.width == module.wires[chunk.wire].width
            ):
                names.setdefault(chunk.wire, f"{to.wire}_{position}")
            position += chunk.width
    return names


def _driven(graph: Graph, child_names: Mapping[str, Mapping[str, str]]) -> dict[str, str]:
    """List the wires that this module drives, with a name for wires that have none."""
    driven: dict[str, str] = {}
    for cell in graph.cells:
        if graph.is_instance(cell):
            for port, spec in cell.ports.items():
                if graph.is_output(cell, port):
                    name = child_names.get(cell.kind, {}).get(port, port)
                    driven.update(
                        (chunk.wire, legal(f"{cell.name}_{name}"))
                        for chunk in spec
                        if isinstance(chunk, Slice)
                    )
        elif cell.kind in ("$dff", "$adff", "$memrd_v2") or cell.kind in INLINE:
            wire = output(cell)
            if wire not in graph.folded:
                driven[wire] = _generated_name(cell.kind, wire)
    for process in graph.processes:
        wire = graph.target(process)
        driven[wire] = _generated_name("$choice", wire)
    for (chunk, *_), _value in graph.drives:
        if isinstance(chunk, Slice) and graph.module.wires[chunk.wire].direction is None:
            driven[chunk.wire] = _generated_name("$pad", chunk.wire)
    return driven


def _generated_name(kind: str, wire: str) -> str:
    word = {"$dff": "register", "$adff": "register", "$memrd_v2": "read"}.get(kind, kind)
    return f"{word.removeprefix('$').removeprefix('reduce_')}_{wire.removeprefix('$')}"


def initial_value(wire: Wire | None, width: int) -> str:
    """Write the initial value of a register."""
    bits = wire.attributes.get("init") if wire is not None else None
    text = bits.text if isinstance(bits, Bits) else "0" * width
    if width == 1:
        return bit_literal(text)
    return literal(text) if "1" in text else "(others => '0')"


def enumeration(wire: Wire, bits: str) -> str:
    """Give the name of a value in an enumeration, or an empty text."""
    return _one_line(wire.attributes.get(f"enum_value_{bits}", ""))


def _one_line(value: Value) -> str:
    return " ".join(str(value).split())
