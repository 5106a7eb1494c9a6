"""Seeded bugs: a function with a part of its text replaced, for as long as a proof needs it."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from types import CodeType
from typing import Any

__all__ = ["Bug", "seeded"]


@dataclass(frozen=True, slots=True)
class Bug:
    """A replacement in the text of a function.

    Attributes
    ----------
    function : function
    old, new : str
        `old` occurs exactly once in the function.
    """

    function: Callable[..., Any]
    old: str
    new: str

    def __str__(self) -> str:
        return f"{self.function.__qualname__}: {self.old} -> {self.new}"


@contextmanager
def seeded(bugs: Sequence[Bug]) -> Iterator[None]:
    """Put bugs into functions, and take them out again."""
    with ExitStack() as stack:
        for bug in bugs:
            function: Any = bug.function
            stack.callback(setattr, function, "__code__", function.__code__)
            function.__code__ = _compiled(bug, function.__code__)
        yield


def _compiled(bug: Bug, code: CodeType) -> CodeType:
    text = textwrap.dedent(inspect.getsource(code))
    if text.count(bug.old) != 1:
        raise ValueError(f"{bug}: the text occurs {text.count(bug.old)} times")
    # A function in a class sees the cell `__class__`, if it calls `super`.
    text = "class _:\n" + textwrap.indent(text.replace(bug.old, bug.new), "    ")
    tree = ast.parse(text)
    compiled = compile(tree, inspect.getfile(code), "exec", dont_inherit=True)
    for constants in _codes(compiled):
        if constants.co_name == code.co_name and constants.co_freevars == code.co_freevars:
            return constants
    raise ValueError(f"{bug}: the function cannot be compiled alone")


def _codes(code: CodeType) -> Iterator[CodeType]:
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield constant
            yield from _codes(constant)
