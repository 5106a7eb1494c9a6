"""The VHDL package with functions that VHDL-2008 lacks and the generated text uses."""

from __future__ import annotations

from importlib.resources import files

__all__ = ["PACKAGE", "PACKAGE_NAME"]

PACKAGE_NAME = "firm_hdl_pkg"

PACKAGE = files("firm_hdl.vhdl").joinpath(f"{PACKAGE_NAME}.vhd").read_text(encoding="utf-8")
"""Text of the package."""
