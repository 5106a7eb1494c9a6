"""The netlist of a design that a user hands over."""

from __future__ import annotations

from typing import Any

from amaranth.back import rtlil
from amaranth.hdl import Elaboratable, Fragment
from amaranth.lib import wiring

__all__ = ["rtlil_of"]


def rtlil_of(design: Any, *, name: str, ports: Any = None, platform: Any = None) -> str:
    """Return the RTLIL of a design.

    Parameters
    ----------
    design : elaboratable or str
        A component or other elaboratable, or already RTLIL.
    name : str
        Name of the outermost module.
    ports, platform
        As for `amaranth.back.rtlil.convert`; a component needs no ports.

    Raises
    ------
    TypeError
        If the design or its name is none, or an elaboratable that is no component has no ports.
    ValueError
        If the name is no word.
    """
    if not isinstance(name, str):
        raise TypeError(f"Name of a design must be a text, not {name!r}")
    if [name] != name.split():
        raise ValueError(f"Name of a design must be one word, not {name!r}")
    if isinstance(design, str):
        return design
    if not isinstance(design, Elaboratable | Fragment):
        raise TypeError(
            "A design must be an Amaranth component or another elaboratable, or the text of its "
            f"RTLIL, not {design!r}"
        )
    if ports is None and not isinstance(getattr(design, "signature", None), wiring.Signature):
        raise TypeError(
            f"{design!r} is no component of amaranth.lib.wiring, so its ports must be given: "
            "ports=[...]"
        )
    return str(rtlil.convert(design, name=name, platform=platform, ports=ports, emit_src=False))
