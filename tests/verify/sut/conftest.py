"""What tests of client libraries share: types from a text, and libraries where they are here."""

from __future__ import annotations

from itertools import count

import pytest

from firm_hdl.frontend import Library
from firm_hdl.verify.sut import client
from tests.export.conftest import need


@pytest.fixture
def library_here():
    """Give a client library. Where it is not installed, skip the test; in CI, fail it."""

    def get(name):
        found = client(name)
        if found.missing() is not None:
            need(f"{name} ({found.missing()})", None)
        return found

    return get


@pytest.fixture
def make_message(tmp_path):
    """Make a message type of a text; texts of others may follow, by name."""
    numbers = count()

    def make(text, distro="lyrical", **others):
        root = tmp_path / f"workspace{next(numbers)}"
        folder = root / "p" / "msg"
        folder.mkdir(parents=True)
        for name, each in {"A": text, **others}.items():
            (folder / f"{name}.msg").write_text(each)
        return Library(distro, [root]).message("p/A" if distro == "noetic" else "p/msg/A")

    return make
