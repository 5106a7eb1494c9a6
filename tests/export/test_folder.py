"""Folders of generated files: what is the user's stays, and a folder is complete or says so."""

from __future__ import annotations

import fcntl
import json
import os
import resource
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import firm_hdl
from firm_hdl.export import folder as module
from firm_hdl.export.backend import BuildError
from firm_hdl.export.folder import build_folder, check_folder, read_manifest
from firm_hdl.export.manifest import digest
from tests.depth import by_depth
from tests.export.strikes import VERSIONS, build, manifest, texts, tree, write

ROOT = Path(firm_hdl.__file__).parent.parent


@pytest.fixture
def folder(tmp_path):
    made = tmp_path / "out" / "T"
    build(made, 0)
    return made


def run(*words: str) -> str:
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def state(root: Path) -> dict[Path, tuple[int, ...]]:
    found = {path: path.lstat() for path in (root, *root.rglob("*"))}
    return {path: (each.st_ino, each.st_mode, each.st_mtime_ns) for path, each in found.items()}


def test_no_kill_and_no_other_build_costs_a_users_file_or_leaves_half_a_folder():
    assert json.loads(run(sys.executable, "-m", "tests.export.strikes", by_depth("6", "200"))) == []


def test_a_folder_is_current_while_its_inputs_and_files_are_the_same(folder):
    assert write(folder, texts(0), version=0) is None
    (folder / "mine").write_text("x")
    assert write(folder, texts(0), version=0) is None
    assert write(folder, texts(0), version=0, more=1) == ()
    (folder / "plan.yaml").unlink()
    assert write(folder, texts(0), version=0, more=1) == ()
    assert tree(folder).keys() == {*VERSIONS[0], "manifest.json", "mine"}


def test_files_are_replaced_in_place(folder):
    """A shell, an editor or a simulator in the folder goes on, and so does a written log."""
    before = {path: path.stat().st_ino for path in (folder, folder / "vhdl", folder / "plan.yaml")}
    inside = os.open(folder / "vhdl", os.O_RDONLY)
    with (folder / "log.txt").open("w") as log:
        build(folder, 1)
        log.write("written")
    assert "run_ghdl.sh" in os.listdir(inside)
    os.close(inside)
    assert before == {path: path.stat().st_ino for path in before}
    assert tree(folder).keys() == {*VERSIONS[1], "manifest.json", "log.txt"}
    assert tree(folder)["log.txt"] == "written"
    # The last outdated file of a subfolder takes it along.
    assert not (folder / "systemverilog").exists()
    assert [os.access(folder / name, os.X_OK) for name in ("vhdl/run_ghdl.sh", "plan.yaml")] == [
        True,
        False,
    ]


@pytest.mark.parametrize(
    "name", ["plan.yaml", "vhdl/T.vhd", "waivers.vlt", "vhdl", "vhdl/run_ghdl.sh"]
)
@pytest.mark.parametrize("what", ["file", "link", "same", "dangling", "folder", "fifo"])
def test_what_is_in_the_way_is_named_and_nothing_changes(folder, tmp_path, name, what):
    place, right = folder / name, tmp_path / "right"
    build(right, 1)
    shutil.rmtree(place) if place.is_dir() else place.unlink(missing_ok=True)
    if what == "file":
        place.write_text("changed")
    elif what == "folder":
        place.mkdir()
        if name == "vhdl":
            name = "vhdl/T.vhd"
            (folder / name).mkdir()
    elif what == "fifo":
        os.mkfifo(place)
    else:
        # A link is in the way even if the right file, or a right folder, is behind it.
        (tmp_path / "other").write_text("mine")
        targets = {"link": tmp_path / "other", "same": right / name, "dangling": "nowhere"}
        place.symlink_to(targets[what])
    before = state(tmp_path)
    for force in (False, True):
        with pytest.raises(BuildError, match=f"has files of yours, .*delete them: {name}$"):
            build_folder(
                folder.parent, folder, {}, lambda: (texts(1), manifest(texts(1))), force=force
            )
    assert state(tmp_path) == before


def test_outdated_files_that_the_user_changed_stay_and_are_named(folder, tmp_path):
    (tmp_path / "mine").write_text("mine")
    (folder / "vhdl" / "T_old.vhd").write_text("mine")
    (folder / "systemverilog" / "T_sv.sv").unlink()
    (folder / "systemverilog" / "T_sv.sv").symlink_to(tmp_path / "mine")
    kept = ("systemverilog/T_sv.sv", "vhdl/T_old.vhd")
    assert write(folder, texts(1)) == kept
    assert [(folder / name).read_text() for name in kept] == ["mine", "mine"]
    assert write(folder, texts(1), more=1) == ()


def test_a_folder_of_others_is_refused(tmp_path):
    for name, make in (
        ("full", lambda path: (path.mkdir(), (path / "thesis.tex").write_text("mine"))),
        ("file", lambda path: path.write_text("mine")),
        ("fifo", os.mkfifo),
    ):
        make(tmp_path / name)
        before = state(tmp_path / name)
        for refused in (check_folder, lambda out, folder: build(folder, 0)):
            with pytest.raises(BuildError, match=rf"{name}' (is not a folder that|cannot be wr)"):
                refused(tmp_path, tmp_path / name)
        assert state(tmp_path / name) == before
    (tmp_path / "empty").mkdir()
    # A build was killed before it wrote the manifest.
    (tmp_path / "empty" / f".firm-hdl-{'0' * 16}.tmp").write_text("half")
    assert (
        check_folder(tmp_path, tmp_path / "empty") == check_folder(tmp_path, tmp_path / "no") == {}
    )
    build(tmp_path / "empty", 0)


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"\xff",
        b"[]",
        b'{"inputs_sha256": ""}',
        b'{"inputs_sha256": "", "inputs": [], "files": {}}',
        b'{"inputs_sha256": "", "inputs": {}, "files": []}',
        b'{"inputs_sha256": "", "inputs": {}, "files": {"plan.yaml": []}}',
        b'{"inputs_sha256": "", "inputs": {}, "files": {}, "unfinished": {"plan.yaml": {}}}',
        b'{"inputs_sha256": "", "inputs": {}, "files": {}, "unfinished": null}',
        b"[" * 100_000,
        b"9" * 100_000,
        "link",
        "fifo",
        "huge",
    ],
)
def test_a_folder_with_a_manifest_that_is_none_is_the_users(folder, tmp_path, text):
    place = folder / "manifest.json"
    place.rename(tmp_path / "manifest.json")
    if text == "link":
        place.symlink_to(tmp_path / "manifest.json")
    elif text == "fifo":
        os.mkfifo(place)
    elif text == "huge":
        place.touch()
        os.truncate(place, 1 << 40)
    else:
        place.write_bytes(text)
    assert read_manifest(folder) is None
    with pytest.raises(BuildError, match="is not a folder that firm-hdl made; move it away"):
        build(folder, 0)


def test_a_manifest_of_others_deletes_only_what_firm_hdl_could_have_written(folder):
    """Each of these files has the sum that the manifest says."""
    outside = folder.parent / "thesis.tex"
    outside.write_text("mine")
    names = ["thesis.tex", "vhdl/thesis.tex", "notes.txt", "vhdl/mine.vhd", "src/T.v", "a/b/T.v"]
    names += ["T.v/x", "T.c", ".T.v", "vhdl/.git", "xT.v"]
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("mine")
    (folder / "loop").symlink_to(folder.parent)
    names += ["../thesis.tex", str(outside), "vhdl/../../thesis.tex", "loop/thesis.tex"]
    names += ["vhdl//T.vhd", "./plan.yaml", "..", ".", "", "/", "T\0.v", "T\ud800.v", "T" * 300]
    # Such a name would keep the pattern of our names busy for hours.
    names += [f"a_cdr_{'1' * 500_000}!"]
    made = json.loads((folder / "manifest.json").read_text())
    made["files"] |= dict.fromkeys(names, digest("mine"))
    (folder / "manifest.json").write_text(json.dumps(made))
    before = {name: text for name, text in tree(folder.parent).items() if text == "mine"}
    assert write(folder, texts(0), version=0) == ()
    assert {name: text for name, text in tree(folder.parent).items() if text == "mine"} == before
    assert len(before) == 12


def test_links_are_followed_only_where_the_user_named_them(tmp_path):
    (tmp_path / "disk").mkdir()
    (tmp_path / "out").symlink_to("disk")
    (tmp_path / "later").symlink_to("disk/made")
    for out in ("out", "later"):
        build(tmp_path / out / "T", 0)
        assert (tmp_path / out).is_symlink()
    assert (tmp_path / "disk" / "made" / "T" / "plan.yaml").exists()
    (tmp_path / "out" / "L").symlink_to("T")
    (tmp_path / "out" / "lyrical").symlink_to("made")
    before = tree(tmp_path)
    for folder in (Path("L"), Path("lyrical", "T")):
        for what in (
            check_folder,
            lambda *given: build_folder(*given, {}, lambda: ({}, {"files": {}})),
        ):
            with pytest.raises(
                BuildError, match=f"written: a link, .* folder .'{folder.parts[0]}'"
            ):
                what(tmp_path / "out", tmp_path / "out" / folder)
    assert tree(tmp_path) == before


def test_mounts_in_a_folder_are_not_entered(folder, tmp_path):
    """Bind mounts have the same device; nothing is lost if it has the files of the folder, too."""
    script = """
        mount --bind {other} {folder}/vhdl
        mount --bind {other}/../plan.yaml {folder}/plan.yaml
        mount -t tmpfs none {folder}/systemverilog
        mkdir {folder}/../whole
        mount --bind {other} {folder}/../whole
        exec {python} -c "
        from pathlib import Path
        from tests.export.strikes import build, write
        for files in {{'vhdl/T.vhd': ''}}, {{'plan.yaml': ''}}, {{'systemverilog/T_sv.sv': ''}}:
            try:
                write(Path('{folder}'), files)
            except Exception as error:
                print(str(error).rpartition(' ')[2])
        print(write(Path('{folder}'), {{}}))
        try:
            build(Path('{folder}').with_name('whole'), 0)
        except Exception as error:
            print(error)
        "
    """
    other = tmp_path / "other"
    shutil.copytree(folder / "vhdl", other)
    shutil.copy(folder / "plan.yaml", tmp_path)
    text = textwrap.dedent(script).format(folder=folder, other=other, python=sys.executable)
    unshare = shutil.which("unshare")
    if unshare is None or subprocess.run([unshare, "-rm", "true"], check=False).returncode:
        pytest.skip("nothing can be mounted here")
    *named, kept, whole = run(unshare, "-rm", "sh", "-ec", text).splitlines()
    assert named == ["vhdl", "plan.yaml", "systemverilog"]
    assert kept == "('plan.yaml', 'systemverilog', 'vhdl')"
    assert whole.endswith("cannot be written: something of yours is in the way ('whole')")
    assert tree(other) == {"T.vhd": texts(0)["vhdl/T.vhd"], "T_old.vhd": texts(0)["vhdl/T_old.vhd"]}


def test_temporary_files_of_killed_builds_go_and_nothing_else_of_such_a_name(folder):
    hexadecimal = "0123456789abcdef"
    left = folder / f".firm-hdl-{hexadecimal}.tmp"
    left.write_text("half")
    others = [folder / f".firm-hdl-{hexadecimal[::-1]}.tmp", folder / ".firm-hdl-x.tmp"]
    others[0].symlink_to(folder / "plan.yaml")
    others[1].write_text("mine")
    others += [folder / f".firm-hdl-{'0' * 16}.tmp", folder / "vhdl" / left.name]
    others[2].mkdir()
    others[3].write_text("mine")
    others += [folder.parent / left.name]
    others[4].write_text("mine")
    # The folder is current.
    assert write(folder, texts(0), version=0) is None
    assert not left.exists() and all(os.path.lexists(each) for each in others)


def test_without_room_nothing_changes(folder, tmp_path):
    before = tree(folder)
    with pytest.raises(BuildError, match="T' cannot be written: File too large"):
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, limits[1]))
        try:
            write(folder, {**texts(1), "vhdl/T_large.vhd": "x" * (2 << 20)}, version=1)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert tree(folder) == before
    assert write(folder, texts(0), version=0) is None


@pytest.mark.parametrize("name", ["T" * 300 + ".v", "T" * 300 + "/a.v"])
def test_a_name_that_is_too_long_changes_nothing(folder, name):
    before = tree(folder)
    with pytest.raises(BuildError, match="T' cannot be written: File name too long"):
        write(folder, {**texts(1), name: ""})
    assert tree(folder) == before


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
@pytest.mark.parametrize("place", [".", "vhdl"])
def test_a_folder_without_rights_is_one_error_and_read_only_files_are_none(folder, place):
    before = tree(folder)
    for path in folder.rglob("*.vhd"):
        path.chmod(0o444)
    (folder / place).chmod(0o555)
    with pytest.raises(BuildError, match="T' cannot be written: "):
        build(folder, 1)
    assert tree(folder) == before
    (folder / place).chmod(0o755)
    build(folder, 1)


def test_only_one_build_at_a_time_writes(folder, monkeypatch):
    monkeypatch.setattr(module, "LOCK_SECONDS", 0.0)
    before = tree(folder)
    number = os.open(folder, os.O_RDONLY)
    fcntl.flock(number, fcntl.LOCK_EX)
    with pytest.raises(BuildError, match="another process has been writing there for a minute"):
        build(folder, 1)
    os.close(number)
    assert tree(folder) == before


def test_a_file_that_has_the_right_text_already_is_not_in_the_way(folder):
    for name in texts(1).keys() - texts(0).keys():
        (folder / name).write_text(texts(1)[name])
    build(folder, 1)
    assert tree(folder).keys() == {*VERSIONS[1], "manifest.json"}
