"""Boards: the ways from a host to a node. Each carries frames, and knows nothing of their content.

:func:`board_of` makes a board of what a user names, such as ``udp://192.168.1.50:7411``.
"""

from __future__ import annotations

from firm_hdl.node.boards.board import Board, BoardError
from firm_hdl.node.boards.choose import BOARD_FORMS, board_of

__all__ = ["BOARD_FORMS", "Board", "BoardError", "board_of"]
