"""The description of the node that a board has to have: each type comes in and goes back.

A user builds the design from the same text (``--write-node``), so both sides have the same
fingerprint. Types are in the order of their names, so the order of arguments does not count.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from urllib.parse import SplitResult, parse_qsl, urlsplit

from firm_hdl.errors import UserError
from firm_hdl.files import write_new
from firm_hdl.frontend import open_library
from firm_hdl.node import Description, Topic, read_description, read_description_text
from firm_hdl.node.description import NODE_BUS_BYTES
from firm_hdl.verify.systems.options import Request

__all__ = ["chosen_loops", "described_board", "loop_text", "write_description"]

ACCELERATOR = "firm_hdl.node.loop:Loop"


def loop_text(
    names: Iterable[str],
    distro: str,
    *,
    paths: Sequence[str] = (),
    folder: str = ".",
    bus_bytes: int = 8,
    board: str | None = None,
) -> str:
    """Return the text of a description that sends each type back as it came.

    * `names`: full names of messages, such as ``std_msgs/msg/String`` or
      ``std_srvs/srv/Trigger_Request``.
    * `paths`: folders with ROS packages, as the user named them.
    * `folder`: folder of the file that the text is for; paths are relative to it.
    * `board`: the board, as :func:`firm_hdl.node.boards.board_of` takes it; its form decides the
      link. `None`: UDP.
    """
    lines = [
        "# A node that sends back what it receives, for firm-hdl verify --board.",
        "node: loopback",
        f"distro: {distro}",
    ]
    if paths:
        relative = [os.path.relpath(path, folder) for path in paths]
        lines.append(f"paths: {json.dumps(relative, ensure_ascii=False)}")
    lines += [
        f"bus_bytes: {bus_bytes}",
        "clock_mhz: 100",
        f"link: {_link(board)}",
        f"accelerator: {ACCELERATOR}",
    ]
    types = sorted(set(names))
    for kind, way in (("subscribe", "in"), ("publish", "out")):
        lines.append(f"{kind}:")
        lines += [f"  /loopback/{way}/{_short(name)}: {{type: {name}}}" for name in types]
    return "\n".join(lines) + "\n"


def described_board(request: Request, names: Iterable[str]) -> Description:
    """Return the description of a board: that of ``--node``, or one that loops named types.

    * `request`: `board`, `node`, `paths`, `depends`, `widths` and `distros`; without ``--node``,
      one of each of the latter two.
    * `names`: full names of messages; not used with ``--node``.

    Raises `DefinitionError` if the description cannot be used. Raises `UserError` if it loops no
    type, or no node has a bus of that width.
    """
    if request.node is not None:
        found = read_description(request.node, paths=(*request.paths, *request.depends))
        if not found.loops():
            raise UserError(
                f"'{request.node}' has no subscription with a publication of the same type"
            )
        return found
    return read_description_text(_text(request, names, "."), name="<loopback>")


def write_description(request: Request, names: Iterable[str], path: str) -> None:
    """Write the description of a board that loops named types; parameters as above.

    Raises `DefinitionError` or `UserError`: as above, or if the file exists or cannot be written.
    """
    text = _text(request, names, os.path.dirname(path) or ".")
    # What cannot be built should not be written.
    read_description_text(text, name=path, folder=os.path.dirname(path) or ".")
    try:
        write_new(path, text.encode())
    except FileExistsError:
        raise UserError(f"'{path}' exists already, and may have changes of yours") from None
    except OSError as error:
        raise UserError(f"cannot write '{path}': {error.strerror}") from None


def chosen_loops(description: Description, names: Sequence[str]) -> tuple[tuple[Topic, Topic], ...]:
    """Return the loops of a description whose types are named; without names, all of them.

    Raises `UserError` if there is no loop of a type that is named.
    """
    loops = description.loops()
    if not names:
        return loops
    wanted = {name.replace("/msg/", "/") for name in names}
    found = tuple(loop for loop in loops if loop[0].type.replace("/msg/", "/") in wanted)
    if missing := wanted - {loop[0].type.replace("/msg/", "/") for loop in found}:
        raise UserError(f"the node of the board has no loop of {', '.join(sorted(missing))}")
    return found


def _text(request: Request, names: Iterable[str], folder: str) -> str:
    (distro,), (bus_bytes,) = request.distros, request.widths
    if bus_bytes not in NODE_BUS_BYTES:
        widths = ", ".join(map(str, NODE_BUS_BYTES))
        raise UserError(f"the bus of a node has {widths} bytes, not {bus_bytes}")
    library = open_library(distro, request.paths, depends=request.depends)
    return loop_text(
        # The names of ROS 1, which have no ``msg``.
        (library.interface(name).name for name in names),
        distro,
        paths=(*request.paths, *request.depends),
        folder=folder,
        bus_bytes=bus_bytes,
        board=request.board,
    )


def _short(name: str) -> str:
    """Return the name of a type as a part of a topic's name."""
    package, _, rest = name.partition("/")
    return f"{package}/{rest.rpartition('/')[2]}"


def _link(board: str | None) -> str:
    """Return the link of a node behind a board of that form."""
    try:
        url = urlsplit("udp:" if board is None else board)
    except ValueError:
        # The name is an error that is found elsewhere.
        return "stream"
    if url.scheme == "udp":
        return f"{{kind: udp{_port(url)}}}"
    if url.scheme in ("tcp", "serial"):
        rates = [value for key, value in parse_qsl(url.query) if key == "baud"]
        # A rate that is none is an error of the board's name, which is found elsewhere.
        return f"{{kind: uart, baud: {rates[-1]}}}" if rates and rates[-1].isdecimal() else "uart"
    return "axi_dma" if url.scheme == "zynq" else "stream"


def _port(url: SplitResult) -> str:
    """Return the option for a port; a name without one means the default, 7411."""
    try:
        return f", port: {url.port}" if url.port else ""
    except ValueError:
        return ""
