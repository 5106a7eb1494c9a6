"""Tests of what accelerators are made of."""
