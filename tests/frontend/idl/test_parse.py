"""The parser of IDL: from texts to trees."""

from __future__ import annotations

import pytest

from firm_hdl.errors import Diagnostic, Source
from firm_hdl.frontend.idl.parse import parse_file
from firm_hdl.frontend.idl.tree import (
    Annotation,
    BasicType,
    Chain,
    Constant,
    Enum,
    FileSyntax,
    Include,
    LiteralSyntax,
    Member,
    Module,
    SequenceType,
    StringType,
    Struct,
    Typedef,
    Unary,
)
from tests.depth import by_depth
from tests.steps import calls_at_most


def parse(text):
    file = parse_file(Source(name="test.idl", text=text))
    assert isinstance(file, FileSyntax), str(file)
    return file.definitions


def words(node):
    return node.span.source.text[node.span.start : node.span.end]


def test_every_definition_has_its_place_and_its_parts():
    text = """#include "a/msg/B.idl"
    @m module p {
      const long N = 1 + x::y;
      typedef sequence<string<3>, 4> S;
      enum E { A, @e B };
      struct F;
      @s(1) struct T { @k(value="v" "w", b=-2) unsigned long long a, b[N]; };
    };
    """
    include, module = parse(text)
    assert isinstance(include, Include) and include.path == "a/msg/B.idl"
    assert isinstance(module, Module) and words(module.name) == module.name.text == "p"
    assert [words(a) for a in module.annotations] == ["@m"]
    constant, typedef, enum, forward, struct = module.definitions
    assert isinstance(constant, Constant) and isinstance(constant.value, Chain)
    assert [words(o) for o in constant.value.operands] == ["1", "x::y"]
    assert constant.value.operators == ("+",)
    assert isinstance(typedef, Typedef) and isinstance(typedef.type, SequenceType)
    assert isinstance(typedef.type.element, StringType)
    assert (words(typedef.type.element), words(typedef.type.bound)) == ("string<3>", "4")
    assert isinstance(enum, Enum) and enum.name.text == words(enum.name)
    assert isinstance(forward, Struct) and forward.members is None
    assert isinstance(struct, Struct) and len(struct.members) == 1
    (member,) = struct.members
    assert isinstance(member, Member) and isinstance(member.type, BasicType)
    assert (member.type.name, words(member.type)) == ("uint64", "unsigned long long")
    assert [(d.name.text, len(d.sizes)) for d in member.declarators] == [("a", 0), ("b", 1)]
    (annotation,) = member.annotations
    assert isinstance(annotation, Annotation)
    (value, text), (b, minus) = annotation.arguments
    assert (value.text, b.text) == ("value", "b")
    assert isinstance(text, LiteralSyntax) and text.parts == ('"v"', '"w"')
    assert isinstance(minus, Unary) and words(minus) == "-2"


@pytest.mark.parametrize("sign", ["|", "^", "&", "<<", "+", "-", "*", "/", "%"])
def test_operators_stand_between_angles_as_elsewhere(sign):
    for operands in (["8", "2"], ["8", "2", "1"]):
        text = f" {sign} ".join(operands)
        (struct,) = parse(f"struct T {{ sequence<long, {text}> a; string<{text}> b; }};")
        for bound in (member.type.bound for member in struct.members):
            assert isinstance(bound, Chain) and {*bound.operators} == {sign}
            assert [words(operand) for operand in bound.operands] == operands


@pytest.mark.parametrize("blank", [" ", "\t", "\f", "\r", "\n"])
def test_every_blank_separates_words(blank):
    (struct,) = parse("struct T { unsigned long a ; } ;".replace(" ", blank))
    assert struct.members[0].type.name == "uint32"
    (include,) = parse(f"#include{blank}<a/b.idl>{blank}")
    assert include.path == "a/b.idl"


def test_operators_bind_as_in_c():
    (module,) = parse("module m { const long A = 1|2^3&4<<5+6*-7; };")
    node = module.definitions[0].value
    for sign in ("|", "^", "&", "<<", "+", "*"):
        assert isinstance(node, Chain) and node.operators == (sign,)
        node = node.operands[1]
    assert isinstance(node, Unary)


def test_long_texts_are_read_in_time():
    count = by_depth(600, 5000)
    members = "".join(f'@unit(value="m") sequence<double, {i + 1}> a{i}; ' for i in range(count))
    with calls_at_most(by_depth(1_900_000, 30_000_000)):
        (struct,) = parse(f"struct T {{ {members} }};")
        assert len(struct.members) == count


@pytest.mark.parametrize(
    "text",
    [
        "module m { " * 5000,
        "struct T { " + "sequence<" * 5000,
        "module m { const long A = " + "(" * 5000 + "1" + ")" * 5000 + "; };",
        "module m { const long A = " + "-(" * 5000 + "1" + ")" * 5000 + "; };",
        "module m { const long A = " + "1+(" * 5000 + "1" + ")" * 5000 + "; };",
        "struct T { long a[" + "1|1^1&1<<1+1*(" * 5000,
    ],
    ids=["modules", "sequences", "parentheses", "signs", "sums", "all operators"],
)
def test_too_deep_nesting_is_refused(text):
    found = parse_file(Source(name="test.idl", text=text))
    assert isinstance(found, Diagnostic)
    assert found.message == "this is nested too deeply"


def test_nesting_ends_at_its_limit():
    for depth, is_read in ((192, True), (193, False)):
        text = "const long A = " + "(" * depth + "1" + ")" * depth + ";"
        found = parse_file(Source(name="test.idl", text=text))
        assert isinstance(found, FileSyntax) == is_read
