"""Tests of `firm_hdl.node`."""
