"""Fields of structures by their names.

Amaranth declares a wire for each field of a signal with a layout, such as ``order.step``, but reads
bits of the whole signal: ``order [3:0]``. Here, operators and processes read the fields.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace

from firm_hdl.rtlil.ir import Assign, Case, Cell, Module, Process, Slice, Spec, Statement, Switch

__all__ = ["base_of_field", "with_fields"]

_OUTPUTS = ("Y", "Q")
# In VHDL, a clock that passes an assignment comes a delta cycle late.
_CLOCKS = ("CLK", "ARST", "TRG")


def base_of_field(name: str) -> str:
    """Return the name of the signal of which a wire is a field or an element; empty if of none."""
    cut = min((i for i in (name.find("."), name.find("[")) if i > 0), default=0)
    return name[:cut]


def with_fields(module: Module) -> Module:
    """Return the module with fields instead of the bits of structures that operators read."""
    names = _Fields(module)
    if not names.fields:
        return module
    return replace(module, items=tuple(names.item(item) for item in module.items))


@dataclass(frozen=True, slots=True)
class _Field:
    wire: str
    low: int
    width: int


class _Fields:
    def __init__(self, module: Module) -> None:
        # By wire that holds a structure: its fields, the narrowest first.
        self.fields: dict[str, list[_Field]] = defaultdict(list)
        for target, value in module.connections:
            if len(target) != 1 or len(value) != 1:
                continue
            to, source = target[0], value[0]
            assert isinstance(to, Slice)
            base = base_of_field(to.wire)
            if base not in module.wires or not isinstance(source, Slice):
                continue
            # Bits of another signal with a name have a name already.
            is_own = base == source.wire or source.wire.startswith(("$", "port$"))
            if is_own and source.width < module.wires[source.wire].width:
                self.fields[source.wire].append(_Field(to.wire, source.low, source.width))
        for fields in self.fields.values():
            fields.sort(key=lambda each: each.width)

    def item(self, item: Cell | Process) -> Cell | Process:
        if isinstance(item, Process):
            return replace(item, body=self._body(item.body))
        if not item.kind.startswith("$"):
            return item
        fixed = (*_OUTPUTS, *_CLOCKS, *(["DATA"] if item.kind == "$memrd_v2" else []))
        ports = {p: s if p in fixed else self._spec(s) for p, s in item.ports.items()}
        return replace(item, ports=ports)

    def _body(self, body: tuple[Statement, ...]) -> tuple[Statement, ...]:
        return tuple(self._statement(statement) for statement in body)

    def _statement(self, statement: Statement) -> Statement:
        if isinstance(statement, Assign):
            return Assign(target=statement.target, value=self._spec(statement.value))
        cases = tuple(
            Case(patterns=each.patterns, body=self._body(each.body)) for each in statement.cases
        )
        return Switch(selector=self._spec(statement.selector), cases=cases)

    def _spec(self, spec: Spec) -> Spec:
        if not any(isinstance(chunk, Slice) and chunk.wire in self.fields for chunk in spec):
            return spec
        return tuple(self._slice(each) if isinstance(each, Slice) else each for each in spec)

    def _slice(self, chunk: Slice) -> Slice:
        for each in self.fields.get(chunk.wire, ()):
            low = chunk.low - each.low
            if low >= 0 and low + chunk.width <= each.width:
                return Slice(each.wire, low, chunk.width)
        return chunk
