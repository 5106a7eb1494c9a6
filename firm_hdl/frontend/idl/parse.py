"""Text to tree, with the grammar in ``idl.lark``.

The LALR parser has an explicit stack and the tree is built bottom-up, so that no text reaches
Python's recursion limit. Code that walks the tree may recurse, because the parser limits nesting.
"""

from __future__ import annotations

from functools import cache, lru_cache
from importlib import resources
from typing import Any

from lark import Lark, Token, Transformer_NonRecursive, Tree, v_args
from lark.exceptions import UnexpectedInput
from lark.tree import Meta

from firm_hdl.errors import Diagnostic, Source, Span
from firm_hdl.frontend.idl.explain import explain
from firm_hdl.frontend.idl.tree import (
    Annotation,
    BasicType,
    Chain,
    Constant,
    Declarator,
    Enum,
    Expression,
    FileSyntax,
    FixedType,
    Include,
    LiteralSyntax,
    Member,
    Module,
    ScopedName,
    SequenceType,
    StringType,
    Struct,
    Typedef,
    Unary,
)
from firm_hdl.frontend.syntax import NameSyntax

__all__ = ["idl_tree", "parse_file"]

# Limit on the parser's stack. A parenthesis takes one to twelve entries, a module six.
_MOST_NESTED = 200

_ROS_NAMES = {
    "boolean": "bool",
    "octet": "byte",
    "short": "int16",
    "unsigned short": "uint16",
    "long": "int32",
    "unsigned long": "uint32",
    "long long": "int64",
    "unsigned long long": "uint64",
    "float": "float32",
    "double": "float64",
}
_LITERALS: dict[str, Any] = {
    "DECIMAL": "integer",
    "OCTAL": "integer",
    "HEXADECIMAL": "integer",
    "FLOAT": "float",
    "FIXED": "fixed",
    "CHARACTER": "character",
    "TRUE": "boolean",
    "FALSE": "boolean",
    "STRING": "string",
    "WIDE_STRING": "wstring",
}


# Cached, because many files include the same file.
@lru_cache(maxsize=512)
def parse_file(source: Source) -> FileSyntax | Diagnostic:
    """Parse an IDL file.

    Returns: the tree, or the first syntax error.
    """
    parser = _parser().parse_interactive(source.text)
    try:
        for token in parser.iter_parse():
            if len(parser.parser_state.state_stack) > _MOST_NESTED:
                return Diagnostic("this is nested too deeply", _span(source, token))
        tree = parser.feed_eof()  # type: ignore[no-untyped-call]
    except UnexpectedInput as error:
        accepts = parser.accepts()  # type: ignore[no-untyped-call]
        start, end, message = explain(error, source.text, accepts)
        return Diagnostic(message, Span(source, start, end))
    file = _Builder(source).transform(tree)
    assert isinstance(file, FileSyntax)
    return file


def idl_tree(text: str) -> list[Tree[Token]]:
    """List the parse tree of a text, or nothing if the text has a syntax error."""
    try:
        return [_parser().parse(text)]
    except UnexpectedInput:
        return []


@cache
def _parser() -> Lark:
    grammar = resources.files(__package__).joinpath("idl.lark").read_text("utf-8")
    return Lark(grammar, parser="lalr", lexer="contextual", propagate_positions=True)


@v_args(meta=True)
class _Builder(Transformer_NonRecursive[Token, Any]):
    """Builds the syntax tree from the parse tree; each grammar rule has a method of its name."""

    def __init__(self, source: Source) -> None:
        super().__init__()
        self._source = source

    def start(self, meta: Meta, parts: list[Any]) -> FileSyntax:
        return FileSyntax(self._source, tuple(parts))

    def include(self, meta: Meta, parts: list[Any]) -> Include:
        return Include(parts[0].removeprefix("#include").strip()[1:-1])

    def module(self, meta: Meta, parts: list[Any]) -> Module:
        annotations, name, *definitions = parts
        return Module(annotations, self._name(name), tuple(definitions))

    def constant(self, meta: Meta, parts: list[Any]) -> Constant:
        annotations, type_, name, value = parts
        return Constant(annotations, type_, self._name(name), value)

    def typedef(self, meta: Meta, parts: list[Any]) -> Typedef:
        return Typedef(parts[0], tuple(parts[1:]))

    def struct(self, meta: Meta, parts: list[Any]) -> Struct:
        annotations, name, members = parts
        return Struct(annotations, self._name(name), members)

    def body(self, meta: Meta, parts: list[Any]) -> tuple[Member, ...]:
        return tuple(parts)

    def member(self, meta: Meta, parts: list[Any]) -> Member:
        annotations, type_, *declarators = parts
        return Member(annotations, type_, tuple(declarators))

    def enum(self, meta: Meta, parts: list[Any]) -> Enum:
        return Enum(self._name(parts[1]))

    def declarator(self, meta: Meta, parts: list[Any]) -> Declarator:
        return Declarator(self._name(parts[0]), tuple(parts[1:]))

    def annotations(self, meta: Meta, parts: list[Any]) -> tuple[Annotation, ...]:
        return tuple(parts)

    def annotation(self, meta: Meta, parts: list[Any]) -> Annotation:
        name, *arguments = parts
        return Annotation(name, tuple(a for a in arguments if a is not None), self._span(meta))

    def argument(self, meta: Meta, parts: list[Any]) -> tuple[None, Expression]:
        return None, parts[0]

    def named_argument(self, meta: Meta, parts: list[Any]) -> tuple[NameSyntax, Expression]:
        return self._name(parts[0]), parts[1]

    def basic_type(self, meta: Meta, parts: list[Any]) -> BasicType:
        words = " ".join(part for part in parts if part)
        return BasicType(_ROS_NAMES.get(words, words), self._span(meta))

    def sequence_type(self, meta: Meta, parts: list[Any]) -> SequenceType:
        element, bound = parts
        return SequenceType(element, bound, self._span(meta))

    def string_type(self, meta: Meta, parts: list[Any]) -> StringType:
        word, bound = parts
        return StringType(word == "wstring", bound, self._span(meta))

    def fixed_type(self, meta: Meta, parts: list[Any]) -> FixedType:
        return FixedType(self._span(meta))

    fixed_constant = fixed_type

    def scoped_name(self, meta: Meta, parts: list[Any]) -> ScopedName:
        words = tuple(str(part) for part in parts if part is not None and part != "::")
        return ScopedName(words, parts[0] is not None, self._span(meta))

    def chain(self, meta: Meta, parts: list[Any]) -> Chain:
        return Chain(tuple(parts[::2]), tuple(map(str, parts[1::2])), self._span(meta))

    def left(self, meta: Meta, parts: list[Any]) -> str:
        return self._source.text[meta.start_pos : meta.end_pos]

    right = left

    def unary(self, meta: Meta, parts: list[Any]) -> Unary:
        operator, operand = parts
        return Unary(str(operator), operand, self._span(meta))

    def literal(self, meta: Meta, parts: list[Any]) -> LiteralSyntax:
        kind = _LITERALS[parts[0].type]
        return LiteralSyntax(kind, tuple(map(str, parts)), self._span(meta))

    def _name(self, token: Token) -> NameSyntax:
        return NameSyntax(str(token), _span(self._source, token))

    def _span(self, meta: Meta) -> Span:
        return Span(self._source, meta.start_pos, meta.end_pos)


def _span(source: Source, token: Token) -> Span:
    assert token.start_pos is not None and token.end_pos is not None
    return Span(source, token.start_pos, token.end_pos)
