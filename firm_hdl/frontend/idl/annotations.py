"""Annotations: comments, units and defaults.

Other annotations are ignored, as in rosidl_parser, unless they change the bytes on the wire in the
standard. ROS 2 ignores these, too, but the author of the definition does not expect this. Therefore
they are errors.
"""

from __future__ import annotations

import ast
import math
import re
import warnings
from collections.abc import Iterator

from firm_hdl.errors import Diagnostic, Span
from firm_hdl.frontend.idl.tree import Annotation, Expression, LiteralSyntax, ScopedName
from firm_hdl.frontend.idl.values import IdlError, Lookup, Value, evaluate, fit
from firm_hdl.frontend.syntax import ListSyntax, TypeSyntax, ValueSyntax
from firm_hdl.model import IDL_PRIMITIVES

__all__ = ["comment_of", "default_of", "refusals", "unit_of", "unsigned_bits", "words_of"]

_REFUSED = ("optional", "mutable")


def refusals(annotations: tuple[Annotation, ...]) -> Iterator[Diagnostic]:
    """Find annotations that would change the bytes on the wire."""
    for annotation in annotations:
        name = annotation.name.parts[0]
        values = [v for _, v in annotation.arguments if isinstance(v, ScopedName)]
        if name in _REFUSED:
            message = f"annotation '@{name}' is not supported"
            yield Diagnostic(message=message, span=annotation.span)
        elif name == "extensibility" and any(v.parts[-1] == "MUTABLE" for v in values):
            message = "annotation '@extensibility(MUTABLE)' is not supported"
            yield Diagnostic(message=message, span=annotation.span)


def comment_of(annotations: tuple[Annotation, ...]) -> str:
    """Join the texts of ``@verbatim(language="comment", text="...")``."""
    lines: list[str] = []
    for annotation in _named(annotations, "verbatim"):
        texts = {}
        for name, value in annotation.arguments:
            if name is not None and isinstance(value, LiteralSyntax):
                texts[name.text] = _literal_text(value)
        if texts.get("language") == "comment" and texts.get("text"):
            lines += (texts["text"] or "").splitlines()
    return "\n".join(lines)


def unit_of(annotations: tuple[Annotation, ...]) -> str | None:
    """Give the text of ``@unit(value="...")``."""
    for annotation in _named(annotations, "unit"):
        for name, value in annotation.arguments:
            if name is None or name.text == "value":
                return _literal_text(value) if isinstance(value, LiteralSyntax) else None
    return None


def default_of(
    annotations: tuple[Annotation, ...], type_: TypeSyntax, lookup: Lookup
) -> ValueSyntax | ListSyntax | None:
    """Give the value of ``@default(value=...)``, converted to a type.

    Raises
    ------
    IdlError
        If there are two defaults, if the default has no value, or if it does not fit the type.
    """
    found = list(_named(annotations, "default"))
    if not found:
        return None
    if len(found) > 1:
        raise IdlError("a member can have only one default", found[1].span)
    if not type_.is_builtin:
        raise IdlError("only a builtin type can have a default", found[0].span)
    expression = _default_expression(found[0])
    span = expression.span
    value = evaluate(expression, lookup, unsigned_bits(type_.name))
    if type_.array != "one":
        return _list(value, type_, span)
    return ValueSyntax(value=fit(value, type_.name, span), text=words_of(span), span=span)


def unsigned_bits(name: str) -> int | None:
    """Give the bits of an unsigned integer type; `None` for any other type."""
    primitive = IDL_PRIMITIVES.get(name)
    if primitive is None or primitive.kind != "int" or primitive.signed:
        return None
    return 8 * primitive.bytes


def words_of(span: Span) -> str:
    """Give the text of a span, on one line."""
    return " ".join(span.source.text[span.start : span.end].split())


def _named(annotations: tuple[Annotation, ...], name: str) -> Iterator[Annotation]:
    # rosidl_parser compares only the first word of a name with a scope.
    return (a for a in annotations if a.name.parts[0] == name)


def _literal_text(literal: LiteralSyntax) -> str | None:
    try:
        value = evaluate(literal, _no_names).value
    except IdlError:
        return None
    return value if isinstance(value, str) else None


def _no_names(name: ScopedName) -> Value:
    raise AssertionError(name)


def _default_expression(annotation: Annotation) -> Expression:
    for name, value in annotation.arguments:
        if name is None or name.text == "value":
            return value
    raise IdlError("a default needs a value: '@default(value=...)'", annotation.span)


# An element of a Python list: a single token, so that lists cannot nest.
_ITEM = re.compile(
    r"""\s*(?P<item>[+-]?[\w.]+(?:(?<=[eE])[+-]\d+)?|'(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*")\s*(?:,|$)"""
)


def _list(value: Value, type_: TypeSyntax, span: Span) -> ListSyntax:
    """Read a default of several elements, which rosidl_adapter writes like a Python tuple."""
    text = value.value.strip() if isinstance(value.value, str) else ""
    if text[:1] + text[-1:] not in ("()", "[]"):
        raise _no_list(type_, span)
    items = []
    inside = text[1:-1].rstrip()
    position = 0
    while position < len(inside):
        match = _ITEM.match(inside, position)
        if match is None:
            raise _no_list(type_, span)
        element = _python_value(match["item"], span)
        if element is None:
            raise _no_list(type_, span)
        items.append(
            ValueSyntax(value=fit(element, type_.name, span), text=match["item"], span=span)
        )
        position = match.end()
    return ListSyntax(items=tuple(items), span=span)


def _no_list(type_: TypeSyntax, span: Span) -> IdlError:
    return IdlError(f'expected a list of {type_.name} as a string, such as "(1, 2)"', span)


def _python_value(text: str, span: Span) -> Value | None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # Unknown escapes stay as they are, as in rosidl.
        try:
            value = ast.literal_eval(text)
        except (ValueError, SyntaxError):
            return None
    match value:
        case bool():
            return Value("boolean", value)
        case int():
            return Value("integer", value)
        case float() if math.isfinite(value):
            return Value("float", value)
        case str():
            return Value("text", value)
    return None
