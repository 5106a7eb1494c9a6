"""A plan run in plain Python: the golden model of the gateware.

Both directions follow the tree of the plan (slices, runs, loops, dynamic alignment) and never
read the layout, so a wrong plan gives wrong results. Results are exact to the primitive and do not
depend on the bus width: a packet's first error is the first one in wire order, whichever cycle the
hardware finds it in (docs/reference/status.md, "Status").
"""

from firm_hdl.plan.interpret.decode import Decoded, DecodeStatus, Transfer, decode
from firm_hdl.plan.interpret.encode import EncodeStatus, encode
from firm_hdl.plan.interpret.machine import Edge, Payload, Visit

__all__ = [
    "DecodeStatus",
    "Decoded",
    "Edge",
    "EncodeStatus",
    "Payload",
    "Transfer",
    "Visit",
    "decode",
    "encode",
]
