"""Sums, hashes and examples of types that share a last name or are easy to confuse."""

from __future__ import annotations

import hashlib

import pytest
import yaml

from firm_hdl.frontend import Library
from firm_hdl.identity import (
    md5sum,
    proto,
    type_description,
)

from ..frontend.workspace import library, make_files

PARTS = {
    "p/T": "Part a\nq/Part[] b\nr/Zed c\nq/Whole d",
    "p/Part": "int8 p",
    "q/Part": "int16 q\nint16 more",
    "q/Whole": "Part q\np/Part p",
    "q/Zed": "int8 unused",
    "r/Zed": "string r",
    "r/Aaa": "int8 unused",
}


def digest(text):
    return hashlib.md5(text.encode()).hexdigest()


def test_sum_has_the_sums_of_the_right_types(tmp_path):
    p, q, r = digest("int8 p"), digest("int16 q\nint16 more"), digest("string r")
    whole = digest(f"{q} q\n{p} p")
    assert md5sum(library(tmp_path, PARTS, "ros1").message("p/T")) == digest(
        f"{p} a\n{q} b\n{r} c\n{whole} d"
    )


def test_sum_of_a_service_has_the_sums_of_the_right_types(tmp_path):
    files = {f"{n.replace('/', '/msg/')}.msg": text for n, text in PARTS.items()}
    make_files(tmp_path, files | {"p/srv/S.srv": "Part a\n---\nq/Part a\nPart b"})
    p, q = digest("int8 p"), digest("int16 q\nint16 more")
    service = Library("noetic", [tmp_path]).interface("p/srv/S")
    assert md5sum(service) == digest(f"{p} a{q} a\n{p} b")


@pytest.mark.parametrize(
    ("text", "summed"),
    [
        ("float32 A=1.50\nint8 a", "float32 A=1.50\nint8 a"),
        ("int8 B=+1\nint8 A=-0\nuint8 C=007", "int8 B=+1\nint8 A=-0\nuint8 C=007"),
        ("bool A=1\nbool B=True", "bool A=1\nbool B=True"),
        ("string A=  x # y\nint8 a # z", "string A=x # y\nint8 a"),
        ("int8 a\nint8 A=1\nint8 b\nint8 B=2", "int8 A=1\nint8 B=2\nint8 a\nint8 b"),
        ("int8 B=1\nint8 A=2\nint8 B=3", "int8 B=1\nint8 A=2\nint8 B=3"),
        ("time a\nduration[] b\nTime c", f"time a\nduration[] b\n{digest('int8 x')} c"),
        ("Header a\nHeader[2] b", f"{digest('int8 std')} a\n{digest('int8 own')} b"),
    ],
)
def test_sum_is_over_the_words_of_the_definition(tmp_path, text, summed):
    texts = {
        "p/T": text,
        "p/Time": "int8 x",
        "p/Header": "int8 own",
        "std_msgs/Header": "int8 std",
    }
    assert md5sum(library(tmp_path, texts, "ros1").message("p/T")) == digest(summed)


def test_descriptions_are_sorted_by_full_names(tmp_path):
    described = type_description(library(tmp_path, PARTS).message("p/T"))
    parts = {
        part["type_name"]: [f["name"] for f in part["fields"]]
        for part in described["referenced_type_descriptions"]
    }
    assert [*parts.items()] == [
        ("p/msg/Part", ["p"]),
        ("q/msg/Part", ["q", "more"]),
        ("q/msg/Whole", ["q", "p"]),
        ("r/msg/Zed", ["r"]),
    ]
    fields = described["type_description"]["fields"]
    assert [f["type"]["nested_type_name"] for f in fields] == [
        "p/msg/Part", "q/msg/Part", "r/msg/Zed", "q/msg/Whole"
    ]  # fmt: skip


def read_back(message):
    return yaml.safe_load(proto(message, quotes=False))


def test_examples_have_values_of_the_right_types(tmp_path):
    p, q = {"p": 0}, {"q": 0, "more": 0}
    assert read_back(library(tmp_path / "2", PARTS).message("p/T")) == {
        "a": p, "b": [], "c": {"r": ""}, "d": {"q": q, "p": p}
    }  # fmt: skip
    assert read_back(library(tmp_path / "1", PARTS, "ros1").message("p/T")) == {
        "a": p, "b": [q], "c": {"r": ""}, "d": {"q": q, "p": p}
    }  # fmt: skip


NESTED = {
    "p/T": "Row[2] rows\nEmpty none\nEmpty[2] nones\nSaid said\nSaid[2] all\nint8 last",
    "p/Row": "Cell[3] cells\nint8[2] n\nstring[2] s\nEmpty[2] e",
    "p/Cell": "int8 a\nPoint[2] points",
    "p/Point": "float64 x\nfloat64[2] y",
    "p/Empty": "",
    "p/Said": "int8 WHY=1",
}


def test_examples_of_nested_arrays_have_the_values_of_new_messages(tmp_path):
    point = {"x": 0.0, "y": [0.0, 0.0]}
    row = {
        "cells": [{"a": 0, "points": [point] * 2}] * 3,
        "n": [0, 0],
        "s": ["", ""],
        "e": [{}, {}],
    }
    want = {
        "rows": [row] * 2, "none": {}, "nones": [{}] * 2, "said": {}, "all": [{}] * 2, "last": 0
    }  # fmt: skip
    for dialect in ("ros1", "ros2"):
        message = library(tmp_path / dialect, NESTED, dialect).message("p/T")
        assert read_back(message) == want
    # A message without fields counts as one value, whatever constants it has.
    text = proto(library(tmp_path / "ros2", NESTED).message("p/T"), quotes=False)
    assert "\nnone: {}\n" in text and "\nsaid: {}\n" in text


# The commands.


def test_descriptions_of_services_and_actions_name_their_parts(tmp_path):
    make_files(tmp_path, {"p/srv/S.srv": "int8 a\n---\nint8 b"})
    make_files(tmp_path, {"p/action/D.action": "int8 a\n---\nint8 b\n---\nint8 c"})
    ours = Library("lyrical", [tmp_path])

    def fields(name, base):
        described = type_description(ours.interface(name))
        top = described["type_description"]
        parts = [part["type_name"] for part in described["referenced_type_descriptions"]]
        assert parts == sorted(parts)
        named = {f["name"]: f["type"]["nested_type_name"] for f in top["fields"]}
        assert set(named.values()) <= {*parts}
        return {key: value.removeprefix(base) for key, value in named.items()}, parts

    named, parts = fields("p/srv/S", "p/srv/S")
    assert [*named.items()] == [
        ("request_message", "_Request"),
        ("response_message", "_Response"),
        ("event_message", "_Event"),
    ]
    assert "service_msgs/msg/ServiceEventInfo" in parts
    named, parts = fields("p/action/D", "p/action/D")
    assert [*named.items()] == [
        ("goal", "_Goal"),
        ("result", "_Result"),
        ("feedback", "_Feedback"),
        ("send_goal_service", "_SendGoal"),
        ("get_result_service", "_GetResult"),
        ("feedback_message", "_FeedbackMessage"),
    ]
    own = {part.removeprefix("p/action/D_") for part in parts if part.startswith("p/")}
    assert own == {
        *("Goal", "Result", "Feedback", "FeedbackMessage", "SendGoal", "GetResult"),
        *(f"{s}_{p}" for s in ("SendGoal", "GetResult") for p in ("Request", "Response", "Event")),
    }
