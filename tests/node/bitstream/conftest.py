# amaranth: UnusedElaboratable=no
"""The node of all tests here."""

from __future__ import annotations

import pytest

from firm_hdl.node.build import build_node
from tests.node.bitstream.samples import description


@pytest.fixture(scope="session")
def node(tmp_path_factory):
    """The node of the description of `samples`; copy its folder before you change it."""
    return build_node(description(), tmp_path_factory.mktemp("pins"))
