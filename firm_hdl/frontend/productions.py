"""The grammar productions that a definition uses, for choosing definitions that use all of them.

A production is a rule of the grammar with the kinds of its children in a parse tree, such as
``field: INT_TYPE array NAME``. Several children of one kind in a row count as "one or more", so
that the number of productions is finite.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from lark import Token, Tree

from firm_hdl.frontend.idl.parse import idl_tree
from firm_hdl.frontend.parse import line_trees
from firm_hdl.model import Dialect

__all__ = ["productions"]


def productions(text: str, dialect: Dialect, *, is_idl: bool = False) -> frozenset[str]:
    """List the productions of a text; a part with a syntax error has none.

    Parameters
    ----------
    text : str
        Text of one message, or of a whole IDL file.
    dialect : "ros1" or "ros2"
    is_idl : bool
        Whether the text is OMG IDL.
    """
    trees = idl_tree(text) if is_idl else line_trees(text, dialect)
    return frozenset(found for tree in trees for found in _productions(tree))


def _productions(tree: Tree[Token]) -> Iterator[str]:
    # Iterate instead of recursing, because a tree of IDL may be deep.
    for node in tree.iter_subtrees():
        kinds = [_kind(child) for child in node.children if child is not None]
        parts = [f"{kind}+" if len(list(same)) > 1 else kind for kind, same in groupby(kinds)]
        yield f"{node.data}: {' '.join(parts)}".rstrip()


def _kind(node: Token | Tree[Token]) -> str:
    return node.type if isinstance(node, Token) else str(node.data)
