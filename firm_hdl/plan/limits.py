"""The legal bus widths and message sizes of converters."""

from __future__ import annotations

from firm_hdl.wire import Layout

__all__ = ["BUS_BYTES", "DEFAULT_MAX_MESSAGE_BYTES", "check_bus_bytes", "check_max_message_bytes"]

BUS_BYTES = (1, 2, 4, 8, 16, 32, 64)
"""Legal widths of the packet bus."""

DEFAULT_MAX_MESSAGE_BYTES = 1 << 24


def check_bus_bytes(bus_bytes: int) -> None:
    """Check the width of the packet bus.

    Raises
    ------
    TypeError
        If the width is not an integer.
    ValueError
        If the width is not one of `BUS_BYTES`.
    """
    if not isinstance(bus_bytes, int) or isinstance(bus_bytes, bool):
        raise TypeError(f"Bus width must be an integer, not {bus_bytes!r}")
    if bus_bytes not in BUS_BYTES:
        raise ValueError(
            f"Bus width must be one of {', '.join(map(str, BUS_BYTES))} bytes, not {bus_bytes!r}"
        )


def check_max_message_bytes(layout: Layout, max_message_bytes: int) -> None:
    """Check the size of the longest packet that the converters of a layout take.

    Raises
    ------
    TypeError
        If the size is not an integer.
    ValueError
        If no message of the type has so few bytes, or the size is above 2**32 - 1.
    """
    # In Python, a bool is an integer, too.
    if not isinstance(max_message_bytes, int) or isinstance(max_message_bytes, bool):
        raise TypeError(f"Maximum message size must be an integer, not {max_message_bytes!r}")
    if layout.min_bytes >= 1 << 32:
        raise ValueError(
            f"Each message has at least {layout.min_bytes} bytes, and at most {(1 << 32) - 1} are "
            "possible"
        )
    if not layout.min_bytes <= max_message_bytes < 1 << 32:
        raise ValueError(
            f"Maximum message size must be from {layout.min_bytes} bytes, the least that a "
            f"{layout.message.name} has, to {(1 << 32) - 1}, not {max_message_bytes!r}"
        )
