"""Converters that have their ports and nothing inside, for tests of what is around them."""

from __future__ import annotations

import pytest
from amaranth.hdl import Module

from firm_hdl import Deserializer, Serializer

__all__ = ["hollow_converters"]


def hollow_converters(monkeypatch: pytest.MonkeyPatch) -> None:
    """Elaborate converters to nothing, because their insides take nine tenths of a build's time.

    Their ports, the layers with records, packages, benches and manifests are those of a build.
    """
    for converter in (Deserializer, Serializer):
        monkeypatch.setattr(converter, "elaborate", lambda self, platform: Module())
