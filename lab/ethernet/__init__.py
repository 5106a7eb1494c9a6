"""The edge to Ethernet in Verilator: damaged frames, and a network of Linux."""

__all__: list[str] = []
