"""What ROS's own tools compute for an interface: md5 sum, type hash, and the text of an example.

All results are computed from the model. So they can be compared with the output of ROS's tools for
the same definition.
"""

from __future__ import annotations

from firm_hdl.identity.md5 import md5sum
from firm_hdl.identity.proto import proto
from firm_hdl.identity.rihs import type_description, type_hash

__all__ = ["md5sum", "proto", "type_description", "type_hash"]
