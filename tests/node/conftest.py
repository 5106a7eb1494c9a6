# amaranth: UnusedElaboratable=no
"""Fixtures that several tests of nodes share."""

from __future__ import annotations

import pytest

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.node.build import build_node
from tests.node.samples import RELAY, read
from tests.tools import made_once


@pytest.fixture(scope="session")
def relay(tmp_path_factory):
    """The folder of `RELAY`; copy it before you change a file."""

    def make(out):
        build_node(read(RELAY), out, stimuli=stimuli, datasheet=True)

    return made_once(tmp_path_factory, "with space", make) / "relay"
