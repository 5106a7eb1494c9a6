"""Types with all typedefs expanded.

ROS 2 has single elements, and arrays or sequences of them. With typedefs, rosidl_parser accepts an
array of arrays or of sequences. Here such a type is an error, because ROS 2 cannot build it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

from firm_hdl.errors import Span
from firm_hdl.frontend.explain import clip
from firm_hdl.frontend.idl.names import Alias, Names, Path
from firm_hdl.frontend.idl.tree import (
    Declarator,
    Expression,
    FixedType,
    ScopedName,
    SequenceType,
    StringType,
    TypeNode,
)
from firm_hdl.frontend.idl.values import (
    AlreadyReportedError,
    IdlError,
    UnknownNameError,
    evaluate,
)
from firm_hdl.frontend.names import Kind
from firm_hdl.frontend.syntax import SizeSyntax, TypeSyntax
from firm_hdl.wire.alignment import MAX_LENGTH

__all__ = ["Expander"]

# Names of IDL's types in other languages and in ROS.
_FOREIGN = {
    "bool": "boolean",
    "byte": "octet",
    "float32": "float",
    "float64": "double",
    "int": "long",
    "uint": "unsigned long",
    "time": "builtin_interfaces::msg::Time",
    "duration": "builtin_interfaces::msg::Duration",
}
_REFUSED = ("any", "map", "Object", "ValueBase")


class _Shape(NamedTuple):
    """A type, independent of the place where it is written."""

    name: str
    is_builtin: bool = True
    package: str | None = None
    kind: Kind | None = None
    bound: SizeSyntax | None = None
    array: Literal["one", "array", "sequence"] = "one"
    size: SizeSyntax | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Layer:
    """A type as written in one place: the type of a member, or of a typedef that it uses."""

    type: TypeNode
    declarator: Declarator
    path: Path
    struct: str | None = None

    @property
    def core(self) -> TypeNode:
        """The type without the sequences around it."""
        type_ = self.type
        while isinstance(type_, SequenceType):
            type_ = type_.element
        return type_

    @property
    def sequences(self) -> list[SequenceType]:
        """The sequences around the core, the inner one first."""
        found = []
        type_ = self.type
        while isinstance(type_, SequenceType):
            found.append(type_)
            type_ = type_.element
        return found[::-1]


class Expander:
    """Expands types, each typedef once."""

    def __init__(self, names: Names) -> None:
        self._names = names
        self._shapes: dict[str, _Shape | None] = {}

    def member(
        self, type_: TypeNode, declarator: Declarator, path: Path, struct: str
    ) -> TypeSyntax:
        """Expand the type of a struct's member.

        Raises
        ------
        IdlError
            If the type is wrong; `AlreadyReportedError` if a typedef's error was raised before.
        """
        layer = _Layer(type=type_, declarator=declarator, path=path, struct=struct)
        return TypeSyntax(**self._expand([layer], {})._asdict(), span=type_.span)

    def alias(self, name: str) -> None:
        """Expand a typedef, whether it is used or not; raises as `member` does."""
        if name not in self._shapes:
            self._shapes[name] = None
            self._expand([_layer_of(self._names.aliases[name])], {name: None})

    def _expand(self, layers: list[_Layer], names: dict[str, None]) -> _Shape:
        """Follow typedefs down to a type that is not a typedef, then apply the layers one by one.

        Parameters
        ----------
        layers : list of _Layer
            The type to expand.
        names : dict of str to None
            The typedefs of the last layers, in order.
        """
        shape: _Shape | None = None
        while shape is None:
            core = layers[-1].core
            name = self._alias_name(core, layers[-1].path)
            if name is None:
                shape = self._element(core, layers[-1])
            elif name in names:
                raise IdlError(f"typedef '{name}' refers to itself", core.span)
            elif name in self._shapes:
                shape = self._shapes[name]
                if shape is None:
                    raise AlreadyReportedError(f"typedef '{name}' is wrong", core.span)
            else:
                self._shapes[name] = None  # It stays `None` if there is an error below.
                names[name] = None
                layers.append(_layer_of(self._names.aliases[name]))
        return self._apply(layers, [*names], shape)

    def _apply(self, layers: list[_Layer], names: list[str], shape: _Shape) -> _Shape:
        # The first layer may be a member. It has no typedef name, so pad the names with `None`.
        padded = [None] * (len(layers) - len(names)) + names
        for layer, name in zip(reversed(layers), reversed(padded), strict=True):
            shape = self._wrap(layer, shape)
            if name is not None:
                self._shapes[name] = shape
        return shape

    def _alias_name(self, core: TypeNode, path: Path) -> str | None:
        if not isinstance(core, ScopedName):
            return None
        alias = self._names.aliases.get(core.parts[-1])
        if alias is None:
            return None
        # A name with a scope is looked up like a constant, from the inner module outwards.
        around = range(0 if core.is_absolute else len(path), -1, -1)
        full = [(*path[:depth], *core.parts) for depth in around]
        is_bare = len(core.parts) == 1 and not core.is_absolute
        return core.parts[-1] if is_bare or _full_name(alias) in full else None

    def _element(self, core: TypeNode, layer: _Layer) -> _Shape:
        match core:
            case StringType():
                bound = None
                if core.bound is not None:
                    bound = self._size(core.bound, layer, "bound of a string")
                return _Shape("wstring" if core.wide else "string", bound=bound)
            case ScopedName():
                return self._reference(core)
            case FixedType():
                raise IdlError("type 'fixed' is not supported", core.span)
        assert not isinstance(core, SequenceType)
        return _Shape(core.name)

    def _reference(self, name: ScopedName) -> _Shape:
        match name.parts:
            case [package, ("msg" | "srv" | "action") as kind, base]:
                if self._names.enums.get(base) != name.parts:
                    return _Shape(base, is_builtin=False, package=package, kind=kind)
        raise UnknownNameError(self._explain(name), name.span)

    def _explain(self, name: ScopedName) -> str:
        """Explain why a name is not the name of a type."""
        text = clip(str(name))
        last = name.parts[-1]
        if last in self._names.enums:
            return f"enum '{text}' cannot be the type of a member in ROS 2; use an integer"
        if len(name.parts) == 1:
            if last in _REFUSED:
                return f"type '{last}' is not supported"
            if last in _FOREIGN:
                return f"'{text}' is not a type; did you mean '{_FOREIGN[last]}'?"
            full = self._names.structs.get(last, ())
            if len(full) > 1:
                return (
                    f"'{text}' is not a typedef; a struct needs its full name, '{'::'.join(full)}'"
                )
        return f"'{text}' is not a type; those of ROS are written 'package::msg::Name'"

    def _wrap(self, layer: _Layer, shape: _Shape) -> _Shape:
        for sequence in layer.sequences:
            if shape.array != "one":
                message = f"a sequence of {shape.array}s is not supported"
                raise IdlError(message, sequence.span)
            size = None
            if sequence.bound is not None:
                size = self._size(sequence.bound, layer, "bound of a sequence")
            shape = shape._replace(array="sequence", size=size)
        sizes = layer.declarator.sizes
        if not sizes:
            return shape
        if shape.array == "sequence":
            raise IdlError("an array of sequences is not supported", sizes[0].span)
        if shape.array == "array" or len(sizes) > 1:
            raise IdlError("arrays of several dimensions are not supported", sizes[-1].span)
        size = self._size(sizes[0], layer, "length of an array")
        return shape._replace(array="array", size=size)

    def _size(self, expression: Expression, layer: _Layer, what: str) -> SizeSyntax:
        value = evaluate(
            expression, lambda name: self._names.constant(name, layer.path, layer.struct), 32
        )
        span: Span = expression.span
        if value.kind != "integer":
            raise IdlError(f"the {what} must be an integer", span)
        assert isinstance(value.value, int)
        if value.value < 1:
            raise IdlError(f"the {what} must be at least 1, not {value.value}", span)
        if value.value > MAX_LENGTH:
            raise IdlError(f"the {what} must be at most {MAX_LENGTH}", span)
        return SizeSyntax(value=value.value, span=span)


def _layer_of(alias: Alias) -> _Layer:
    return _Layer(type=alias.type, declarator=alias.declarator, path=alias.path)


def _full_name(alias: Alias) -> Path:
    return (*alias.path, alias.declarator.name.text)
