"""Boards: the ways from a host to a node. Each carries frames, and knows nothing of their content.

:func:`board_of` makes a board of what a user names, such as ``udp://192.168.1.50:7411``.
"""

from __future__ import annotations

import re
from typing import Any
from urllib.parse import SplitResult, parse_qsl, urlsplit

from firm_hdl.errors import UserError
from firm_hdl.node.boards.board import Board, BoardError
from firm_hdl.node.boards.bytestreams import BAUD_RATES, SerialBoard, TcpBoard
from firm_hdl.node.boards.udp import UdpBoard
from firm_hdl.node.boards.zynq import ZynqBoard
from firm_hdl.node.description import Description

__all__ = ["BOARD_FORMS", "Board", "BoardError", "board_of"]


BOARD_FORMS = (
    "sim, udp://HOST[:PORT], tcp://HOST:PORT, serial:///dev/DEVICE[?baud=RATE], zynq://UIO/BUFFER"
)
"""The forms of names of boards."""

_BOARDS = {
    "axi_dma": "which goes with --board zynq://UIO/BUFFER, on the processor beside it",
    "udp": "which goes with --board udp://HOST",
    "uart": "which goes with --board serial:///dev/DEVICE or tcp://HOST:PORT",
    "rtps": "with which the node is in the graph by itself: no host runs it",
    "stream": "which goes with --board sim, or a board of your own in Python",
}
"""The boards of each kind of link."""

_LINKS = {"udp": "udp", "tcp": "uart", "serial": "uart", "zynq": "axi_dma"}
"""The link of each form of a board."""


def board_of(name: str, description: Description, **simulation: Any) -> Board:
    """Make a board, which is not yet open.

    * `name`: one of `BOARD_FORMS`. Port and rate are by default those of the description's link.
    * `simulation`: further parameters of a :class:`.SimulatedBoard`.

    Raises `UserError` if the name has another form or is that of another link, or a simulation is
    not possible.
    """
    if name == "sim":
        # Amaranth takes seconds to import, and a host of a real board does not need it.
        from firm_hdl.node.boards.simulated import SimulatedBoard

        return SimulatedBoard(description, **simulation)
    link = description.link
    try:
        url = urlsplit(name)
    except ValueError as error:
        # Such as a bracket that is not closed.
        raise UserError(f"'{name}' is no board: {error}") from None
    board: Board
    match url.scheme:
        case "udp":
            board = UdpBoard(name, *_address(name, url, link.port), link.datagram_bytes)
        case "tcp":
            board = TcpBoard(name, *_address(name, url, None))
            board.bytes_per_second = link.baud / 10
        case "serial":
            board = SerialBoard(name, *_device(name, url, link.baud))
        case "zynq":
            board = ZynqBoard(name, *_devices(name, url), link.buffer_bytes)
        case _:
            raise UserError(f"'{name}' is no board; boards are {BOARD_FORMS}")
    kind = _LINKS[url.scheme]
    if link.kind != kind:
        raise UserError(
            f"'{name}' is a board whose link is '{kind}', and the link of '{description.node}' is "
            f"'{link.kind}', {_BOARDS[link.kind]}"
        )
    return board


def _address(name: str, url: SplitResult, default: int | None) -> tuple[str, int]:
    try:
        port = default if url.port is None else url.port
    except ValueError:
        port = 0
    if port == 0:
        raise UserError(f"'{name}' has no port from 1 to 65535")
    if not url.hostname or url.path not in ("", "/") or url.query:
        raise UserError(f"'{name}' is not {url.scheme}://HOST:PORT")
    if port is None:
        raise UserError(f"'{name}' needs a port, such as {url.scheme}://{url.hostname}:7411")
    return url.hostname, port


def _devices(name: str, url: SplitResult) -> tuple[str, str]:
    names = (url.netloc, url.path.removeprefix("/"))
    # One part of a path each, as it has to be a name in sysfs.
    if url.query or any(not re.fullmatch("[A-Za-z0-9_][A-Za-z0-9_.@,+-]*", each) for each in names):
        raise UserError(f"'{name}' is not zynq://UIO/BUFFER, such as zynq://uio0/udmabuf0")
    return names


def _device(name: str, url: SplitResult, baud: int) -> tuple[str, int]:
    if url.netloc or not url.path:
        raise UserError(f"'{name}' is not serial:///dev/DEVICE, with three '/'")
    for key, value in parse_qsl(url.query, keep_blank_values=True):
        if key != "baud" or not re.fullmatch("[0-9]{1,9}", value):
            raise UserError(f"'{name}' has an option other than 'baud=RATE'")
        baud = int(value)
    if baud not in BAUD_RATES:
        rates = ", ".join(str(rate) for rate in sorted(BAUD_RATES) if rate >= 9600)
        raise UserError(f"this system has no rate of {baud} baud; it has {rates}")
    return url.path, baud
