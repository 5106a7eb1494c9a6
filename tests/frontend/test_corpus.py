"""Definitions of real ROS packages, where a corpus of them is at hand.

``FIRM_HDL_CORPUS`` names its folder: ``ros1/`` and ``ros2/`` with packages that ROS's own tools
read, ``invalid/`` with files that they refuse (``REASONS.tsv`` says why), the md5 sums that genmsg
computed, and pairs of input and output of rosidl_adapter.
"""

from __future__ import annotations

import csv
import hashlib
import os
import re
import time
from pathlib import Path

import pytest
from rosbags.typesys import get_types_from_msg
from rosbags.typesys.msg import TypesysError

from firm_hdl.errors import DefinitionError, Source
from firm_hdl.frontend import Library
from firm_hdl.frontend.parse import parse_message

from .structure import field_descriptions

DISTROS = {"ros1": "noetic", "ros2": "lyrical"}


@pytest.fixture(scope="module")
def corpus():
    folder = os.environ.get("FIRM_HDL_CORPUS")
    if folder:
        return Path(folder)
    if os.environ.get("CI"):
        pytest.fail("FIRM_HDL_CORPUS is not set, and CI must not skip this")
    pytest.skip("FIRM_HDL_CORPUS is not set")


def files(folder):
    """Package, name and path of every ``.msg`` file of a folder of packages."""
    return [(p.parts[-3], p.stem, p) for p in sorted(folder.glob("*/msg/*.msg"))]


@pytest.mark.parametrize("dialect", DISTROS)
def test_every_file_resolves_and_in_time(corpus, dialect):
    start = time.perf_counter()
    library = Library(DISTROS[dialect], [corpus / dialect])
    wrong = {}
    found = files(corpus / dialect)
    for package, name, _ in found:
        try:
            library.message(f"{package}/{name}")
        except DefinitionError as error:
            wrong[package, name] = str(error)
    assert wrong == {}
    assert len(found) > 4000
    # 5 s on the machine of 2025 that this was written on.
    assert time.perf_counter() - start < 60


def test_ros1_md5_sums_are_those_of_genmsg(corpus):
    library = Library("noetic", [corpus / "ros1"])
    with (corpus / "ros1_md5.tsv").open(encoding="utf-8") as lines:
        want = {row[0]: row[1] for row in list(csv.reader(lines, delimiter="\t"))[1:]}
    sums = {}

    def md5(message):
        if message.name not in sums:
            lines = [f"{c.type} {c.name}={c.text}" for c in message.constants]
            children = {child.name: child for child in message.children if child.package}
            for item in message.fields:
                kind = getattr(item.type, "element", item.type)
                if str(kind) in children:
                    lines.append(f"{md5(kind)} {item.name}")
                else:
                    lines.append(f"{item.type} {item.name}")
            sums[message.name] = hashlib.md5("\n".join(lines).encode()).hexdigest()
        return sums[message.name]

    ours = {f"{p}/{n}": md5(library.message(f"{p}/{n}")) for p, n, _ in files(corpus / "ros1")}
    assert {name: digest for name, digest in ours.items() if want[name] != digest} == {}


def test_ros2_fields_are_those_that_rosbags_reads(corpus):
    library = Library("lyrical", [corpus / "ros2"])
    unread = []
    for package, name, path in files(corpus / "ros2"):
        full = f"{package}/msg/{name}"
        text = path.read_bytes().decode()
        if "wstring" in text:
            continue  # rosbags does not know the word.
        try:
            theirs = get_types_from_msg(text, full)
        except TypesysError:
            unread.append(full)
            continue
        constants, fields = theirs[full]
        message = library.message(full)
        assert field_descriptions(message) == list(fields), full
        assert [c.name for c in message.constants] == [c[0] for c in constants], full
    # It refuses CRLF, and little else.
    assert len(unread) < 10


@pytest.mark.parametrize("dialect", DISTROS)
def test_every_invalid_file_is_refused_for_its_reason(corpus, dialect):
    library = Library(DISTROS[dialect], [corpus / "invalid" / dialect, corpus / dialect])
    with (corpus / "invalid" / "REASONS.tsv").open(encoding="utf-8") as lines:
        rows = [r for r in csv.DictReader(lines, delimiter="\t") if r["ros"] == dialect[-1]]
    cases = [row for row in rows if row["file"].endswith(".msg")]
    assert len(cases) == len(files(corpus / "invalid" / dialect)) > 5
    for row in cases:
        with pytest.raises(DefinitionError) as error:
            library.message(f"{row['package']}/{row['file'].removesuffix('.msg')}")
        # The name that is to blame, in whatever words.
        quoted = re.search(r"'(\w+)' is an invalid|^\w+/(\w+)$", row["reason"])
        blamed = (quoted[1] or quoted[2]) if quoted else ""
        # What is to blame may be there, but refused itself, and then that is what is reported.
        if not any(row["file"] == f"{blamed}.msg" for row in cases):
            assert re.search(rf"\b{blamed}\b", str(error.value)), (row, str(error.value))
        assert all(d.span is not None for d in error.value.diagnostics)


def test_comments_are_those_that_rosidl_adapter_finds(corpus):
    folder = corpus / "rosidl_adapter_pairs" / "msg"
    text = (folder / "Test.msg").read_text(encoding="utf-8")
    idl = (folder / "Test.expected.idl").read_text(encoding="utf-8")
    syntax = parse_message(Source(name="Test.msg", text=text), "ros2")
    ours = [syntax.comment] + [m.comment for m in syntax.members if m.comment]
    verbatim = re.findall(r'text=\s*((?:"(?:[^"\\]|\\.)*"\s*)+)\)', idl)
    parts = [re.findall(r'"((?:[^"\\]|\\.)*)"', block) for block in verbatim]
    assert ours == ["".join(block).replace("\\n", "\n") for block in parts]
    assert len(ours) == 4
