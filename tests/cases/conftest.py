"""Fixtures for tests of cases and their oracle: message types."""

from __future__ import annotations

from itertools import count

import pytest

from firm_hdl.frontend import Library


@pytest.fixture
def make_message(tmp_path):
    """A function that makes a message type from its text, and texts of other types by name."""
    numbers = count()

    def make(text, distro="lyrical", **others):
        root = tmp_path / f"workspace{next(numbers)}"
        folder = root / "p" / "msg"
        folder.mkdir(parents=True)
        for name, each in {"A": text, **others}.items():
            end = "idl" if each.startswith("module") else "msg"
            (folder / f"{name}.{end}").write_text(each)
        return Library(distro, [root]).message("p/A" if distro == "noetic" else "p/msg/A")

    return make
