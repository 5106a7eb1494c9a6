"""The command ``board``: projects for boards whose FPGA is beside a processor."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from firm_hdl.node import Description

__all__ = ["add_board"]


def add_board(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl board``."""
    actions = command.add_subparsers(
        title="actions", dest="action", metavar="ACTION", required=True
    )
    text = "write a block design of Vivado, a device tree or a notebook, and the commands in order"
    init = actions.add_parser(
        "init",
        help=text,
        description=f"{text[0].upper()}{text[1:]}.",
        examples=("firm-hdl board init kria", "firm-hdl board init pynq node.yaml"),
    )
    init.add_argument("board", metavar="BOARD", help="kria (KV260, KR260) or pynq (PYNQ-Z2)")
    init.add_argument(
        "file",
        nargs="?",
        metavar="FILE",
        help="description of the node, in YAML, with 'link: axi_dma' (default: one whose commands "
        "come back, in the new folder)",
    )
    init.add_argument(
        "-o", "--out", metavar="DIR", help="folder to write, which must not exist (NODE_BOARD)"
    )
    command.set_defaults(run=_init)


def _init(args: argparse.Namespace) -> None:
    from firm_hdl.node import read_description, read_description_text
    from firm_hdl.node.projects import EXAMPLE, board_named, write_project

    board = board_named(args.board)
    description = read_description_text(EXAMPLE) if not args.file else read_description(args.file)
    folder = write_project(board, description, args.file, args.out, sample=_sample(description))
    print(f"wrote   {folder}\nREADME.md there has the commands in their order.")


def _sample(description: Description) -> Sequence[bytes]:
    """Return packets of the first subscription, as for the benches of a node."""
    # rosbags takes time to import.
    from firm_hdl.cases.stimuli import stimuli

    for topic in description.topics:
        if topic.kind == "subscribe":
            store = topic.store("in")
            return stimuli(store.message, description.plan(store))
    return ()
