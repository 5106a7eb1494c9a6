"""Attributes of signals by which a circuit tells its back ends more than a name."""

__all__ = ["REMARK"]

REMARK = "firm_hdl_remark"
"""A comment on a signal, one line, which stands beside its declaration."""
