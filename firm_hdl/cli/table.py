"""The table of commands of ``firm-hdl``, with the modules that define them.

The module of a command is imported when the command is called. It imports other modules only when
it needs them.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from importlib import import_module

__all__ = ["COMMANDS", "Command"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """A command.

    Attributes
    ----------
    help : str
        Purpose of the command, in one line.
    module : str
        Name of the module of `firm_hdl.cli` with the function ``add_NAME``, which adds the
        arguments and sets ``run``.
    has_origins : bool
        Whether the command takes ``--distro``, ``--path``, ``--bag`` and ``--depends``.
    """

    help: str
    module: str
    has_origins: bool = True

    def add(self, name: str, parser: argparse.ArgumentParser) -> None:
        """Add the command's arguments to its parser."""
        from firm_hdl.arguments import add_origins

        if self.has_origins:
            add_origins(parser)
        getattr(import_module(f"firm_hdl.cli.{self.module}"), f"add_{name}")(parser)


COMMANDS: dict[str, Command] = {
    "build": Command(help="write the converters of message types", module="building"),
    "list": Command(help="list all messages, services and actions", module="reading"),
    "show": Command(help="print a type as ROS's own tools do", module="reading"),
    "plan": Command(help="print what converters do in each cycle, as YAML", module="building"),
    "info": Command(
        help="print how many cycles packets take, and which clock a line rate needs",
        module="building",
    ),
    "part": Command(
        help="write a part that stores, checks, merges or routes packets",
        module="parts",
        has_origins=False,
    ),
    "node": Command(
        help="write a design with several topics behind one link, print its figures, or run it "
        "in a graph of ROS",
        module="nodes",
        has_origins=False,
    ),
    "verify": Command(
        help="test converters against ROS's own libraries", module="testing", has_origins=False
    ),
    "report": Command(
        help="write a report of results of verify, as HTML, Markdown or JSON",
        module="testing",
        has_origins=False,
    ),
    "prove": Command(
        help="prove that the VHDL is equivalent to Amaranth's circuit", module="testing"
    ),
    "bench": Command(
        help="measure converters on an FPGA: area, clock rate, cycles", module="testing"
    ),
    "golden": Command(help="compare plans with golden ones, by meaning", module="testing"),
    "cover": Command(help="choose a few types that have every feature", module="testing"),
    "md5": Command(help="print the md5 sums of ROS 1 types", module="reading"),
    "hash": Command(help="print the type hashes (RIHS01) of ROS 2 types", module="reading"),
    "proto": Command(help="print an example of a type as ROS's own tools do", module="reading"),
    "metrics": Command(
        help="print figures of message types: depth, leaves, sizes, alignment, features",
        module="reading",
    ),
}
"""All commands by name, in the order in which ``--help`` lists them."""
