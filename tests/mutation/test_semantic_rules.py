"""The mutants that each semantic rule makes, and the code that it does not change."""

from __future__ import annotations

import textwrap

import pytest

from tools.mutation.rules.index import index_of
from tools.mutation.rules.python_rules import is_fault
from tools.mutation.rules.semantic_rules import changes


def faults(text, rule, index=None):
    """Return the text with each change of a rule, except changes that do not compile."""
    found = [each for each in changes(text, index) if each.rule == rule and is_fault(text, each)]
    return [each.apply(text) for each in found]


CHAIN = "if a:\n    x()\nelif b:\n    y()\nelse:\n    z()"
T_A, T_AB, T_AC = (f"t.startswith({each!r}):" for each in ("a", "ab", "ac"))
GUARDS = "def f():\n    if a:\n        return 1\n    if b:\n        return 2\n    return 3"
HARDWARE = "with m.If(a):\n    m.d.comb += x.eq(1)\nwith m.Elif(b):\n    m.d.comb += x.eq(2)"
OVERRIDE = "m.d.comb += x.eq(1)\nm.d.comb += z.eq(1)\nwith m.If(a):\n    m.d.comb += x.eq(2)"
MATCH = (
    "match a:\n    case A(b=1):\n        x()\n    case A() if c:\n        y()\n"
    "    case _:\n        z()"
)
KINDS = "match a:\n    case A(k=1):\n        x()\n    case A(k=2):\n        y()"
REGISTER = "a = Signal(8)\nb = Signal()\nm.d.sync += a.eq(1)\nm.d.comb += b.eq(a)"

COMMAND = (
    "def f(a: ArgumentParser):\n    _add_b(a)\n    _add_c(a)\n"
    "def _add_b(a):\n    a.add_argument('b')\ndef _add_c(a):\n    a.add_argument('-d')"
)


@pytest.mark.parametrize(
    ("rule", "text", "changed"),
    [
        ("swapped branches", CHAIN, ["if b:\n    y()\nelif a:\n    x()\nelse:\n    z()"]),
        (
            "swapped branches",
            GUARDS,
            ["def f():\n    if b:\n        return 2\n    if a:\n        return 1\n    return 3"],
        ),
        ("swapped branches", HARDWARE, 1),
        ("swapped branches", MATCH, 1),
        ("swapped branches", CHAIN.replace("a:", "k == 1:").replace("b:", "k == 2:"), []),
        (
            "swapped branches",
            "match a:\n    case A():\n        x()\n    case B():\n        y()",
            [],
        ),
        # No text begins with both; one that begins with the second may begin with the first.
        ("swapped branches", CHAIN.replace("a:", T_AB).replace("b:", T_AC), []),
        ("swapped branches", CHAIN.replace("a:", T_A).replace("b:", T_AC), 1),
        ("swapped branches", CHAIN.replace("a:", T_AB).replace("b:", "u.startswith('c'):"), 1),
        ("swapped branches", KINDS, []),
        ("swapped branches", KINDS.replace("k=2", "b=2"), 1),
        (
            "overridden assignment",
            OVERRIDE,
            [
                "pass\nm.d.comb += z.eq(1)\nwith m.If(a):\n    m.d.comb += x.eq(2)\n"
                "m.d.comb += x.eq(1)"
            ],
        ),
        ("overridden assignment", OVERRIDE.replace("x.eq(2)", "y.eq(2)"), []),
        ("overridden assignment", OVERRIDE.replace("comb += x.eq(2)", "sync += x.eq(2)"), []),
        ("overridden assignment", "x = 1\nif a:\n    x = 2", ["pass\nif a:\n    x = 2\nx = 1"]),
        ("dropped clause", "y = a and b", ["y = (b)", "y = (a)"]),
        ("dropped clause", "y = a & (b | c)", 4),
        ("dropped clause", "y = 0 <= a < b", ["y = a < b", "y = 0 <= a"]),
        ("dropped filter", "y = [a for a in b if c]", ["y = [a for a in b if True]"]),
        ("dropped choice", "y = a in (1, 2)", ["y = a in (2,)", "y = a in (1,)"]),
        ("dropped choice", "y = isinstance(a, (A, B))", 2),
        ("dropped choice", "match a:\n    case 1 | 2:\n        x()", 2),
        ("swapped operand", "y = a - (b + c)", ["y = (b + c) - (a)"]),
        ("swapped operand", "y = a < b", ["y = b < a"]),
        ("swapped operand", "y = Mux(a, b, c)", ["y = Mux(a, c, b)"]),
        ("swapped operand", "y = a + b, '%s' % a", []),
        ("wrong limit", "y = range(n)", ["y = range(n + 1)", "y = range(n - 1)"]),
        ("wrong limit", "y = x[a:b]", 4),
        ("wrong limit", "y = Signal(range(n))", []),
        (
            "ignored item",
            "for a in b:\n    c()",
            ["for a in list(b)[1:]:\n    c()", "for a in list(b)[:-1]:\n    c()"],
        ),
        ("early exit", "for a in b:\n    c()", ["for a in b:\n    c()\n    break"]),
        ("early exit", "for a in b:\n    break", []),
        ("unwrapped", "y = a.strip(), sorted(b)", 2),
        ("dropped branch", CHAIN, 2),
        ("dropped branch", HARDWARE, 2),
        ("dropped branch", MATCH, 2),
        ("ignored condition", "if a:\n    b()", ["if True:\n    b()"]),
        ("dropped check", "try:\n    a()\nexcept E:\n    raise B", 1),
        ("dropped check", "if a:\n    raise B", []),
        ("dropped assignment", "def f(self):\n    self.a = b", ["def f(self):\n    pass"]),
        ("dropped assignment", "def __init__(self):\n    self.a = b", []),
        ("dropped assignment", "def f():\n    a = b\n    a = c", 1),
        ("dropped assignment", "m.d.sync += [a.eq(b), c.eq(d)]", 2),
        ("sticky flag", "m.d.sync += a.eq(0)", ["pass"]),
        ("sticky flag", "m.d.sync += [a.eq(0), c.eq(1)]", ["m.d.sync += [c.eq(1)]"]),
        ("sticky flag", "def f(self):\n    self.a = None", ["def f(self):\n    pass"]),
        (
            "missing reset",
            "for a in b:\n    c = []\n    d()",
            ["c = []\nfor a in b:\n    pass\n    d()"],
        ),
        (
            "missing reset",
            REGISTER,
            [REGISTER.replace("Signal(8)", "Signal(8, reset_less=True)")],
        ),
        ("kept state", "x: list = field(default_factory=list)", 1),
        ("kept state", "x: Mapping[str, int] = field(default_factory=dict)", []),
        ("kept state", "x: dict[str, int] = field(default_factory=dict)", 1),
        ("kept state", "def f():\n    a = []\n    b = 0", 1),
        ("constant return", "def f() -> bool:\n    return a == b", 2),
        ("constant return", "def f() -> A | None:\n    return a", 1),
        ("constant return", "def f() -> A:\n    return a", []),
        ("constant return", "def f() -> tuple[A, ...]:\n    return a", 1),
        ("constant return", "def f() -> tuple[A, ...]:\n    return ()", []),
        ("swapped calls", "a()\nb()", ["b()\na()"]),
        # Two independent collections; then two of which one uses the other, or may use it.
        ("swapped calls", "a.append(b)\nc.add(d)", []),
        ("swapped calls", "a.setdefault(b, []).append(c)\nd.pop()", []),
        ("swapped calls", "self.a.append(b.join(c))\nself.d.clear()", []),
        ("swapped calls", "a.append(b)\na.append(c)", 1),
        ("swapped calls", "a.append(b)\nc.append(a)", 1),
        ("swapped calls", "a.append(b.d)\nb.d.clear()", 1),
        ("swapped calls", "a.append(b())\nc.append(d())", 1),
        ("swapped calls", "a.append(b)\nc.write(d)", 1),
        ("swapped calls", "f(a).append(b)\nc.append(d)", 1),
        # Arguments of a command line: one is an option; then both may be positional.
        ("swapped calls", "a.add_argument('b')\na.add_argument('--c')", []),
        ("swapped calls", "a.add_argument('b')\na.set_defaults(c=d)", []),
        ("swapped calls", "a.add_argument('b')\na.add_argument('c')", 1),
        ("swapped calls", COMMAND, []),
        ("swapped calls", COMMAND.replace("'-d'", "'d'"), 1),
        ("swapped calls", COMMAND.replace("ArgumentParser", "Recorder"), 1),
        ("unwrapped", "y = int(a < b)", []),
        ("unwrapped", "y = int(a), bool(b)", 2),
        ("unwrapped", "def f() -> bool:\n    return bool(a)", []),
        ("unwrapped", "def f() -> bool:\n    return bool(a) == b", 1),
        ("unwrapped", "def f() -> object:\n    return bool(a)", 1),
        ("wrong neighbour", "def f(a: int, b: int, c: str):\n    return a", 1),
        ("wrong neighbour", "class K(Enum):\n    A = 1\n    B = 2\n\ny = K.A", 1),
        ("wrong neighbour", "a = Signal(8)\nb = Signal(8)", []),
        ("wrong neighbour", "y = s.valid", ["y = s.ready"]),
        ("default used", "def f(a, b=1): ...\n\ny = f(1, b=2)", 1),
        ("default used", "def f(a, b=1): ...\n\ny = f(1, 2)", 1),
        ("default used", "def f(a, b): ...\n\ny = f(1, b=2)", []),
    ],
)
def test_rules(rule, text, changed):
    found = faults(text, rule)
    assert len(found) == changed or sorted(found) == sorted(changed)


def test_attributes_are_taken_for_those_of_the_same_type():
    text = textwrap.dedent(
        """
        @dataclass
        class A:
            first_bits: int
            name: str
            last_bits: int = 0

            @property
            def all_bits(self) -> int:
                return self.first_bits

        class B:
            other_bits: int

        def f(a):
            return a.last_bits
        """
    )
    assert [new.splitlines()[-1].strip() for new in faults(text, "wrong neighbour")[-2:]] == [
        "return a.all_bits",
        "return a.first_bits",
    ]
    # An attribute of the class counts, too; one of another class does not.
    assert len(faults(text, "wrong neighbour")) == 4
    # The type is one of another module.
    use = "def g(a):\n    return a.first_bits"
    assert faults(use, "wrong neighbour") == []
    assert len(faults(use, "wrong neighbour", index_of([text, use]))) == 2


@pytest.mark.parametrize(
    "text",
    [
        '"""One, a and b."""',
        "assert a and b",
        "x: a and b",
        "def f(a: int, b: int) -> a and b: ...",
        "raise E(a and b)",
        "y = f'{a and b}'",
        "__all__ = [a and b]",
        "if TYPE_CHECKING:\n    x = a and b",
        "@d(a and b)\ndef f(): ...",
    ],
)
def test_code_that_only_declares_is_not_changed(text):
    assert faults(text, "dropped clause") == []


def test_a_change_names_the_function_that_it_is_in():
    text = "class A:\n    def f(self):\n        for a in b:\n            c()\n\n    x = 1\n"
    found = {each.rule: each.scope for each in changes(text)}
    assert found == {"ignored item": "A.f", "early exit": "A.f"}
