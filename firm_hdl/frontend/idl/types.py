"""Types with all typedefs expanded.

ROS 2 knows elements, and arrays or sequences of them. Typedefs are the one way to get an array of
arrays or of sequences past rosidl_parser; it is refused here, as nothing behind it can be built.
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

__all__ = ["Expander"]

# Every wire format counts in 32 bits.
_MOST = 2**32 - 1

# What other languages, and ROS itself, call the types of IDL.
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
    """What a type is, wherever it is written."""

    name: str
    is_builtin: bool = True
    package: str | None = None
    kind: Kind | None = None
    bound: SizeSyntax | None = None
    array: Literal["one", "array", "sequence"] = "one"
    size: SizeSyntax | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Layer:
    """A type as it is written in one place: that of a member, or a typedef on the way from it."""

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
    """Gives types their meaning, each typedef once."""

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
            If it has none; `AlreadyReportedError` if that of a typedef was raised before.
        """
        layer = _Layer(type=type_, declarator=declarator, path=path, struct=struct)
        return TypeSyntax(**self._expand([layer], {})._asdict(), span=type_.span)

    def alias(self, name: str) -> None:
        """Expand a typedef, which need not be used; raises as `member` does."""
        if name not in self._shapes:
            self._shapes[name] = None
            self._expand([_layer_of(self._names.aliases[name])], {name: None})

    def _expand(self, layers: list[_Layer], names: dict[str, None]) -> _Shape:
        """Follow typedefs down to a type that is none, then put on the layers one by one.

        Parameters
        ----------
        layers : list of _Layer
            The type to expand.
        names : dict of str to None
            The typedefs, in order, that the last layers stand for.
        """
        shape: _Shape | None = None
        while shape is None:
            core = layers[-1].core
            name = self._alias_name(core, layers[-1].path)
            if name is None:
                shape = self._element(core, layers[-1])
            elif name in names:
                raise IdlError(f"typedef '{name}' stands for itself", core.span)
            elif name in self._shapes:
                shape = self._shapes[name]
                if shape is None:
                    raise AlreadyReportedError(f"typedef '{name}' is wrong", core.span)
            else:
                self._shapes[name] = None  # It stays so if anything on the way is wrong.
                names[name] = None
                layers.append(_layer_of(self._names.aliases[name]))
        return self._put_on(layers, [*names], shape)

    def _put_on(self, layers: list[_Layer], names: list[str], shape: _Shape) -> _Shape:
        # The first layer may be a member, which has no name.
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
        # With a scope, it is looked for like a constant, from the module of the place outwards.
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
        """Say why a name is not that of a type."""
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
        if value.value > _MOST:
            raise IdlError(f"the {what} must be at most {_MOST}", span)
        return SizeSyntax(value=value.value, span=span)


def _layer_of(alias: Alias) -> _Layer:
    return _Layer(type=alias.type, declarator=alias.declarator, path=alias.path)


def _full_name(alias: Alias) -> Path:
    return (*alias.path, alias.declarator.name.text)
