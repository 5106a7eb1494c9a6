"""What a description means at its edges: ends of lines, sizes of files, names and remappings."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.node import read_description, read_description_text
from tests.node.samples import LIBRARY

BOOL = "{type: std_msgs/msg/Bool}"


def described(text):
    return read_description_text(text, library=LIBRARY)


def names(text):
    return [topic.name for topic in described(text).topics]


@pytest.mark.parametrize("size", [262_144, 262_145])
def test_the_largest_file(size, tmp_path):
    text = f"node: n\npublish: {{/a: {BOOL}}}\n"
    path = tmp_path / "node.yaml"
    path.write_text(text + "#" * (size - len(text)))
    if size == 262_144:
        assert read_description(path, library=LIBRARY).node == "n"
        return
    with pytest.raises(DefinitionError, match="has 262145 bytes, and at most 262144 are read"):
        read_description(path, library=LIBRARY)


def test_a_remapping_is_not_remapped_again():
    text = f"node: n\nremap: {{/a: /b, /b: /c}}\nsubscribe: {{/a: {BOOL}, /b: {BOOL}}}\n"
    assert names(text) == ["/b", "/c"]
    assert names(text.replace("/c", "/a")) == ["/b", "/a"]
    # Without a topic of its own, the second one is of no use.
    with pytest.raises(DefinitionError, match=r":2:17: error: no topic has the name '/b'"):
        described(text.replace(f", /b: {BOOL}", ""))


def test_two_topics_that_a_remapping_makes_one_are_refused():
    text = f"node: n\nremap: {{/a: /b}}\nsubscribe:\n  /a: {BOOL}\n  /b: {BOOL}\n"
    with pytest.raises(DefinitionError, match=r":5:3: error: '/b' is already there, as '/a'"):
        described(text)
    # A node may hear what it says, in ports of one name.
    both = described(text.replace("  /b:", "publish:\n  /b:"))
    assert [(topic.kind, topic.name, topic.port) for topic in both.topics] == [
        ("subscribe", "/b", "b"),
        ("publish", "/b", "b"),
    ]


@pytest.mark.parametrize(
    ("first", "second", "more"),
    [
        ("/r/a", "/r/a", ""),
        ("a", "/r/a", ""),
        ("~/a", "n/a", ""),
        ("/r/n/a", "~/a", ""),
        ("/b", "a", "remap: {a: /b}\n"),
        ("c", "d", "remap: {c: /x, d: /x}\n"),
    ],
)
def test_a_topic_has_one_type_by_whatever_names(first, second, more):
    text = f"node: n\nnamespace: /r\n{more}publish:\n  {first}: {BOOL}\nsubscribe:\n"
    text += f"  {second}: {{depth: 1, type: std_msgs/Byte}}\n"
    with pytest.raises(DefinitionError) as caught:
        described(text)
    head, line, caret = str(caught.value).splitlines()
    row, column = text.count("\n"), text.splitlines()[-1].index("std_msgs") + 1
    assert head.startswith(f"<description>:{row}:{column}: error: the topic '/")
    wanted = f"has the type 'std_msgs/msg/Bool' already ('{first}' in line {row - 2}); a topic "
    assert wanted in head
    assert line == text.splitlines()[-1] and caret == " " * (column - 1) + "^" * 13
    # One type has many names; and a service is no topic.
    described(text.replace("std_msgs/Byte", "std_msgs/Bool"))
    served = text.replace("depth: 1, type: std_msgs/Byte", "type: robot_msgs/Calibrate")
    described(served.replace("subscribe", "serve"))


@pytest.mark.parametrize(
    ("name", "port"),
    [("/a_b", "a_b"), ("/a__b/c_", "a_b_c"), ("/_a/B/_/c1", "a_B_c1"), ("/a/b", "a_b")],
)
def test_a_port_has_the_words_of_the_complete_name(name, port):
    (topic,) = described(f"node: n\npublish: {{{name}: {BOOL}}}\n").topics
    assert topic.port == port


@pytest.mark.parametrize("word", ["signature", "metadata", "elaborate", "clk", "rst", "lambda"])
def test_words_that_are_no_ports(word):
    for topic in (f"/{word}: {BOOL}", f"/a: {BOOL[:-1]}, port: {word}}}"):
        with pytest.raises(DefinitionError, match="because Python or Amaranth use it"):
            described(f"node: n\npublish: {{{topic}}}\n")
    assert described(f"node: n\npublish: {{/a_{word}: {BOOL}}}\n").topics[0].port == f"a_{word}"


def test_a_port_belongs_to_the_first_topic_that_has_it():
    text = f"node: n\npublish:\n  /a/b: {BOOL}\n  /a_b: {BOOL}\n  /A__b: {BOOL}\n"
    with pytest.raises(DefinitionError) as caught:
        described(text)
    lines = str(caught.value).splitlines()[::3]
    assert [line.partition("; ")[0] for line in lines] == [
        f"<description>:{line}:3: error: the port '{port}' is already that of '/a/b'"
        for line, port in ((4, "a_b"), (5, "A_b"))
    ]


@pytest.mark.parametrize("name", ["a:B", "a.b_1:C", "a:B.C", "_a.b.c:_D"])
def test_names_of_accelerators(name):
    text = f"node: n\npublish: {{/a: {BOOL}}}\naccelerator: '{name}'\n"
    assert described(text).accelerator == name


@pytest.mark.parametrize(
    "name", ["a", "a:", ":B", "a.:B", "a.1b:C", "a:b-c", "a:B.", "a b:C", "a::B"]
)
def test_what_is_no_name_of_an_accelerator(name):
    with pytest.raises(DefinitionError, match=r":3:14: error: an accelerator is named as 'module:"):
        described(f"node: n\npublish: {{/a: {BOOL}}}\naccelerator: '{name}'\n")
