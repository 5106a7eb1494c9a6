"""The arguments of ``firm-hdl verify`` for boards, and what they exclude."""

from __future__ import annotations

import argparse

from firm_hdl.arguments import add_engine, seconds
from firm_hdl.frontend import DEFAULT_DISTRO
from firm_hdl.verify.request import Workload

__all__ = ["add_board_arguments", "check_board", "distros_of", "write_node"]


def add_board_arguments(group: argparse._ArgumentGroup) -> None:
    """Add the arguments to a group of a parser."""
    group.add_argument(
        "--board",
        metavar="BOARD",
        help="send the cases of ts3 through a board that sends them back: sim, udp://HOST[:PORT], "
        "tcp://HOST:PORT or serial:///dev/DEVICE[?baud=RATE]",
    )
    group.add_argument(
        "--node",
        metavar="FILE",
        help="description of the node on the board; without TYPE, all types that it sends back; "
        "default: that of --write-node",
    )
    group.add_argument(
        "--write-node",
        metavar="FILE",
        help="test nothing, but write the description of a node that sends the types back, for "
        "firm-hdl node build",
    )
    add_engine(group, "--board sim")
    group.add_argument(
        "--silent-seconds",
        type=seconds,
        metavar="S",
        help="a board that says nothing for so long fails; default: 5, or 60 for sim",
    )


def distros_of(given: argparse.Namespace) -> tuple[str, ...]:
    """Return the distributions; a node has one."""
    distros = tuple(given.distro or ())
    has_node = given.board is not None or given.write_node is not None
    return (DEFAULT_DISTRO,) if has_node and not distros else distros


def check_board(given: argparse.Namespace) -> None:
    """Refuse arguments that cannot be combined with a board."""
    has_node = given.board is not None or given.write_node is not None
    if given.systems is not None and ("board" in given.systems) != (given.board is not None):
        given.usage_error("--systems board needs --board, and the reverse")
    for name in ("node", "engine", "silent_seconds"):
        if given.board is None and getattr(given, name) != given.default_of(name):
            given.usage_error(f"--{name.replace('_', '-')} needs --board")
    if not has_node:
        return
    if given.all or given.bag:
        given.usage_error("a board takes named types, or those of --node")
    if given.wire is not None:
        given.usage_error("a board has the wire format of its distribution: not with --wire")
    if len(given.distro or ()) > 1 or len(set(given.bus_bytes or ())) > 1:
        given.usage_error("a board has one --distro and one --bus-bytes")
    if given.node is None:
        return
    if given.write_node is not None:
        given.usage_error("argument --write-node: not allowed with argument --node")
    if given.distro or given.bus_bytes:
        given.usage_error("--distro and --bus-bytes are those of --node")
    if set(given.systems or ()) - {"board"}:
        given.usage_error("--node is for the test system board alone")


def write_node(work: Workload, path: str) -> int:
    """Write the description of a node for the types of a request; return the exit status."""
    from firm_hdl.verify.board.description import write_description

    write_description(work.request, [task.name for task in work.tasks], path)
    print(f"wrote   {path}")
    return 0
