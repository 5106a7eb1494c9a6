"""The md5 sums of ROS 1, compared with those of genmsg."""

from __future__ import annotations

import csv
import hashlib

import pytest
from rosbags.typesys import Stores, get_typestore

from firm_hdl.frontend import Library
from firm_hdl.identity import md5sum
from firm_hdl.model import Action, Field, Message
from tests.depth import by_depth

from ..frontend.workspace import library, make_files

# As ``rosmsg md5`` and ``rossrv md5`` print them.
PUBLISHED = {
    "std_msgs/String": "992ce8a1687cec8c8bd883ec73ca41d1",
    "std_msgs/Header": "2176decaecbce78abc3b96ef049fabed",
    "std_msgs/Empty": "d41d8cd98f00b204e9800998ecf8427e",
    "sensor_msgs/Imu": "6a62c6daae103f4ff57a132d6f95cec2",
    "geometry_msgs/Twist": "9f195f881246fdfa2798d1d3eebca84a",
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_sum_is_the_published_one(name):
    assert md5sum(Library("noetic").message(name)) == PUBLISHED[name]


def test_sum_of_a_service_is_over_both_parts(tmp_path):
    make_files(
        tmp_path,
        {
            "std_srvs/srv/SetBool.srv": "bool data # which\n---\nbool success\nstring message\n",
            "std_srvs/srv/Empty.srv": "---\n",
        },
    )
    noetic = Library("noetic", [tmp_path])
    assert md5sum(noetic.interface("std_srvs/SetBool")) == "09fb03525b03e7ea1fd3992bafd87e16"
    assert md5sum(noetic.interface("std_srvs/Empty")) == "d41d8cd98f00b204e9800998ecf8427e"


def test_sums_of_embedded_types_are_those_of_rosbags():
    store, noetic = get_typestore(Stores.ROS1_NOETIC), Library("noetic")
    for name in noetic.names():
        want = store.generate_msgdef(name.replace("/", "/msg/"))[1]
        assert md5sum(noetic.message(name)) == want, name


def test_sums_of_the_corpus_are_those_of_genmsg(corpus):
    with (corpus / "ros1_md5.tsv").open(encoding="utf-8") as lines:
        want = dict(list(csv.reader(lines, delimiter="\t"))[1:])
    noetic = Library("noetic", [corpus / "ros1"])
    ours = {}
    for path in sorted((corpus / "ros1").glob("*/*/*.*"))[:: by_depth(25, 1)]:
        package, kind = path.parts[-3:-1]
        interface = noetic.interface(f"{package}/{kind}/{path.stem}")
        parts = interface.messages[:3] if isinstance(interface, Action) else (interface,)
        ours.update((part.name, md5sum(part)) for part in parts)
    assert len(want) == 5915
    expected = {name: want[name] for name in by_depth(ours.keys() & want.keys(), want.keys())}
    assert {name: ours.get(name) for name in expected if ours.get(name) != want[name]} == {}
    assert len(expected) > by_depth(200, 5900)


@pytest.mark.parametrize(
    ("text", "is_same"),
    [
        ("# other\nint32 A=1\nuint8[3] b   # comment\nTime[] c\n", True),
        ("uint8[3] b\nTime[] c\nint32 A=1\n", True),
        ("int32 A=2\nuint8[3] b\nTime[] c\n", False),
        ("int32 A=1\nuint8[4] b\nTime[] c\n", False),
        ("int32 A=1\nTime[] c\nuint8[3] b\n", False),
        # A message's array counts as the message.
        ("int32 A=1\nuint8[3] b\nTime c\n", True),
    ],
)
def test_sum_does_not_depend_on_spelling(tmp_path, text, is_same):
    texts = {"p/A": "int32 A=1\nuint8[3] b\nTime[] c\n", "p/B": text, "p/Time": "time t\n"}
    ours = library(tmp_path, texts, "ros1")
    assert (md5sum(ours.message("p/A")) == md5sum(ours.message("p/B"))) is is_same


def test_lengths_of_arrays_count_as_they_are_written(tmp_path):
    texts = {"p/A": "int8[003] a\nint8[3] b\ntime[02] c\nB[09] d\nint8[]  e\n", "p/B": "int8 x"}
    message = library(tmp_path, texts, "ros1").message("p/A")
    inner = hashlib.md5(b"int8 x").hexdigest()
    want = f"int8[003] a\nint8[3] b\ntime[02] c\n{inner} d\nint8[] e"
    assert md5sum(message) == hashlib.md5(want.encode()).hexdigest()


def test_types_of_ros2_have_none():
    with pytest.raises(ValueError, match=r"^Only types of ROS 1 have md5 sums, and std_msgs/msg/"):
        md5sum(Library("humble").message("std_msgs/msg/Bool"))


def test_depth_is_not_limited():
    top = Message(name="p/L", dialect="ros1", fields=())
    for level in range(3000):
        top = Message(name=f"p/L{level}", dialect="ros1", fields=(Field(name="f", type=top),))
    assert len(md5sum(top)) == 32
