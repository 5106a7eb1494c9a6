"""Choose a small set of types that has every feature of all types.

Features of a type belong to four families: the productions of the grammar that its text uses, and
the constructs of its definition, of its layout and of its plan. A production is a rule of the
grammar with the kinds of its children in a parse tree, such as ``field: INT_TYPE array NAME``.
Several children of one kind in a row count as "one or more", so that there are finitely many. The
set is chosen greedily: each step takes the type that adds most features per cost. The cost of the
result is within a logarithmic factor of the smallest possible cost (Chvatal, 1979). The result is
the same on every run.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import groupby

from lark import Token, Tree

from firm_hdl.frontend import Library
from firm_hdl.frontend.idl.parse import idl_tree
from firm_hdl.frontend.parse import line_trees
from firm_hdl.model import Array, Dialect, Field, Message, Primitive, Sequence, String, closure
from firm_hdl.plan import Plan
from firm_hdl.plan.shape import constructs
from firm_hdl.wire import Wire, lay_out
from firm_hdl.wire.layout import Gap, LengthField, LoopNode, Node, RunNode, Scalar, walk

__all__ = ["FAMILIES", "all_features", "choose", "cost", "features", "productions"]

FAMILIES = ("grammar", "definition", "layout", "plan")
"""The families of features. The names that `all_features` returns begin with ``family: ``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Chosen:
    """A type of a covering set."""

    name: str
    adds: tuple[str, ...]  # The features that no type chosen before this one has.


def features(message: Message, plan: Plan) -> frozenset[str]:
    """Return the features of a type's definition and plan."""
    return frozenset(_meaning(message)) | constructs(plan)


def all_features(library: Library, message: Message, plan: Plan) -> frozenset[str]:
    """Return the features of a type, of all families.

    * `library`: the library of the message; it has the language of each definition.
    """
    found = {f"grammar: {name}" for name in _grammar(library, message)}
    found |= {f"definition: {name}" for name in _meaning(message)}
    found |= {f"layout: {name}" for name in _layout(message, plan.wire)}
    found |= {f"plan: {name}" for name in constructs(plan)}
    return frozenset(found)


def cost(plan: Plan) -> float:
    """Estimate the cost of simulating a type: a constant for the set-up, and 1 for each step."""
    return 20.0 + len(plan.steps)


def _grammar(library: Library, message: Message) -> Iterator[str]:
    for each in closure([message]):
        # The builtin types of ROS 1 have no text.
        if each.package:
            is_idl = library.is_idl(each.name)
            language = "idl" if is_idl else each.dialect
            for production in productions(each.text, each.dialect, is_idl=is_idl):
                yield f"{language} {production}"


# By the text, which is not compared: equal messages may have been written differently.
@cache
def productions(text: str, dialect: Dialect, *, is_idl: bool = False) -> frozenset[str]:
    """List the grammar productions of a text; a part with a syntax error has none.

    * `text`: text of one message, or of a whole IDL file.
    """
    trees = idl_tree(text) if is_idl else line_trees(text, dialect)
    return frozenset(found for tree in trees for found in _productions(tree))


def _productions(tree: Tree[Token]) -> Iterator[str]:
    # Iterate instead of recursing, because a tree of IDL may be deep.
    for node in tree.iter_subtrees():
        kinds = [_kind_of(child) for child in node.children if child is not None]
        parts = [f"{kind}+" if len(list(same)) > 1 else kind for kind, same in groupby(kinds)]
        yield f"{node.data}: {' '.join(parts)}".rstrip()


def _kind_of(node: Token | Tree[Token]) -> str:
    return node.type if isinstance(node, Token) else str(node.data)


def _meaning(message: Message) -> Iterator[str]:
    for each in closure([message]):
        yield from _own(each)


def _layout(message: Message, wire: Wire) -> Iterator[str]:
    for node in walk(lay_out(message, wire).nodes):
        yield _node(node)


def _node(node: Node) -> str:
    match node:
        case Scalar():
            return f"scalar of {node.type.bytes} bytes, {_gap(node.gap)}"
        case RunNode() | LoopNode():
            words = [f"run of {node.item.bytes} bytes" if isinstance(node, RunNode) else "loop"]
            length = node.length if isinstance(node.length, LengthField) else None
            words.append(f"length: {_gap(length.gap)}" if length else "of a constant length")
            words += [f"items: {_gap(node.item_gap)}"] if isinstance(node, RunNode) else []
            words += ["bounded"] if length and length.bound is not None else []
            words += ["NUL"] if isinstance(node, RunNode) and node.terminated else []
            return ", ".join(words)
        case _:
            return "trigger"


def _gap(gap: Gap) -> str:
    if gap.bytes is None:
        return f"gap to a multiple of {gap.align}, by packet"
    return f"gap of {gap.bytes}"


def _own(message: Message) -> Iterator[str]:
    if not message.fields:
        yield "empty message"
    for constant in message.constants:
        yield f"constant {constant.type if isinstance(constant.type, Primitive) else 'string'}"
    for item in message.fields:
        yield from _field(item)


def _field(item: Field) -> Iterator[str]:
    kind = item.type
    if item.default is not None:
        yield f"default of {_kind(item.element_type)}"
    match kind:
        case Array():
            yield f"array of {_kind(kind.element)}"
        case Sequence():
            bound = "" if kind.bound is None else "bounded "
            yield f"{bound}sequence of {_kind(kind.element)}"
        case _:
            yield f"field {_kind(kind)}"


def _kind(kind: Primitive | String | Message) -> str:
    match kind:
        case Primitive():
            return kind.name
        case String():
            bound = "" if kind.bound is None else "bounded "
            return f"{bound}{'wstring' if kind.wide else 'string'}"
        case _:
            return "message" if kind.fields else "empty message"


def choose(types: Mapping[str, Iterable[str]], costs: Mapping[str, float]) -> list[Chosen]:
    """Choose types that together have every feature.

    * `types`: features by name of type.
    * `costs`: cost of testing each type, above zero. If several types add equally many features per
      cost, the first by name is taken.
    """
    left = {name: set(found) for name, found in types.items()}
    missing = set().union(*left.values()) if left else set()
    chosen = []
    while missing:
        best = min(left, key=lambda name: (-len(left[name]) / costs[name], name))
        adds = left.pop(best)
        chosen.append(Chosen(name=best, adds=tuple(sorted(adds))))
        missing -= adds
        for found in left.values():
            found -= adds
    return chosen
