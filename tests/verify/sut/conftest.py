"""What tests of client libraries share: types from a text."""

from __future__ import annotations

from itertools import count

import pytest

from firm_hdl.frontend import Library


@pytest.fixture
def make_message(tmp_path):
    """Make a message type of a text; texts of others may follow, by name."""
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
