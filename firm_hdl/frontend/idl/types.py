"""Types with all typedefs expanded.

ROS 2 has single elements, and arrays or sequences of them. With typedefs, rosidl_parser accepts an
array of arrays or of sequences. Here such a type is an error, because ROS 2 cannot build it.
"""

from __future__ import annotations

from dataclasses import replace

from firm_hdl.errors import Span
from firm_hdl.frontend.explain import clip
from firm_hdl.frontend.idl.names import Declared, Names, Path
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


class Expander:
    """Expands types, each typedef once."""

    def __init__(self, names: Names) -> None:
        self._names = names
        # Typedefs by name; `None` while one is expanded, or if it is wrong.
        self._types: dict[str, TypeSyntax | None] = {}

    def member(
        self, type_: TypeNode, declarator: Declarator, path: Path, struct: str
    ) -> TypeSyntax:
        """Expand the type of a struct's member.

        Raises `IdlError` if the type is wrong; `AlreadyReportedError` if a typedef's error was
        raised before.
        """
        declared = Declared(path, type_, declarator, struct)
        return replace(self._expand(None, declared), span=type_.span)

    def alias(self, name: str) -> None:
        """Expand a typedef, whether it is used or not; raises as `member` does."""
        if name not in self._types:
            self._types[name] = None
            self._expand(name, self._names.aliases[name])

    def _expand(self, name: str | None, declared: Declared) -> TypeSyntax:
        """Follow typedefs down to a type that is not a typedef, then apply them one by one.

        * `name`: that of the typedef to begin with; `None` for a member.
        """
        layers = {name: declared}
        found: TypeSyntax | None = None
        while found is None:
            last = next(reversed(layers.values()))
            name = self._alias_name(last.core, last.path)
            if name is None:
                found = self._element(last.core, last)
            elif name in layers:
                raise IdlError(f"typedef '{name}' refers to itself", last.core.span)
            elif name in self._types:
                found = self._types[name]
                if found is None:
                    raise AlreadyReportedError(f"typedef '{name}' is wrong", last.core.span)
            else:
                self._types[name] = None  # It stays `None` if there is an error below.
                layers[name] = self._names.aliases[name]
        for name, declared in reversed(layers.items()):
            found = self._wrap(declared, found)
            if name is not None:
                self._types[name] = found
        return found

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
        return (
            core.parts[-1] if is_bare or (*alias.path, alias.declarator.name.text) in full else None
        )

    def _element(self, core: TypeNode, layer: Declared) -> TypeSyntax:
        match core:
            case StringType():
                bound = None
                if core.bound is not None:
                    bound = self._size(core.bound, layer, "bound of a string")
                name = "wstring" if core.wide else "string"
                return TypeSyntax(name=name, bound=bound, span=core.span)
            case ScopedName():
                return self._reference(core)
            case FixedType():
                raise IdlError("type 'fixed' is not supported", core.span)
        assert not isinstance(core, SequenceType)
        return TypeSyntax(name=core.name, span=core.span)

    def _reference(self, name: ScopedName) -> TypeSyntax:
        match name.parts:
            case [package, ("msg" | "srv" | "action") as kind, base]:
                if self._names.enums.get(base) != name.parts:
                    return TypeSyntax(
                        package=package, name=base, is_builtin=False, kind=kind, span=name.span
                    )
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

    def _wrap(self, layer: Declared, shape: TypeSyntax) -> TypeSyntax:
        for sequence in layer.sequences:
            if shape.array != "one":
                message = f"a sequence of {shape.array}s is not supported"
                raise IdlError(message, sequence.span)
            size = None
            if sequence.bound is not None:
                size = self._size(sequence.bound, layer, "bound of a sequence")
            shape = replace(shape, array="sequence", size=size)
        sizes = layer.declarator.sizes
        if not sizes:
            return shape
        if shape.array == "sequence":
            raise IdlError("an array of sequences is not supported", sizes[0].span)
        if shape.array == "array" or len(sizes) > 1:
            raise IdlError("arrays of several dimensions are not supported", sizes[-1].span)
        size = self._size(sizes[0], layer, "length of an array")
        return replace(shape, array="array", size=size)

    def _size(self, expression: Expression, layer: Declared, what: str) -> SizeSyntax:
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
        return SizeSyntax(value.value, span)
