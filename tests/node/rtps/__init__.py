"""Tests of the participant in gateware."""
