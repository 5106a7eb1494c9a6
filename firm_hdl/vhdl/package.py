"""The VHDL package with functions that the generated text uses and VHDL-2008 does not have."""

from __future__ import annotations

from importlib.resources import files

__all__ = ["PACKAGE", "PACKAGE_NAME"]

PACKAGE_NAME = "firm_hdl_pkg"

PACKAGE = files("firm_hdl.vhdl").joinpath(f"{PACKAGE_NAME}.vhd").read_text(encoding="utf-8")
"""Text of the package."""
