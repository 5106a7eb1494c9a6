"""Tests of fast simulation."""
