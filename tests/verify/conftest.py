"""Fixtures for tests of verification: external programs, libraries and message types."""

from __future__ import annotations

from itertools import count

import pytest

from firm_hdl.frontend import Library
from firm_hdl.jobs.programs import ProgramMissingError, find_ghdl
from firm_hdl.verify.references.clients import client
from firm_hdl.verify.simulators.programs import TextSimulator, simulator
from tests.tools import need


@pytest.fixture
def ghdl() -> str:
    """The path of GHDL."""
    try:
        return find_ghdl()
    except ProgramMissingError:
        return need("GHDL", None)


@pytest.fixture
def of_verilog(request: pytest.FixtureRequest) -> TextSimulator:
    """A Verilog simulator, named by the parameter."""
    found = None
    try:
        found = simulator(request.param)
    except ProgramMissingError:
        need(request.param, None)
    assert found is not None
    return found


@pytest.fixture
def library_here():
    """A function that returns a client library; skip the test if it is missing, or fail in CI."""

    def get(name):
        found = client(name)
        if found.missing() is not None:
            need(f"{name} ({found.missing()})", None)
        return found

    return get


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
