"""Attributes by which a circuit tells its back ends more than names."""

__all__ = ["PURPOSE", "REMARK"]

PURPOSE = "firm_hdl_purpose"
"""What a module is for, one line, which stands at its head."""

REMARK = "firm_hdl_remark"
"""A comment on a signal, one line, which stands beside its declaration."""
