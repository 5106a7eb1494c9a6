"""Fixtures for tests of the exported files."""

from __future__ import annotations

import pytest
from amaranth.hdl import Module

from firm_hdl import Deserializer, Serializer
from firm_hdl.export.backend import Converters, Output
from firm_hdl.export.top import DIRECTIONS
from firm_hdl.export.vhdl.backend import Vhdl


def quick_vhdl(self: Vhdl, converters: Converters) -> Output:
    text = converters.header(converters.name, "converters")
    return Output(files={"vhdl/a.vhd": f"-- {text}"}, manifest={"vhdl": {}})


@pytest.fixture
def quick(monkeypatch):
    """Replace Yosys by a stub, because Yosys takes nearly all of a build's time."""
    monkeypatch.setattr(Converters, "make_circuits", lambda self: dict.fromkeys(DIRECTIONS, ""))
    monkeypatch.setattr(
        "firm_hdl.export.verilog.backend.convert",
        lambda top, name, header: f"{header}module {name};\n",
    )
    monkeypatch.setattr(Vhdl, "write", quick_vhdl)


@pytest.fixture
def without_vhdl(monkeypatch):
    """Leave the VHDL out of builds, which takes more than half of their time."""
    monkeypatch.setattr(Vhdl, "write", quick_vhdl)


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
