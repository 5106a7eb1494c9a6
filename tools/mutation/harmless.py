"""Changes that nobody could notice, whatever the program does; none of them is made.

Each function tells one class of them from its source alone, and says no where it is not sure.
"""

from __future__ import annotations

import ast
import re

from tools.mutation.source import Functions, Source

__all__ = ["are_independent", "durations", "is_plain_bool", "is_read_only"]

# What a list, set, dictionary or deque is told, and changes nothing else.
COLLECTS = {
    *("add", "append", "appendleft", "clear", "discard", "extend", "insert", "pop", "remove"),
    *("setdefault", "sort", "update"),
}
# What may be called for an argument without a change of anything.
PURE = {"bool", "bytes", "dict", "frozenset", "int", "join", "len", "list", "max", "min"}
PURE |= {"replace", "set", "sorted", "str", "tuple"}
# What a command line is told; in which order shows in its help alone.
DECLARES = re.compile(r"add_argument|set_defaults|_?add_[a-z0-9_]*")
_OF_A_PARSER = {"argparse.ArgumentParser", "argparse._ArgumentGroup", "ArgumentParser"}
DURATION = re.compile(r"(^|_)(seconds|timeout)(_|$)", re.IGNORECASE)


def are_independent(source: Source, one: ast.Call, two: ast.Call) -> bool:
    """Tell whether two calls may come in any order.

    They tell two different collections something that does not depend on the other one, or declare
    arguments of a command line. Of two arguments without dashes, the first comes first.
    """
    if _declares(source, one) and _declares(source, two):
        return not (_takes_place(source, one) and _takes_place(source, two))
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
    """Return the name that a collection has, or nothing if it is not told by a name alone."""
    function = call.func
    if not isinstance(function, ast.Attribute) or function.attr not in COLLECTS:
        return None
    inner: ast.expr = function.value
    if isinstance(inner, ast.Call) and _collection(inner) is not None:
        return _collection(inner)  # What `setdefault` returns is in the collection.
    name = ast.unparse(inner)
    return name if re.fullmatch(r"[A-Za-z_][\w.]*", name) else None


def _is_pure(call: ast.Call) -> bool:
    name = ast.unparse(call.func).rpartition(".")[2]
    return name in PURE or name[:1].isupper() or name == "setdefault"


def _declares(source: Source, call: ast.Call) -> bool:
    """Tell what declares arguments of a command line."""
    name = ast.unparse(call.func).rpartition(".")[2]
    return name in ("add_argument", "set_defaults") or (
        DECLARES.fullmatch(name) is not None and bool(_OF_A_PARSER & _names(source, call))
    )


def _names(source: Source, call: ast.Call) -> set[str]:
    """Return the types of what a call is given, by the parameters of the function around it."""
    function = source.function(call)
    given = {each.id for each in ast.walk(call) if isinstance(each, ast.Name)}
    arguments = function.args.args if function is not None else []
    return {ast.unparse(a.annotation) for a in arguments if a.annotation and a.arg in given}


def _takes_place(source: Source, call: ast.Call, seen: frozenset[str] = frozenset()) -> bool:
    """Tell what declares an argument without dashes, or may do so."""
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
        _takes_place(source, each, seen | {name})
        for each in calls
        if DECLARES.fullmatch(ast.unparse(each.func).rpartition(".")[2])
    )


def durations(text: str) -> set[tuple[int, int]]:
    """Return where numbers of seconds are, of which one more or less is not noticed.

    Of 0, 1 and 2 it is.
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
    """Tell the default of a field whose type lets nobody change it: all objects may share one."""
    field = source.parent(factory)
    declared = source.parent(field) if field is not None else None
    return isinstance(declared, ast.AnnAssign) and ast.unparse(declared.annotation).startswith(
        ("Mapping[", "Sequence[", "Collection[", "Iterable[")
    )


def is_plain_bool(source: Source, call: ast.Call) -> bool:
    """Tell `int` of a comparison, which is a number anyway, and `bool` of what is only asked for.

    That is, what a function returns that is declared to return a truth value.
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
