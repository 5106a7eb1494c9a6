"""The generated VHDL test benches as a test system."""

__all__ = []
