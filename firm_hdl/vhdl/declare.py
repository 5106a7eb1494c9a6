"""The signals and ports of a module's architecture, with their names and initial values."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from textwrap import shorten
from typing import Literal, TypeAlias

from firm_hdl.names.attributes import REMARK
from firm_hdl.rtlil.evaluate import constant
from firm_hdl.rtlil.fields import base_of_field
from firm_hdl.rtlil.ir import (
    Assign,
    Bits,
    Cell,
    Module,
    Slice,
    Spec,
    Statement,
    Value,
    Wire,
    cut,
    once_per_module,
    spec_width,
)
from firm_hdl.vhdl.expr import Declared
from firm_hdl.vhdl.graph import Graph, attributes_of, only, uses_with_registers, wires_of
from firm_hdl.vhdl.instance import component_names
from firm_hdl.vhdl.names import AMS, Scope, is_identifier, legal
from firm_hdl.vhdl.text import bit_literal, literal
from firm_hdl.vhdl.uses import INLINE, Use, output

__all__ = [
    "Names",
    "declare",
    "enumeration",
    "fixed_names",
    "initial_value",
    "layouts",
    "part_names",
    "remark_of",
]

_MAX_REMARK = 150
"""Most characters of a remark that names other signals."""

_MAX_LAYOUT = 800
"""Most characters of a remark on the fields of a signal."""

_MAX_NAME = 60
"""Most characters of a name that is made of other names."""

Role: TypeAlias = Literal["register", "logic", "alias"]
DriverKind: TypeAlias = Literal["register", "logic", "submodule", "foreign"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Port:
    """A port of an entity. `inner`: the signal that drives it, if logic cannot assign to it."""

    wire: str
    direction: str
    outer: Declared
    inner: Declared | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Signal:
    """A signal of an architecture."""

    wire: str  # The wire of the module that has this signal.
    declared: Declared
    role: Role  # A register has an initial value; an alias only gives a value another name.


@dataclass(frozen=True, slots=True, kw_only=True)
class Names:
    """All declarations of a module."""

    ports: tuple[Port, ...]
    signals: tuple[Signal, ...]  # Signals of the architecture, in order.
    # The signal or port of each wire that has a driver, and of each alias.
    declared: dict[str, Declared]
    # Identifiers of memories and instances.
    memories: dict[str, str]
    labels: dict[str, str]
    scope: Scope  # Scope of the architecture, for further names.
    remarks: dict[str, str]  # Comments on generated wires.


@dataclass(frozen=True, slots=True, kw_only=True)
class _Driver:
    """The driver of a wire, and a name and a comment for the wire if the design has none."""

    kind: DriverKind
    name: str
    remark: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Request:
    """A signal without its identifier. `generated`: `name` is not a name of the design."""

    wire: str
    name: str
    role: Role
    generated: bool = False
    vector: bool = False


def declare(
    graph: Graph,
    *,
    entity: str,
    port_names: dict[str, str],
    child_names: Mapping[str, Mapping[str, str]],
    vectors: bool,
) -> Names:
    """Choose the declarations of a module.

    * `port_names`: identifiers of the ports by wire.
    * `child_names`: identifiers of the ports of all modules, by module.
    * `vectors`: whether ports are `std_logic_vector`.
    """
    fixed = fixed_names(graph.module, graph.modules)
    scope = Scope([entity, "rtl", *port_names.values(), *fixed], AMS)
    drivers = _drivers(graph, child_names)
    ports, signals = _ports(graph, port_names, drivers, scope, vectors=vectors)
    declared = {port.wire: port.inner or port.outer for port in ports}
    requests: list[_Request] = []
    for wire, driver in drivers.items():
        owner = graph.name_of.get(wire, wire)
        if owner in declared:
            declared[wire] = declared[owner]
        elif wire not in declared:
            requests.append(_request(graph, wire, owner, driver))
    for (chunk, *_), _value in graph.aliases:
        # Only wires are connected.
        assert isinstance(chunk, Slice)
        requests.append(_Request(wire=chunk.wire, name=chunk.wire, role="alias"))
    signals += _signals(graph, requests, scope)
    instances = [cell.name for cell in graph.cells if graph.is_instance(cell)]
    declared |= {signal.wire: signal.declared for signal in signals}
    # A field may be read by its own name, and be all that is read of a generated wire.
    declared |= {owner: declared[wire] for wire, owner in graph.name_of.items()}
    return Names(
        ports=tuple(ports),
        signals=tuple(signals),
        declared=declared,
        memories=scope.give_all({name: name for name in graph.module.memories}),
        labels=scope.give_all({name: name for name in instances}),
        scope=scope,
        remarks={wire: driver.remark for wire, driver in drivers.items() if driver.remark},
    )


def fixed_names(module: Module, modules: Collection[str]) -> set[str]:
    """Return the identifiers that nothing else in the module may have: tools know them.

    * `modules`: names of all modules of the design.
    """
    attributes = {name for wire in module.wires.values() for name in attributes_of(wire)}
    # An extended identifier differs from all basic ones.
    return {name for name in attributes if is_identifier(name)} | component_names(module, modules)


def _request(graph: Graph, wire: str, owner: str, driver: _Driver) -> _Request:
    """Request a signal for a driven wire; its owner is the wire that has the same value."""
    generated = owner.startswith("$")
    return _Request(
        wire=wire,
        name=driver.name if generated else owner,
        role="register" if driver.kind == "register" else "logic",
        generated=generated,
        vector=driver.kind == "foreign",
    )


def _signals(graph: Graph, requests: list[_Request], scope: Scope) -> Iterator[Signal]:
    """Give the requested signals their identifiers; names of the design come first."""
    given: dict[str, str] = {}
    for generated in (False, True):
        given |= scope.give_all({r.wire: r.name for r in requests if r.generated is generated})
    for each in requests:
        declared = Declared(name=given[each.wire], width=graph.width[each.wire], vector=each.vector)
        yield Signal(wire=each.wire, declared=declared, role=each.role)


def _ports(
    graph: Graph,
    port_names: dict[str, str],
    drivers: Mapping[str, _Driver],
    scope: Scope,
    *,
    vectors: bool,
) -> tuple[list[Port], list[Signal]]:
    """List the ports, and the inner signals of ports that logic cannot assign to.

    A register needs an inner signal for its initial value, because some tools ignore the initial
    value of a port. An instance's output needs an inner signal if its type is not that of the port.
    """
    source_of = {owner: wire for wire, owner in graph.name_of.items()}
    # Ports of submodules are `unsigned`, those of foreign components `std_logic_vector`.
    other_type = {True: "submodule", False: "foreign"}
    ports: list[Port] = []
    signals: list[Signal] = []
    for wire, name in port_names.items():
        declaration = graph.module.wires[wire]
        width, direction = declaration.width, declaration.direction or ""
        vector = vectors or direction == "inout"
        source = source_of.get(wire, wire)
        driver = drivers.get(source) if direction == "output" else None
        inner = None
        if driver is not None and driver.kind == "register":
            inner = Declared(name=scope.give(graph.copy_of.get(source, f"{name}_q")), width=width)
            signals.append(Signal(wire=source, declared=inner, role="register"))
        elif driver is not None and width > 1 and driver.kind == other_type[vector]:
            inner = Declared(
                name=scope.give(graph.copy_of.get(source, f"{name}_i")),
                width=width,
                vector=not vector,
            )
            signals.append(Signal(wire=source, declared=inner, role="logic"))
        outer = Declared(name=name, width=width, vector=vector)
        ports.append(Port(wire=wire, direction=direction, outer=outer, inner=inner))
    return ports, signals


@once_per_module
def part_names(module: Module) -> dict[str, str]:
    """Name generated wires after the named signal to which they are connected as a part.

    The part has the name of its field, or else the number of its lowest bit.
    """
    fields: dict[str, str] = {}
    for target, value in module.connections:
        to, source = only(target), only(value)
        is_whole = source is not None and source.width == module.wires[source.wire].width
        if to is not None and source is not None and is_whole and _field_of(to.wire):
            fields.setdefault(source.wire, to.wire.replace(".", "_"))
    return {
        wire: fields.get(wire, f"{signal}_{low}") for wire, (signal, low) in _parts(module).items()
    }


def _field_of(name: str) -> str:
    """Return the name of a field without that of its signal; empty for an element of an array."""
    base = base_of_field(name)
    return name[len(base) + 1 :] if name[len(base) :].startswith(".") and "[" not in name else ""


@once_per_module
def _parts(module: Module) -> dict[str, tuple[str, int]]:
    """Return the generated wires that are a part of a named signal: the signal and lowest bit."""
    parts: dict[str, tuple[str, int]] = {}
    # By wire and lowest bit of a chunk: the signals that have the chunk, and where.
    places: dict[tuple[str, int], list[tuple[str, Spec, int]]] = defaultdict(list)
    ports: list[tuple[str, Spec]] = []
    for target, value in module.connections:
        to = only(target)
        if to is None or to.wire.startswith("port$"):
            ports += [(to.wire, value)] if to is not None else []
            continue
        if to.wire.startswith("$") or "[" in to.wire or "." in to.wire or len(value) < 2:
            continue
        position = 0
        for chunk in value:
            if isinstance(chunk, Slice):
                places[chunk.wire, chunk.low].append((to.wire, value, position))
                is_whole = chunk.width == module.wires[chunk.wire].width
                if is_whole and chunk.wire.startswith(("$", "port$")):
                    parts.setdefault(chunk.wire, (to.wire, position))
            position += chunk.width
    # Output ports that Amaranth only numbers.
    for port, part in ports:
        first = part[0] if part else None
        for signal, value, low in places[first.wire, first.low] if isinstance(first, Slice) else ():
            if cut(value, low, spec_width(part)) == part:
                parts[port] = signal, low
                break
    return parts


@once_per_module
def layouts(module: Module) -> dict[str, str]:
    """Return the bits of the fields of each signal with a structure, and of its parts, as text."""
    fields: dict[str, list[tuple[int, int, str]]] = defaultdict(list)
    ends: Counter[str] = Counter()
    for target, _ in module.connections:
        to = only(target)
        field = _field_of(to.wire) if to is not None else ""
        if to is not None and field and "." not in field:
            base = base_of_field(to.wire)
            fields[base].append((ends[base], to.width, field))
            ends[base] += to.width
    wires = module.wires
    found = {base: (base, 0) for base in fields} | _parts(module)
    texts: dict[str, str] = {}
    for wire, (base, low) in found.items():
        # Fields of a union begin at the same bit.
        if base not in fields or base not in wires or ends[base] != wires[base].width:
            continue
        inside = [
            f"{name}({at + bits - 1 - low}:{at - low})" if bits > 1 else f"{name}({at - low})"
            for at, bits, name in fields[base]
            if low <= at and at + bits <= low + wires[wire].width
        ]
        if len(inside) > 1:
            texts[wire] = shorten(f"bits: {' '.join(inside)}", _MAX_LAYOUT, placeholder=" ...")
    return texts


def _next_names(graph: Graph) -> tuple[dict[str, str], dict[str, str]]:
    """Name generated wires after the register of whose next value they are a part.

    A wire that something else reads as well is more than a next value.

    Returns
    -------
    The names, and remarks on the wires that are a part of several registers' next values.
    """
    names: dict[str, list[str]] = defaultdict(list)
    reads = wires_of(use.spec for use in uses_with_registers(graph))
    reads_here: Counter[str] = Counter()
    for wire, cell in graph.register_of.items():
        register = graph.name_of.get(wire, wire)
        if register.startswith("$"):
            continue
        process = graph.next_state.get(wire)
        whole = Assign(target=(Slice(wire, 0, graph.width[wire]),), value=cell.ports["D"])
        assigned = list(_assignments((whole,) if process is None else process.body))
        reads_here += wires_of(each.value for each in assigned)
        for each in assigned:
            (target,) = each.target
            assert isinstance(target, Slice)
            position = target.low
            for chunk in each.value:
                if isinstance(chunk, Slice) and chunk.wire.startswith("$") and chunk.low == 0:
                    is_whole = chunk.width == graph.width[wire]
                    name = f"{register}_next" if is_whole else f"{register}_next_{position}"
                    if name not in names[chunk.wire]:
                        names[chunk.wire].append(name)
                position += chunk.width
    for wire in [wire for wire in names if reads[wire] != reads_here[wire]]:
        del names[wire]
    remarks = {
        wire: shorten(f"also {' '.join(map(legal, others))}", _MAX_REMARK, placeholder=" ...")
        for wire, (_, *others) in names.items()
        if others
    }
    return {wire: first for wire, (first, *_) in names.items()}, remarks


def _part_of_results(graph: Graph, named: Mapping[str, str]) -> dict[str, str]:
    """Name the other generated wires after the one signal of whose value they are a part.

    * `named`: names of generated wires, which have one already.
    """
    readers: dict[str, set[str]] = defaultdict(set)

    def read(by: str, uses: Iterable[Use]) -> None:
        for use in uses:
            for chunk in use.spec:
                if isinstance(chunk, Slice) and chunk.wire.startswith("$"):
                    readers[chunk.wire].add(by)

    for cell, uses in zip(graph.cells, graph.cell_uses, strict=True):
        by = output(cell) if cell.kind in INLINE or cell.kind in ("$dff", "$adff") else ""
        read(by, uses)
    registers = {graph.target(process): wire for wire, process in graph.next_state.items()}
    for wire, uses in graph.process_uses.items():
        read(registers.get(wire, wire), uses)
    for target, value in (*graph.drives, *graph.aliases):
        read(next(iter(wires_of([target]))), [Use(value, True)])

    found: dict[str, str] = {}

    def results(wire: str, seen: frozenset[str] = frozenset()) -> set[str]:
        """Return the names of the signals that read a wire; empty if one has no name."""
        names: set[str] = set()
        for by in readers[wire] - seen:
            owner = graph.name_of.get(by, by)
            if by in graph.folded:
                inner = results(by, seen | {wire})
                if not inner:
                    return set()
                names |= inner
            elif not by or (owner.startswith("$") and by not in named and by not in found):
                return set()
            else:
                name = owner if not owner.startswith("$") else named.get(by) or found[by]
                names.add(name)
        return names

    # A wire comes before those that read it.
    for cell in reversed(graph.cells):
        wire = output(cell) if cell.kind in INLINE else ""
        has_name = not wire.startswith("$") or wire in named or wire in graph.name_of
        if not has_name and wire not in graph.folded and len(names := results(wire)) == 1:
            found[wire] = f"{names.pop().removesuffix('_part')}_part"
    return found


def _assignments(body: tuple[Statement, ...]) -> Iterator[Assign]:
    for statement in body:
        if isinstance(statement, Assign):
            yield statement
        else:
            for case in statement.cases:
                yield from _assignments(case.body)


def _drivers(graph: Graph, child_names: Mapping[str, Mapping[str, str]]) -> dict[str, _Driver]:
    """List the wires that this module drives, with their drivers."""
    drivers: dict[str, _Driver] = {}
    parts = part_names(graph.module)
    nexts, remarks = _next_names(graph)
    operators = {output(cell): cell for cell in graph.cells if cell.kind in INLINE}
    tests = {
        wire: name
        for wire, cell in operators.items()
        if wire not in graph.folded
        and (name := _either(graph, cell) or _test(graph, cell, operators))
    }
    results = _part_of_results(graph, {**nexts, **tests, **parts})

    def add(kind: DriverKind, wire: str, name: str) -> None:
        remark = ""
        if kind != "register":
            name = nexts.get(wire) or tests.get(wire) or results.get(wire, name)
            remark = remarks.get(wire, "")
        drivers[wire] = _Driver(kind=kind, name=parts.get(wire, name), remark=remark)

    for cell in graph.cells:
        if graph.is_instance(cell):
            kind: DriverKind = "submodule" if graph.is_submodule(cell) else "foreign"
            for port, spec in cell.ports.items():
                name = child_names.get(cell.kind, {}).get(port, port)
                for chunk in spec if graph.is_output(cell, port) else ():
                    if isinstance(chunk, Slice):
                        add(kind, chunk.wire, legal(f"{cell.name}_{name}"))
        elif cell.kind in INLINE or _is_register(cell) or cell.kind == "$memrd_v2":
            wire = output(cell)
            if wire not in graph.folded:
                kind = "register" if _is_register(cell) else "logic"
                add(kind, wire, _generated_name(cell.kind, wire))
    for process in graph.processes:
        wire = graph.target(process)
        add("logic", wire, _generated_name("$choice", wire))
    for (chunk, *_), _value in graph.drives:
        if isinstance(chunk, Slice) and graph.module.wires[chunk.wire].direction is None:
            add("logic", chunk.wire, _generated_name("$pad", chunk.wire))
    return drivers


def _is_register(cell: Cell) -> bool:
    """Return whether a cell is a flip-flop, or a memory port that reads at a clock edge."""
    if cell.kind == "$memrd_v2":
        return cell.parameters.get("CLK_ENABLE") == 1
    return cell.kind in ("$dff", "$adff")


def _either(graph: Graph, cell: Cell) -> str | None:
    """Name a disjunction of a few bits after them, without the word with which all of them begin.

    So the condition "in step a or in step b" is `step_a_or_b`. A signal or 0 is `signal_if_bit`.
    """
    if cell.kind == "$mux":
        value, test = only(cell.ports["B"]), only(cell.ports["S"])
        if value is None or test is None or constant(cell.ports["A"]) != 0:
            return None
        if value.width != graph.width[value.wire]:
            return None
        name = "_if_".join(graph.name_of.get(each.wire, each.wire) for each in (value, test))
        return name if "$" not in name and len(name) <= _MAX_NAME else None
    if cell.kind not in ("$or", "$reduce_or", "$reduce_bool"):
        return None
    chunks = (*cell.ports["A"], *cell.ports.get("B", ()))
    names = [
        graph.name_of.get(chunk.wire, chunk.wire)
        for chunk in chunks
        if isinstance(chunk, Slice) and graph.width[chunk.wire] == 1
    ]
    if not 1 < len(names) == len(chunks) <= 3:
        return None
    first = names[0].partition("_")[0] + "_"
    if all(name.startswith(first) for name in names):
        names[1:] = [name.removeprefix(first) for name in names[1:]]
    name = "_or_".join(names)
    is_plain = not any(mark in name for mark in "$.[")
    return name if is_plain and len(name) <= _MAX_NAME else None


def _test(graph: Graph, cell: Cell, operators: Mapping[str, Cell]) -> str | None:
    """Name a test of some bits of one signal after the signal and its bits."""
    if graph.width[output(cell)] != 1:
        return None
    part, number = only(cell.ports["A"]), constant(cell.ports.get("B", ()))
    if cell.kind == "$eq" and part is not None and number is not None:
        name = graph.name_of.get(part.wire, part.wire)
        high = part.low + part.width - 1
        return None if name.startswith("$") else f"{name}_{high}_{part.low}_is_{number}"
    bits: dict[str, tuple[int, int]] = {}
    pending = [cell]
    while pending:
        for port, spec in pending.pop().ports.items():
            for chunk in spec if port != "Y" else ():
                if isinstance(chunk, Bits):
                    return None
                if chunk.wire.startswith("$") and chunk.wire in operators and chunk.width == 1:
                    pending.append(operators[chunk.wire])
                    continue
                wire = graph.name_of.get(chunk.wire, chunk.wire)
                low, high = bits.get(wire, (chunk.low, 0))
                bits[wire] = min(low, chunk.low), max(high, chunk.low + chunk.width - 1)
    if len(bits) != 1:
        return None
    ((wire, (low, high)),) = bits.items()
    if wire.startswith("$") or low == high:
        return None
    kind = {"$reduce_or": "not_0", "$reduce_bool": "not_0", "$reduce_and": "all_1"}
    return f"{wire}_{high}_{low}_{kind.get(cell.kind, 'test')}"


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


def remark_of(wire: Wire) -> str:
    """Return the design's remark on a wire, its sign and its enumeration; empty without them."""
    remarks = [_one_line(wire.attributes[REMARK])] if REMARK in wire.attributes else []
    remarks += ["signed"] if wire.signed and wire.width > 1 else []
    values = [
        f"{int(key[11:], 2)} {enumeration(wire, key[11:])}"
        for key in wire.attributes
        if key.startswith("enum_value_")
    ]
    remarks += [", ".join(values)] if 0 < len(values) <= 8 else []
    return "; ".join(remarks)


def enumeration(wire: Wire, bits: str) -> str:
    """Return the name of a value in an enumeration, or an empty text."""
    return _one_line(wire.attributes.get(f"enum_value_{bits}", ""))


def _one_line(value: Value) -> str:
    return " ".join(str(value).split())
