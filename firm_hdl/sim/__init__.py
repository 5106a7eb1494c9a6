"""Simulation helpers to test accelerators in plain Amaranth.

Which one, from the slowest to the fastest:

* A user's own testbench, written with `async`: `send_packets`, `receive_packets`, `watch`, and
  `MessagePort` for whole messages. Any code may run between two transfers.
* Converters as functions, for a test in one line: `loopback`, `decode`, `encode`.
* Converters with thousands of packets, stalls or resets: `Harness` with `RunOptions`, elaborated
  once. For any other design, :class:`firm_hdl.sim.bench.Bench`, on which `Harness` stands.
* A design as large as a node, or a program that talks to the design while it runs:
  :class:`firm_hdl.sim.fast.FastSimulation`, compiled by Verilator.
"""

from __future__ import annotations

from firm_hdl.gateware.signatures import leaf_streams
from firm_hdl.sim.bench import DeadlineError, RunOptions
from firm_hdl.sim.design import ClockDomainError
from firm_hdl.sim.harness import Harness, RunResult, leaf_name
from firm_hdl.sim.loopback import Decoding, Encoding, Loopback, decode, encode, loopback
from firm_hdl.sim.messages import MessagePort
from firm_hdl.sim.stalls import StallPlan, Stalls
from firm_hdl.sim.streams import receive, receive_packets, receive_statuses, send, send_packets
from firm_hdl.sim.values import from_transfers, to_transfers
from firm_hdl.sim.watch import StreamRuleError, StreamRules, watch

__all__ = [
    "ClockDomainError",
    "DeadlineError",
    "Decoding",
    "Encoding",
    "Harness",
    "Loopback",
    "MessagePort",
    "RunOptions",
    "RunResult",
    "StallPlan",
    "Stalls",
    "StreamRuleError",
    "StreamRules",
    "decode",
    "encode",
    "from_transfers",
    "leaf_name",
    "leaf_streams",
    "loopback",
    "receive",
    "receive_packets",
    "receive_statuses",
    "send",
    "send_packets",
    "to_transfers",
    "watch",
]
