"""Results are continued only with the same code and inputs; digests of both."""

from __future__ import annotations

import os

import pytest

import firm_hdl
from firm_hdl.verify.results.file import code_digest, inputs_digest
from tests.frontend.workspace import make_files

TEXTS = {"p/msg/A.msg": "int8 a\n", "p/msg/B.msg": "int8 b\n", "p/package.xml": "<package/>"}


def digest_of(folder, files=TEXTS):
    return inputs_digest([str(make_files(folder, files))])


@pytest.mark.parametrize(
    "files",
    [
        TEXTS | {"p/msg/A.msg": "int8 c\n"},
        TEXTS | {"p/package.xml": "<package></package>"},
        TEXTS | {"p/msg/C.msg": ""},
        {name: text for name, text in TEXTS.items() if name != "p/msg/B.msg"},
        # The same texts in files of other names.
        {name.replace("A.msg", "0.msg"): text for name, text in TEXTS.items()},
        {name.replace("p/", "q/"): text for name, text in TEXTS.items()},
    ],
)
def test_every_change_of_an_input_changes_the_digest(files, tmp_path):
    assert digest_of(tmp_path / "a") != digest_of(tmp_path / "b", files)


@pytest.mark.parametrize(
    "name",
    ["msg/A.msg", "srv/A.srv", "action/A.action", "msg/A.idl", "package.xml", "A.lyrical.yaml"],
)
def test_the_text_of_every_kind_of_input_counts_and_not_its_time(name, tmp_path):
    path = make_files(tmp_path, {f"p/{name}": "one"}) / "p" / name
    first = inputs_digest([str(tmp_path)])
    os.utime(path, (1000, 1000))
    assert inputs_digest([str(tmp_path)]) == first
    # The new text is as long as the old one.
    path.write_text("two")
    os.utime(path, (1000, 1000))
    assert inputs_digest([str(tmp_path)]) != first


def test_a_recording_counts_by_its_size_and_its_time(tmp_path):
    bag = tmp_path / "run.bag"
    seen = []
    for text, time in (("abc", 1000), ("abcd", 1000), ("abcd", 1001), ("xyzw", 1001)):
        bag.write_text(text)
        os.utime(bag, (time, time))
        seen.append(inputs_digest([str(bag)]))
    # The content is not read.
    assert len(set(seen[:3])) == 3 and seen[3] == seen[2]
    bag.unlink()
    assert inputs_digest([str(bag)]) not in seen


def test_a_folder_of_a_recording_counts_with_all_of_its_files(tmp_path):
    """The data of a recording in a folder is beside ``metadata.yaml``, whatever its name is."""
    bag = make_files(tmp_path / "bag", {"metadata.yaml": "x", "data.db3": "abc"})
    first = inputs_digest([str(bag)])
    (bag / "data.db3").write_text("abcd")
    assert inputs_digest([str(bag)]) != first


def test_linked_folders_count_and_may_be_linked_in_a_circle(tmp_path):
    elsewhere = make_files(tmp_path / "elsewhere", TEXTS)
    folder = tmp_path / "src"
    folder.mkdir()
    (folder / "linked").symlink_to(elsewhere)
    (folder / "circle").symlink_to(folder)
    first = inputs_digest([str(folder)])
    make_files(elsewhere, {"p/msg/B.msg": "int8 c\n"})
    assert inputs_digest([str(folder)]) != first


CODE = {
    "a.py": "x = 1",
    "b/c.lark": "a: b",
    "b/d.cpp": ";",
    "b/d.h": ";",
    "e.j2": "{}",
    "f.vhd": "",
}


@pytest.mark.parametrize(
    "files",
    [
        *(CODE | {name: "other"} for name in CODE),
        {name.replace("a.py", "z.py"): text for name, text in CODE.items()},
        # The same name in another folder, and the end of one file at the start of the next.
        {name.replace("b/d.h", "d.h"): text for name, text in CODE.items()},
        {name: text for name, text in CODE.items() if name != "f.vhd"},
    ],
)
def test_every_change_of_the_code_changes_its_digest(tmp_path, monkeypatch, files):
    def digest(folder, files):
        main = make_files(folder, {"__init__.py": "", **files}) / "__init__.py"
        monkeypatch.setattr(firm_hdl, "__file__", str(main))
        return code_digest()

    first = digest(tmp_path / "a", CODE)
    assert digest(tmp_path / "b", CODE | {"notes.md": "no code"}) == first
    assert digest(tmp_path / "c", files) != first
