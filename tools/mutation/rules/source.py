"""A Python module with the places of its nodes, without code that only declares."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tools.mutation.mutants import Change

__all__ = ["Functions", "Source"]

# No faults here: assertions have no effect in a correct program; f-strings are mostly messages.
LEFT_OUT = (ast.Assert, ast.JoinedStr)
Functions = (ast.FunctionDef, ast.AsyncFunctionDef)


class Source:
    """The input of the rules.

    Attributes
    ----------
    text : str
    tree : ast.Module
    nodes : list of ast.AST
        Nodes in order, without docstrings, annotations, decorators, `__all__`, `assert`, f-strings,
        and raised exceptions. (Before Python 3.12, nodes in f-strings have wrong places.)
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self.tree = ast.parse(text)
        self.nodes: list[ast.AST] = []
        self._lines = text.splitlines(keepends=True)
        self._starts = [0]
        for line in self._lines:
            self._starts.append(self._starts[-1] + len(line))
        self._parents: dict[ast.AST, ast.AST] = {}
        self._scopes: dict[ast.AST, str] = {}
        self._walk(self.tree, ())
        self._statements = [
            (*self.span(node), self._scopes[node])
            for node in self.nodes
            if isinstance(node, ast.stmt)
        ]

    def _walk(self, node: ast.AST, scope: tuple[str, ...]) -> None:
        self.nodes.append(node)
        self._scopes[node] = ".".join(scope)
        if isinstance(node, (*Functions, ast.ClassDef)):
            scope = (*scope, node.name)
        for child in _computing(node):
            self._parents[child] = node
            self._walk(child, scope)

    def parent(self, node: ast.AST) -> ast.AST | None:
        """Return the parent of a node."""
        return self._parents.get(node)

    def around(self, node: ast.AST) -> Iterator[ast.AST]:
        """Yield the ancestors of a node, the innermost first."""
        above = self.parent(node)
        while above is not None:
            yield above
            above = self.parent(above)

    def function(self, node: ast.AST) -> ast.FunctionDef | ast.AsyncFunctionDef | None:
        """Return the innermost function around a node."""
        return next((each for each in self.around(node) if isinstance(each, Functions)), None)

    def at(self, line: int, column: int) -> int:
        """Return a place in characters; `column` counts bytes of UTF-8, as in nodes."""
        return self._starts[line - 1] + len(self._lines[line - 1].encode()[:column].decode())

    def span(self, node: ast.AST) -> tuple[int, int]:
        """Return where a node starts and ends."""
        start = self.at(node.lineno, node.col_offset)  # type: ignore[attr-defined]
        return start, self.at(node.end_lineno, node.end_col_offset)  # type: ignore[attr-defined]

    def of(self, node: ast.AST) -> str:
        """Return the text of a node."""
        start, end = self.span(node)
        return self.text[start:end]

    def atom(self, node: ast.AST) -> str:
        """Return the text of an expression, in parentheses unless it is a name, call or such."""
        text = self.of(node)
        plain = (ast.Name, ast.Attribute, ast.Constant, ast.Call, ast.Subscript)
        return text if isinstance(node, plain) and "\n" not in text else f"({text})"

    def indent(self, node: ast.AST) -> str:
        """Return the indentation of the line of a node."""
        line = self._lines[node.lineno - 1]  # type: ignore[attr-defined]
        return line[: len(line) - len(line.lstrip())]

    def change(self, rule: str, where: ast.AST | tuple[int, int], new: str) -> Change:
        """Make a change of a node, or of the text between two places."""
        if isinstance(where, tuple):
            (start, end), scope = where, self._scope_at(where[0])
        else:
            start, end = self.span(where)
            scope = self._scopes.get(where, "") or self._scope_at(start)
        return Change(start=start, end=end, new=new, rule=rule, scope=scope)

    def _scope_at(self, place: int) -> str:
        """Return the scope of the innermost statement around a place, or right before it."""
        scope = ""
        for start, end, name in self._statements:
            if start <= place <= end:
                scope = name
        return scope


def _computing(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the children of a node that compute something."""
    if isinstance(node, ast.Raise):
        return
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "type_comment"):
            continue
        for each in value if isinstance(value, list) else [value]:
            if isinstance(each, ast.AST) and not _only_states(each):
                yield each


def _only_states(node: ast.AST) -> bool:
    if isinstance(node, ast.Expr):
        return isinstance(node.value, ast.Constant)
    if isinstance(node, ast.If):
        return ast.unparse(node.test) in ("TYPE_CHECKING", "__name__ == '__main__'")
    if isinstance(node, ast.Assign):
        return isinstance(node.targets[0], ast.Name) and node.targets[0].id == "__all__"
    return isinstance(node, LEFT_OUT)
