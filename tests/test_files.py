"""Input files: regular ones up to their limit are read, and no others."""

from __future__ import annotations

import errno
import os
import socket
import stat
from types import SimpleNamespace

import pytest

from firm_hdl.files import check_file, read_file


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
