"""Replacing a folder while others read it or write to it, or while the build is killed."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

import firm_hdl
from firm_hdl.cli import main
from firm_hdl.export import folder as module
from firm_hdl.export.build import Built
from firm_hdl.export.exchange import exchange, locked
from tests.export import strikes
from tests.export.strikes import NEW, OLD, texts, with_manifest

ROOT = Path(firm_hdl.__file__).parent.parent


@pytest.fixture
def target(tmp_path):
    made = tmp_path / "out" / "type"
    module.replace(made, with_manifest(OLD))
    return made


@pytest.fixture
def has_exchange(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    if not exchange(tmp_path / "a", tmp_path / "b"):
        pytest.skip("this file system cannot exchange folders")


def strike(*arguments: str) -> dict[str, object]:
    done = subprocess.run(
        [sys.executable, "-m", "tests.export.strikes", *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=300,
        check=True,
    )
    found: dict[str, object] = json.loads(done.stdout)
    return found


@pytest.mark.usefixtures("has_exchange")
def test_a_build_killed_anywhere_leaves_a_whole_folder_and_all_that_is_a_users():
    found = strike("exchange")
    assert found["wrong"] == []
    assert found["strikes"] > 30


def test_without_an_exchange_the_next_build_puts_everything_back():
    found = strike("fallback")
    assert found["wrong"] == []
    assert found["strikes"] > 30


def test_the_crash_check_finds_lost_files(target):
    # Must-fail twin: a folder as a careless build would leave it.
    for name in ("notes", "a.v"):
        (target / name).unlink(missing_ok=True)
    found = [*strikes.problems(target, has_exchange=True)]
    assert "notes is lost" in found
    assert "a.v is not whole" in found
    assert [*strikes.problems(target.parent / "none", has_exchange=True)][-1] == (
        "there is no folder"
    )


@pytest.mark.usefixtures("has_exchange")
def test_a_reader_that_polls_always_sees_a_whole_manifest(target):
    misses, looks, done = 0, 0, threading.Event()
    manifests = {with_manifest(files)["manifest.json"] for files in (OLD, NEW)}

    def poll() -> None:
        nonlocal misses, looks
        while not done.is_set() or not looks:
            looks += 1
            try:
                misses += (target / "manifest.json").read_text() not in manifests
            except OSError:
                misses += 1

    reader = threading.Thread(target=poll)
    reader.start()
    try:
        for _ in range(30):
            module.replace(target, with_manifest(NEW))
            module.replace(target, with_manifest(OLD))
    finally:
        done.set()
        reader.join()
    assert (misses, looks > 0) == (0, True)


@pytest.mark.usefixtures("has_exchange")
def test_before_each_call_to_the_system_a_reader_sees_a_whole_manifest():
    found = strike("exchange", "look")
    assert found["misses"] == 0
    assert found["looks"] > 30


def test_a_reader_finds_the_gap_between_two_renames():
    # Must-fail twin: if folders cannot be exchanged, there is no folder for a moment.
    found = strike("fallback", "look")
    assert found["misses"] > 0


def test_scripts_can_be_run_and_other_files_cannot(tmp_path):
    texts = {"a.sh": "#!/bin/sh\nexit 7\n", "vhdl/run.sh": "#!/bin/sh\n", "vhdl/a.vhd": "--\n"}
    for _ in range(2):
        module.replace(tmp_path / "type", with_manifest(texts))
        modes = {name: os.access(tmp_path / "type" / name, os.X_OK) for name in texts}
        assert modes == {"a.sh": True, "vhdl/run.sh": True, "vhdl/a.vhd": False}
    assert subprocess.run([tmp_path / "type/a.sh"], timeout=60, check=False).returncode == 7


def test_folders_of_others_are_not_taken_for_leftovers(target):
    # Names of another program, or of an older build with the same process id.
    for name in (f".type.{os.getpid()}.new", f".type.{os.getpid()}.old", ".type.old", "type.new"):
        (target.parent / name).mkdir()
        (target.parent / name / "thesis.tex").write_text("ten years")
    before = {path.name for path in target.parent.iterdir()}
    module.replace(target, with_manifest(NEW))
    assert texts(target) == with_manifest(NEW)
    assert {path.name for path in target.parent.iterdir()} == before
    assert len([*target.parent.glob("*/thesis.tex")]) == len(before) - 1 == 4


def test_users_files_are_the_same_files_after_a_build(target):
    kept = target / "results.csv"
    kept.write_text("1\n")
    with kept.open("a") as log:
        module.replace(target, with_manifest(NEW))
        log.write("2\n")
    assert kept.read_text() == "1\n2\n"


def test_files_written_to_the_old_folder_meanwhile_are_moved(target, monkeypatch):
    original = module._swap

    def swap(folder: Path, *rest: object) -> None:
        (folder / "late.txt").write_text("late")
        (folder / "notes").unlink()
        (folder / "notes").write_text("changed")
        original(folder, *rest)

    (target / "notes").write_text("first")
    monkeypatch.setattr(module, "_swap", swap)
    module.replace(target, with_manifest(NEW))
    found = texts(target)
    assert found["late.txt"] == "late"
    assert {found["notes"], found["notes.kept"]} == {"first", "changed"}
    assert sorted(path.name for path in target.parent.iterdir()) == ["type"]


def test_renamed_files_are_reported(target):
    new = "mine.txt"
    (target / "notes").write_text("mine")
    for number in ("1", "2", "3"):
        (target / new).write_text(number)
        renamed = module.replace(target, with_manifest(NEW))
        assert list(renamed) == [new]
        assert (target / renamed[new]).read_text() == number
        assert (target / new).read_text() == NEW[new]
        # As if another version had not written the file.
        module.replace(target, with_manifest(OLD))
        assert not (target / new).exists()
    kept = {each.name: each.read_text() for each in target.glob(f"{new}.kept*")}
    assert kept == {f"{new}.kept": "1", f"{new}.kept2": "2", f"{new}.kept3": "3"}
    assert (target / "notes").read_text() == "mine"
    assert module.replace(target, with_manifest(OLD)) == {}


def test_the_command_prints_renamed_files(monkeypatch, capsys):
    def build(
        *arguments: object, report: Callable[[Built], None], **options: object
    ) -> list[Built]:
        renamed = {"mine.txt": "mine.txt.kept", "a": "a.kept"}
        made = Built(
            name="T", folder=Path("out"), was_current=False, description="", renamed=renamed
        )
        report(made)
        return [made]

    monkeypatch.setattr(sys.modules["firm_hdl.export.build"], "build", build)
    main(["build", "std_msgs/msg/Bool"])
    assert capsys.readouterr().out.splitlines()[1:3] == [
        "        your file a is now a.kept",
        "        your file mine.txt is now mine.txt.kept",
    ]


@pytest.mark.parametrize("kind", ["fifo", "link", "dangling", "socket_name", "read_only"])
def test_special_files_of_users_stay(target, kind):
    special = target / "odd"
    if kind == "fifo":
        os.mkfifo(special)
    elif kind == "link":
        special.symlink_to(target.parent)
    elif kind == "dangling":
        special.symlink_to("nowhere")
    elif kind == "read_only":
        special.mkdir()
        (special / "file").write_text("mine")
        special.chmod(0o555)
    else:
        special.mkdir()
    before = special.lstat().st_mode
    module.replace(target, with_manifest(NEW))
    assert special.lstat().st_mode == before
    assert sorted(path.name for path in target.parent.iterdir()) == ["type"]


def test_a_link_to_a_folder_stays_a_link(target):
    link = target.parent / "link"
    link.symlink_to(target)
    module.replace(link, with_manifest(NEW))
    assert link.is_symlink()
    assert texts(target) == with_manifest(NEW)


def test_a_manifest_deletes_nothing_outside_of_its_folder(target):
    (target.parent / "thesis").write_text("mine")
    made = json.loads((target / "manifest.json").read_text())
    made["files"] |= {"../thesis": "0", str(target.parent / "thesis"): "0"}
    (target / "manifest.json").write_text(json.dumps(made))
    module.replace(target, with_manifest(NEW))
    assert (target.parent / "thesis").read_text() == "mine"


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"\xff",
        b"[]",
        b'{"inputs_sha256": ""}',
        b'{"inputs_sha256": "", "inputs": [], "files": {}}',
        b'{"inputs_sha256": "", "inputs": {}, "files": []}',
        b"[" * 100_000,
        None,
    ],
)
def test_damaged_manifests_are_ignored(target, text):
    (target / "manifest.json").unlink()
    if text is None:
        os.mkfifo(target / "manifest.json")
    else:
        (target / "manifest.json").write_bytes(text)
    assert module.read_manifest(target) is None
    assert not module.is_current(target, {})


def test_a_file_that_became_a_fifo_is_not_waited_for(target):
    (target / "a.v").unlink()
    os.mkfifo(target / "a.v")
    assert not module.is_current(target, {})


def test_only_one_build_at_a_time_writes(target, monkeypatch):
    monkeypatch.setattr("firm_hdl.export.exchange.LOCK_SECONDS", 0.0)
    with locked(target.parent) as alone:
        assert alone
        with pytest.raises(OSError, match="another process has been writing there"):
            module.replace(target, with_manifest(NEW))
    assert texts(target) == with_manifest(OLD)
