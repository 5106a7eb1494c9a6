"""Faults in Python: one operator, number, condition or statement changed.

Code that declares and does not compute is left out: docstrings, annotations, `__all__`, imports,
arguments of decorators, `assert`, the `strict` of `zip`, and texts of errors.
"""

from __future__ import annotations

import ast
import io
import tokenize
from collections.abc import Iterator
from types import CodeType

from tools.mutation.mutants import Change
from tools.mutation.rules.harmless import durations

__all__ = ["changes", "is_fault", "same_code"]

COMPARISONS = {
    ast.Lt: ("<", ["<="]),
    ast.LtE: ("<=", ["<"]),
    ast.Gt: (">", [">="]),
    ast.GtE: (">=", [">"]),
    ast.Eq: ("==", ["!="]),
    ast.NotEq: ("!=", ["=="]),
    ast.Is: ("is", ["is not"]),
    ast.IsNot: ("is not", ["is"]),
    ast.In: ("in", ["not in"]),
    ast.NotIn: ("not in", ["in"]),
}
OPERATORS = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "+"),
    ast.Div: ("/", "*"),
    ast.FloorDiv: ("//", "*"),
    ast.Mod: ("%", "//"),
    ast.Pow: ("**", "*"),
    ast.LShift: ("<<", ">>"),
    ast.RShift: (">>", "<<"),
    ast.BitAnd: ("&", "|"),
    ast.BitOr: ("|", "&"),
    ast.BitXor: ("^", "|"),
}
UNARY = {ast.USub: "-", ast.Invert: "~"}
CALLS = {"min": "max", "max": "min", "any": "all", "all": "any"}


def changes(text: str) -> list[Change]:
    """Return all changes of a module, in order; some of them may be no faults."""
    left_out = durations(text)
    found = [each for each in _Finder(text).found() if (each.start, each.end) not in left_out]
    return sorted(found, key=lambda each: (each.start, each.end, each.rule, each.new))


def is_fault(text: str, change: Change) -> bool:
    """Return whether the changed text compiles, and compiles to different code."""
    try:
        code = compile(change.apply(text), "<module>", "exec", dont_inherit=True)
    except SyntaxError:
        return False
    return not same_code(compile(text, "<module>", "exec", dont_inherit=True), code)


def same_code(a: CodeType, b: CodeType) -> bool:
    """Compare compiled code without line numbers."""
    if (a.co_code, a.co_names, a.co_varnames) != (b.co_code, b.co_names, b.co_varnames):
        return False
    if getattr(a, "co_exceptiontable", b"") != getattr(b, "co_exceptiontable", b""):
        return False
    return len(a.co_consts) == len(b.co_consts) and all(
        same_code(x, y)
        if isinstance(x, CodeType) and isinstance(y, CodeType)
        # Compare types and texts, because 1 equals True, and 0.0 equals -0.0.
        else (type(x), repr(x)) == (type(y), repr(y))
        for x, y in zip(a.co_consts, b.co_consts, strict=True)
    )


class _Finder(ast.NodeVisitor):
    """Walks a module and notes changes."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._lines = [0]
        for line in text.splitlines(keepends=True):
            self._lines.append(self._lines[-1] + len(line))
        self._source = text.splitlines(keepends=True)
        self._tokens = [
            (self._lines[token.start[0] - 1] + token.start[1], token.string)
            for token in tokenize.generate_tokens(io.StringIO(text).readline)
            if token.type in (tokenize.OP, tokenize.NAME)
        ]
        self._scope: list[str] = []
        self._found: list[Change] = []

    def found(self) -> Iterator[Change]:
        self.visit(ast.parse(self._text))
        yield from self._found

    def _at(self, line: int, column: int) -> int:
        """Return the place of a node, whose columns are bytes of UTF-8."""
        return self._lines[line - 1] + len(
            self._source[line - 1].encode()[:column].decode() if column else ""
        )

    def _start(self, node: ast.expr | ast.stmt) -> int:
        return self._at(node.lineno, node.col_offset)

    def _end(self, node: ast.expr | ast.stmt) -> int:
        assert node.end_lineno is not None and node.end_col_offset is not None
        return self._at(node.end_lineno, node.end_col_offset)

    def _note(self, rule: str, start: int, end: int, new: str) -> None:
        scope = ".".join(self._scope)
        self._found.append(Change(start=start, end=end, new=new, rule=rule, scope=scope))

    def _token(self, text: str, start: int, end: int) -> tuple[int, int] | None:
        """Find a token, or two, between two places."""
        words = text.split()
        inside = [token for token in self._tokens if start <= token[0] < end]
        for index in range(len(inside) - len(words) + 1):
            run = inside[index : index + len(words)]
            if [word for _, word in run] == words:
                return run[0][0], run[-1][0] + len(words[-1])
        return None

    # Code that is left out.

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        self._scope.append(node.name)
        for default in [*node.args.defaults, *node.args.kw_defaults]:
            if isinstance(default, ast.Constant) and isinstance(default.value, str):
                start, end = self._start(default), self._end(default)
                self._note("default", start, end, '""')
            elif default is not None:
                self.visit(default)
        self._body(node.body)
        self._scope.pop()

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        self._scope.append(node.name)
        self._body(node.body)
        self._scope.pop()

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            self.visit(node.value)

    def visit_Assign(self, node: ast.Assign) -> None:
        if not (isinstance(node.targets[0], ast.Name) and node.targets[0].id == "__all__"):
            self.generic_visit(node)

    def visit_Assert(self, node: ast.Assert) -> None:
        """Skip the statement: in a correct program, an `assert` has no effect."""

    def visit_Raise(self, node: ast.Raise) -> None:
        """Skip the statement: its content is the text of an error."""

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        # Before Python 3.12, nodes inside an f-string have wrong places.
        """Skip the f-string."""

    def visit_If(self, node: ast.If) -> None:
        if ast.unparse(node.test) in ("TYPE_CHECKING", "__name__ == '__main__'"):
            return
        self._condition(node.test)
        self.visit(node.test)
        self._body(node.body)
        self._body(node.orelse)

    # Conditions.

    def visit_IfExp(self, node: ast.IfExp) -> None:
        self._condition(node.test)
        self.generic_visit(node)

    def visit_While(self, node: ast.While) -> None:
        if not isinstance(node.test, ast.Constant):
            self._condition(node.test)
            self.visit(node.test)
        self._body(node.body)
        self._body(node.orelse)

    def visit_comprehension(self, node: ast.comprehension) -> None:
        for test in node.ifs:
            self._condition(test)
        self.generic_visit(node)

    def _condition(self, test: ast.expr) -> None:
        # A single comparison and a `not` have rules of their own.
        single = isinstance(test, ast.Compare) and isinstance(
            test.ops[0], (ast.Eq, ast.NotEq, ast.Is, ast.IsNot, ast.In, ast.NotIn)
        )
        negated = isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not)
        if not single and not negated:
            start, end = self._start(test), self._end(test)
            self._note("negate condition", start, end, f"(not ({self._text[start:end]}))")

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        old, new = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
        for left, right in zip(node.values, node.values[1:], strict=False):
            at = self._token(old, self._end(left), self._start(right))
            if at:
                self._note("and/or", *at, new)
        self.generic_visit(node)

    def visit_Compare(self, node: ast.Compare) -> None:
        left = node.left
        for op, right in zip(node.ops, node.comparators, strict=True):
            old, others = COMPARISONS[type(op)]
            at = self._token(old, self._end(left), self._start(right))
            if at is not None:
                for new in others:
                    self._note("comparison", *at, new)
            left = right
        self.generic_visit(node)

    # Values.

    def visit_BinOp(self, node: ast.BinOp) -> None:
        old, new = OPERATORS.get(type(node.op), ("", ""))
        text = any(
            isinstance(side, (ast.JoinedStr, ast.List, ast.Tuple))
            or (isinstance(side, ast.Constant) and isinstance(side.value, (str, bytes)))
            for side in (node.left, node.right)
        )
        at = self._token(old, self._end(node.left), self._start(node.right)) if old else None
        if at and not text:  # With a text, any other operator makes the program crash.
            self._note("operator", *at, new)
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        start = self._start(node)
        if isinstance(node.op, ast.Not):
            self._note("not", start, start + 3, "")
        elif type(node.op) in UNARY:
            self._note("sign", start, start + 1, "")
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        start, end = self._start(node), self._end(node)
        if isinstance(node.value, bool):
            self._note("true/false", start, end, str(not node.value))
        elif isinstance(node.value, int):
            self._note("number + 1", start, end, str(node.value + 1))
            if node.value > 0:
                self._note("number - 1", start, end, str(node.value - 1))

    def visit_Call(self, node: ast.Call) -> None:
        if isinstance(node.func, ast.Name) and node.func.id in CALLS:
            start, end = self._start(node.func), self._end(node.func)
            self._note("call", start, end, CALLS[node.func.id])
        self.visit(node.func)
        for each in node.args:
            self.visit(each)
        for keyword in node.keywords:
            if keyword.arg != "strict":
                self.visit(keyword.value)

    def visit_Subscript(self, node: ast.Subscript) -> None:
        at = node.slice
        index = ast.unparse(at)
        if isinstance(node.ctx, ast.Load) and index in ("0", "-1"):
            new = "-1" if index == "0" else "0"
            self._note("first/last", self._start(at), self._end(at), new)
            self.visit(node.value)
        else:
            self.generic_visit(node)

    # Statements.

    def _body(self, body: list[ast.stmt]) -> None:
        for statement in body:
            self.visit(statement)

    def visit_Expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Constant):
            return
        self._delete(node, "yield" if _yields(node.value) else "call")
        self.generic_visit(node)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        self._delete(node, "assignment")
        old, new = OPERATORS.get(type(node.op), ("", ""))
        at = self._token(f"{old}=", self._end(node.target), self._start(node.value))
        if at and not isinstance(node.value, (ast.JoinedStr, ast.List)):
            self._note("operator", *at, f"{new}=")
        self.generic_visit(node)

    def visit_Continue(self, node: ast.Continue) -> None:
        self._note("continue/break", self._start(node), self._end(node), "break")

    def visit_Break(self, node: ast.Break) -> None:
        self._note("continue/break", self._start(node), self._end(node), "continue")

    def _delete(self, node: ast.stmt, what: str) -> None:
        start, end = self._start(node), self._end(node)
        # Keep the function a generator, even if it yields nothing.
        new = "yield from ()" if what == "yield" else "pass"
        self._note(f"delete {what}", start, end, new)


def _yields(value: ast.expr) -> bool:
    return isinstance(value, (ast.Yield, ast.YieldFrom))
