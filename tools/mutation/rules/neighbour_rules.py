"""Faults of names: another attribute, variable or member of the same type; a default that is used.

Names without a type in the source are not changed, because a name of another type mostly makes the
program crash.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator

from tools.mutation.mutants import Change
from tools.mutation.rules.index import Index
from tools.mutation.rules.source import Source

__all__ = ["RULES"]

# Pairs of names that are easily confused: of streams, AXI, results of processes, places in texts.
PAIRS = {
    "valid": "ready",
    "ready": "valid",
    "first": "last",
    "start": "end",
    "end": "start",
    "stdout": "stderr",
    "stderr": "stdout",
    "items": "values",
    "startswith": "endswith",
    "endswith": "startswith",
    "removeprefix": "removesuffix",
    "lstrip": "rstrip",
    "rstrip": "lstrip",
    "partition": "rpartition",
    "rpartition": "partition",
    "append": "extend",
    "find": "rfind",
    "any": "all",
    "search": "match",
    "match": "fullmatch",
    "fullmatch": "match",
}
MOST = 2


def wrong_attribute(source: Source, index: Index) -> Iterator[Change]:
    """Take another attribute of the same type, or another member of an enumeration."""
    for node in source.nodes:
        if not isinstance(node, ast.Attribute) or not isinstance(node.ctx, ast.Load):
            continue
        name = node.value.id if isinstance(node.value, ast.Name) else ""
        if name in index.enums and node.attr in index.enums[name]:
            members = index.enums[name]
            at = members.index(node.attr)
            others = [members[(at + 1) % len(members)]] if len(members) > 1 else []
        else:
            others = index.neighbours(node.attr, _class(source, node) if name == "self" else None)
            others = others or ([PAIRS[node.attr]] if node.attr in PAIRS else [])
        end = source.span(node)[1]
        for other in others[:MOST]:
            yield source.change("wrong neighbour", (end - len(node.attr), end), other)


def wrong_variable(source: Source, _: Index) -> Iterator[Change]:
    """Take another parameter of the same type, or another signal of the same shape."""
    groups: dict[ast.AST, list[list[str]]] = {}
    for node in source.nodes:
        if not isinstance(node, ast.Name) or not isinstance(node.ctx, ast.Load):
            continue
        function = source.function(node)
        if function is None:
            continue
        if function not in groups:
            groups[function] = list(_alike(function))
        for group in groups[function]:
            if node.id in group:
                others = [each for each in group if each != node.id]
                at = group.index(node.id)
                others.sort(key=lambda each: abs(group.index(each) - at))
                for other in others[:MOST]:
                    yield source.change("wrong neighbour", node, other)


def _alike(function: ast.FunctionDef | ast.AsyncFunctionDef) -> Iterator[list[str]]:
    """Yield groups of two or more names of the same type."""
    types: dict[str, list[str]] = defaultdict(list)
    given = function.args
    for argument in [*given.posonlyargs, *given.args, *given.kwonlyargs]:
        if argument.annotation is not None:
            types[ast.unparse(argument.annotation)].append(argument.arg)
    for node in ast.walk(function):
        if isinstance(node, ast.Assign) and ast.unparse(node.value).startswith("Signal("):
            types[ast.unparse(node.value)] += [
                target.id for target in node.targets if isinstance(target, ast.Name)
            ]
    yield from (group for group in types.values() if len(group) > 1)


def default_used(source: Source, index: Index) -> Iterator[Change]:
    """Leave out an argument that has a default."""
    for node in source.nodes:
        if not isinstance(node, ast.Call):
            continue
        function = node.func
        called = function.attr if isinstance(function, ast.Attribute) else ""
        called = function.id if isinstance(function, ast.Name) else called
        known = index.parameters(called)
        for keyword in node.keywords:
            name = keyword.arg
            if name is not None and name in known and known[name].has_default:
                yield from _without(source, node, keyword)
        if node.args and not node.keywords and not isinstance(node.args[-1], ast.Starred):
            plain = index.positional(called)
            if len(node.args) <= len(plain) and plain[len(node.args) - 1].has_default:
                yield from _without(source, node, node.args[-1])


def _without(source: Source, node: ast.Call, argument: ast.AST) -> Iterator[Change]:
    start, end = source.span(argument)
    rest = source.text[end : source.span(node)[1]]
    after = len(rest) - len(rest.lstrip(", \n"))
    yield source.change("default used", (start, end + after), "")


def _class(source: Source, node: ast.AST) -> str | None:
    found = [each.name for each in source.around(node) if isinstance(each, ast.ClassDef)]
    return found[0] if found else None


RULES = (wrong_attribute, wrong_variable, default_used)
