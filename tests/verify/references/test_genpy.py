"""The requests to genpy's process, and conversions to and from genpy's objects."""

from __future__ import annotations

import struct
from types import SimpleNamespace

import pytest

from firm_hdl.verify.references.client import ClientDiedError, Refusal, UnsupportedError
from firm_hdl.verify.references.genpy import Genpy
from firm_hdl.verify.references.genpy_objects import Objects, to_json
from firm_hdl.verify.ros_python.worker import DIED


class FakeWorker:
    """A process that knows only the type that was opened last, as the real one does."""

    def __init__(self):
        self.missing, self.versions = None, {"genpy": "0.6", "rosmsg": "1"}
        self.requests, self.answers, self.name = [], [], None

    def ask(self, request):
        self.requests.append(request)
        if self.answers:
            return self.answers.pop(0)
        if request["oracle"] == "open":
            self.name = request["name"]
            return {"facts": None}
        items = [{"item": [self.name, request["oracle"], each]} for each in request["items"]]
        return {"facts": items}

    def close(self):
        self.name = None


@pytest.fixture
def far():
    return FakeWorker()


@pytest.fixture
def codec_of(far, make_message):
    """A function that opens the codec of a type of one field."""
    genpy = Genpy()
    genpy.__dict__["_worker"] = far

    def codec(text="uint8 a\n"):
        return genpy.open(make_message(text, "noetic"), "ros1")

    return codec


def kinds(far):
    return [request["oracle"] for request in far.requests]


def test_a_type_is_opened_again_if_another_was_opened_in_between(far, codec_of):
    one, other = codec_of(), codec_of("uint8 b\n")
    far.requests.clear()
    other.encode_all([1])
    other.decode_all([b""])
    assert kinds(far) == ["encode", "decode"]
    one.encode_all([1])
    one.encode_all([2])
    other.encode_all([3])
    assert kinds(far)[2:] == ["open", "encode", "encode", "open", "encode"]
    assert [request["text"] for request in far.requests if request["oracle"] == "open"] == [
        "uint8 a\n",
        "uint8 b\n",
    ]


def test_bytes_are_text_on_the_way(far, codec_of):
    codec = codec_of()
    far.answers = [{"facts": [{"item": "\xffa"}, {"refused": "no"}, {"item": ""}]}]
    answers = codec.encode_all([{"a": b"\xfe"}, {"a": [b"x", 2]}, {"a": True}])
    assert far.requests[-1]["items"] == [{"a": "\xfe"}, {"a": ["x", 2]}, {"a": True}]
    assert answers == [b"\xffa", Refusal("no"), b""] and str(answers[1]) == "no"
    far.answers = [{"facts": [{"item": {"a": "\xff", "b": [1]}}]}]
    assert codec.decode_all([b"\x00\xff"]) == [{"a": b"\xff", "b": [1]}]
    assert far.requests[-1] == {"oracle": "decode", "items": ["\x00\xff"]}


@pytest.mark.parametrize(
    ("answer", "kind", "text"),
    [
        ({"refused": "no such type"}, UnsupportedError, "genpy: no such type"),
        ({"failed": "it took over 60 s"}, UnsupportedError, "genpy: it took over 60 s"),
        ({"failed": DIED}, ClientDiedError, f"genpy: {DIED}"),
        ({}, ClientDiedError, "genpy: it answered nothing"),
    ],
)
def test_a_process_that_does_not_answer_is_asked_from_the_start(far, codec_of, answer, kind, text):
    codec = codec_of()
    far.answers = [answer]
    with pytest.raises(UnsupportedError) as raised:
        codec.encode_all([1])
    assert type(raised.value) is kind and str(raised.value) == text
    far.requests.clear()
    codec.encode_all([1])
    assert kinds(far) == ["open", "encode"]


def test_genpy_has_types_of_ros1_and_a_version(far, make_message):
    genpy = Genpy()
    genpy.__dict__["_worker"] = far
    assert (genpy.missing(), genpy.version()) == (None, "0.6")
    with pytest.raises(UnsupportedError, match=r"^genpy has no types of ROS 2$"):
        genpy.open(make_message("uint8 a\n"), "ros1")
    far.missing = "it is gone"
    assert genpy.missing() == "genpy cannot be used: it is gone (Debian: python3-genpy)"
    far.name = "p/A"
    genpy.close()
    assert far.name is None


# genpy's objects.


class Time:
    __slots__ = ["nsecs", "secs"]

    def __init__(self, secs=0, nsecs=0):
        # genpy normalizes what its constructor gets.
        self.secs, self.nsecs = secs + nsecs // 10**9, nsecs % 10**9


class Duration(Time):
    pass


class B:
    __slots__ = ["from_", "x"]


class A:
    __slots__ = ["b", "d", "f", "flag", "list", "many", "numbers", "t", "text", "texts"]

    def serialize(self, buffer):
        buffer.write(struct.pack("<f", self.f))

    def deserialize(self, packet):
        for name in self.__slots__:
            setattr(self, name, getattr(KEPT, name))


KEPT = SimpleNamespace()
TABLE = {
    "p/A": [
        ("t", False, "time"),
        ("d", True, "duration"),
        ("f", False, "float32"),
        ("many", True, "float64"),
        ("text", False, "string"),
        ("texts", True, "string"),
        ("b", False, "p/B"),
        ("list", True, "p/B"),
        ("flag", False, "bool"),
        ("numbers", True, "int16"),
    ],
    "p/B": [("x", False, "uint8"), ("from", False, "uint8")],
}
VALUE = {
    "t": {"secs": 1, "nsecs": 3_000_000_000},
    "d": [{"secs": -1, "nsecs": -2}],
    "f": 0x3FC00000,
    "many": [0x3FF8000000000000, 1 << 63],
    "text": b"\xc3\xa9\xff",
    "texts": [b"a", b""],
    "b": {"x": 1, "from": 2},
    "list": [{"x": 3, "from": 4}, {"x": 5, "from": 6}],
    "flag": True,
    "numbers": [-1, 300],
}


@pytest.fixture
def objects():
    return Objects(SimpleNamespace(Time=Time, Duration=Duration), {"p/A": A, "p/B": B}, TABLE)


@pytest.mark.parametrize("change", [lambda value: value, to_json])
def test_values_become_genpy_s_objects_and_come_back(objects, change):
    made = objects.made("p/A", change(VALUE))
    assert type(made.t) is Time and (made.t.secs, made.t.nsecs) == (1, 3_000_000_000)
    assert type(made.d[0]) is Duration and (made.d[0].secs, made.d[0].nsecs) == (-1, -2)
    assert (made.f, made.many, str(made.many[1])) == (1.5, [1.5, 0.0], "-0.0")
    assert (made.text, made.texts) == ("é\udcff", ["a", ""])
    assert (made.b.x, made.b.from_) == (1, 2)
    assert [(each.x, each.from_) for each in made.list] == [(3, 4), (5, 6)]
    assert made.flag is True and made.numbers == [-1, 300]
    assert objects.plain("p/A", made) == VALUE


def test_packets_are_those_of_genpy(objects):
    assert objects.encode("p/A", VALUE) == bytes.fromhex("0000c03f")
    made = objects.made("p/A", VALUE)
    # genpy reads a bool as a number in some releases.
    made.flag = 1
    for name in A.__slots__:
        setattr(KEPT, name, getattr(made, name))
    found = objects.decode("p/A", b"")
    assert found == VALUE and found["flag"] is True
