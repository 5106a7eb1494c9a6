"""The command ``board``: projects for FPGAs beside a processor, or with one inside."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from firm_hdl.arguments import add_origins
from firm_hdl.errors import UserError

if TYPE_CHECKING:
    from firm_hdl.node import Description

__all__ = ["add_board"]


def add_board(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl board``."""
    actions = command.add_subparsers(
        title="actions", dest="action", metavar="ACTION", required=True
    )
    text = (
        "write a block design of Vivado with a device tree or a notebook, or a SoC of LiteX with "
        "firmware, and the commands in order"
    )
    init = actions.add_parser(
        "init",
        help=text,
        description=f"{text[0].upper()}{text[1:]}.",
        examples=(
            "firm-hdl board init kria",
            "firm-hdl board init pynq node.yaml",
            "firm-hdl board init litex geometry_msgs/msg/Twist",
        ),
    )
    init.add_argument(
        "board", metavar="BOARD", help="kria (KV260, KR260), pynq (PYNQ-Z2), or litex"
    )
    init.add_argument(
        "file",
        nargs="?",
        metavar="FILE",
        help="description of the node, in YAML, with 'link: axi_dma' (default: one whose commands "
        "come back, in the new folder); for litex, a message type (default: a Twist)",
    )
    init.add_argument(
        "-o",
        "--out",
        metavar="DIR",
        help="folder to write, which must not exist (NODE_BOARD, or TYPE_litex)",
    )
    add_origins(init.add_argument_group("of the type, for litex"))
    init.set_defaults(usage_error=init.error)
    command.set_defaults(run=_init)


def _init(args: argparse.Namespace) -> None:
    from firm_hdl.node.projects import board_named

    board = board_named(args.board)
    folder = _init_litex(args) if board == "litex" else _init_node(board, args)
    print(f"wrote   {folder}\nREADME.md there has the commands in their order.")


def _init_node(board: str, args: argparse.Namespace) -> Path:
    from firm_hdl.node import read_description, read_description_text
    from firm_hdl.node.projects import EXAMPLE, clock_problem, write_project

    if args.distro or args.path or args.bag or args.depends:
        args.usage_error("--distro, --path, --bag and --depends are for litex; a node has its own")
    description = read_description_text(EXAMPLE) if not args.file else read_description(args.file)
    folder = write_project(board, description, args.file, args.out, sample=_sample(description))
    if problem := clock_problem(board, description):
        print(f"warning: {problem}", file=sys.stderr)
    return folder


def _init_litex(args: argparse.Namespace) -> Path:
    from firm_hdl.cli.types import library_of, take_spellings

    if (args.file or "").endswith((".yaml", ".yml")):
        raise UserError(
            "a project for 'litex' has the converters of a message type; for a node, 'node build "
            "--ip litex' writes a module of LiteX"
        )
    args.type = args.file or "geometry_msgs/msg/Twist"
    take_spellings(args)
    library = library_of(args)
    # Errors in definitions are reported before Amaranth is imported, which takes time.
    library.message(args.type)
    from firm_hdl.node.projects.converters import write_litex_project

    origins = {"--path": args.path, "--bag": args.bag, "--depends": args.depends}
    return write_litex_project(library, args.type, args.out, origins=origins)


def _sample(description: Description) -> Sequence[bytes]:
    """Return packets of the first subscription, as for the benches of a node."""
    # rosbags takes time to import.
    from firm_hdl.cases.stimuli import stimuli

    for topic in description.topics:
        if topic.kind == "subscribe":
            store = topic.store("in")
            return stimuli(store.message, description.plan(store))
    return ()
