"""Client libraries that equal another one, or are broken on purpose."""

from __future__ import annotations

from firm_hdl.verify.clients.system import compare
from firm_hdl.verify.references.client import Client, Codec
from firm_hdl.verify.systems.system import Trial
from tests.verify.report.samples import a_test

__all__ = ["Same", "Twin", "compared"]


def compared(library, reference, message, values, wire="cdr"):
    """Compare two libraries; return the trial."""
    trial = Trial.of(a_test())
    has_type = compare(library, reference, message, wire, values, trial)
    assert has_type or trial.obstacle is not None
    return trial


class Twin(Client):
    """A correct library with an injected fault."""

    name = "twin"
    wires = frozenset({"cdr", "ros1"})

    def __init__(self, right, fault, byte_orders=("little",)):
        self.right, self.fault = right, fault
        self.byte_orders = byte_orders

    def missing(self):
        return None

    def version(self):
        return "0"

    def open(self, message, wire):
        return self.fault(self.right.open(message, wire))


class Same(Codec):
    """A codec without a fault."""

    def __init__(self, right):
        self.right = right

    def encode(self, value):
        return self.right.encode(value)

    def decode(self, packet):
        return self.right.decode(packet)
