"""The VHDL package that all messages share: streams of primitives, and status codes.

Its text does not depend on the message type. So a procedure for a `float64_stream_t`, for example,
works for all message types and bus widths, and all converters of a design have the same status
codes.
"""

from __future__ import annotations

from firm_hdl.export.primitives import PRIMITIVE_BITS, TYPES_NAME
from firm_hdl.export.templates import text_of

__all__ = ["data_type", "types_package"]


def data_type(primitive: str) -> str:
    """Return the VHDL type of a primitive's value.

    >>> data_type("int16"), data_type("bool"), data_type("float32")
    ('signed(15 downto 0)', 'std_logic', 'std_logic_vector(31 downto 0)')
    """
    if primitive == "bool":
        return "std_logic"
    kinds = {"int": "signed", "uint": "unsigned", "float": "std_logic_vector"}
    return f"{kinds[primitive.rstrip('0123456789')]}({PRIMITIVE_BITS[primitive] - 1} downto 0)"


def types_package() -> str:
    """Return the package and its body, a file beside this module."""
    return text_of(f"vhdl/{TYPES_NAME}.vhd")
