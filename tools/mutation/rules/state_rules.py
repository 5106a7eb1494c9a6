"""Faults of statements and state: actions that are left out, state that is kept too long."""

from __future__ import annotations

import ast
import itertools
import re
from collections.abc import Iterator

from tools.mutation.mutants import Change
from tools.mutation.rules.harmless import are_independent, is_read_only
from tools.mutation.rules.index import Index
from tools.mutation.rules.order_rules import blocks, hardware_branch
from tools.mutation.rules.source import Source

__all__ = ["RULES"]

BUILDERS = ("__init__", "__post_init__")
EMPTY = {"list", "dict", "set"}
Name = ast.Name | ast.Attribute | ast.Subscript


def dropped_branch(source: Source, _: Index) -> Iterator[Change]:
    """Never take a branch, or always take it."""
    for node in source.nodes:
        if isinstance(node, ast.If):
            yield source.change("dropped branch", node.test, "False")
            if not node.orelse and not isinstance(node.body[-1], (ast.Return, ast.Raise)):
                yield source.change("ignored condition", node.test, "True")
        elif isinstance(node, ast.Match):
            for case in node.cases:
                # Do not drop a wildcard case: often, it is for values that never occur.
                wild = isinstance(case.pattern, ast.MatchAs) and case.pattern.pattern is None
                if case.guard is not None:
                    yield source.change("dropped branch", case.guard, "False")
                    yield source.change("ignored condition", case.guard, "True")
                elif not wild and len(node.cases) > 1:
                    end = source.span(case.pattern)[1]
                    yield source.change("dropped branch", (end, end), " if False")
        elif isinstance(node, ast.With) and hardware_branch(node) in ("If", "Elif"):
            call = node.items[0].context_expr
            assert isinstance(call, ast.Call)
            if call.args:
                text = source.atom(call.args[0])
                yield source.change("dropped branch", call.args[0], f"{text} & 0")


def dropped_check(source: Source, _: Index) -> Iterator[Change]:
    """Drop a `raise`, unless it is the only statement of an `if` (then the branch is dropped)."""
    for node in source.nodes:
        if isinstance(node, ast.Raise) and node.exc is not None:
            above = source.parent(node)
            alone = isinstance(above, ast.If) and len(above.body) == 1 and above.body[0] is node
            never = re.match(r"(AssertionError|NotImplementedError)\b", ast.unparse(node.exc))
            if not alone and not never:
                yield source.change("dropped check", node, "pass")


def dropped_assignment(source: Source, _: Index) -> Iterator[Change]:
    """Leave out an assignment; if it only clears a flag, the rule is called "sticky flag"."""
    for node in source.nodes:
        if not isinstance(node, ast.Assign) or len(node.targets) != 1:
            continue
        function = source.function(node)
        if function is not None and _is_set_before(node, function):
            rule = "sticky flag" if _is_nothing(node.value) else "dropped assignment"
            yield source.change(rule, node, "pass")
    for node in source.nodes:
        # Drop one of several assignments to signals.
        if isinstance(node, ast.AugAssign) and ".d." in f"{ast.unparse(node.target)}.":
            many = node.value.elts if isinstance(node.value, (ast.List, ast.Tuple)) else []
            for one in many:
                rest = ", ".join(source.of(each) for each in many if each is not one)
                yield source.change(_kind(one), node.value, f"[{rest}]")
            if not many and _kind(node.value) == "sticky flag":
                yield source.change("sticky flag", node, "pass")


def _kind(assignment: ast.expr) -> str:
    clears = re.search(r"\.eq\((0|False|Const\(0.*\)|C\(0.*\))\)$", ast.unparse(assignment))
    return "sticky flag" if clears else "dropped assignment"


def _is_set_before(node: ast.Assign, function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    target = node.targets[0]
    if isinstance(target, ast.Attribute):
        return function.name not in BUILDERS
    if isinstance(target, ast.Subscript):
        return True
    return isinstance(target, ast.Name) and any(
        isinstance(each, ast.Assign)
        and each.lineno < node.lineno
        and ast.unparse(each.targets[0]) == target.id
        for each in ast.walk(function)
    )


def _is_nothing(value: ast.expr) -> bool:
    return ast.unparse(value) in ("0", "None", "False", "[]", "{}", "''", "b''", "set()")


def missing_reset(source: Source, _: Index) -> Iterator[Change]:
    """Keep state from one iteration of a loop to the next; leave a register out of a reset."""
    for node in source.nodes:
        if isinstance(node, (ast.For, ast.While)):
            first = node.body[0]
            if isinstance(first, ast.Assign) and _is_fresh(first.value):
                start = source.span(node)[0]
                first_start, end = source.span(first)
                text = source.text[first_start:end]
                loop = source.text[start:first_start]
                new = f"{text}\n{' ' * node.col_offset}{loop}pass"
                yield source.change("missing reset", (start, end), new)
        elif isinstance(node, ast.Assign) and _is_signal(node.value):
            name = re.escape(ast.unparse(node.targets[0]))
            if re.search(rf"d\.sync \+= [^=]*?\b{name}\.eq\(", source.text):
                end = source.span(node.value)[1] - 1
                comma = "" if source.of(node.value).endswith("()") else ", "
                yield source.change("missing reset", (end, end), f"{comma}reset_less=True")


def _is_signal(value: ast.expr) -> bool:
    return isinstance(value, ast.Call) and ast.unparse(value.func) == "Signal"


def _is_fresh(value: ast.expr) -> bool:
    if isinstance(value, (ast.List, ast.Dict)):
        return not (value.elts if isinstance(value, ast.List) else value.keys)
    if isinstance(value, ast.Call):
        return not value.args and ast.unparse(value.func) in EMPTY
    return isinstance(value, ast.Constant)


def kept_state(source: Source, _: Index) -> Iterator[Change]:
    """Share a collection between calls or objects, although each should have its own."""
    number = 0
    for node in source.nodes:
        if isinstance(node, ast.keyword) and node.arg == "default_factory":
            text = source.of(node.value)
            if text in EMPTY and not is_read_only(source, node):
                yield source.change("kept state", node.value, f"lambda kept={text}(): kept")
        elif isinstance(node, (ast.Assign, ast.AnnAssign)) and isinstance(node.value, ast.expr):
            function = source.function(node)
            empty = _is_fresh(node.value) and not isinstance(node.value, ast.Constant)
            if empty and function is not None and source.parent(node) is function:
                # Keep the collection in a global, as a mutable default argument would.
                number += 1
                kept = f'globals().setdefault("_kept_{number}", {source.of(node.value)})'
                yield source.change("kept state", node.value, kept)


def constant_return(source: Source, _: Index) -> Iterator[Change]:
    """Always return the same value."""
    for node in source.nodes:
        if not isinstance(node, ast.Return) or node.value is None:
            continue
        function = source.function(node)
        if function is None or function.returns is None or isinstance(node.value, ast.Constant):
            continue
        type_ = ast.unparse(function.returns)
        if type_ == "bool":
            values = ["True", "False"]
        elif type_.endswith("| None"):
            values = ["None"]
        elif type_.startswith(("list[", "dict[", "set[", "tuple[")) and "..." in type_ + "...":
            values = [f"{type_.partition('[')[0]}()"]
        else:
            continue
        for value in values:
            if ast.unparse(node.value) not in (value, "[]", "{}", "()"):
                yield source.change("constant return", node.value, value)


def swapped_calls(source: Source, _: Index) -> Iterator[Change]:
    """Swap two calls that follow each other."""
    for block in blocks(source):
        for one, two in itertools.pairwise(block):
            calls = [
                each.value
                for each in (one, two)
                if isinstance(each, ast.Expr) and isinstance(each.value, ast.Call)
            ]
            same = source.of(one) == source.of(two)
            if len(calls) == 2 and not same and not are_independent(source, *calls):
                (start, one_end), (two_start, end) = source.span(one), source.span(two)
                new = source.of(two) + source.text[one_end:two_start] + source.of(one)
                yield source.change("swapped calls", (start, end), new)


RULES = (
    dropped_branch,
    dropped_check,
    dropped_assignment,
    missing_reset,
    kept_state,
    constant_return,
    swapped_calls,
)
