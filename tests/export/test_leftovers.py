"""Folders left by a killed build: removed files, kept files, and the names of kept files."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import stat
from pathlib import Path

import pytest

from firm_hdl.export import folder as module
from tests.export.strikes import NEW, OLD, texts, with_manifest


@pytest.fixture
def target(tmp_path):
    made = tmp_path / "out" / "type"
    module.replace(made, with_manifest(OLD))
    return made


def leftover(target, files, what="old", number="0"):
    """Make a folder as a killed build leaves it."""
    made = target.with_name(f"{module._prefix(target)}{number * 16}.{what}")
    for name, text in files.items():
        (made / name).parent.mkdir(parents=True, exist_ok=True)
        (made / name).write_text(text)
    return made


def names_beside(target):
    return sorted(path.name for path in target.parent.iterdir())


@pytest.mark.parametrize("what", ["old", "new"])
def test_files_of_users_are_moved_and_generated_files_removed(target, what):
    left = leftover(target, {**with_manifest(NEW), "notes": "mine", "deep/er/x": "y"}, what)
    module.clear_up(target)
    assert not left.exists() and names_beside(target) == ["type"]
    assert texts(target) == {**with_manifest(OLD), "notes": "mine", "deep/er/x": "y"}


def test_no_existing_file_is_replaced_or_written_twice(target):
    (target / "same").write_text("same")
    (target / "other").write_text("here")
    (target / "renamed.kept").write_text("copied")
    (target / "renamed").write_text("ours")
    (target / "linked").write_text("linked")
    left = leftover(target, {**with_manifest(OLD), "same": "same", "other": "there"})
    # The file exists already, under its new name or under its own.
    (left / "renamed.kept").write_text("copied")
    os.link(target / "linked", left / "elsewhere")
    module.clear_up(target)
    assert not left.exists()
    found = texts(target)
    assert {name: text for name, text in found.items() if name not in with_manifest(OLD)} == {
        "same": "same",
        "other": "here",
        "other.kept": "there",
        "renamed": "ours",
        "renamed.kept": "copied",
        "linked": "linked",
    }


def test_files_written_while_a_folder_was_replaced_are_reported(target, monkeypatch):
    """An editor replaces a file of which a copy is already kept."""
    (target / "notes").write_text("first")
    swap = module._swap

    def saved_meanwhile(folder, staging, made):
        (folder / "notes").unlink()
        (folder / "notes").write_text("second")
        (folder / "more").write_text("more")
        swap(folder, staging, made)

    monkeypatch.setattr(module, "_swap", saved_meanwhile)
    assert module.replace(target, with_manifest(NEW)) == {"notes": "notes.kept"}
    found = texts(target)
    assert (found["notes"], found["notes.kept"], found["more"]) == ("first", "second", "more")
    monkeypatch.setattr(module, "_swap", swap)
    assert module.replace(target, with_manifest(NEW)) == {}


def test_a_copy_without_a_link_is_kept_once(target):
    # Without hard links, a copy has the name of the file, or the name with a suffix.
    (target / "a").write_text("text")
    left = leftover(target, {**with_manifest(OLD), "a.kept": "text", "b.kept": "text"})
    (target / "b").write_text("another")
    module.clear_up(target)
    assert not left.exists()
    found = texts(target)
    assert "a.kept" not in found
    assert found["b"] == "another" and found["b.kept"] == "text"


def test_a_file_where_a_folder_is_needed_makes_another_name(target):
    (target / "x").write_text("a file")
    leftover(target, {**with_manifest(OLD), "x/y/z": "deep"})
    module.clear_up(target)
    found = texts(target)
    assert found["x"] == "a file" and found["x_y_z"] == "deep"


def test_links_are_the_same_where_they_lead_to_the_same(target):
    left = leftover(target, with_manifest(OLD))
    for folder, name, to in (
        (target, "same", "nowhere"),
        (left, "same", "nowhere"),
        (target, "other", "here"),
        (left, "other", "there"),
        (target, "kind", "x"),
    ):
        (folder / name).symlink_to(to)
    (left / "kind").write_text("x")
    module.clear_up(target)
    assert not left.exists()
    found = {path.name: path for path in target.iterdir()}
    assert "same.kept" not in found
    assert os.readlink(found["other"]) == "here" and os.readlink(found["other.kept"]) == "there"
    assert found["kind"].is_symlink() and found["kind.kept"].read_text() == "x"


def test_a_folder_without_a_manifest_belongs_to_the_user(target):
    left = leftover(target, {"a.v": "mine", "gone.txt": "old gone.txt\n"})
    module.clear_up(target)
    assert not left.exists()
    found = texts(target)
    assert found["a.v"] == OLD["a.v"] and found["a.v.kept"] == "mine"
    assert "gone.txt.kept" not in found


def test_an_old_folder_is_put_back_where_there_is_none(target):
    made = {**with_manifest(OLD), "notes": "mine"}
    left = leftover(target, made)
    leftover(target, with_manifest(NEW), "new", "1")
    for path in sorted(target.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    target.rmdir()
    module.clear_up(target)
    assert not left.exists() and names_beside(target) == ["type"]
    assert texts(target) == made


@pytest.mark.parametrize(
    ("files", "what"),
    [(with_manifest(NEW), "new"), ({"notes": "mine"}, "old"), ({"notes": "mine"}, "new")],
)
def test_no_other_leftover_is_put_in_its_place(tmp_path, files, what):
    target = tmp_path / "type"
    left = leftover(target, files, what)
    module.clear_up(target)
    assert not target.exists()
    # Files of users stay in place, because there is no folder to move them to.
    assert left.exists() == ("notes" in files)


def test_a_leftover_lists_its_files_while_it_has_files_of_users(tmp_path):
    """There is no folder to move them to, and only part of the generated files was deleted."""
    target = tmp_path / "type"
    left = leftover(target, {**with_manifest(NEW), "notes": "mine"}, "new")
    module.clear_up(target)
    assert texts(left) == {"notes": "mine", "manifest.json": with_manifest(NEW)["manifest.json"]}
    # The next build moves them.
    module.replace(target, with_manifest(OLD))
    assert not left.exists() and texts(target) == {**with_manifest(OLD), "notes": "mine"}


def test_leftovers_of_other_folders_are_let_alone(target):
    other = target.with_name("other")
    left = leftover(other, with_manifest(OLD))
    odd = leftover(target, {"x": "y"}, "odd")
    (target.parent / "thing.old").mkdir()
    module.clear_up(target)
    assert left.is_dir() and odd.is_dir() and (target.parent / "thing.old").is_dir()


def test_read_only_files_are_removed(target):
    left = leftover(target, {**with_manifest(NEW), "deep/mine": "x"})
    (left / "vhdl").chmod(0o500)
    (left / "deep").chmod(0o500)
    left.chmod(0o500)
    module.clear_up(target)
    assert not left.exists()
    assert (target / "deep" / "mine").read_text() == "x"


def test_folders_of_users_keep_their_rights_and_times(target):
    mine = target / "mine"
    (mine / "empty").mkdir(parents=True)
    mine.chmod(0o750)
    os.utime(mine, (1_000_000_000, 1_000_000_000))
    (target / "run.sh").write_text("mine")
    (target / "run.sh").chmod(0o640)
    module.replace(target, with_manifest(NEW))
    assert stat.S_IMODE(mine.stat().st_mode) == 0o750
    assert mine.stat().st_mtime == 1_000_000_000
    assert (mine / "empty").is_dir()
    assert stat.S_IMODE((target / "run.sh").stat().st_mode) == 0o640
    assert (target / "vhdl" / "c.sh").stat().st_mode & 0o111 == 0o111
    assert (target / "a.v").stat().st_mode & 0o111 == 0


def test_files_of_users_make_room_for_new_files_and_folders(target):
    (target / "vhdl" / "c.sh").mkdir()
    (target / "vhdl" / "c.sh" / "x").write_text("in a folder")
    (target / "mine.txt").write_text("a file")
    (target / "sim").write_text("no folder")
    # A name with the suffix is a user's, too.
    (target / "sim.kept").write_text("before")
    renamed = module.replace(target, with_manifest({**NEW, "sim/a": "b"}))
    assert renamed == {
        "mine.txt": "mine.txt.kept",
        "sim": "sim.kept2",
        "vhdl/c.sh/x": "vhdl/c.sh.kept/x",
    }
    assert {old: (target / new).read_text() for old, new in renamed.items()} == {
        "mine.txt": "a file",
        "sim": "no folder",
        "vhdl/c.sh/x": "in a folder",
    }


def test_without_links_files_are_copied(target, monkeypatch):
    def link(*arguments: object, **options: object) -> None:
        raise PermissionError("no links here")

    monkeypatch.setattr(os, "link", link)
    (target / "notes").write_text("mine")
    (target / "notes").chmod(0o640)
    os.utime(target / "notes", (1_000_000_000, 1_000_000_000))
    (target / "mine.txt").write_text("first")
    (target / "to").symlink_to("nowhere")
    assert module.replace(target, with_manifest(NEW)) == {"mine.txt": "mine.txt.kept"}
    found = texts(target)
    assert found["notes"] == "mine" and found["mine.txt.kept"] == "first"
    assert found["mine.txt"] == NEW["mine.txt"] and "notes.kept" not in found
    status = (target / "notes").stat()
    assert (stat.S_IMODE(status.st_mode), status.st_mtime) == (0o640, 1_000_000_000)
    assert os.readlink(target / "to") == "nowhere"
    assert names_beside(target) == ["type"]


def test_a_folder_is_current_while_each_file_is_as_it_was_written(tmp_path):
    files = {"a": "1", "b/c": "2"}
    inputs = {"type": "x", "bus": 8}
    digests = {name: hashlib.sha256(text.encode()).hexdigest() for name, text in files.items()}
    manifest = {"inputs_sha256": "0", "inputs": inputs, "files": digests}
    made = tmp_path / "type"
    module.replace(made, {**files, "manifest.json": json.dumps(manifest)})
    assert module.is_current(made, inputs)
    (made / "mine").write_text("x")
    assert module.is_current(made, inputs)
    assert not module.is_current(made, {**inputs, "bus": 4})
    assert not module.is_current(made, {"type": "x"})
    for name, text in files.items():
        (made / name).write_text("3")
        assert not module.is_current(made, inputs)
        (made / name).write_text(text)
        assert module.is_current(made, inputs)
    (made / "b" / "c").unlink()
    assert not module.is_current(made, inputs)


def test_empty_folders(tmp_path):
    assert module.is_empty(tmp_path)
    assert not module.is_empty(tmp_path / "none")
    (tmp_path / "x").write_text("")
    assert not module.is_empty(tmp_path) and not module.is_empty(Path(tmp_path / "x"))


def test_an_old_folder_is_put_back_before_files_of_users_are_moved_into_it(target):
    # Names of leftovers are random: that of the new folder may come first.
    leftover(target, {**with_manifest(NEW), "notes": "mine"}, "new", "0")
    leftover(target, {**with_manifest(OLD), "more": "too"}, "old", "f")
    shutil.rmtree(target)
    module.clear_up(target)
    assert names_beside(target) == ["type"]
    assert texts(target) == {**with_manifest(OLD), "notes": "mine", "more": "too"}
