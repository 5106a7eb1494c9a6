"""The command ``node``: designs with several topics behind one link."""

from __future__ import annotations

import argparse

from firm_hdl.arguments import add_path

__all__ = ["add_node"]


def add_node(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl node``."""
    command.add_argument(
        "action",
        choices=["info", "build"],
        help="info: print topics, ids, cycles, clocks, memory and area; build: write the design",
    )
    command.add_argument("file", metavar="FILE", help="description of a node; see docs/node.md")
    add_path(command)
    command.add_argument(
        "--out", default="node_out", help="folder that build writes to (%(default)s)"
    )
    command.add_argument("--force", action="store_true", help="also write a folder that is current")
    command.set_defaults(run=_node)


def _node(args: argparse.Namespace) -> None:
    from firm_hdl.node import read_description
    from firm_hdl.node.summary import summary

    description = read_description(args.file, paths=args.path)
    if args.action == "build":
        from firm_hdl.node.build import build_node

        built = build_node(description, args.out, force=args.force)
        print(f"{'current' if built.was_current else 'wrote':8}{built.folder}", flush=True)
        for old, new in sorted(built.renamed.items()):
            print(f"        your file {old} is now {new}", flush=True)
    print(summary(description))
