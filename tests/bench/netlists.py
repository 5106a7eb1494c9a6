"""A small netlist in the format of Yosys."""

from __future__ import annotations

from typing import Any

__all__ = ["flip_flop", "lut", "small"]


def lut(z: int, *inputs: int) -> dict[str, Any]:
    ports = dict(zip("ABC", [[bit] for bit in inputs], strict=False))
    return {
        "type": "LUT4",
        "port_directions": {"Z": "output", **dict.fromkeys(ports, "input"), "D": "input"},
        "connections": {"Z": [z], **ports, "D": ["0"]},
    }


def flip_flop(d: int, q: int) -> dict[str, Any]:
    return {
        "type": "TRELLIS_FF",
        "port_directions": {"CLK": "input", "DI": "input", "Q": "output"},
        "connections": {"CLK": [2], "DI": [d], "Q": [q]},
    }


def small() -> dict[str, Any]:
    """A module of three ports, a register, and two look-up tables between them."""
    return {
        "ports": {
            "clk": {"direction": "input", "bits": [2]},
            "rst": {"direction": "input", "bits": [3]},
            "i": {"direction": "input", "bits": [4, 5]},
            "o": {"direction": "output", "bits": [7, "0"]},
        },
        "cells": {
            "fill_LUT4_A_Z_LUT4_Z": lut(6, 5, 7, 8),
            "i_LUT4_A": lut(8, 4, 5),
            "fill_TRELLIS_FF_Q": flip_flop(6, 7),
            "$1": flip_flop(6, 9),
        },
        "netnames": {
            "clk": {"bits": [2]},
            "rst": {"bits": [3]},
            "i": {"bits": [4, 5]},
            "o": {"bits": [7, "0"]},
            "i_LUT4_A_Z": {"bits": [8]},
            "fill_LUT4_A_Z": {"bits": [6]},
            "core.fill": {"bits": [7]},
            "$abc$1$x": {"bits": [6]},
            "f": {"bits": [7], "hide_name": 1},
        },
    }
