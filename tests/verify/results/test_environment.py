"""Results are continued only with the same code and inputs; digests of both."""

from __future__ import annotations

import os
from datetime import datetime, timedelta, timezone
from importlib.metadata import PackageNotFoundError

import pytest

import firm_hdl
from firm_hdl.verify.results import environment as module
from firm_hdl.verify.results.environment import code_digest, environment, inputs_digest
from tests.frontend.workspace import make_files

TEXTS = {"p/msg/A.msg": "int8 a\n", "p/msg/B.msg": "int8 b\n", "p/package.xml": "<package/>"}


def digest_of(folder, files=TEXTS):
    return inputs_digest([str(make_files(folder, files))])


def test_the_same_inputs_have_one_digest_wherever_they_are(tmp_path):
    assert digest_of(tmp_path / "a") == digest_of(tmp_path / "b")
    # What no definition is read from does not count.
    assert digest_of(tmp_path / "c", TEXTS | {"p/README.md": "x"}) == digest_of(tmp_path / "a")


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


def test_each_of_several_folders_counts(tmp_path):
    one, two = (make_files(tmp_path / name, TEXTS) for name in "ab")
    first = inputs_digest([str(one), str(two)])
    make_files(two, {"p/msg/B.msg": "int8 c\n"})
    assert inputs_digest([str(one), str(two)]) != first


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


def test_an_environment_has_versions_and_what_is_added():
    found = environment(executor="processes")
    assert found["executor"] == "processes" and found["amaranth"][0].isdigit()
    assert environment(Python="another")["Python"] == "another"
    assert {"started", "firm-hdl", "Python", "system", "processors"} <= found.keys()


def test_a_package_that_is_not_installed_is_left_out_alone(monkeypatch):
    def version(name):
        if name == "cyclonedds":
            raise PackageNotFoundError(name)
        return f"{name} 1"

    monkeypatch.setattr(module, "version", version)
    found = environment()
    assert "cyclonedds" not in found
    others = [name for name in module.PACKAGES if name != "cyclonedds"]
    assert others and {name: found[name] for name in others} == {
        name: f"{name} 1" for name in others
    }


def test_a_run_starts_at_a_time_of_utc(monkeypatch):
    class Clock(datetime):
        @classmethod
        def now(cls, tz=None):
            here = timezone(timedelta(hours=-7))
            return datetime(2026, 3, 4, 18, 5, tzinfo=here).astimezone(tz or here)

    monkeypatch.setattr(module, "datetime", Clock)
    assert environment()["started"] == "2026-03-05 01:05 UTC"


def test_each_file_of_folders_that_are_linked_in_circles_is_read_once(tmp_path, monkeypatch):
    folder = make_files(tmp_path, TEXTS)
    for name in ("one", "two"):
        (folder / "p" / name).symlink_to(folder)
    read = []
    monkeypatch.setattr(module, "_content", lambda path: read.append(path) or b"")
    walk, visited = os.walk, []

    def counted(*given, **more):
        for each in walk(*given, **more):
            visited.append(each[0])
            assert len(visited) < 50
            yield each

    monkeypatch.setattr(os, "walk", counted)
    inputs_digest([str(folder)])
    assert sorted(os.path.relpath(path, folder) for path in read) == sorted(TEXTS)


def test_the_order_in_which_the_system_lists_files_does_not_count(tmp_path, monkeypatch):
    files = {f"{package}/msg/{name}.msg": package for package in "pqr" for name in "AB"}
    first = digest_of(tmp_path, files)
    walk = os.walk

    def backwards(*given, **more):
        for folder, folders, names in walk(*given, **more):
            folders.sort(reverse=True)
            names.sort(reverse=True)
            yield folder, folders, names

    monkeypatch.setattr(os, "walk", backwards)
    assert inputs_digest([str(tmp_path)]) == first


def test_of_a_definition_that_is_too_large_to_read_the_size_counts(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "_MOST_BYTES", 7)
    whole, same, longer = (
        digest_of(tmp_path / name, {"p/msg/A.msg": text})
        for name, text in (("a", "int8 abc"), ("b", "int8 xyz"), ("c", "int8 abcd"))
    )
    assert whole == same != longer
    # What is just small enough is read.
    small, other = (
        digest_of(tmp_path / name, {"p/msg/A.msg": text})
        for name, text in (("d", "int8 ab"), ("e", "int8 xy"))
    )
    assert small != other
