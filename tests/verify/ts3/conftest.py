"""Fixtures of the tests of TS3."""

from __future__ import annotations

import pytest

import firm_hdl.verify.ts3.circuit as circuit
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.sim.harness import Harness
from tests.depth import THOROUGH


@pytest.fixture(scope="module")
def harnesses():
    """Simulated circuits of a file of tests, by what they are made for."""
    return {}


@pytest.fixture
def same_circuit(monkeypatch, harnesses):
    """Simulate a type with the circuit of an earlier test: each run starts from initial values.

    It does not touch converters that a test has changed, nor circuits that keep their state.
    """

    def harness(rx, tx, *, message, gated, probes=(), keeps_state=False):
        options = {"message": message, "gated": gated}
        if probes or keeps_state or (type(rx), type(tx)) != (Deserializer, Serializer):
            return Harness(rx, tx, **options, probes=probes, keeps_state=keeps_state)
        key = (message, rx.plan, tx.plan, gated)
        if key not in harnesses:
            harnesses[key] = Harness(rx, tx, **options)
        return harnesses[key]

    if not THOROUGH:
        monkeypatch.setattr(circuit, "Harness", harness)
