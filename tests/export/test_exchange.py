"""The exchange of two folders and the lock on a folder, where a system has them or not."""

from __future__ import annotations

import ctypes
import errno
import fcntl
import os
import threading

import pytest

from firm_hdl.export import exchange as module
from firm_hdl.export import folder as folders
from firm_hdl.export.exchange import exchange, locked
from tests.export.strikes import NEW, OLD, texts, with_manifest
from tests.export.test_leftovers import leftover


@pytest.mark.parametrize(
    ("code", "exchanges"),
    [
        (0, True),
        (errno.ENOSYS, False),
        (errno.EINVAL, False),
        (errno.EPERM, False),
        (errno.ENOTSUP, False),
    ],
)
def test_a_system_says_whether_it_exchanges(tmp_path, monkeypatch, code, exchanges):
    class Library:
        def __init__(self, *arguments: object, **options: object) -> None: ...

        @staticmethod
        def renameat2(*arguments: object) -> int:
            # AT_FDCWD, the paths, and RENAME_EXCHANGE of Linux.
            assert arguments == (-100, b"/one", -100, b"/two", 2)
            return -1 if code else 0

    monkeypatch.setattr(ctypes, "CDLL", Library)
    monkeypatch.setattr(ctypes, "get_errno", lambda: code)
    monkeypatch.setattr(module.sys, "platform", "linux")
    assert exchange("/one", "/two") is exchanges


def test_a_failed_exchange_is_an_error_that_names_the_folder(tmp_path, monkeypatch):
    class Library:
        def __init__(self, *arguments: object, **options: object) -> None: ...

        @staticmethod
        def renameat2(*arguments: object) -> int:
            return -1

    monkeypatch.setattr(ctypes, "CDLL", Library)
    monkeypatch.setattr(ctypes, "get_errno", lambda: errno.ENOSPC)
    monkeypatch.setattr(module.sys, "platform", "linux")
    with pytest.raises(OSError, match="/two") as caught:
        exchange("/one", "/two")
    assert (caught.value.errno, caught.value.filename) == (errno.ENOSPC, "/two")


def test_systems_without_the_call_exchange_nothing(monkeypatch):
    monkeypatch.setattr(ctypes, "CDLL", lambda *arguments, **options: object())
    assert exchange("/one", "/two") is False
    monkeypatch.setattr(module.sys, "platform", "darwin")
    monkeypatch.setattr(ctypes, "CDLL", None)
    assert exchange("/one", "/two") is False


def test_a_build_waits_until_the_folder_is_free(tmp_path):
    order = []
    held = threading.Event()

    def hold() -> None:
        with locked(tmp_path):
            held.set()
            done.wait(0.1)
            order.append("first")

    done = threading.Event()
    other = threading.Thread(target=hold)
    other.start()
    held.wait()
    with locked(tmp_path) as alone:
        order.append("second")
    other.join()
    assert alone and order == ["first", "second"]


@pytest.mark.parametrize("code", [errno.ENOLCK, errno.EOPNOTSUPP])
def test_without_locks_only_leftovers_of_the_own_build_are_deleted(tmp_path, monkeypatch, code):
    target = tmp_path / "type"
    folders.replace(target, with_manifest(OLD))
    left = leftover(target, with_manifest(NEW), "new")

    def flock(descriptor: int, operation: int) -> None:
        raise OSError(code, os.strerror(code))

    with monkeypatch.context() as patch:
        patch.setattr(fcntl, "flock", flock)
        with locked(tmp_path) as alone:
            assert not alone
        # Another build may be writing the other folder at this time.
        folders.clear_up(target)
        folders.replace(target, with_manifest(NEW))
        assert texts(target) == with_manifest(NEW)
        assert sorted(tmp_path.iterdir()) == sorted([target, left])
    folders.clear_up(target)
    assert list(tmp_path.iterdir()) == [target]
