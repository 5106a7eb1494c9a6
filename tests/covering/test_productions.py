"""The productions of a grammar that a text uses."""

from __future__ import annotations

from firm_hdl.covering.choose import productions


def test_lines_of_a_message_are_named_by_rule_and_parts():
    assert productions("int32[3] a  # how many\nHeader h\n", "ros1") == {
        "line: field COMMENT",
        "line: field",
        "line:",
        "field: INT_TYPE array NAME",
        "array: OPEN SIZE CLOSE",
        "field: reference NAME",
        "reference: MESSAGE_NAME",
    }


def test_alternatives_of_a_rule_are_distinguished():
    integer = productions("int8 A=1", "ros2")
    text = productions("string A='x'", "ros2")
    assert integer - text and text - integer


def test_repetitions_are_one_production():
    few, many = (productions(f"int8[] a {value}", "ros2") for value in ("[1, 2]", "[1, 2, 3, 4]"))
    assert few == many
    assert few != productions("int8[] a [1]", "ros2")


def test_wrong_texts_have_no_productions():
    assert productions("int32\n%%\nbool b\n", "ros2") == productions("bool b\n", "ros2")
    assert productions("module {", "ros2", is_idl=True) == frozenset()


def test_idl_has_a_grammar_of_its_own():
    found = productions(
        'module a { module msg { struct B { @unit(value="m") long x; }; }; };',
        "ros2",
        is_idl=True,
    )
    assert any(name.startswith("struct:") for name in found)
    assert any(name.startswith("annotation:") for name in found)
