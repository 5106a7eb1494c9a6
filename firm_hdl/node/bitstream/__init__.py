"""From a node to the bitstream of a board.

:mod:`board` reads what a board has, :mod:`families` knows the FPGAs, :mod:`top` writes the module
between a node and its pins, and :mod:`build` runs Yosys, nextpnr and the packer.
"""

from __future__ import annotations

from firm_hdl.node.bitstream.board import Board, board_list, board_names, read_board

__all__ = ["Board", "board_list", "board_names", "read_board"]
