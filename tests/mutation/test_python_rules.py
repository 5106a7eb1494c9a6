"""The mutants that each rule for Python makes, and the code that it does not change."""

from __future__ import annotations

import pytest

from tools.mutation.rules.python_rules import changes, is_fault, same_code


def faults(text):
    return [(change.rule, change.apply(text)) for change in changes(text) if is_fault(text, change)]


@pytest.mark.parametrize(
    ("text", "rule", "changed"),
    [
        ("y = a < b", "comparison", ["y = a <= b"]),
        ("y = a not  in b", "comparison", ["y = a in b"]),
        ("y = (a) is (b)", "comparison", ["y = (a) is not (b)"]),
        ("y = a < b == c", "comparison", ["y = a < b != c", "y = a <= b == c"]),
        ("y = a + b", "operator", ["y = a - b"]),
        ("y = a << b & c", "operator", ["y = a << b | c", "y = a >> b & c"]),
        ("a |= b", "operator", ["a &= b"]),
        ("a |= b", "delete assignment", ["pass"]),
        ("y = a and b or c", "and/or", ["y = a and b and c", "y = a or b or c"]),
        ("y = not a", "not", ["y =  a"]),
        ("y = -a, ~b", "sign", ["y = -a, b", "y = a, ~b"]),
        ("y = 7", "number + 1", ["y = 8"]),
        ("y = 7", "number - 1", ["y = 6"]),
        ("y = 0", "number - 1", []),
        ("y = True", "true/false", ["y = False"]),
        ("if a:\n    b = c", "negate condition", ["if (not (a)):\n    b = c"]),
        ("y = [a for a in b if a.c]", "negate condition", ["y = [a for a in b if (not (a.c))]"]),
        ("f(a)", "delete call", ["pass"]),
        ("def f():\n    yield a", "delete yield", ["def f():\n    yield from ()"]),
        ("for a in b:\n    break", "continue/break", ["for a in b:\n    continue"]),
        ("for a in b:\n    if c:\n        continue", "continue/break", 1),
        ("for a in b:\n    c()\n    continue\n    d()", "continue/break", 1),
        ("def f(a=1):\n    b()", "number + 1", ["def f(a=2):\n    b()"]),
        ("def f(a='x'):\n    b()", "default", ['def f(a=""):\n    b()']),
        ("y = a[0], b[-1]", "first/last", ["y = a[-1], b[-1]", "y = a[0], b[0]"]),
        ("SECONDS = 60", "number + 1", []),
        ("f(most_seconds=60, timeout=60)", "number - 1", []),
        ("SECONDS = 2\ntimeout = a + 60", "number + 1", 2),
        ("f(beats=60)", "number - 1", ["f(beats=59)"]),
        ("y = min(a, b)", "call", ["y = max(a, b)"]),
        ("ü = 'é', a + b", "operator", ["ü = 'é', a - b"]),
    ],
)
def test_rules(text, rule, changed):
    found = sorted(new for name, new in faults(text) if name == rule)
    assert found == changed or len(found) == changed


@pytest.mark.parametrize(
    "text",
    [
        '"""One, 1 < 2."""',
        "# 1 < 2",
        "x: Literal[1]",
        "def f(a: Literal[1]) -> Literal[2]: ...",
        '__all__ = ["a"] + ["b"]',
        "raise ValueError(f'{a + 1}' + b)",
        "assert a < 1",
        "@d(frozen=True)\nclass A: ...",
        "y = zip(a, b, strict=True)",
        "if TYPE_CHECKING:\n    a = 1",
        "y = 'a' + b",
    ],
)
def test_code_that_only_declares_is_not_changed(text):
    assert faults(text) == []


def test_changes_are_of_one_place_and_name_their_scope():
    text = "class A:\n    def f(self):\n        return 1 + 1  # kept\n"
    found = changes(text)
    assert {change.scope for change in found} == {"A.f"}
    assert all(change.apply(text).endswith("  # kept\n") for change in found)
    assert len({change.apply(text) for change in found}) == len(found) == 5


def test_code_is_the_same_when_only_lines_differ():
    def code(text):
        return compile(text, "a", "exec")

    assert same_code(code("def f(): return 2"), code("\n\ndef f():\n  return 1 + 1"))
    assert not same_code(code("def f(): return 1"), code("def f(): return True"))
