"""What a typedef names is looked up where the typedef stands, whoever uses it."""

from __future__ import annotations

import pytest

from .rosidl import read

FAR = "module q {{ module msg {{ const long N = 2; typedef long V[2]; {typedef} }}; }}; "
NEAR = "module p {{ module msg {{ const long N = 5; {near} struct T {{ {use} x; }}; }}; }};"


def of_member(text):
    """Return the array size and the bound of the only member, or what is wrong."""
    messages, wrong = read(text)
    if wrong:
        return wrong[0].message
    type_ = messages["T"].members[-1].type
    return type_.size and type_.size.value, type_.bound and type_.bound.value


@pytest.mark.parametrize("use", ["W", "q::msg::W", "q::msg::X"])
@pytest.mark.parametrize(
    ("typedef", "found"),
    [
        ("typedef msg::V W;", (2, None)),
        ("typedef q::msg::V W;", (2, None)),
        ("typedef ::q::msg::V W;", (2, None)),
        ("typedef long W[N];", (2, None)),
        ("typedef long W[msg::N];", (2, None)),
        ("typedef sequence<long, N> W;", (2, None)),
        ("typedef string<N> W;", (None, 2)),
        ("typedef string<msg::N> W;", (None, 2)),
    ],
)
def test_names_in_a_typedef_are_those_of_its_own_module(typedef, found, use):
    far = FAR.format(typedef=f"{typedef} typedef W X;")
    assert of_member(far + NEAR.format(near="", use=use)) == found


@pytest.mark.parametrize("use", ["W", "q::msg::X"])
def test_a_typedef_does_not_see_the_module_where_it_is_used(use):
    far = FAR.format(typedef="typedef msg::P W; typedef W X;")
    message = of_member(far + NEAR.format(near="typedef long P[6];", use=use))
    assert message.startswith("'msg::P' is not a type;")


def test_a_typedef_has_no_struct_whose_constants_it_sees_first():
    text = """module p {{ module msg {{ module S_Constants {{ const long N = 6; }};
      module T_Constants {{ const long N = 7; }};
      typedef long W{}; struct T {{ W x{}; }}; }}; }};"""
    assert of_member(text.format("", "[N]")) == (7, None)
    wrong = "constant 'N' is not declared above; there are 2 of that name elsewhere"
    assert of_member(text.format("[N]", "")) == wrong


@pytest.mark.parametrize(("outer", "found"), [("msg::V", (3, None)), ("p::V", (4, None))])
def test_each_typedef_of_a_chain_has_its_own_module(outer, found):
    """The first one stands in p, the second in p::msg, the member in r."""
    text = f"""module p {{ typedef {outer} A; typedef long V[4]; }};
      module p {{ module msg {{ typedef p::A B; }}; }};
      module r {{ typedef msg::B C; struct T {{ p::msg::B x; }}; }};"""
    if outer == "msg::V":
        text = text.replace("typedef long V[4];", "module msg { typedef long V[3]; };")
    assert of_member(text) == found
