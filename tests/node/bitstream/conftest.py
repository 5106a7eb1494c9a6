"""The node of all tests here."""

from __future__ import annotations

import io
from contextlib import redirect_stdout

import pytest

from firm_hdl.cli import main
from firm_hdl.export.design import BuiltDesign
from firm_hdl.node.bitstream import build
from tests.node.bitstream.samples import PINS, TEXT, fake_tools
from tests.tools import made_once


@pytest.fixture(scope="session")
def node(tmp_path_factory):
    """The node of `samples`, as the command makes it with a bitstream and says it in `said.txt`.

    Copy its folder before you change it.
    """

    def make(out):
        file = out / "pins.yaml"
        file.write_text(TEXT + PINS)
        command = ["node", "build", str(file), "--out", str(out), "--board", "ulx3s-45f"]
        with pytest.MonkeyPatch.context() as patch, redirect_stdout(io.StringIO()) as said:
            patch.setattr(build, "find_tools", lambda family: fake_tools(7.5))
            main(command)
        (out / "pins" / "said.txt").write_text(said.getvalue())

    out = made_once(tmp_path_factory, "bitstream", make)
    return BuiltDesign(folder=out / "pins", was_current=False)
