"""Faults of meaning in conditions and sequences: a clause, limit, item or operand that is wrong.

For example, a condition loses one side, operands change their order, and a sequence loses its first
or last item.
"""

from __future__ import annotations

import ast
import itertools
from collections.abc import Iterator

from tools.mutation.mutants import Change
from tools.mutation.rules.harmless import is_plain_bool
from tools.mutation.rules.index import Index
from tools.mutation.rules.source import Source

__all__ = ["RULES"]

BITS = (ast.BitAnd, ast.BitOr)
ORDERED = (ast.Sub, ast.Div, ast.FloorDiv, ast.Mod, ast.LShift, ast.RShift)
LIMITS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
MEMBERS = (ast.In, ast.NotIn)
# Calls with a range as a shape. One value more or less rarely changes the width of a shape.
SHAPES = ("Signal", "In", "Out", "Const", "C", "cast", "Shape")
ENDLESS = ("count", "cycle", "repeat", "iter")
UNWRAPPED = ("strip", "rstrip", "lstrip", "lower", "upper", "copy", "casefold")


def dropped_clause(source: Source, _: Index) -> Iterator[Change]:
    """Leave out one side of `and`, `or`, `&`, `|`, or one comparison of a chain."""
    for node in source.nodes:
        if isinstance(node, ast.BoolOp):
            word = " and " if isinstance(node.op, ast.And) else " or "
            for index in range(len(node.values)):
                rest = [*node.values[:index], *node.values[index + 1 :]]
                text = word.join(source.atom(each) for each in rest)
                yield source.change("dropped clause", node, f"({text})")
        elif isinstance(node, ast.BinOp) and isinstance(node.op, BITS):
            sides = [node.left, node.right]
            if not any(isinstance(side, (ast.Constant, ast.Set)) for side in sides):
                for side in sides:
                    yield source.change("dropped clause", node, source.atom(side))
        elif isinstance(node, ast.Compare) and len(node.ops) == 2:
            first, middle = source.span(node.left)[0], source.span(node.comparators[0])
            yield source.change("dropped clause", (first, middle[0]), "")
            yield source.change("dropped clause", (middle[1], source.span(node)[1]), "")


def dropped_filter(source: Source, _: Index) -> Iterator[Change]:
    """Replace a condition of a comprehension by `True`, so that no item is dropped."""
    for node in source.nodes:
        if isinstance(node, ast.comprehension):
            for test in node.ifs:
                yield source.change("dropped filter", test, "True")


def dropped_choice(source: Source, _: Index) -> Iterator[Change]:
    """Leave out one of several accepted values, types or patterns."""
    for node in source.nodes:
        if isinstance(node, ast.Compare) and isinstance(node.ops[0], MEMBERS):
            choices = node.comparators[0]
        elif isinstance(node, ast.Call) and _called(node) in ("isinstance", "startswith"):
            choices = node.args[-1]
        elif isinstance(node, ast.MatchOr):
            for each in node.patterns:
                rest = [source.of(other) for other in node.patterns if other is not each]
                yield source.change("dropped choice", node, " | ".join(rest))
            continue
        else:
            continue
        if isinstance(choices, (ast.Tuple, ast.Set, ast.List)) and len(choices.elts) > 1:
            for one in choices.elts:
                rest = [source.of(other) for other in choices.elts if other is not one]
                yield source.change("dropped choice", choices, f"({', '.join(rest)},)")


def swapped_operand(source: Source, index: Index) -> Iterator[Change]:
    """Swap both sides of an operator, or two neighbouring arguments of a call."""
    for node in source.nodes:
        sides: tuple[ast.expr, ...] = ()
        if isinstance(node, ast.BinOp) and isinstance(node.op, ORDERED):
            if not any(_is_text(side) for side in (node.left, node.right)):
                sides = (node.left, node.right)
        elif isinstance(node, ast.Compare) and len(node.ops) == 1:
            if isinstance(node.ops[0], LIMITS):
                sides = (node.left, node.comparators[0])
        elif isinstance(node, ast.IfExp):
            sides = (node.body, node.orelse)
        elif isinstance(node, ast.Call):
            for pair in _pairs(node, index):
                yield _swap(source, *pair)
        if sides:
            yield _swap(source, *sides)


def _swap(source: Source, a: ast.expr, b: ast.expr) -> Change:
    (start, a_end), (b_start, end) = source.span(a), source.span(b)
    new = source.atom(b) + source.text[a_end:b_start] + source.atom(a)
    # Parentheses around one of the two operands stay where they are.
    return source.change("swapped operand", (start, end), new)


def _pairs(node: ast.Call, index: Index) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield pairs of neighbouring arguments of the same type."""
    name = _called(node)
    if name in ("Mux", "Cat"):
        plain = node.args[1:] if name == "Mux" else node.args
        yield from itertools.pairwise(plain)
        return
    declared = index.positional(name)
    for number, (a, b) in enumerate(zip(node.args, node.args[1:], strict=False)):
        if isinstance(b, ast.Starred) or number + 1 >= len(declared):
            return
        if declared[number].annotation == declared[number + 1].annotation != "":
            yield a, b
    types = {each: parameter.annotation for each, parameter in index.parameters(name).items()}
    for one, other in zip(node.keywords, node.keywords[1:], strict=False):
        if types.get(one.arg or "", "") == types.get(other.arg or "") != "":
            yield one.value, other.value


def wrong_limit(source: Source, _: Index) -> Iterator[Change]:
    """Begin or end a range or slice one earlier or later."""
    for node in source.nodes:
        if isinstance(node, ast.Call) and _called(node) == "range" and not node.keywords:
            above = source.parent(node)
            if isinstance(above, ast.Call) and _called(above) in SHAPES:
                continue
            yield from _off_by_one(source, node.args[0 if len(node.args) == 1 else 1])
            if len(node.args) > 1:
                yield from _off_by_one(source, node.args[0])
        elif isinstance(node, ast.Slice):
            for limit in (node.lower, node.upper):
                if limit is not None:
                    yield from _off_by_one(source, limit)


def _off_by_one(source: Source, limit: ast.expr) -> Iterator[Change]:
    if not isinstance(limit, ast.Constant):  # Numbers have a rule of their own.
        for change in ("+ 1", "- 1"):
            yield source.change("wrong limit", limit, f"{source.atom(limit)} {change}")


def ignored_item(source: Source, _: Index) -> Iterator[Change]:
    """Leave out the first or last item of an iteration, or stop after the first item."""
    for node in source.nodes:
        if isinstance(node, (ast.For, ast.comprehension)):
            if isinstance(node.iter, ast.Call) and _called(node.iter) in (*ENDLESS, "range"):
                continue
            for part in ("[1:]", "[:-1]"):
                yield source.change(
                    "ignored item", node.iter, f"list({source.of(node.iter)}){part}"
                )
        if isinstance(node, ast.For):
            last = node.body[-1]
            if not isinstance(last, (ast.Return, ast.Raise, ast.Break, ast.Continue)):
                end = source.span(last)[1]
                indent = " " * node.body[0].col_offset
                yield source.change("early exit", (end, end), f"\n{indent}break")


def unwrapped(source: Source, _: Index) -> Iterator[Change]:
    """Leave out a call that transforms a text, sequence or number."""
    for node in source.nodes:
        if not isinstance(node, ast.Call) or node.keywords:
            continue
        if isinstance(node.func, ast.Attribute) and node.func.attr in UNWRAPPED:
            yield source.change("unwrapped", node, source.atom(node.func.value))
        elif isinstance(node.func, ast.Name) and len(node.args) == 1:
            if node.func.id in ("sorted", "reversed"):
                yield source.change("unwrapped", node, f"list({source.of(node.args[0])})")
            elif node.func.id in ("abs", "int", "bool") and not is_plain_bool(source, node):
                yield source.change("unwrapped", node, source.atom(node.args[0]))


def _called(node: ast.Call) -> str:
    """Return the name of a called function, without the object before it."""
    if isinstance(node.func, ast.Attribute):
        return node.func.attr
    return node.func.id if isinstance(node.func, ast.Name) else ""


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (
        isinstance(node, ast.Constant) and isinstance(node.value, (str, bytes))
    )


RULES = (
    dropped_clause,
    dropped_filter,
    dropped_choice,
    swapped_operand,
    wrong_limit,
    ignored_item,
    unwrapped,
)
