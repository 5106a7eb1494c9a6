"""OMG IDL, as ROS 2 packages have it beside ``.msg``, ``.srv`` and ``.action`` files."""

from __future__ import annotations

from firm_hdl.frontend.idl.read import read_idl

__all__ = ["read_idl"]
