"""Compiled programs that are kept: where, whose, and what is removed."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import time
from pathlib import Path

import pytest

from firm_hdl.jobs import caches
from firm_hdl.jobs.caches import cache_folder, kept_program, private_folder

DAY = 86_400
OLD = "simulation-" + 64 * "0"


@pytest.fixture
def kept(tmp_path):
    """Return a function that returns the same program; `kept.times` is how often it was made."""

    def make(scratch: Path) -> Path:
        kept.times += 1
        assert list(scratch.iterdir()) == []
        (scratch / "made").write_text("#!/bin/sh\necho mine\n")
        return scratch / "made"

    def kept(folder: Path | None = tmp_path / "cache", make=make) -> Path:
        return kept_program("simulation", ["a", "b"], make, folder)

    kept.times = 0
    return kept


def test_a_program_is_made_once_and_nobody_else_can_write_it(kept, tmp_path):
    program = kept()
    assert program == kept() and kept.times == 1
    assert subprocess.run([program], capture_output=True, check=True).stdout == b"mine\n"
    assert list(program.parent.iterdir()) == [program]
    for path in (program, tmp_path / "cache"):
        assert stat.S_IMODE(path.stat().st_mode) == 0o700
    # What was divided in another way is another program.
    another = shutil.copy(program, tmp_path)
    other = kept_program(
        "simulation", ["ab", ""], lambda scratch: Path(another), tmp_path / "cache"
    )
    assert other != program


def test_only_programs_that_were_not_used_for_long_are_removed(kept, tmp_path):
    folder = private_folder(tmp_path / "cache")
    names = {
        "thesis.tex": 10_000,
        "simulation-notes": 31,
        f"{OLD}.tex.bak": 31,
        f"simulation-{64 * '1'}": 29,
        OLD: 31,
        f"{OLD}.k3_x9q2a": 31,
    }
    for name, days in names.items():
        (folder / name).write_text(name)
        os.utime(folder / name, (time.time() - days * DAY,) * 2)
    (folder / f"simulation-{64 * '2'}").mkdir()
    os.utime(folder / f"simulation-{64 * '2'}", (0, 0))
    before = {each.name for each in folder.iterdir()}
    program = kept()
    left = {each.name for each in folder.iterdir()} - {program.name}
    assert before - left == {OLD, f"{OLD}.k3_x9q2a"}
    # A program that is used stays, however old it is.
    os.utime(program, (0, 0))
    kept()
    assert kept.times == 1 and program.stat().st_mtime > 0


def others_own(folder, monkeypatch):
    number = os.geteuid() + 1
    monkeypatch.setattr(os, "geteuid", lambda: number)


def is_link(folder, monkeypatch):
    folder.rename(folder.with_name("other"))
    folder.symlink_to("other")


def is_file(folder, monkeypatch):
    shutil.rmtree(folder)
    folder.write_text("")


REFUSED = {
    "everybody writes": (lambda folder, _: folder.chmod(0o777), "other users can write it"),
    "a group writes": (lambda folder, _: folder.chmod(0o770), "other users can write it"),
    "parent": (lambda folder, _: folder.parent.chmod(0o777), "other users can write it"),
    "link": (is_link, "it is a link"),
    "file": (is_file, "it is not a folder"),
    "owner": (others_own, "it belongs to another user"),
}


@pytest.mark.parametrize("change", REFUSED)
def test_a_folder_that_others_own_write_or_replace_is_refused(kept, tmp_path, monkeypatch, change):
    """A program that lies there is not run, and nothing is removed."""
    folder = tmp_path / "parent" / "cache"
    program = kept(folder)
    damage, reason = REFUSED[change]
    damage(folder, monkeypatch)
    with pytest.raises(OSError, match=reason):
        kept(folder)
    assert kept.times == 1 and (change == "file" or program.exists())


def test_a_folder_in_one_that_all_may_write_is_private_if_nobody_else_can_replace_it(tmp_path):
    tmp_path.chmod(0o1777)
    assert private_folder(tmp_path / "cache") == tmp_path / "cache"
    assert stat.S_IMODE((tmp_path / "cache").stat().st_mode) == 0o700


@pytest.mark.parametrize("kind", ["everybody writes", "link"])
def test_a_program_that_is_not_ours_is_made_again(kept, tmp_path, kind):
    program = kept()
    program.unlink()
    other = tmp_path / "other"
    other.write_text("#!/bin/sh\necho other\n")
    other.chmod(0o777)
    if kind == "link":
        program.symlink_to(other)
        other.chmod(0o700)
    else:
        other.rename(program)
    assert "mine" in kept().read_text() and kept.times == 2
    assert kind != "link" or "other" in other.read_text()


@pytest.fixture
def home(tmp_path, monkeypatch):
    caches._temporary_folder.cache_clear()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    (tmp_path / "home").mkdir()
    (tmp_path / "open").mkdir()
    (tmp_path / "open").chmod(0o777)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path / "home"


@pytest.mark.parametrize("variable", [None, "", "relative"])
def test_programs_are_kept_in_the_home_of_the_user(home, monkeypatch, variable):
    if variable is not None:
        monkeypatch.setenv("XDG_CACHE_HOME", variable)
    assert cache_folder() == home / ".cache" / "firm-hdl" / "programs"
    monkeypatch.setenv("XDG_CACHE_HOME", str(home / "a"))
    assert cache_folder() == home / "a" / "firm-hdl" / "programs"


@pytest.mark.parametrize(
    ("variables", "named"),
    [
        ({"HOME": "/dev/null"}, "/dev/null: there is no such folder"),
        ({"HOME": "nowhere"}, "nowhere: there is no such folder"),
        # A home is never made.
        ({"HOME": "{folder}/nowhere"}, "{folder}/nowhere: there is no such folder"),
        ({"HOME": ""}, "HOME: there is no such folder"),
        ({"XDG_CACHE_HOME": "/proc/nowhere"}, "/proc/nowhere: No such file or directory"),
        (
            {"XDG_CACHE_HOME": "{folder}/open"},
            "{folder}/open: other users can write it (see chmod go-w)",
        ),
    ],
)
def test_without_a_home_programs_are_kept_until_the_process_ends(
    kept, home, monkeypatch, caplog, variables, named
):
    for name, value in variables.items():
        monkeypatch.setenv(name, value.format(folder=home.parent))
    program = kept(None)
    assert program == kept(None) and kept.times == 1
    assert program.is_relative_to(home.parent / "temporary")
    (message,) = caplog.messages
    assert message.endswith(named.format(folder=home.parent))


@pytest.mark.parametrize("tool", ["wasmtime", "zig"])
def test_the_caches_of_tools_are_no_links(home, caplog, tool):
    private_folder(home / ".cache" / "firm-hdl" / "programs")
    link = home / ".cache" / "firm-hdl" / "programs" / tool
    link.symlink_to(home.parent / "open")
    assert cache_folder().is_relative_to(home.parent / "temporary")
    assert caplog.messages[0].endswith(f"{link}: it is a link")


def test_a_program_that_cannot_be_kept_is_returned_all_the_same(kept, home, caplog):
    def make(scratch: Path) -> Path:
        # Another program does it meanwhile; a full disk comes to the same.
        shutil.rmtree(home / ".cache")
        (scratch / "made").write_text("mine")
        return scratch / "made"

    assert kept(None, make).read_text() == "mine"
    assert str(home / ".cache" / "firm-hdl" / "programs") in caplog.messages[0]
