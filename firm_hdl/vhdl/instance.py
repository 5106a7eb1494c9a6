"""Instances of the design's own entities, and of foreign components.

The declaration of a foreign component follows from the RTLIL that Amaranth prints: ports by name
and width. A port that is connected to a whole wire is an output.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from firm_hdl.rtlil.ir import Bits, Cell, Module, Slice, Spec, Value, spec_width
from firm_hdl.vhdl.expr import Values, short_constants
from firm_hdl.vhdl.graph import Graph
from firm_hdl.vhdl.names import is_identifier
from firm_hdl.vhdl.text import bit_literal, literal
from firm_hdl.vhdl.uses import output

__all__ = ["component", "component_names", "exact", "foreign_instance", "instance"]


def instance(
    cell: Cell,
    submodule: Module,
    values: Values,
    *,
    label: str,
    entity: str,
    ports: Mapping[str, str],
) -> Iterator[str]:
    """Yield the instantiation of an entity of the design."""
    associations: list[tuple[str, str]] = []
    for port, spec in cell.ports.items():
        if spec:
            vector = submodule.wires[port].direction == "inout"
            associations += _associate(ports[port], spec, values, vector=vector)
    yield f"{label} : entity work.{entity}"
    yield from _port_map(associations)


def component_names(module: Module, modules: Collection[str]) -> set[str]:
    """Return the identifiers of foreign components, which nothing else in the module may have.

    * `modules`: names of all modules of the design.
    """
    cells = [item for item in module.items if isinstance(item, Cell)]
    kinds = {cell.kind for cell in cells if not cell.kind.startswith("$")}
    # An extended identifier differs from all basic ones.
    return {kind for kind in kinds - {*modules} if is_identifier(kind)}


def component(cell: Cell, graph: Graph) -> Iterator[str]:
    """Yield the declaration of a foreign component."""
    yield f"component {exact(cell.kind)} is"
    if cell.parameters:
        yield "  generic ("
        last = len(cell.parameters) - 1
        for index, (name, value) in enumerate(cell.parameters.items()):
            yield f"    {exact(name)} : {_generic(value)[0]}{'' if index == last else ';'}"
        yield "  );"
    ports = {name: spec for name, spec in cell.ports.items() if spec}
    if ports:
        yield "  port ("
        for index, (name, spec) in enumerate(ports.items()):
            width = spec_width(spec)
            kind = "std_logic" if width == 1 else f"std_logic_vector({width - 1} downto 0)"
            end = "" if index == len(ports) - 1 else ";"
            yield f"    {exact(name)} : {_mode(cell, name, graph)} {kind}{end}"
        yield "  );"
    yield "end component;"


def foreign_instance(cell: Cell, graph: Graph, values: Values, label: str) -> Iterator[str]:
    """Yield the instantiation of a foreign component."""
    yield f"{label} : {exact(cell.kind)}"
    if cell.parameters:
        generics = [(exact(name), _generic(value)[1]) for name, value in cell.parameters.items()]
        yield "  generic map ("
        yield from _aligned(generics)
        yield "  )"
    associations: list[tuple[str, str]] = []
    for port, spec in cell.ports.items():
        if spec:
            associations += _associate(exact(port), spec, values, vector=True)
    yield from _port_map(associations)


def _port_map(associations: list[tuple[str, str]]) -> Iterator[str]:
    if not associations:
        yield ";"
        return
    yield "  port map ("
    yield from _aligned(associations)
    yield "  );"


def _aligned(pairs: list[tuple[str, str]]) -> Iterator[str]:
    size = max(len(formal) for formal, _ in pairs)
    for index, (formal, actual) in enumerate(pairs):
        yield f"    {formal:<{size}} => {actual}{'' if index == len(pairs) - 1 else ','}"


def _associate(
    formal: str, spec: Spec, values: Values, *, vector: bool
) -> Iterator[tuple[str, str]]:
    """Yield associations; a value of several chunks is connected chunk by chunk.

    An expression in a port map would be an implicit signal, one delta cycle late.
    """
    spec = tuple(short_constants(spec))
    position = 0
    for chunk in spec:
        name = formal
        if len(spec) > 1:
            top = position + chunk.width - 1
            name = (
                f"{formal}({top} downto {position})"
                if chunk.width > 1
                else (f"{formal}({position})")
            )
        if isinstance(chunk, Bits):
            actual = bit_literal(chunk.text) if chunk.width == 1 else literal(chunk.text)
        else:
            actual = values.name(chunk)
            if chunk.width > 1 and values.is_vector(chunk) != vector:
                actual = f"{'std_logic_vector' if vector else 'unsigned'}({actual})"
        yield name, actual
        position += chunk.width


def _mode(cell: Cell, port: str, graph: Graph) -> str:
    spec = cell.ports[port]
    if graph.is_output(cell, port):
        return "out"
    wires = [graph.module.wires[chunk.wire] for chunk in spec if isinstance(chunk, Slice)]
    directions = {wire.direction for wire in wires}
    if directions == {"inout"}:
        return "inout"
    if "inout" in directions:
        # Pads that are used in one way only tell the mode. VHDL does not connect them to `inout`.
        return "out" if "output" in directions else "in"
    # A port of the module that goes out, and that nothing else here drives, is driven by this one.
    driven = {output(other) for other in graph.cells if other.kind in ("$dff", "$adff")}
    if directions == {"output"} and not any(
        wire.name in driven or wire.name in _sources(graph) for wire in wires
    ):
        return "out"
    return "in"


def _sources(graph: Graph) -> set[str]:
    """List the wires that processes, operators, instances and connections drive."""
    names = {graph.target(process) for process in graph.processes}
    names.update(
        output(cell)
        for cell in graph.cells
        if cell.kind.startswith("$") and ("Y" in cell.ports or cell.kind == "$memrd_v2")
    )
    outputs = (
        spec
        for cell in graph.cells
        if graph.is_instance(cell)
        for port, spec in cell.ports.items()
        if graph.is_output(cell, port)
    )
    driven = (*outputs, *(target for target, _ in graph.drives))
    names.update(chunk.wire for spec in driven for chunk in spec if isinstance(chunk, Slice))
    return names | set(graph.name_of.values())


def exact(name: str) -> str:
    """Keep a foreign name unchanged, as an extended identifier if necessary."""
    return name if is_identifier(name) else "\\" + name.replace("\\", "\\\\") + "\\"


def _generic(value: Value) -> tuple[str, str]:
    if isinstance(value, Bits):
        return f"std_logic_vector({value.width - 1} downto 0)", f'"{value.text}"'
    if isinstance(value, int):
        return "integer", str(value)
    if isinstance(value, float):
        return "real", repr(value)
    quoted = value.replace('"', '""')
    return "string", f'"{quoted}"'
