"""Messages of fixed size as records of plain values in VHDL, and conversions to vectors and back.

Each message type of fixed size has a record type with the same members as the record of streams.
`to_slv` and `to_..._value` convert between a record and the vector of the circuit. The vector has
the layout of :func:`firm_hdl.gateware.record_layout`, with the first member in the lowest bits.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from firm_hdl.export.primitives import PRIMITIVE_BITS, primitive_name
from firm_hdl.export.remarks import origin
from firm_hdl.export.tree import Node, Package, Tree
from firm_hdl.export.vhdl.constants import quoted
from firm_hdl.export.vhdl.package import data_type, record_elements
from firm_hdl.gateware.limits import MAX_CELL_BITS
from firm_hdl.model import Array, Field, Message
from firm_hdl.plan import Plan

__all__ = ["Member", "ValueType", "values_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Member:
    """A member of a record."""

    # Name and type in VHDL.
    name: str
    type: str
    # Lowest bit in the record's vector, and number of bits.
    first: int
    bits: int
    # Functions that convert the member to a vector and back; empty if the member is a vector.
    to_slv: str
    from_slv: str
    source: Field | None  # The definition's field; `None` in a message without fields.


@dataclass(frozen=True, slots=True, kw_only=True)
class ValueType:
    """A message type as a record."""

    # Stem of the names: the record is `base_t`, its function `to_base`, its size `BASE_BITS`; an
    # array of records is `bases_t`, and its function `to_bases`.
    base: str
    package: str  # The package that declares them.
    bits: int
    members: tuple[Member, ...]

    @property
    def name(self) -> str:
        """The record's type."""
        return f"{self.base}_t"

    def declarations(self) -> Iterator[str]:
        """Yield the declarations of the package."""
        yield "\n  -- The message as plain values, for the ports of the entities ..._record.\n"
        yield from _record(self)
        yield "\n  -- Conversion between records and vectors, first member in the lowest bits.\n"
        yield f"  constant {self.base.upper()}_BITS : positive := {self.bits};\n"
        for head in (_to_slv(self), _from_slv(self), _all_to_slv(self), _all_from_slv(self)):
            yield f"{head};\n"

    def bodies(self) -> Iterator[str]:
        """Yield the bodies of the functions."""
        yield from _conversions(self)
        yield from _conversions_of_arrays(self)


def values_of(tree: Tree, plan: Plan) -> dict[str, ValueType]:
    """Return the records of values of a message and the types in it, by the name of the type.

    Types without a fixed size and types that are too wide for Amaranth are left out.
    """
    made: dict[str, ValueType] = {}
    for package in tree.packages:
        if package.message.is_fixed_size and (kind := _value_type(package, plan, made)):
            made[package.message.name] = kind
    return made


def _value_type(package: Package, plan: Plan, made: Mapping[str, ValueType]) -> ValueType | None:
    members: list[Member] = []
    first = 0
    for node in package.node.children:
        member = _member(node, plan, made, package.name, first)
        if member is None or (first := first + member.bits) > MAX_CELL_BITS:
            return None
        members.append(member)
    return ValueType(
        base=f"{package.base}_value", package=package.name, bits=first, members=tuple(members)
    )


def _member(
    node: Node, plan: Plan, made: Mapping[str, ValueType], package: str, first: int
) -> Member | None:
    """Describe a member; return `None` if it is too wide."""
    kind = node.source.type if node.source is not None else None
    element = node.source.element_type if node.source is not None else None
    count = kind.count if isinstance(kind, Array) else None
    if isinstance(element, Message):
        value = made.get(element.name)
        if value is None:
            return None
        words = value.base if count is None else f"{value.base}s"
        where = f"work.{value.package}"
        name, into, outof = f"{where}.{words}_t", f"{where}.to_slv", f"{where}.to_{words}"
        bits = value.bits
    else:
        leaf = next(each.leaf for each in node.leaves())
        assert leaf is not None
        primitive = primitive_name(plan.leaves[leaf])
        name, bits = data_type(primitive), PRIMITIVE_BITS[primitive]
        into, outof = (
            ("", "")
            if name.startswith("std_logic")
            else ("std_logic_vector", name.partition("(")[0])
        )
        if count is not None:
            name, into, outof = f"{primitive}_items_t", "to_slv", f"to_{primitive}_items"
    if count is not None:
        name = f"{name}(0 to {count - 1})"
    return Member(
        name=node.name,
        type=name,
        first=first,
        bits=bits * (1 if count is None else count),
        to_slv=into,
        from_slv=outof,
        source=node.source,
    )


def _record(kind: ValueType) -> Iterator[str]:
    yield f"\n  type {kind.name} is record\n"
    yield from record_elements(
        [
            (
                member.name,
                member.type,
                origin(member.source, member.name) if member.source is not None else "",
                quoted(member.source.comment, "    ") if member.source is not None else (),
            )
            for member in kind.members
        ]
    )
    yield "  end record;\n"
    yield f"\n  type {kind.base}s_t is array (natural range <>) of {kind.name};\n"


def _to_slv(kind: ValueType) -> str:
    return _function("to_slv", f"value : {kind.name}", "std_logic_vector")


def _from_slv(kind: ValueType) -> str:
    return _function(f"to_{kind.base}", "bits : std_logic_vector", kind.name)


def _all_to_slv(kind: ValueType) -> str:
    return _function("to_slv", f"values : {kind.base}s_t", "std_logic_vector")


def _all_from_slv(kind: ValueType) -> str:
    return _function(f"to_{kind.base}s", "bits : std_logic_vector", f"{kind.base}s_t")


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
        f"    alias all_values : {kind.base}s_t(0 to values'length - 1) is values;\n"
        f"    variable bits : std_logic_vector({size} * values'length - 1 downto 0);\n"
        "  begin\n"
        "    for k in all_values'range loop\n"
        f"      bits{part} := to_slv(all_values(k));\n"
        "    end loop;\n"
        "    return bits;\n"
        "  end function;\n"
        f"\n{_all_from_slv(kind)} is\n"
        "    alias all_bits : std_logic_vector(bits'length - 1 downto 0) is bits;\n"
        f"    variable values : {kind.base}s_t(0 to bits'length / {size} - 1);\n"
        "  begin\n"
        "    for k in values'range loop\n"
        f"      values(k) := to_{kind.base}(all_bits{part});\n"
        "    end loop;\n"
        "    return values;\n"
        "  end function;\n"
    )
