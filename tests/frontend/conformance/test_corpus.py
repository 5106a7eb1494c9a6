"""Definitions of real ROS packages, if a corpus of them is available.

``FIRM_HDL_CORPUS`` names its folder: ``ros1/`` and ``ros2/`` with packages that ROS's own tools
read, ``invalid/`` with files that they refuse (``REASONS.tsv`` says why), the md5 sums that genmsg
computed, and pairs of input and output of rosidl_adapter.
"""

from __future__ import annotations

import csv
import re
from functools import cache

import pytest
from rosbags.typesys import TypesysError, get_types_from_msg

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from tests.depth import by_depth
from tests.frontend.reading import parse
from tests.frontend.structure import field_descriptions

DISTROS = {"ros1": "noetic", "ros2": "lyrical"}
KINDS = ("msg", "srv", "action")
# One file in so many is read.
STEP = by_depth(96, 1)


@cache
def library_of(dialect, corpus):
    """Return the library of a dialect, which several tests read the same types from."""
    return Library(DISTROS[dialect], [corpus / dialect])


def files(folder, *kinds):
    """Return package, kind, name and path of every definition in a folder of packages."""
    found = (path for kind in kinds or KINDS for path in folder.glob(f"*/{kind}/*"))
    return [(p.parts[-3], p.parts[-2], p.stem, p) for p in sorted(found)]


@pytest.mark.parametrize("dialect", DISTROS)
def test_every_file_resolves(corpus, dialect):
    library = library_of(dialect, corpus)
    wrong, messages = {}, 0
    found = files(corpus / dialect)[::STEP]
    for package, kind, name, _ in found:
        full = f"{package}/{kind}/{name}"
        try:
            messages += len(library.interface(full).messages)
        except DefinitionError as error:
            wrong[full] = [diagnostic.message for diagnostic in error.diagnostics]
    assert wrong == {}
    assert len(found) > 5600 // STEP and messages >= len(found)


def test_ros2_fields_are_those_that_rosbags_reads(corpus):
    library = library_of("ros2", corpus)
    unread = []
    for package, _, name, path in files(corpus / "ros2", "msg")[::STEP]:
        if path.suffix == ".idl":
            continue
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
    # rosbags refuses CRLF, and few other files.
    assert len(unread) < 10


@pytest.mark.parametrize("dialect", DISTROS)
def test_every_invalid_file_is_refused_for_its_reason(corpus, dialect):
    library = Library(DISTROS[dialect], [corpus / "invalid" / dialect, corpus / dialect])
    with (corpus / "invalid" / "REASONS.tsv").open(encoding="utf-8") as lines:
        rows = [r for r in csv.DictReader(lines, delimiter="\t") if r["ros"] == dialect[-1]]
    assert len(rows) == len(files(corpus / "invalid" / dialect)) > 10
    for row in rows:
        name, _, kind = row["file"].partition(".")
        with pytest.raises(DefinitionError) as error:
            library.interface(f"{row['package']}/{kind}/{name}")
        # The message must have the wrong name, in any wording.
        quoted = re.search(r"'(\w+)' is an invalid|^\w+/(\w+)$", row["reason"])
        blamed = (quoted[1] or quoted[2]) if quoted else ""
        # The named type may exist with errors; then its own errors are reported.
        if not any(other["file"] == f"{blamed}.msg" for other in rows):
            assert re.search(rf"\b{blamed}\b", str(error.value)), (row, str(error.value))
        assert all(d.span is not None for d in error.value.diagnostics)


def test_comments_are_those_that_rosidl_adapter_finds(corpus):
    folder = corpus / "rosidl_adapter_pairs" / "msg"
    text = (folder / "Test.msg").read_text(encoding="utf-8")
    idl = (folder / "Test.expected.idl").read_text(encoding="utf-8")
    syntax = parse(text, "ros2")
    ours = [syntax.comment] + [m.comment for m in syntax.members if m.comment]
    verbatim = re.findall(r'text=\s*((?:"(?:[^"\\]|\\.)*"\s*)+)\)', idl)
    parts = [re.findall(r'"((?:[^"\\]|\\.)*)"', block) for block in verbatim]
    assert ours == ["".join(block).replace("\\n", "\n") for block in parts]
    assert len(ours) == 4
