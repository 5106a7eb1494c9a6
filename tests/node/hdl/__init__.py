"""Tests of accelerators in VHDL and Verilog."""
