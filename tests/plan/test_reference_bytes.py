"""Reference bytes from ROS 2's own type support (humble, Fast CDR), stored with the corpus."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan, decode, encode
from firm_hdl.sim.values import from_transfers, to_transfers
from firm_hdl.wire import lay_out
from tests.strategies import on_every_bus

# Correct differences of converters: they neither cut at a NUL nor take more than the bound.
OTHERWISE = {"str_nul", "bounded_overflow"}


@pytest.fixture(scope="module")
def folder(corpus: Path) -> Path:
    return corpus.parent / "cdr_reference"


@pytest.fixture(scope="module")
def cases(folder):
    rows = [line.split("\t") for line in (folder / "bytes.tsv").read_text().splitlines()]
    packets = {name: bytes.fromhex(text) for name, order, text in rows if order == "LE"}
    given = yaml.safe_load((folder / "cases.yaml").read_text())
    library = Library("humble", [folder])
    return {
        name: (library.message(case["message"]), case["values"], packets[name])
        for name, case in given.items()
    }


@on_every_bus
def test_values_become_the_reference_bytes_and_back(cases, bus_bytes):
    assert len(cases) >= 23
    for name in sorted(cases.keys() - OTHERWISE):
        message, value, packet = cases[name]
        plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
        assert encode(plan, to_transfers(plan, message, value)) == (packet, "OK"), name
        decoded = decode(plan, packet)
        assert decoded.status == "OK", name
        assert from_transfers(plan, message, decoded.streams) == value, name


@on_every_bus
def test_a_nul_in_a_string_is_a_character(cases, bus_bytes):
    message, value, packet = cases["str_nul"]
    assert packet.hex() == "00010000020000006100"
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    got, status = encode(plan, to_transfers(plan, message, value))
    assert (got.hex(), status) == ("000100000400000061006200", "OK")
    assert from_transfers(plan, message, decode(plan, got).streams) == value


@on_every_bus
def test_a_string_over_its_bound_is_written_and_refused_when_read(cases, bus_bytes):
    message, value, packet = cases["bounded_overflow"]
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    streams = to_transfers(plan, message, value, check_bounds=False)
    assert encode(plan, streams) == (packet, "LENGTH")
    assert decode(plan, packet).status == "LENGTH"
