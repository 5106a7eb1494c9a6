"""Text to syntax, line by line.

The lines of a ``.msg`` text are independent. So each line is parsed by itself, and an error never
hides the next one. The grammars of a line are ``ros1_msg.lark`` and ``ros2_msg.lark``; this module
turns their parse trees into syntax.

Comments are assigned by the rule of ``rosidl_adapter`` (``parse_message_string``,
``process_comments``), used for both dialects. Comment lines at the very top describe the message. A
comment above a definition, or after it on the same line, describes that definition. An indented
comment line continues the comment of the definition before it.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from functools import cache
from importlib import resources
from itertools import groupby

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput

from firm_hdl.errors import MAX_DIAGNOSTICS, Diagnostic, Source, Span
from firm_hdl.frontend.explain import clip, explain
from firm_hdl.frontend.syntax import (
    ConstantSyntax,
    FieldSyntax,
    ListSyntax,
    MemberSyntax,
    MessageSyntax,
    NameSyntax,
    SizeSyntax,
    TypeSyntax,
    ValueSyntax,
)
from firm_hdl.model import Dialect

__all__ = [
    "is_type_name",
    "line_trees",
    "lines_of",
    "read_message",
]


def condense(lines: list[str]) -> tuple[str, str | None]:
    """Take the unit out of comment lines and join what is left.

    * `lines`: comment lines without their ``#``.

    Returns: the comment and its unit. Common indentation and empty lines at both ends are removed,
    and several empty lines become one. The unit is the text in brackets, if there is exactly one.
    """
    units = list(_units("\n".join(lines)))
    unit = None
    if len(units) == 1:
        ((text, unit),) = units
        lines = [line.replace(text, "") for line in lines]
    kept: list[str] = []
    for is_empty, group in groupby(lines, key=lambda line: line == ""):
        kept += [""] if is_empty else group
    return textwrap.dedent("\n".join(kept)).strip("\n"), unit


def _units(comment: str) -> Iterator[tuple[str, str]]:
    r"""Yield each ``[unit]`` with the blanks in front of it, and the unit alone.

    A comma inside the brackets means a range, not a unit. The regular expression
    ``\s*\[([^,\]]+)\]`` finds the same, but not in linear time.
    """
    for part in comment.split(","):
        *closed, _ = part.split("]")
        for piece in closed:
            before, bracket, unit = piece.partition("[")
            if bracket and unit:
                blanks = before[len(before.rstrip()) :]
                yield f"{blanks}[{unit}]", unit


class CommentCollector:
    """Assigns each comment to a definition while the lines of a text are read."""

    def __init__(self) -> None:
        self.head: list[str] = []
        self._is_head = True
        self._pending: list[str] = []
        self._last: list[str] | None = None

    def add(self, comment: str, *, is_indented: bool, is_alone: bool) -> None:
        """Take one comment.

        * `comment`: the whole comment, from its first ``#`` to the end of the line.
        * `is_indented`: whether blanks precede the comment. Ignored unless `is_alone`.
        * `is_alone`: whether the line has no definition.
        """
        text = comment.lstrip("#").rstrip()
        if not is_alone:
            self._pending.append(text)
        elif not is_indented:
            (self.head if self._is_head else self._pending).append(text)
        elif self._last is not None:
            self._last.append(text)

    def end_head(self) -> None:
        """Note a line that is not a comment in the first column."""
        self._is_head = False

    def claim(self) -> list[str]:
        """Give a new definition the comments above it and in its line.

        The list that is returned still grows while indented comment lines follow.
        """
        self._last, self._pending = self._pending, []
        return self._last


_LINE_ENDS = {
    # genmsg and rosidl_adapter read files in text mode. rosidl_adapter then splits at every line
    # boundary of Python's `splitlines`.
    "ros1": re.compile(r"\r\n|[\n\r]"),
    "ros2": re.compile("\r\n|[\n\r\v\f\x1c\x1d\x1e\x85\u2028\u2029]"),
}


def read_message(
    source: Source,
    dialect: Dialect,
    *,
    lines: Iterable[tuple[int, str]] | None = None,
    text: str | None = None,
) -> tuple[MessageSyntax, list[Diagnostic]]:
    """Parse a ``.msg`` text, leaving out the lines with errors.

    * `lines`: the lines from `lines_of` that belong to the message; by default all.
    * `text`: the text of the message, if it is not the whole source.

    Returns: the syntax of the correct lines, and the errors of the others, in the order of the
    text.
    """
    parser = _parser(dialect)
    comments = CommentCollector()
    # The comment of a member is complete at the end.
    members: list[tuple[MemberSyntax, list[str]]] = []
    diagnostics: list[Diagnostic] = []
    for offset, line in lines_of(source.text, dialect) if lines is None else lines:
        if len(diagnostics) >= MAX_DIAGNOSTICS:
            message = "too many errors; the rest of this file was not checked"
            span = Span(source, offset, offset + len(line))
            diagnostics.append(Diagnostic(message, span))
            break
        if not line.startswith("#"):
            comments.end_head()
        try:
            tree = parser.parse(line, start="line")
        except UnexpectedInput as error:
            start, end, message = explain(error, line, dialect)
            span = Span(source, offset + start, offset + end)
            diagnostics.append(Diagnostic(message, span))
            continue
        definition = _collect_comment(tree, comments)
        if definition is not None:
            member = _Reader(source, offset).member(definition)
            if isinstance(member, Diagnostic):
                diagnostics.append(member)
            else:
                members.append((member, comments.claim()))
    comment, _ = condense(comments.head)
    syntax = MessageSyntax(
        source=source,
        dialect=dialect,
        members=tuple(_described(member, lines) for member, lines in members),
        comment=comment,
        text=text,
    )
    return syntax, diagnostics


def line_trees(text: str, dialect: Dialect) -> Iterator[Tree[Token]]:
    """Yield the parse trees of all lines without a syntax error."""
    for _, line in lines_of(text, dialect):
        with suppress(UnexpectedInput):
            yield _parser(dialect).parse(line, start="line")


def is_type_name(name: str, dialect: Dialect) -> bool:
    """Tell whether ``Name`` or ``package/Name`` is a legal name of a message type."""
    if name != name.strip():
        return False
    try:
        _parser(dialect).parse(name, start="reference")
    except UnexpectedInput:
        return False
    return True


@cache
def _parser(dialect: Dialect) -> Lark:
    grammar = resources.files(__package__).joinpath(f"{dialect}_msg.lark").read_text("utf-8")
    return Lark(grammar, parser="lalr", lexer="contextual", start=["line", "reference"])


def lines_of(text: str, dialect: Dialect) -> Iterator[tuple[int, str]]:
    """Split a text as ROS does.

    Yields the offset of a line, and the line without its line end. The text after the last line end
    is a line, too; it may be empty.
    """
    if dialect == "ros2":
        text = text.replace("\t", " ")  # As in rosidl_adapter, even in texts and comments.
    start = 0
    for end in _LINE_ENDS[dialect].finditer(text):
        yield start, text[start : end.start()]
        start = end.end()
    yield start, text[start:]


def _collect_comment(line: Tree[Token], comments: CommentCollector) -> Tree[Token] | None:
    """Pass a line's comment to the collector; return the line's definition, if any."""
    definition: Tree[Token] | None = None
    for child in line.children:
        if isinstance(child, Tree):
            definition = child
        elif child is not None:
            text = child.lstrip()
            is_indented = len(text) < len(child)
            comments.add(text, is_indented=is_indented, is_alone=definition is None)
    return definition


def _described(member: MemberSyntax, lines: list[str]) -> MemberSyntax:
    comment, unit = condense(lines)
    return replace(member, comment=comment, unit=unit)


class _Reader:
    """Turns the parse tree of one line into syntax.

    * `offset`: where the line starts in the source.
    """

    def __init__(self, source: Source, offset: int) -> None:
        self._source = source
        self._offset = offset

    def member(self, tree: Tree[Token]) -> MemberSyntax | Diagnostic:
        """Read a definition. Errors that a grammar cannot express are returned."""
        children = [child for child in tree.children if child is not None]
        at_name = next(i for i, c in enumerate(children) if _kind(c) in _NAMES)
        token = children[at_name]
        assert isinstance(token, Token)
        name = NameSyntax(str(token), self._span(token))
        try:
            type_ = self._type(children[:at_name])
            value = self._value(children[at_name + 1 :])
        except _TokenError as error:
            wrong, message = error.args
            return Diagnostic(message, self._span(wrong))
        if tree.data != "constant":
            return FieldSyntax(type=type_, name=name, default=value)
        indent = self._source.text[self._offset : type_.span.start]
        # The grammar of ROS 2 has no indented definitions.
        if type_.name == "string" and " " in indent:
            message = "a string constant must start in the first column: genmsg would read "
            message += f"'string {token}' for its name"
            return Diagnostic(message, type_.span)
        if value is None:
            # ``string NAME=`` is the empty text.
            end = Span(self._source, name.span.end, name.span.end)
            value = ValueSyntax(value="", text="", span=end)
        assert isinstance(value, ValueSyntax)
        return ConstantSyntax(type=type_, name=name, value=value)

    def _type(self, parts: list[Token | Tree[Token]]) -> TypeSyntax:
        head, *suffixes = parts
        package: str | None = None
        if isinstance(head, Token):
            name = str(head)
        else:
            *prefix, word = [t for t in head.children if isinstance(t, Token)]
            package = str(prefix[0]) if prefix else None
            name = str(word)
        tokens = list(_tokens(parts))
        bound = next((self._size(s) for s in suffixes if _kind(s) == "bound"), None)
        array = next((s for s in suffixes if _kind(s) == "array"), None)
        size = None if array is None else self._size(array)
        at_most = array is not None and any(t.type == "AT_MOST" for t in _tokens([array]))
        return TypeSyntax(
            package=package,
            name=name,
            is_builtin=isinstance(head, Token),
            bound=bound,
            array="one" if array is None else "array" if size and not at_most else "sequence",
            size=size,
            span=self._span(tokens[0], tokens[-1]),
        )

    def _size(self, suffix: Token | Tree[Token]) -> SizeSyntax | None:
        for token in _tokens([suffix]):
            if token.type == "SIZE":
                return SizeSyntax(_integer(token), self._span(token))
        return None

    def _value(self, parts: list[Token | Tree[Token]]) -> ValueSyntax | ListSyntax | None:
        if not parts:
            return None
        (part,) = parts
        if isinstance(part, Token):
            return self._scalar(part)
        tokens = list(_tokens([part]))
        items = tuple(self._scalar(t) for t in tokens if t.type not in _BRACKETS)
        return ListSyntax(items=items, span=self._span(tokens[0], tokens[-1]))

    def _scalar(self, token: Token) -> ValueSyntax:
        value: bool | int | float | str
        match token.type:
            case "INTEGER":
                value = _integer(token)
            case "FLOAT":
                value = float(token)
            case "BOOLEAN":
                value = _boolean(token)
            case "RAW_TEXT" | "BARE_TEXT" | "CONSTANT_BARE_TEXT":
                value = str(token)
            case "DOUBLE_QUOTED_ITEM" | "SINGLE_QUOTED_ITEM" | "BARE_ITEM":
                value = _item(token)
            case _:
                value = _unquoted(token)
        return ValueSyntax(value=value, text=str(token), span=self._span(token))

    def _span(self, first: Token, last: Token | None = None) -> Span:
        last = last or first
        assert first.start_pos is not None and last.end_pos is not None
        return Span(self._source, self._offset + first.start_pos, self._offset + last.end_pos)


_NAMES = frozenset({"NAME", "FIELD_NAME", "CONSTANT_NAME"})
_BRACKETS = frozenset({"EMPTY_LIST", "LIST_OPEN", "LIST_CLOSE", "LAST_CLOSE"})


class _TokenError(Exception):
    """A token that the grammar accepts but that has no value: the token, and why."""


def _kind(node: Token | Tree[Token]) -> str:
    return node.type if isinstance(node, Token) else str(node.data)


def _tokens(nodes: list[Token | Tree[Token]]) -> Iterator[Token]:
    for node in nodes:
        if isinstance(node, Token):
            yield node
        elif node is not None:
            yield from _tokens(node.children)


def _integer(token: Token) -> int:
    for base in (10, 0):
        try:
            return int(token, base)
        except ValueError:
            continue
    # The grammar accepts integers only, so conversion fails only at Python's limit on digits.
    raise _TokenError(token, f"a number of {len(token)} digits is too long")


def _boolean(token: Token) -> bool:
    word = token.lower()
    return word == "true" or (word != "false" and word.strip("+-0") != "")


def _unquoted(text: str) -> str:
    quote = text[0]
    return text[1:-1].replace("\\" + quote, quote)


def _item(token: Token) -> str:
    """Read an element of a list of texts; like rosidl, unquote and strip it twice."""
    text = str(token)  # A plain string, not a token.
    if text[0] in "\"'":
        text = _unquoted(text).strip()
    if text and text[0] in "\"'" and text[0] == text[-1]:
        if re.search(rf"(?<!\\){text[0]}", text[1:-1]):
            raise _TokenError(
                token, f"{clip(text)} is not a string: a quote inside it needs a backslash"
            )
        text = _unquoted(text)
    return text
