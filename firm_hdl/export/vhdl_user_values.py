"""Messages of fixed size as records of plain values in VHDL, and their way to a vector and back.

A record type for each message type in a message, with the same members as the records of streams;
`to_slv` and `to_..._value` convert between a record and the vector that the circuit has, whose
layout is that of :func:`firm_hdl.gateware.record_layout`: the first member lowest.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from amaranth.hdl import Shape
from amaranth.lib import data

from firm_hdl.export.names import first_free
from firm_hdl.export.vhdl_user_constants import origin, quoted
from firm_hdl.export.vhdl_user_tree import member_names, snake
from firm_hdl.export.vhdl_user_types import data_type
from firm_hdl.gateware import record_layout
from firm_hdl.model import Array, Field, FieldType, Message, Primitive
from firm_hdl.plan import Plan

__all__ = ["Member", "ValueType", "Values", "values_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Member:
    """A member of a record.

    Attributes
    ----------
    name, type : str
        In VHDL.
    first, bits : int
        Where it is in the record's vector.
    to_slv, from_slv : str
        Function that makes a vector of it, and that makes it of a vector; empty if it is one.
    source : Field or None
        The definition's field; none in a message without fields.
    """

    name: str
    type: str
    first: int
    bits: int
    to_slv: str
    from_slv: str
    source: Field | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ValueType:
    """A message type as a record.

    Attributes
    ----------
    base : str
        The record is ``base_t``, the function ``to_base``, the size ``BASE_BITS``; of an array of
        them, `bases_t` and `to_bases` of plural.
    plural : str
        Empty if the message has no array of it.
    """

    base: str
    plural: str
    bits: int
    members: tuple[Member, ...]

    @property
    def name(self) -> str:
        """The record's type."""
        return f"{self.base}_t"


@dataclass(frozen=True, slots=True, kw_only=True)
class Values:
    """The records of a message.

    Attributes
    ----------
    types : tuple of ValueType
        Each after those that it has members of; the message's own is the last one.
    taken : frozenset of str
        All identifiers that they need, in lower case.
    """

    types: tuple[ValueType, ...]
    taken: frozenset[str]

    @property
    def root(self) -> ValueType:
        """The message's own."""
        return self.types[-1]

    def declarations(self) -> Iterator[str]:
        """Yield what a package declares."""
        yield "\n  -- The message as values, without handshakes; the entities ..._record have it.\n"
        for kind in self.types:
            yield from _record(kind)
        yield "\n  -- Between records and vectors, the first member lowest.\n"
        for index, kind in enumerate(self.types):
            yield "\n" * bool(index)
            yield f"  constant {kind.base.upper()}_BITS : positive := {kind.bits};\n"
            yield from (f"{head};\n" for head in (_to_slv(kind), _from_slv(kind)))
            if kind.plural:
                yield from (f"{head};\n" for head in (_all_to_slv(kind), _all_from_slv(kind)))

    def bodies(self) -> Iterator[str]:
        """Yield what the package's body has."""
        for kind in self.types:
            yield from _conversions(kind)
            if kind.plural:
                yield from _conversions_of_arrays(kind)


def values_of(
    message: Message, plan: Plan, taken: Iterable[str], members: Iterable[str]
) -> Values:
    """Decide on the records of a message of fixed size.

    Parameters
    ----------
    taken : iterable of str
        Identifiers that nothing may have, in lower case.
    members : iterable of str
        Identifiers of members of records, in lower case, which would hide types.
    """
    maker = _Maker({*taken}, {*members})
    maker.count_arrays(message)
    maker.add(message, record_layout(message, wire=plan.wire))
    return Values(types=tuple(maker.types.values()), taken=frozenset(maker.own))


def _derived(base: str) -> tuple[str, ...]:
    return f"{base}_t", f"to_{base}", f"{base}_bits", f"{base}s_t", f"to_{base}s"


@dataclass(slots=True)
class _Maker:
    taken: set[str]
    members: set[str]
    own: set[str] = field(default_factory=set)
    types: dict[str, ValueType] = field(default_factory=dict)
    in_arrays: set[str] = field(default_factory=set)

    def count_arrays(self, message: Message) -> None:
        """Note which types there are arrays of."""
        for item in message.fields:
            if isinstance(item.type, Array) and isinstance(item.type.element, Message):
                self.in_arrays.add(item.type.element.name)
        for child in message.children:
            self.count_arrays(child)

    def add(self, message: Message, layout: data.StructLayout) -> ValueType:
        if message.name in self.types:
            return self.types[message.name]
        shapes: Mapping[str, object] = layout.members
        fields = {item.name: item for item in message.fields}
        members = tuple(
            self.member(name, fields.get(raw), layout[raw])
            for raw, name in member_names(shapes).items()
        )
        wanted = f"{snake(message.base_name) or 'message'}_value"
        base = first_free(wanted, self.taken | self.members | self.own, _derived)
        self.own.update(_derived(base))
        plural = f"{base}s" if message.name in self.in_arrays else ""
        made = ValueType(base=base, plural=plural, bits=layout.size, members=members)
        self.types[message.name] = made
        return made

    def member(self, name: str, source: Field | None, place: data.Field) -> Member:
        kind, into, outof = self.type_of(source.type if source else None, place.shape)
        return Member(
            name=name,
            type=kind,
            first=place.offset,
            bits=Shape.cast(place.shape).width,
            to_slv=into,
            from_slv=outof,
            source=source,
        )

    def type_of(self, kind: FieldType | None, shape: object) -> tuple[str, str, str]:
        """Give a type in VHDL, the function to a vector, and that from one."""
        if isinstance(shape, data.StructLayout):
            assert isinstance(kind, Message)
            made = self.add(kind, shape)
            return made.name, "to_slv", f"to_{made.base}"
        if isinstance(shape, data.ArrayLayout):
            assert isinstance(kind, Array)
            last = shape.length - 1
            if isinstance(kind.element, Message):
                made = self.add(kind.element, shape.elem_shape)
                return f"{made.plural}_t(0 to {last})", "to_slv", f"to_{made.plural}"
            primitive = _primitive(kind.element, Shape.cast(shape.elem_shape))
            return f"{primitive}_items_t(0 to {last})", "to_slv", f"to_{primitive}_items"
        primitive = _primitive(kind, Shape.cast(shape))
        text = data_type(primitive)
        if text.startswith("std_logic"):
            return text, "", ""
        return text, "std_logic_vector", text.partition("(")[0]


def _primitive(kind: object, shape: Shape) -> str:
    """Name a primitive as the shared package does; a message without fields has no `kind`."""
    if isinstance(kind, Primitive) and kind.kind == "float":
        return kind.name
    if shape.width == 1:
        return "bool"
    return f"{'' if shape.signed else 'u'}int{shape.width}"


def _record(kind: ValueType) -> Iterator[str]:
    names = max(len(member.name) for member in kind.members)
    types = max(len(member.type) for member in kind.members) + 1
    yield f"\n  type {kind.name} is record\n"
    for member in kind.members:
        remark = ""
        if member.source is not None:
            yield from quoted(member.source.comment, "    ")
            remark = origin(member.source, member.name)
        line = f"    {member.name:{names}} : {member.type + ';':{types}}{remark}"
        yield f"{line.rstrip()}\n"
    yield "  end record;\n"
    if kind.plural:
        yield f"\n  type {kind.plural}_t is array (natural range <>) of {kind.name};\n"


def _to_slv(kind: ValueType) -> str:
    return _function("to_slv", f"value : {kind.name}", "std_logic_vector")


def _from_slv(kind: ValueType) -> str:
    return _function(f"to_{kind.base}", "bits : std_logic_vector", kind.name)


def _all_to_slv(kind: ValueType) -> str:
    return _function("to_slv", f"values : {kind.plural}_t", "std_logic_vector")


def _all_from_slv(kind: ValueType) -> str:
    return _function(f"to_{kind.plural}", "bits : std_logic_vector", f"{kind.plural}_t")


def _function(name: str, parameter: str, result: str) -> str:
    head = f"  function {name} ({parameter}) return {result}"
    return head if len(head) < 97 else head.replace(") return ", ")\n    return ")


def _conversions(kind: ValueType) -> Iterator[str]:
    size = f"{kind.base.upper()}_BITS"
    yield f"\n{_to_slv(kind)} is\n"
    yield f"    variable bits : std_logic_vector({size} - 1 downto 0);\n  begin\n"
    for member in kind.members:
        whole = f"value.{member.name}"
        text = f"{member.to_slv}({whole})" if member.to_slv else whole
        yield f"    bits{_bits(member)} := {text};\n"
    yield "    return bits;\n  end function;\n"
    yield f"\n{_from_slv(kind)} is\n"
    yield f"    alias all_bits : std_logic_vector({size} - 1 downto 0) is bits;\n"
    yield f"    variable value : {kind.name};\n  begin\n"
    for member in kind.members:
        part = f"all_bits{_bits(member)}"
        text = f"{member.from_slv}({part})" if member.from_slv else part
        yield f"    value.{member.name} := {text};\n"
    yield "    return value;\n  end function;\n"


def _bits(member: Member) -> str:
    if member.type == "std_logic":
        return f"({member.first})"
    return f"({member.first + member.bits - 1} downto {member.first})"


def _conversions_of_arrays(kind: ValueType) -> Iterator[str]:
    size = f"{kind.base.upper()}_BITS"
    part = f"({size} * (k + 1) - 1 downto {size} * k)"
    yield (
        f"\n{_all_to_slv(kind)} is\n"
        f"    alias all_values : {kind.plural}_t(0 to values'length - 1) is values;\n"
        f"    variable bits : std_logic_vector({size} * values'length - 1 downto 0);\n"
        "  begin\n"
        "    for k in all_values'range loop\n"
        f"      bits{part} := to_slv(all_values(k));\n"
        "    end loop;\n"
        "    return bits;\n"
        "  end function;\n"
        f"\n{_all_from_slv(kind)} is\n"
        "    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;\n"
        f"    variable values : {kind.plural}_t(0 to bits'length / {size} - 1);\n"
        "  begin\n"
        "    for k in values'range loop\n"
        f"      values(k) := to_{kind.base}(all_bits{part});\n"
        "    end loop;\n"
        "    return values;\n"
        "  end function;\n"
    )
