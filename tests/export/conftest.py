"""Fixtures for tests of the exported files."""

from __future__ import annotations

import pytest
from amaranth.hdl import Module

from firm_hdl import Deserializer, Serializer
from firm_hdl.export.options import EXTRAS

EVERYTHING = frozenset(EXTRAS) - {"documents"}
"""Files for each kind of tool. Datasheets simulate, which hollow converters do not stand."""


def hollow_converters(monkeypatch: pytest.MonkeyPatch) -> None:
    """Elaborate converters to nothing, because their insides take nine tenths of a build's time.

    Their ports, the layers with records, packages, benches and manifests are those of a build.
    """
    for converter in (Deserializer, Serializer):
        monkeypatch.setattr(converter, "elaborate", lambda self, platform: Module())


@pytest.fixture
def hollow(monkeypatch):
    """Build converters without their insides."""
    hollow_converters(monkeypatch)
