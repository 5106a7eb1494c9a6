"""Figures of message types, compared with layouts, with real messages, and with hand counts."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosbags.interfaces import Nodetype
from rosbags.typesys import get_types_from_msg, get_typestore
from rosbags.typesys.stores import Stores

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import DISTROS, Library
from firm_hdl.metrics import Analyses, metrics_of
from firm_hdl.model import PRIMITIVES, Array, Field, Message, Sequence, String
from firm_hdl.wire import LengthField, LoopNode, RunNode, Scalar, Trigger, lay_out, walk
from tests.depth import by_depth
from tests.steps import calls_at_most

from ..frontend.workspace import library


def counts_in_layout(message, wire):
    """Count leaves and places in the layout, which writes every leaf out."""
    counts = {"leaves": 0, "aligned": 0, "padded": 0, "shifting": 0}

    def place(gap):
        name = "shifting" if gap.bytes is None else "padded" if gap.bytes else "aligned"
        counts[name] += 1

    def has_text(path):
        kind = message
        for name in path:
            if isinstance(kind, Array | Sequence):
                kind = kind.element
            elif name == "structure_needs_at_least_one_member":
                return False
            else:
                kind = next(field.type for field in kind.fields if field.name == name)
        return isinstance(kind, String)

    for node in walk(lay_out(message, wire).nodes):
        counts["leaves"] += not isinstance(node, LoopNode)
        match node:
            case Scalar():
                place(node.gap)
            case RunNode():
                if isinstance(node.length, LengthField):
                    place(node.length.gap)
                if not has_text(node.path):
                    place(node.item_gap)
            case LoopNode():
                if isinstance(node.length, LengthField):
                    place(node.length.gap)
            case Trigger():
                pass
    return counts


@pytest.mark.sampled(2)
@pytest.mark.parametrize("wire", ["ros1", "cdr"])
@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_leaves_and_places_are_those_of_the_layout(distro, wire):
    ours, analyses = Library(distro), Analyses(wire)
    for name in ours.names():
        message = ours.message(name)
        figures = analyses.metrics(message)
        want = counts_in_layout(message, wire)
        assert {key: getattr(figures, key) for key in want} == want, name
        assert figures.fixed_leaves + figures.dynamic_leaves == figures.leaves
        assert (figures.dynamic_leaves == 0) == message.is_fixed_size


def fill(description, store, fullest):
    """Return the shortest or the longest value of a rosbags type; `None` if none is longest."""
    kind, detail = description
    if kind == Nodetype.NAME:
        values = [fill(d, store, fullest) for _, d in store.fielddefs[detail][1]]
        return (
            None
            if None in [*map(type, values)] or any(value is None for value in values)
            else store.types[detail](*values)
        )
    if kind == Nodetype.BASE:
        name, bound = detail
        if name == "string":
            return None if fullest and not bound else "x" * (bound if fullest else 0)
        return False if name == "bool" else 0
    element, count = detail
    if kind == Nodetype.SEQUENCE:
        if fullest and not count:
            return None
        count = count if fullest else 0
    values = [fill(element, store, fullest) for _ in range(count)]
    if any(value is None for value in values):
        return None
    if element[0] == Nodetype.BASE and element[1][0] not in ("string",):
        name = {"byte": "int8", "char": "uint8"}.get(element[1][0], element[1][0])
        return np.zeros(count, dtype=name)
    return values


def check_sizes(message, store, name, wire):
    """Compare the limits with messages that rosbags serializes."""
    figures = metrics_of(message, wire)
    write = store.serialize_cdr if wire == "cdr" else store.serialize_ros1
    shortest = fill((Nodetype.NAME, name), store, False)
    assert figures.min_bytes == len(write(shortest, name)), message
    longest = fill((Nodetype.NAME, name), store, True)
    assert figures.max_bytes == (None if longest is None else len(write(longest, name))), message


@pytest.mark.thorough
@pytest.mark.parametrize("distro", ["noetic", "humble", "lyrical"])
def test_limits_of_size_are_sizes_of_real_messages(distro):
    ours, store = Library(distro), get_typestore(DISTROS[distro].store)
    wire = "ros1" if distro == "noetic" else "cdr"
    for name in ours.names():
        full = name if wire == "cdr" else name.replace("/", "/msg/")
        check_sizes(ours.message(name), store, full, wire)


KINDS = ["bool", "uint8", "int16", "float32", "float64", "string<=3", "string<=4"]


@settings(max_examples=by_depth(20, 100), deadline=None)
@given(data=st.data())
def test_limits_hold_wherever_parts_stand(tmp_path_factory, data):
    texts = {}
    for index in range(3):
        kinds = [*KINDS, *(f"T{i}" for i in range(index))]
        shape = st.sampled_from(["{}", "{}", "{}[3]", "{}[17]", "{}[<=2]", "{}[<=9]"])
        lines = data.draw(st.lists(st.tuples(shape, st.sampled_from(kinds)), max_size=4))
        fields = [f"{form.format(kind)} f{i}\n" for i, (form, kind) in enumerate(lines)]
        texts[f"p/T{index}"] = "".join(fields)
    message = library(tmp_path_factory.mktemp("ws"), texts).message("p/T2")
    store = get_typestore(Stores.EMPTY)
    for name, text in texts.items():
        store.register(get_types_from_msg(text, name.replace("/", "/msg/")))
    check_sizes(message, store, "p/msg/T2", "cdr")


def test_figures_by_hand(tmp_path):
    texts = {
        "p/Top": "# Head.\nuint8 X=1\nuint8 a 5\nPart[] parts\nstring<=3[2] texts\nPart one\n",
        "p/Part": "float64 x\nuint8[<=4] y\nNone none\nwstring<=2 w\n",
        "p/None": "",
    }
    figures = metrics_of(library(tmp_path, texts).message("p/Top"))
    assert (figures.depth, figures.types, figures.constants, figures.fields) == (3, 3, 1, 4)
    # a, one.x and one.none; all of parts, of texts, and one.y and one.w.
    assert (figures.leaves, figures.fixed_leaves, figures.dynamic_leaves) == (10, 3, 7)
    assert figures.max_bytes is None
    # header 4, a 1+3, parts 4, texts 5+3+5+7, x 8, y 4, none 1+3, w 4
    assert figures.min_bytes == 4 + 4 + 4 + 5 + 3 + 5 + (-(8 + 13) % 8) + 8 + 4 + 4 + 4
    assert figures.definition_bytes == len(texts["p/Top"])
    assert figures.features == (
        "constants",
        "defaults",
        "messages",
        "empty_messages",
        "bounded_strings",
        "bounded_wstrings",
        "arrays_of_strings",
        "sequences_of_primitives",
        "sequences_of_messages",
        "bounded_sequences",
        "nested_sequences",
    )


@pytest.mark.parametrize(
    ("text", "features"),
    [
        ("int8 a\n", ()),
        ("string a\nwstring b\n", ("strings", "wstrings")),
        ("string[] a\n", ("strings", "sequences_of_strings")),
        ("int8[2] a\n", ("arrays_of_primitives",)),
        ("Flat[2] a\n", ("messages", "arrays_of_messages")),
        ("Flat[] a\n", ("messages", "sequences_of_messages")),
        ("List[2] a\n", ("messages", "arrays_of_messages", "sequences_of_primitives")),
        (
            "List[] a\n",
            (
                "messages",
                "sequences_of_primitives",
                "sequences_of_messages",
                "nested_sequences",
            ),
        ),
    ],
)
def test_features_are_those_of_the_definition(tmp_path, text, features):
    texts = {"p/A": text, "p/Flat": "int8 x\n", "p/List": "int8[] x\n"}
    assert metrics_of(library(tmp_path, texts).message("p/A")).features == features


@pytest.mark.parametrize(
    ("text", "features"),
    [
        # What ROS 1 has built in is no message of a package.
        ("time t\n", ()),
        ("duration[] t\n", ("sequences_of_messages",)),
        ("Header h\n", ("messages", "strings")),
        ("string[] a\nint8[2] b\n", ("strings", "arrays_of_primitives", "sequences_of_strings")),
        (
            "Texts[] a\n",
            (
                "messages",
                "strings",
                "sequences_of_strings",
                "sequences_of_messages",
                "nested_sequences",
            ),
        ),
        ("Head[] a\n", ("messages", "strings", "sequences_of_messages")),
    ],
)
def test_features_are_those_of_the_definition_in_ros_1(tmp_path, text, features):
    texts = {"p/A": text, "p/Texts": "string[] x\n", "p/Head": "Header x\n"}
    found = metrics_of(library(tmp_path, texts, "ros1").message("p/A"))
    assert found.features == features and found.wire == "ros1"


@pytest.mark.parametrize(("more", "is_refused"), [(0, False), (1, True)])
def test_counts_of_more_than_a_hundred_digits_are_refused(more, is_refused):
    octet = PRIMITIVES["ros2"]["uint8"]
    kind = octet
    for level in range(100):
        fields = tuple(Field(name=f"f{number}", type=kind) for number in range(10))
        kind = Message(name=f"p/msg/T{level}", dialect="ros2", fields=fields)
    rest = tuple(Field(name=f"g{number}", type=octet) for number in range(more))
    top = Message(name="p/msg/Top", dialect="ros2", fields=(Field(name="f", type=kind), *rest))
    assert top.leaf_count == 10**100 + more
    if not is_refused:
        assert metrics_of(top).leaves == 10**100
        return
    with pytest.raises(
        DefinitionError, match=r"^error: p/msg/Top has more than 10\^100 fields when"
    ):
        metrics_of(top)


def test_figures_depend_on_the_wire(tmp_path):
    message = library(tmp_path, {"p/A": "uint8 a\nfloat64 b\nstring c\n"}).message("p/A")
    cdr, ros1 = metrics_of(message, "cdr"), metrics_of(message, "ros1")
    assert (cdr.min_bytes, ros1.min_bytes) == (4 + 16 + 5, 9 + 4)
    assert (cdr.aligned, cdr.padded, cdr.shifting) == (2, 1, 0)
    assert (ros1.aligned, ros1.padded, ros1.shifting) == (3, 0, 0)


def test_large_arrays_and_deep_nesting_cost_nothing():
    octet = PRIMITIVES["ros2"]["uint8"]
    inner = (
        Field(name="b", type=octet),
        Field(name="t", type=String(bound=2)),
        Field(name="d", type=PRIMITIVES["ros2"]["float64"]),
    )
    top = Message(name="p/msg/L", dialect="ros2", fields=inner)
    for level in range(1500):
        count = 1 << 23 if level in (0, 700) else 1
        kind = Array(element=top, count=count)
        top = Message(name=f"p/msg/L{level}", dialect="ros2", fields=(Field(name="f", type=kind),))
    with calls_at_most(2_000_000):
        figures = metrics_of(top)
        # 1+3 and 4+1 or 4+3, up to the next multiple of 8, and 8.
        assert figures.min_bytes == figures.max_bytes == 4 + (24 << 46)
        assert (figures.depth, figures.leaves) == (1501, 3)


@pytest.mark.thorough
def test_the_whole_corpus_has_figures(corpus):
    for dialect, distro in (("ros1", "noetic"), ("ros2", "lyrical")):
        ours = Library(distro, [corpus / dialect])
        found = []
        for name in ours.interfaces():
            # Refused: docs/reference/limits.md lists these types.
            with suppress(DefinitionError):
                found += ours.interface(name).messages
        analyses = Analyses("ros1" if dialect == "ros1" else "cdr")
        rows = [analyses.metrics(message) for message in found]
        assert len(rows) > 5000
        if dialect == "ros1":
            assert max(row.leaves for row in rows) == 37138


@pytest.mark.parametrize(
    ("text", "sizes", "places"),
    [
        # An empty message is one byte on the wire, so what follows is padded.
        ("None n\nint16 x\n", (4, 4), (1, 1, 0)),
        ("None n\nNone m\nint16 x\n", (4, 4), (3, 0, 0)),
        ("None[3] n\nint32 x\n", (8, 8), (1, 1, 0)),
        ("None[4] n\nint32 x\n", (8, 8), (2, 0, 0)),
        # After a part of any size, the padding differs.
        ("None[<=2] n\nint16 x\n", (6, 8), (2, 0, 1)),
        ("Two n\nint16 x\n", (8, 8), (2, 2, 0)),
        ("int8 a\nTwo[2] n\nint64 x\n", (24, 24), (4, 1, 0)),
    ],
)
def test_empty_messages_take_a_byte_of_cdr(tmp_path, text, sizes, places):
    texts = {"p/A": text, "p/None": "", "p/Two": "None n\nint16 y\nNone m\n"}
    message = library(tmp_path, texts).message("p/A")
    figures = metrics_of(message)
    assert (figures.min_bytes - 4, figures.max_bytes - 4) == sizes
    assert (figures.aligned, figures.padded, figures.shifting) == places
    want = counts_in_layout(message, "cdr")
    assert {key: getattr(figures, key) for key in want} == want
