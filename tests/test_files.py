"""Input files: regular ones up to their limit are read. Output files are whole, old or new."""

from __future__ import annotations

import errno
import os
import resource
import socket
import stat
import subprocess
import sys
from types import SimpleNamespace

import pytest

from firm_hdl.files import check_file, read_file, write_file, write_new


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"12345")
    return path


@pytest.mark.parametrize("most", [5, 6, 1 << 20])
def test_a_file_up_to_its_limit_is_read(file, most):
    assert read_file(file, most) == b"12345"
    assert read_file(os.fspath(file), most) == b"12345"
    check_file(file, most)


def test_a_link_to_a_file_is_read(file, tmp_path):
    (tmp_path / "link").symlink_to(file)
    assert read_file(tmp_path / "link", 5) == b"12345"
    check_file(tmp_path / "link", 5)


def test_a_file_that_grows_meanwhile_is_measured_again(file, monkeypatch):
    # It was short enough when it was examined.
    monkeypatch.setattr("firm_hdl.files.check_file", lambda *given: None)
    with pytest.raises(OSError, match="it has 5 bytes, and at most 4 are read"):
        read_file(file, 4)


@pytest.mark.parametrize("most", [0, 4])
def test_a_file_beyond_its_limit_is_refused(file, most):
    for read in (read_file, check_file):
        with pytest.raises(OSError) as error:
            read(file, most)
        assert error.value.errno == errno.EFBIG
        assert error.value.strerror == f"it has 5 bytes, and at most {most} are read"
        assert error.value.filename == os.fspath(file)
    check_file(file)


def test_a_file_that_does_not_tell_its_size_is_measured_while_it_is_read():
    path = "/proc/self/status"
    if not os.path.exists(path) or os.stat(path).st_size:
        pytest.skip("no file here hides its size")
    assert read_file(path, 1 << 20).startswith(b"Name:")
    with pytest.raises(OSError) as error:
        read_file(path, 5)
    assert error.value.strerror == "it has more than 5 bytes, and at most 5 are read"


def test_paths_that_are_no_files_are_named(tmp_path):
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "folder").mkdir()
    with socket.socket(socket.AF_UNIX) as here:
        here.bind(os.path.relpath(tmp_path / "socket"))
        for path, what in (
            (tmp_path / "fifo", "a FIFO"),
            (tmp_path / "folder", "a folder"),
            (tmp_path / "socket", "a socket"),
            ("/dev/null", "a device"),
        ):
            for read in (read_file, check_file):
                with pytest.raises(OSError) as error:
                    read(path, 10)
                assert error.value.errno == errno.EINVAL
                assert error.value.strerror == f"it is {what}, not a regular file"
                assert error.value.filename == os.fspath(path)


@pytest.mark.parametrize(("mode", "what"), [(stat.S_IFBLK, "a device"), (0, "something else")])
def test_kinds_of_files_that_few_users_can_make_are_named(file, monkeypatch, mode, what):
    # Only root can make a block device.
    monkeypatch.setattr(os, "stat", lambda path: SimpleNamespace(st_mode=mode, st_size=0))
    with pytest.raises(OSError, match=f"it is {what}, not a regular file"):
        check_file(file)


def test_missing_paths_are_not_read(tmp_path):
    for read in (read_file, check_file):
        with pytest.raises(FileNotFoundError):
            read(tmp_path / "none", 10)


def test_a_file_that_becomes_a_fifo_meanwhile_is_not_waited_for(file, monkeypatch):
    # It was a regular file when it was examined.
    monkeypatch.setattr("firm_hdl.files.check_file", lambda *given: None)
    file.unlink()
    os.mkfifo(file)
    with pytest.raises(OSError, match="it is a FIFO"):
        read_file(file, 10)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_file_is_replaced_by_a_whole_one(file, tmp_path):
    file.chmod(0o640)
    with file.open() as old:
        write_file(file, "new\n\udcff")
        assert old.read() == "12345"
    assert file.read_bytes() == b"new\n\\udcff"
    assert stat.S_IMODE(file.stat().st_mode) == 0o640
    write_file(tmp_path / "a" / "b", "new")
    assert names(tmp_path) == ["a", "file"] and names(tmp_path / "a") == ["b"]


def test_without_room_a_file_stays_as_it_was(file, tmp_path):
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, limits[1]))
    try:
        for path in (file, tmp_path / "new"):
            with pytest.raises(OSError, match="File too large") as error:
                write_file(path, "x" * (2 << 20))
            assert error.value.filename == os.fspath(path)
        with pytest.raises(OSError, match="File too large"):
            write_new(tmp_path / "new", b"x" * (2 << 20))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert names(tmp_path) == ["file"] and file.read_bytes() == b"12345"


@pytest.mark.parametrize("target", ["file", "none"])
def test_a_link_stays_and_its_file_is_written(file, tmp_path, target):
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "link").symlink_to(f"../{target}")
    write_file(tmp_path / "folder" / "link", "new")
    assert (tmp_path / "folder" / "link").is_symlink() and names(tmp_path / "folder") == ["link"]
    assert (tmp_path / target).read_text() == "new"


def test_nothing_that_is_no_file_is_replaced(tmp_path):
    os.mkfifo(tmp_path / "fifo")
    with pytest.raises(OSError, match="nobody reads it"):
        write_file(tmp_path / "fifo", "new")
    reader = os.open(tmp_path / "fifo", os.O_RDONLY | os.O_NONBLOCK)
    write_file(tmp_path / "fifo", "new")
    assert os.read(reader, 9) == b"new"
    os.close(reader)
    assert stat.S_ISFIFO((tmp_path / "fifo").lstat().st_mode)
    write_file(os.devnull, "new")
    with pytest.raises(IsADirectoryError):
        write_file(tmp_path, "new")
    with pytest.raises(NotADirectoryError):
        write_file("/dev/null/file", "new")
    assert names(tmp_path) == ["fifo"]


def test_standard_output_is_written_in_order_be_it_a_file_or_a_pipe(tmp_path):
    code = (
        "from firm_hdl.files import write_file\n"
        "print('before')\nwrite_file('/dev/stdout', 'text\\n')\nprint('after')"
    )
    command = [sys.executable, "-c", code]
    with (tmp_path / "out").open("w") as out:
        subprocess.run(command, stdout=out, check=True, timeout=60)
    assert (tmp_path / "out").read_text() == "before\ntext\nafter\n"
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout == "before\ntext\nafter\n"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_file_without_rights_stays_as_it_was(file, tmp_path):
    file.chmod(0o444)
    with pytest.raises(PermissionError) as error:
        write_file(file, "new")
    assert error.value.filename == os.fspath(file)
    file.chmod(0o644)
    tmp_path.chmod(0o555)
    with pytest.raises(PermissionError):
        write_file(file, "new")
    tmp_path.chmod(0o755)
    assert file.read_bytes() == b"12345" and names(tmp_path) == ["file"]


def test_a_new_file_replaces_nothing(file, tmp_path):
    (tmp_path / "link").symlink_to("none")
    for path in (file, tmp_path / "link"):
        with pytest.raises(FileExistsError):
            write_new(path, b"new")
    assert names(tmp_path) == ["file", "link"] and file.read_bytes() == b"12345"
