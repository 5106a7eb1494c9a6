"""Simulation helpers to test accelerators in plain Amaranth.

`send_packets`, `receive_packets`, `MessagePort` and `watch` are for a user's own testbenches.
`loopback`, `decode` and `encode` run converters as functions. `Harness` with `RunOptions` runs one
circuit many times.
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
