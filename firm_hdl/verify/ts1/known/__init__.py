"""Differences between oracles and us that are meant to be: docs/errata.md says why.

Each has a key, by which a report names it. An entry normalises what it knows, and the rest is
compared again (`firm_hdl.verify.ts1.again`). A difference that is left then is a mistake of
somebody's.
"""

from __future__ import annotations

from firm_hdl.verify.ts1.known.idl import IDL
from firm_hdl.verify.ts1.known.idl_fit import IDL_FIT
from firm_hdl.verify.ts1.known.idl_values import IDL_VALUES
from firm_hdl.verify.ts1.known.lenient import LENIENT
from firm_hdl.verify.ts1.known.ros import ROS
from firm_hdl.verify.ts1.known.rosbags import ROSBAGS
from firm_hdl.verify.ts1.known.rule import KnownRule

__all__ = ["KNOWN"]

KNOWN: tuple[KnownRule, ...] = (*ROSBAGS, *LENIENT, *ROS, *IDL_FIT, *IDL, *IDL_VALUES)
"""All entries, in the order in which they are applied."""
