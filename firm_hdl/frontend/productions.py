"""Which parts of a grammar a definition uses, for choosing definitions that use all of it.

A production is a rule of the grammar with what stood for it in a text, as the parser's tree has it:
``field: INT_TYPE array NAME``. Several in a row of the same kind count as "one or more", so that
there are finitely many.
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
    """List the productions of a text; what is no sentence of the language has none.

    Parameters
    ----------
    text : str
        Of one message, or of a whole IDL file.
    dialect : "ros1" or "ros2"
    is_idl : bool
        Whether it is OMG IDL.
    """
    trees = idl_tree(text) if is_idl else line_trees(text, dialect)
    return frozenset(found for tree in trees for found in _productions(tree))


def _productions(tree: Tree[Token]) -> Iterator[str]:
    # Not recursive: a tree of IDL may be deep.
    for node in tree.iter_subtrees():
        kinds = [_kind(child) for child in node.children if child is not None]
        parts = [f"{kind}+" if len(list(same)) > 1 else kind for kind, same in groupby(kinds)]
        yield f"{node.data}: {' '.join(parts)}".rstrip()


def _kind(node: Token | Tree[Token]) -> str:
    return node.type if isinstance(node, Token) else str(node.data)
