"""Faults of priority: two branches, or two assignments to one target, in the wrong order.

The rules cover statements of Python and of Amaranth. In Amaranth, the first true condition of
`m.If` and `m.Elif` counts, and the last assignment to a signal.
"""

from __future__ import annotations

import ast
import itertools
from collections.abc import Iterator

from tools.mutation.mutants import Change
from tools.mutation.rules.index import Index
from tools.mutation.rules.source import Source

__all__ = ["RULES", "assigned", "blocks", "hardware_branch"]

ENDS = (ast.Return, ast.Raise, ast.Continue, ast.Break)


def swapped_branches(source: Source, _: Index) -> Iterator[Change]:
    """Test the second of two conditions first."""
    for node in source.nodes:
        if isinstance(node, ast.If) and len(node.orelse) == 1:
            other = node.orelse[0]
            if isinstance(other, ast.If) and source.of(other).startswith("elif"):
                yield from _swap_arms(source, (node.test, node.body), (other.test, other.body))
        elif isinstance(node, ast.Match):
            for first, second in itertools.pairwise(node.cases):
                if not _disjoint_cases(first, second):
                    yield _swap(
                        source,
                        _span(source, first.pattern, first.body),
                        _span(source, second.pattern, second.body),
                    )
    for block in blocks(source):
        for one, two in itertools.pairwise(block):
            if isinstance(one, ast.If) and isinstance(two, ast.If):
                # Both branches leave the block, so the first true condition counts.
                plain = not one.orelse and not source.of(one).startswith("elif")
                if plain and isinstance(one.body[-1], ENDS) and isinstance(two.body[-1], ENDS):
                    yield from _swap_arms(source, (one.test, one.body), (two.test, two.body))
            elif hardware_branch(one) in ("If", "Elif") and hardware_branch(two) == "Elif":
                assert isinstance(one, ast.With) and isinstance(two, ast.With)
                arms = [(_condition(each), each.body) for each in (one, two)]
                yield from _swap_arms(source, *arms)


def overridden_assignment(source: Source, _: Index) -> Iterator[Change]:
    """Move an assignment after the one that should override it."""
    for block in blocks(source):
        for at, first in enumerate(block[:-1]):
            targets = assigned(first, deep=False)
            for last in block[at + 1 :]:
                if targets and targets & assigned(last, deep=True):
                    yield _after(source, first, last)
                    break


def assigned(node: ast.stmt, *, deep: bool) -> set[str]:
    """Return what a statement assigns: signals with their domains, or names of Python.

    Parameters
    ----------
    deep : bool
        Return the assignments inside a branch instead. For a statement that is not a branch, return
        only signals.
    """
    if deep:
        if not isinstance(node, ast.If) and not hardware_branch(node):
            return assigned(node, deep=False) if isinstance(node, ast.AugAssign) else set()
        inner = [each for each in ast.walk(node) if isinstance(each, ast.stmt)]
        return set().union(
            *(assigned(each, deep=False) for each in inner if not isinstance(each, ast.If))
        )
    if isinstance(node, ast.Assign) and len(node.targets) == 1:
        target = node.targets[0]
        if isinstance(target, (ast.Name, ast.Attribute)):
            return {ast.unparse(target)}
    if isinstance(node, ast.AugAssign) and ".d." in f"{ast.unparse(node.target)}.":
        return {
            f"{ast.unparse(node.target)} {ast.unparse(each.func.value)}"
            for each in ast.walk(node.value)
            if isinstance(each, ast.Call)
            and isinstance(each.func, ast.Attribute)
            and each.func.attr == "eq"
        }
    return set()


def blocks(source: Source) -> Iterator[list[ast.stmt]]:
    """Yield sequences of statements."""
    for node in source.nodes:
        for name in ("body", "orelse", "finalbody"):
            block = getattr(node, name, None)
            if isinstance(block, list) and block:
                yield block


def hardware_branch(node: ast.stmt) -> str:
    """Return Amaranth's `If`, `Elif`, `Else`, `Case` or `Default`; empty for other statements."""
    if isinstance(node, ast.With) and isinstance(node.items[0].context_expr, ast.Call):
        function = node.items[0].context_expr.func
        branches = ("If", "Elif", "Else", "Case", "Default")
        if isinstance(function, ast.Attribute) and function.attr in branches:
            return function.attr
    return ""


def _condition(node: ast.With) -> ast.expr:
    call = node.items[0].context_expr
    assert isinstance(call, ast.Call)
    return call.args[0]


def _swap_arms(
    source: Source, one: tuple[ast.expr, list[ast.stmt]], two: tuple[ast.expr, list[ast.stmt]]
) -> Iterator[Change]:
    same = ast.dump(ast.Module(one[1], [])) == ast.dump(ast.Module(two[1], []))
    if not same and not _disjoint(one[0], two[0]):
        # Conditions may be in parentheses. These stay, and so does the text between the conditions.
        first, second = source.span(one[0]), source.span(two[0])
        bodies = [_lines(source, body) for body in (one[1], two[1])]
        new = (
            source.text[second[0] : second[1]]
            + source.text[first[1] : bodies[0][0]]
            + source.text[slice(*bodies[1])]
            + source.text[bodies[0][1] : second[0]]
            + source.text[first[0] : first[1]]
            + source.text[second[1] : bodies[1][0]]
            + source.text[slice(*bodies[0])]
        )
        yield source.change("swapped branches", (first[0], bodies[1][1]), new)


def _lines(source: Source, body: list[ast.stmt]) -> tuple[int, int]:
    return source.span(body[0])[0], source.span(body[-1])[1]


def _span(source: Source, first: ast.AST, body: list[ast.stmt]) -> tuple[int, int]:
    return source.span(first)[0], source.span(body[-1])[1]


def _swap(source: Source, one: tuple[int, int], two: tuple[int, int]) -> Change:
    texts = [source.text[slice(*each)] for each in (one, two)]
    new = texts[1] + source.text[one[1] : two[0]] + texts[0]
    return source.change("swapped branches", (one[0], two[1]), new)


def _after(source: Source, first: ast.stmt, last: ast.stmt) -> Change:
    start, first_end = source.span(first)
    end = source.span(last)[1]
    text = source.text[start:first_end]
    new = f"pass{source.text[first_end:end]}\n{' ' * first.col_offset}{text}"
    return source.change("overridden assignment", (start, end), new)


def _disjoint(one: ast.expr, two: ast.expr) -> bool:
    """Return whether two conditions obviously never hold at the same time."""
    if isinstance(one, ast.Compare) and isinstance(two, ast.Compare):
        same = ast.unparse(one.left) == ast.unparse(two.left)
        exact = isinstance(one.ops[0], (ast.Eq, ast.Is)) and isinstance(
            two.ops[0], (ast.Eq, ast.Is)
        )
        return same and exact
    calls = [each for each in (one, two) if isinstance(each, ast.Call) and len(each.args) == 2]
    if len(calls) == 2 and all(ast.unparse(each.func) == "isinstance" for each in calls):
        return ast.unparse(calls[0].args[0]) == ast.unparse(calls[1].args[0])
    if _starts_otherwise(one, two):
        return True
    return ast.unparse(one) in (f"not {ast.unparse(two)}", ast.unparse(two))


def _starts_otherwise(one: ast.expr, two: ast.expr) -> bool:
    """Return whether two conditions test for different beginnings, which no text has both."""
    receivers, begins = [], []
    for each in (one, two):
        if not (
            isinstance(each, ast.Call)
            and isinstance(each.func, ast.Attribute)
            and each.func.attr == "startswith"
            and len(each.args) == 1
            and isinstance(each.args[0], ast.Constant)
        ):
            return False
        receivers.append(ast.unparse(each.func.value))
        begins.append(str(each.args[0].value))
    short, long = sorted(begins, key=len)
    return receivers[0] == receivers[1] and not long.startswith(short)


def _disjoint_cases(one: ast.match_case, two: ast.match_case) -> bool:
    """Return whether swapping two cases is no fault: they are disjoint, or one must be last."""
    kinds = (ast.MatchClass, ast.MatchValue, ast.MatchSingleton)
    parts = []
    for each in (one, two):
        any_of = each.pattern.patterns if isinstance(each.pattern, ast.MatchOr) else [each.pattern]
        if any(not isinstance(part, kinds) for part in any_of):
            return each.guard is None and isinstance(each.pattern, ast.MatchAs)
        parts.append(any_of)
    return all(_never_both(a, b) for a in parts[0] for b in parts[1])


def _never_both(one: ast.pattern, two: ast.pattern) -> bool:
    if not isinstance(one, ast.MatchClass) or not isinstance(two, ast.MatchClass):
        return ast.unparse(one) != ast.unparse(two)
    if ast.unparse(one.cls) != ast.unparse(two.cls):
        return True
    given = dict(zip(one.kwd_attrs, one.kwd_patterns, strict=True))
    return any(
        isinstance(pattern, ast.MatchValue)
        and isinstance(given.get(name), ast.MatchValue)
        and ast.unparse(pattern) != ast.unparse(given[name])
        for name, pattern in zip(two.kwd_attrs, two.kwd_patterns, strict=True)
    )


RULES = (swapped_branches, overridden_assignment)
