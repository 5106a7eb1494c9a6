"""Figures that no library can confirm, and the types that the command counts."""

from __future__ import annotations

import csv
import io
import json

import pytest

from firm_hdl.cli import main
from firm_hdl.frontend import Library
from firm_hdl.metrics import Analyses, metrics_of

from ..frontend.workspace import library, make_files


@pytest.mark.parametrize(
    ("text", "least", "most"),
    [
        ("wstring<=3 a", 4 + 4, 4 + 4 + 12),
        ("string<=3 a", 4 + 5, 4 + 8),
        ("wstring<=3[2] a", 4 + 8, 4 + 2 * 16),
        ("wstring<=3[<=2] a", 4 + 4, 4 + 4 + 2 * 16),
        ("string<=3[<=2] a", 4 + 4, 4 + 4 + 2 * 8),
        ("uint8 x\nwstring<=1 a\nuint8 y", 4 + 4 + 4 + 1, 4 + 4 + 8 + 1),
        ("wstring<=2 a\nfloat64 b", 4 + 4 + 4 + 8, 4 + 12 + 4 + 8),
        ("wstring a\nuint8 b", 4 + 4 + 1, None),
        ("wstring[2] a\nuint8 b", 4 + 8 + 1, None),
        ("uint8[<=3] a\nuint16 b", 4 + 4 + 2, 4 + 4 + 3 + 1 + 2),
        ("", 4 + 1, 4 + 1),
    ],
)
def test_sizes_by_hand(tmp_path, text, least, most):
    figures = metrics_of(library(tmp_path, {"p/T": text}).message("p/T"))
    assert (figures.min_bytes, figures.max_bytes) == (least, most)


@pytest.mark.parametrize(
    ("text", "places"),
    [
        # After a wide text, a uint32 is aligned; the padding of a float64 is not fixed.
        ("wstring a\nuint32 b", (2, 0, 0)),
        ("wstring a\nfloat64 b", (1, 0, 1)),
        ("string a\nuint8 b", (2, 0, 0)),
        ("string a\nuint16 b", (1, 0, 1)),
        ("uint8 a\nwstring b\nwstring c", (2, 1, 0)),
        ("string[2] a\nuint8 b", (1, 0, 1)),
    ],
)
def test_places_by_hand(tmp_path, text, places):
    figures = metrics_of(library(tmp_path, {"p/T": text}).message("p/T"))
    found = (figures.aligned, figures.padded, figures.shifting)
    assert found == places


def test_counts_by_hand(tmp_path):
    texts = {
        "p/T": "# größe\ntime t\nPart[2] a\nq/Part[] b\nduration[3] d",
        "p/Part": "int8 x\nint8 y",
        "q/Part": "int8 x\nEmpty e\nstring s",
        "q/Empty": "int8 A=1",
    }
    figures = metrics_of(library(tmp_path, texts, "ros1").message("p/T"))
    # The builtin times do not count as types.
    assert (figures.types, figures.depth, figures.fields, figures.constants) == (4, 3, 4, 0)
    assert (figures.leaves, figures.fixed_leaves, figures.dynamic_leaves) == (9, 6, 3)
    assert figures.definition_bytes == len(texts["p/T"].encode()) == len(texts["p/T"]) + 2
    assert figures.features == (
        "constants", "messages", "empty_messages", "strings", "arrays_of_messages",
        "sequences_of_messages",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("text", "features"),
    [
        ("wstring<=2 a", {"bounded_wstrings"}),
        ("wstring a", {"wstrings"}),
        ("string<=2 a", {"bounded_strings"}),
        ("int8[<=2] a", {"bounded_sequences", "sequences_of_primitives"}),
        ("int8 a 0", {"defaults"}),
        ("Empty a", {"messages", "empty_messages"}),
        ("Texts[] a", {"messages", "sequences_of_messages", "nested_sequences",
                       "sequences_of_strings", "strings"}),
        ("Lists[] a", {"messages", "sequences_of_messages", "nested_sequences", "empty_messages"}),
        ("Lists[2] a", {"messages", "sequences_of_messages", "arrays_of_messages",
                        "empty_messages"}),
        ("In[] a", {"messages", "sequences_of_messages", "nested_sequences", "empty_messages"}),
    ],
)  # fmt: skip
def test_features_come_from_all_levels(tmp_path, text, features):
    files = {
        "p/T": text,
        "p/Empty": "",
        "p/Texts": "string[] a",
        "p/Lists": "Empty[] a",
        "p/In": "Lists x",
    }
    assert set(metrics_of(library(tmp_path, files).message("p/T")).features) == features


def test_types_of_one_name_have_figures_of_their_own(tmp_path):
    texts = {"p/T": "Part a", "q/T": "Part a", "p/Part": "int8 x", "q/Part": "int64 x\nint8 y"}
    ours, analyses = library(tmp_path, texts), Analyses("cdr")
    found = [analyses.metrics(ours.message(n)) for n in ("p/T", "q/T", "p/Part", "q/Part")]
    assert [(row.min_bytes, row.leaves) for row in found] == [(5, 1), (13, 2), (5, 1), (13, 2)]


FILES = {
    "p/msg/A.msg": "uint8 a\nuint32 b",
    "p/srv/A.srv": "uint8 a\n---\nuint8 b",
    "z/action/Z.action": "uint8 a\n---\nuint8 b\n---\nuint8 c",
}


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_all_are_messages_services_and_actions(tmp_path, capsys, distro):
    make_files(tmp_path, FILES)
    options = ["--path", str(tmp_path), "--distro", distro]
    assert main(["metrics", "--all", "--format", "csv", *options]) == 0
    names = [row["name"] for row in csv.DictReader(io.StringIO(capsys.readouterr().out))]
    ours = Library(distro, [tmp_path])
    own = [each for each in ours.interfaces() if each.startswith(("p/", "z/"))]
    want = {m.name for each in own for m in ours.interface(each).messages}
    assert {*names} == want and len(names) == len(want)
    assert {n for n in names if n.startswith("z/")} == {
        m.name for m in ours.interface("z/Z").messages
    }


def test_figures_of_nothing_are_zero_and_not_missing(tmp_path, capsys):
    make_files(tmp_path, FILES)
    options = ["p/msg/A", "--path", str(tmp_path)]
    assert main(["metrics", *options, "--format", "json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert (row["dynamic_leaves"], row["shifting"], row["padded"], row["aligned"]) == (0, 0, 1, 1)
    assert main(["metrics", *options]) == 0
    head, line = (text.split() for text in capsys.readouterr().out.splitlines())
    shown = dict(zip(head, line, strict=True))
    assert (shown["fixed"], shown["dynamic"], shown["min"], shown["shifting"]) == (
        "2", "0", "12", "0"
    )  # fmt: skip


@pytest.mark.parametrize(("wire", "least"), [("ros1", 5), ("cdr", 12)])
@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_the_wire_that_is_asked_for_is_the_one(tmp_path, capsys, wire, least, distro):
    make_files(tmp_path, FILES)
    options = ["--path", str(tmp_path), "--distro", distro, "--wire", wire, "--format", "json"]
    assert main(["metrics", "p/msg/A", *options]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert (row["wire"], row["min_bytes"]) == (wire, least)
