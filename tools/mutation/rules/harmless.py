"""Recognize changes that cannot affect any result of the program. They are not made.

Each function recognizes one class of such changes by the source alone, and returns `False` if in
doubt.
"""

from __future__ import annotations

import ast
import re

from tools.mutation.rules.source import Functions, Source

__all__ = ["are_independent", "durations", "is_plain_bool", "is_read_only"]

# Methods that change a list, set, dictionary or deque, and nothing else.
COLLECTS = {
    *("add", "append", "appendleft", "clear", "discard", "extend", "insert", "pop", "remove"),
    *("setdefault", "sort", "update"),
}
# Functions and methods without side effects, which arguments may call.
PURE = {"bool", "bytes", "dict", "frozenset", "int", "join", "len", "list", "max", "min"}
PURE |= {"replace", "set", "sorted", "str", "tuple"}
# Calls that declare arguments of a command line. Their order changes only the help text.
DECLARES = re.compile(r"add_argument|set_defaults|_?add_[a-z0-9_]*")
_OF_A_PARSER = {"argparse.ArgumentParser", "argparse._ArgumentGroup", "ArgumentParser"}
DURATION = re.compile(r"(^|_)(seconds|timeout)(_|$)", re.IGNORECASE)


def are_independent(source: Source, one: ast.Call, two: ast.Call) -> bool:
    """Return whether two calls may come in any order.

    This holds if they change two different collections, and neither reads the other's collection.
    It also holds for declarations of command line arguments, unless both are positional.
    """
    if _declares(source, one) and _declares(source, two):
        return not (_may_be_positional(source, one) and _may_be_positional(source, two))
    receivers = [_collection(each) for each in (one, two)]
    if None in receivers or receivers[0] == receivers[1]:
        return False
    for call, other in ((one, receivers[1]), (two, receivers[0])):
        parts = [node for each in ast.iter_child_nodes(call) for node in ast.walk(each)]
        inner = [node for node in parts if isinstance(node, ast.Call)]
        if any(not _is_pure(each) for each in inner):
            return False
        if any(isinstance(node, (ast.Await, ast.Yield, ast.NamedExpr)) for node in parts):
            return False
        if any(isinstance(node, ast.expr) and ast.unparse(node) == other for node in parts):
            return False
    return True


def _collection(call: ast.Call) -> str | None:
    """Return the name of the collection that a call changes, or `None` if it has no plain name."""
    function = call.func
    if not isinstance(function, ast.Attribute) or function.attr not in COLLECTS:
        return None
    inner: ast.expr = function.value
    if isinstance(inner, ast.Call) and _collection(inner) is not None:
        return _collection(inner)  # For example, the result of `setdefault` is in the collection.
    name = ast.unparse(inner)
    return name if re.fullmatch(r"[A-Za-z_][\w.]*", name) else None


def _is_pure(call: ast.Call) -> bool:
    name = ast.unparse(call.func).rpartition(".")[2]
    return name in PURE or name[:1].isupper() or name == "setdefault"


def _declares(source: Source, call: ast.Call) -> bool:
    """Return whether a call declares arguments of a command line."""
    name = ast.unparse(call.func).rpartition(".")[2]
    return name in ("add_argument", "set_defaults") or (
        DECLARES.fullmatch(name) is not None and bool(_OF_A_PARSER & _names(source, call))
    )


def _names(source: Source, call: ast.Call) -> set[str]:
    """Return the types of names in a call that are parameters of the enclosing function."""
    function = source.function(call)
    given = {each.id for each in ast.walk(call) if isinstance(each, ast.Name)}
    arguments = function.args.args if function is not None else []
    return {ast.unparse(a.annotation) for a in arguments if a.annotation and a.arg in given}


def _may_be_positional(source: Source, call: ast.Call, seen: frozenset[str] = frozenset()) -> bool:
    """Return whether a call declares, or may declare, a positional argument."""
    name = ast.unparse(call.func).rpartition(".")[2]
    if name == "set_defaults":
        return False
    if name == "add_argument":
        first = call.args[0] if call.args else None
        return not (isinstance(first, ast.Constant) and str(first.value).startswith("-"))
    own = [each for each in source.tree.body if isinstance(each, Functions) and each.name == name]
    if not own or name in seen:
        return True
    calls = [each for each in ast.walk(own[0]) if isinstance(each, ast.Call)]
    return any(
        _may_be_positional(source, each, seen | {name})
        for each in calls
        if DECLARES.fullmatch(ast.unparse(each.func).rpartition(".")[2])
    )


def durations(text: str) -> set[tuple[int, int]]:
    """Return the places of numbers of seconds, because no test notices one second more or less.

    Numbers up to 2 are excluded, because tests may notice a change of them.
    """
    source = Source(text)
    numbers = [node for node in source.nodes if isinstance(node, ast.Constant)]
    return {
        source.span(node)
        for node in numbers
        if isinstance(node.value, int) and node.value > 2 and _is_duration(source, node)
    }


def _is_duration(source: Source, number: ast.Constant) -> bool:
    above = source.parent(number)
    if isinstance(above, ast.keyword):
        return DURATION.search(above.arg or "") is not None
    if isinstance(above, (ast.Assign, ast.AnnAssign)) and above.value is number:
        target = above.targets[0] if isinstance(above, ast.Assign) else above.target
        return DURATION.search(ast.unparse(target).rpartition(".")[2]) is not None
    return False


def is_read_only(source: Source, factory: ast.keyword) -> bool:
    """Return whether a default factory is for a read-only type: objects may share the value."""
    field = source.parent(factory)
    declared = source.parent(field) if field is not None else None
    return isinstance(declared, ast.AnnAssign) and ast.unparse(declared.annotation).startswith(
        ("Mapping[", "Sequence[", "Collection[", "Iterable[")
    )


def is_plain_bool(source: Source, call: ast.Call) -> bool:
    """Return whether a conversion to `int` or `bool` has no effect.

    It has none for `int` of a comparison, which is a number anyway, and for `bool` of the result of
    a function that is declared to return a `bool`.
    """
    name, argument = ast.unparse(call.func), call.args[0]
    if name == "int":
        return isinstance(argument, ast.Compare)
    above = source.parent(call)
    function = source.function(call)
    return (
        name == "bool"
        and isinstance(above, ast.Return)
        and function is not None
        and function.returns is not None
        and ast.unparse(function.returns) == "bool"
    )
