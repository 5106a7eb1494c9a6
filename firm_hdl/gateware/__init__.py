"""Converters as Amaranth components."""
