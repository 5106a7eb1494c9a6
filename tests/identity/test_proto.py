"""Examples of types, compared with those of rosmsg and with messages that rosbags makes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from rosbags.interfaces import Nodetype
from rosbags.typesys import get_typestore

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import DISTROS, Library
from firm_hdl.identity import proto
from firm_hdl.model import IDL_PRIMITIVES, Array, Field, Message, Sequence, String
from tests.depth import by_depth

from ..frontend.workspace import library, make_files
from .rosmsg_examples import EXAMPLES

DEBIAN_PYTHON = "/usr/bin/python3"
WORKER = Path(__file__).with_name("rosmsg_worker.py")

# ROS 2.


def default(description, store):
    """Return a value of a rosbags type as rosidl_generator_py initialises it."""
    kind, detail = description
    match kind:
        case Nodetype.BASE:
            zeros = {"string": "", "bool": False, "float32": 0.0, "float64": 0.0, "byte": "\0"}
            return zeros.get(detail[0], 0)
        case Nodetype.NAME:
            return new(detail, store)
        case Nodetype.ARRAY:
            return [default(detail[0], store) for _ in range(detail[1])]
        case _:
            return []


def new(name, store):
    constants, fields = store.fielddefs[name]
    values = {n: default(d, store) for n, d in fields if not n.startswith("structure_needs")}
    # rosbags has no defaults. These two are not 0; the second is as old as its constant.
    if name == "geometry_msgs/msg/Quaternion":
        values["w"] = 1.0
    if ("STATUS_UNKNOWN", "int8", -2) in constants:
        values["status"] = -2
    return values


@pytest.mark.sampled(2)
@pytest.mark.parametrize("distro", ["humble", "lyrical"])
def test_example_is_the_yaml_of_a_new_message(distro):
    store, ours = get_typestore(DISTROS[distro].store), Library(distro)
    for name in ours.names():
        want = yaml.dump(
            new(name, store),
            allow_unicode=True,
            width=sys.maxsize,
            default_flow_style=False,
            sort_keys=False,
        )
        assert proto(ours.message(name)) == f'"{want}"', name


DEFAULTS = r"""bool a true
byte b 200
char c 65
float32 d 1.1
float64 e 3
string f "it's: \"x\""
wstring g "größe"
string<=5 h
int32[3] i [1, 2, -3]
int32[<=3] j [4, 5]
float32[] k [1.5, 0.1]
string[2] l ["yes", ""]
bool[] m [true, false]
byte[2] n [0, 255]
int8[2] o
string<=4[2] p
float64 y
string on "null"
"""


def test_defaults_are_applied(tmp_path):
    ours = library(tmp_path, {"p/A": DEFAULTS})
    assert proto(ours.message("p/A"), quotes=False) == (
        "a: true\nb: È\nc: 65\nd: 1.1\ne: 3.0\n"
        "f: 'it''s: \"x\"'\ng: größe\nh: ''\n"
        "i:\n- 1\n- 2\n- -3\nj:\n- 4\n- 5\nk:\n- 1.5\n- 0.10000000149011612\n"
        "l:\n- 'yes'\n- ''\nm:\n- true\n- false\n"
        "n:\n- \"\\0\"\n- ÿ\no:\n- 0\n- 0\np:\n- ''\n- ''\n"
        "y: 0.0\n'on': 'null'\n"
    )


def test_long_texts_stay_on_their_line_and_floats_of_lists_have_32_bits(tmp_path):
    words = " ".join(["word"] * 60)
    ours = library(tmp_path, {"p/A": f"string s {words}\nfloat32[] f [1e39, -1e39, 1e-50]\n"
                                     "float64[] d [1e39, 0.1]\nfloat32 x 0.1\n"})  # fmt: skip
    assert proto(ours.message("p/A"), quotes=False) == (
        f"s: {words}\nf:\n- .inf\n- -.inf\n- 0.0\nd:\n- 1.0e+39\n- 0.1\nx: 0.1\n"
    )


def test_names_that_yaml_takes_for_values_are_quoted(tmp_path):
    text = "Part on\nPart[2] off\nNone no\nNone[1] yes\nint8[2] null\nstring true 'false'\n"
    ours = library(tmp_path, {"p/A": text, "p/Part": "int8[1] true\nint8 n\n", "p/None": ""})
    found = proto(ours.message("p/A"), quotes=False)
    part = {"true": [0], "n": 0}
    assert yaml.safe_load(found) == {
        "on": part, "off": [part, part], "no": {}, "yes": [{}], "null": [0, 0], "true": "false"
    }  # fmt: skip
    assert found.startswith("'on':\n  'true':\n  - 0\n  n: 0\n'off':\n- 'true':\n  - 0\n")


def test_text_with_line_ends_keeps_its_indentation():
    line = Field(name="s", type=String(), default="one\ntwo\n\nthree")
    leaf = Message(name="p/msg/L", dialect="ros2", fields=(line,))
    top = Message(
        name="p/msg/T", dialect="ros2", fields=(Field(name="a", type=Array(element=leaf, count=1)),)
    )
    want = yaml.dump({"a": [{"s": "one\ntwo\n\nthree"}]}, default_flow_style=False)
    assert proto(top, quotes=False) == want


def test_characters_of_idl_are_texts():
    fields = tuple(
        Field(name=name, type=IDL_PRIMITIVES[name], default=value)
        for name, value in (("char", None), ("wchar", "A"))
    )
    more = (Field(name="more", type=Array(element=IDL_PRIMITIVES["char"], count=2)),)
    message = Message(name="p/msg/A", dialect="ros2", fields=fields + more)
    assert proto(message, quotes=False) == 'char: "\\0"\nwchar: A\nmore:\n- "\\0"\n- "\\0"\n'


@pytest.mark.parametrize(
    ("kind", "value", "text"),
    [
        ("char", "'z'", "z"),
        ("char", "'\\x7f'", '"\\x7F"'),
        # A signed char has the upper half of Latin-1 as negative numbers.
        ("char", "'\\xe4'", "ä"),
        ("char", "-1", "ÿ"),
        ("char", "48", "'0'"),
        ("wchar", "L'\\u20ac'", "€"),
        ("wchar", "65535", '"\\uFFFF"'),
        ("octet", "228", "ä"),
        ("uint8", "228", "228"),
    ],
)
def test_defaults_of_idl_that_are_characters_are_shown_as_such(tmp_path, kind, value, text):
    idl = f"module p {{ module msg {{ struct A {{ @default(value={value}) {kind} c; }}; }}; }};"
    ours = Library("lyrical", [make_files(tmp_path, {"p/msg/A.idl": idl})])
    assert proto(ours.message("p/A"), quotes=False) == f"c: {text}\n"


def test_service_is_shown_by_its_request_and_action_by_its_goal(tmp_path):
    make_files(
        tmp_path,
        {"p/srv/S.srv": "int8 a\n---\nint8 b\n", "p/action/A.action": "int8 c\n---\n---\n"},
    )
    for distro in ("lyrical", "noetic"):
        ours = Library(distro, [tmp_path])
        end = "\n" if distro == "lyrical" else ""
        assert proto(ours.interface("p/srv/S")) == f'"a: 0{end}"'
        assert proto(ours.interface("p/action/A")) == f'"c: 0{end}"'


def test_millions_of_elements_are_quick_and_more_is_refused(tmp_path):
    texts = {
        "p/Large": "uint8[8388608] data\n",
        "p/Larger": "Large[50] data\n",
        "p/Many": "\n".join(f"Large a{i}" for i in range(50)),
    }
    ours = library(tmp_path, texts)
    assert len(proto(ours.message("p/Large"))) == len('"data:\n"') + 8388608 * len("- 0\n")
    each = {"Larger": len("- data:\n"), "Many": len("a10:\n") + len("  data:\n")}
    for name, heading in each.items():
        count = 50 * (heading + 8388608 * len("  - 0\n")) + (
            len("data:\n") if name == "Larger" else -10
        )
        message = f"^error: p/msg/{name} has .* {count} characters, which is more than 268435456$"
        with pytest.raises(DefinitionError, match=message):
            proto(ours.message(f"p/{name}"))


def test_depth_is_not_limited_in_ros2():
    top = Message(name="p/msg/L", dialect="ros2", fields=())
    for level in range(1500):
        kind = Sequence(element=top) if level % 2 else top
        top = Message(name=f"p/msg/L{level}", dialect="ros2", fields=(Field(name="f", type=kind),))
    assert proto(top, quotes=False) == "f: []\n"


# ROS 1.


@pytest.fixture(scope="session")
def rosmsg():
    """Debian's ``rosmsg-proto msg`` for many types at a time."""
    test = [DEBIAN_PYTHON, "-c", "import rosmsg, genpy.dynamic"]
    try:
        subprocess.run(test, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        message = "python3-rosmsg is not installed for /usr/bin/python3 (as root: make tools)"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)

    def run(folder, names):
        command = [DEBIAN_PYTHON, str(WORKER), str(folder)]
        text = "".join(f"{name}\n" for name in names)
        done = subprocess.run(command, input=text, capture_output=True, text=True, check=True)
        return dict(zip(names, map(json.loads, done.stdout.splitlines()), strict=True))

    return run


def make_examples(root):
    """Return a library of the examples' definitions and of ROS's own types in them."""
    needed = {
        "Header": "uint32 seq\ntime stamp\nstring frame_id\n",
        "Time": "time data\n",
        "Duration": "duration data\n",
    }
    make_files(root, {f"std_msgs/msg/{name}.msg": text for name, text in needed.items()})
    return library(root, {name: text for name, (text, _) in EXAMPLES.items()}, "ros1")


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_is_the_recorded_one_of_rosmsg_proto(tmp_path, name):
    message = make_examples(tmp_path).message(name)
    assert proto(message, quotes=False) == EXAMPLES[name][1]
    assert proto(message) == f'"{EXAMPLES[name][1]}"'


def test_example_is_that_of_rosmsg_proto(tmp_path, rosmsg):
    make_examples(tmp_path)
    assert rosmsg(tmp_path, list(EXAMPLES)) == {
        name: f'"{text}"' for name, (_, text) in EXAMPLES.items()
    }


def test_examples_of_the_corpus_are_those_of_rosmsg_proto(corpus, rosmsg):
    # Every 40th type takes 10 s, most of it in rosmsg; all types were compared once.
    noetic = Library("noetic", [corpus / "ros1"])
    files = sorted((corpus / "ros1").glob("*/msg/*.msg"))[:: by_depth(480, 40)]
    names = [f"{path.parts[-3]}/{path.stem}" for path in files]
    want = rosmsg(corpus / "ros1", names)
    assert len(want) > by_depth(7, 100)
    assert {name: proto(noetic.message(name)) for name in names} == want


def test_examples_that_take_pyyaml_minutes_are_refused(tmp_path):
    # More bytes than there may be values; the limit would let 16 million pass.
    count = by_depth(1_000_001, 8_388_608)
    ours = library(tmp_path, {"p/A": "int8[500000] a\n", "p/B": f"uint8[{count}] a\n"}, "ros1")
    message = "^error: p/A has an example of 1000001 values, which is more than 1000000$"
    with pytest.raises(DefinitionError, match=message):
        proto(ours.message("p/A"))
    # A sequence of bytes is one text.
    assert proto(ours.message("p/B")).startswith('"a: !!binary |\n  AAAA')


def test_nesting_too_deep_for_pyyaml_is_refused():
    top = Message(name="p/L", dialect="ros1", fields=())
    for level in range(1000):
        top = Message(name=f"p/L{level}", dialect="ros1", fields=(Field(name="f", type=top),))
    with pytest.raises(
        DefinitionError, match=r"^error: p/L999 has an example of more than 100 levels$"
    ):
        proto(top)


def test_size_is_that_of_the_text_before_it_is_written(tmp_path, monkeypatch):
    texts = {
        "p/Top": "Part part\nPart[3] parts\nPart[] more\nNone none\nNone[2] nones\nint8[] on [1]\n",
        "p/Part": "Leaf leaf\nint8[2] two\nfloat32[12] y\nstring s 'a b'\nbool[2] z [true, true]\n",
        "p/Leaf": "float32 x\nLeast[11] least\n",
        "p/Least": "int8 y 1\nstring[2] null\nwstring[] w\n",
    }
    ours = library(tmp_path, {**texts, "p/None": ""})
    examples = {name: proto(ours.message(name), quotes=False) for name in texts}
    for name, text in examples.items():
        monkeypatch.setattr("firm_hdl.identity.proto_ros2._MAX_CHARACTERS", len(text))
        assert proto(ours.message(name), quotes=False) == text
        monkeypatch.setattr("firm_hdl.identity.proto_ros2._MAX_CHARACTERS", len(text) - 1)
        pattern = f" has an example of {len(text)} characters, which is more than {len(text) - 1}$"
        with pytest.raises(DefinitionError, match=pattern):
            proto(ours.message(name))


def test_levels_of_ros1_are_counted_from_the_outermost_message(tmp_path):
    texts = {f"p/L{n}": f"L{n - 1} f\n" for n in range(1, 101)} | {"p/L0": "int8 x\n"}
    ours = library(tmp_path, texts, "ros1")
    # L99 has 100 levels.
    assert proto(ours.message("p/L99"), quotes=False).endswith("x: 0")
    with pytest.raises(
        DefinitionError, match=r"^error: p/L100 has an example of more than 100 levels$"
    ):
        proto(ours.message("p/L100"))


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("int8 a\nstring b\n", 4),
        # Each element of a list counts, and its values.
        ("string[3] a\n", 1 + 3 * 2),
        ("Part p\n", 1 + 4),
        ("Part[2] p\n", 1 + 2 * (1 + 4)),
        # A list of any length counts as one value.
        ("string[] a\n", 1 + 1 + 1),
        ("Part[] p\n", 1 + 1 + 4),
        # 16 bytes count as one value.
        ("uint8[15] a\n", 1 + 1),
        ("uint8[16] a\n", 1 + 2),
        ("uint8[33] a\n", 1 + 3),
    ],
)
def test_values_of_ros1_are_counted_before_they_are_written(tmp_path, monkeypatch, text, values):
    message = library(tmp_path, {"p/A": text, "p/Part": "int8 x\nint8 y\n"}, "ros1").message("p/A")
    monkeypatch.setattr("firm_hdl.identity.proto_ros1._MAX_VALUES", values)
    proto(message)
    monkeypatch.setattr("firm_hdl.identity.proto_ros1._MAX_VALUES", values - 1)
    pattern = (
        f"^error: p/(A|Part) has an example of {values} values, which is more than {values - 1}$"
    )
    with pytest.raises(DefinitionError, match=pattern):
        proto(message)
