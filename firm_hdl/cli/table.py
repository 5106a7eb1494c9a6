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
    """A command."""

    help: str  # Purpose of the command, in one line.
    # Module of `firm_hdl` with the function `add_NAME`, which adds the arguments and sets `run`.
    module: str
    examples: tuple[str, ...] = ()  # Command lines that its help shows.
    # Whether the command takes `--distro`, `--path`, `--bag` and `--depends`.
    has_origins: bool = True

    def add(self, name: str, parser: argparse.ArgumentParser) -> None:
        """Add the command's arguments to its parser."""
        from firm_hdl.arguments import add_origins

        if self.has_origins:
            add_origins(parser)
        getattr(import_module(f"firm_hdl.{self.module}"), f"add_{name}")(parser)


COMMANDS: dict[str, Command] = {
    "build": Command(
        help="write the converters of message types",
        module="cli.building",
        examples=(
            "firm-hdl build geometry_msgs/msg/Twist --bus-bytes 4",
            "firm-hdl build my_msgs/msg/Spot --path src",
        ),
    ),
    "list": Command(
        help="list all messages, services and actions",
        module="cli.reading",
        examples=(
            "firm-hdl list --distro humble",
            "firm-hdl list --path src --only-path",
        ),
    ),
    "show": Command(
        help="print a type as ROS's own tools do",
        module="cli.reading",
        examples=(
            "firm-hdl show sensor_msgs/msg/Imu",
            "firm-hdl show src/my_msgs/msg/Spot.msg",
        ),
    ),
    "plan": Command(
        help="print what converters do in each cycle, as YAML",
        module="cli.building",
        examples=("firm-hdl plan geometry_msgs/msg/Twist --bus-bytes 4",),
    ),
    "info": Command(
        help="print how many cycles packets take, and which clock a line rate needs",
        module="cli.building",
        examples=(
            "firm-hdl info sensor_msgs/msg/Imu",
            "firm-hdl info sensor_msgs/msg/Imu --json",
        ),
    ),
    "part": Command(
        help="write a part that stores, checks, merges or routes packets",
        module="cli.parts",
        has_origins=False,
        examples=(
            "firm-hdl part gate sensor_msgs/msg/Imu",
            "firm-hdl part fifo --memory-bytes 4096",
        ),
    ),
    "node": Command(
        help="write a design with several topics behind one link, print its figures, or run it "
        "in a graph of ROS",
        module="cli.nodes",
        has_origins=False,
        examples=(
            "firm-hdl node info double.yaml",
            "firm-hdl node build double.yaml",
            "firm-hdl node run double.yaml",
        ),
    ),
    "board": Command(
        help="write a project: a node beside the processor of a Kria or PYNQ-Z2, or a SoC of LiteX",
        module="cli.boards",
        has_origins=False,
        examples=(
            "firm-hdl board init kria",
            "firm-hdl board init pynq node.yaml --out my_board",
            "firm-hdl board init litex my_msgs/msg/Spot --path src",
        ),
    ),
    "verify": Command(
        help="test converters against ROS's own libraries",
        module="verify.command",
        has_origins=False,
        examples=(
            "firm-hdl verify sensor_msgs/msg/Imu",
            "firm-hdl verify --all --path src",
            "firm-hdl verify sensor_msgs/msg/Imu --simulator ghdl",
        ),
    ),
    "report": Command(
        help="write a report of results of verify, as HTML, Markdown or JSON",
        module="verify.report.formats",
        has_origins=False,
        examples=(
            "firm-hdl verify --all --results all.jsonl",
            "firm-hdl report all.jsonl --out all.html",
        ),
    ),
    "prove": Command(
        help="prove that the VHDL is equivalent to Amaranth's circuit",
        module="equivalence.command",
        examples=("firm-hdl prove std_msgs/msg/Header",),
    ),
    "bench": Command(
        help="measure converters on an FPGA: area, clock rate, cycles",
        module="bench.command",
        examples=("firm-hdl bench std_msgs/msg/Header --device ice40",),
    ),
    "golden": Command(
        help="compare plans with golden ones, by meaning",
        module="verify.ts2.golden",
        examples=(
            "firm-hdl golden add plans sensor_msgs/msg/Imu",
            "firm-hdl golden check plans",
        ),
    ),
    "cover": Command(
        help="choose a few types that have every feature",
        module="covering.command",
        examples=("firm-hdl cover --path src --out types.txt",),
    ),
    "doctor": Command(
        help="say which tools, graphs and libraries are here, what they are for, and how to get "
        "the others",
        module="cli.doctor",
        examples=("firm-hdl doctor", "firm-hdl doctor --json"),
        has_origins=False,
    ),
    "md5": Command(
        help="print the md5 sums of ROS 1 types",
        module="cli.reading",
        examples=("firm-hdl md5 std_msgs/String",),
    ),
    "hash": Command(
        help="print the type hashes (RIHS01) of ROS 2 types",
        module="cli.reading",
        examples=("firm-hdl hash std_msgs/msg/String",),
    ),
    "proto": Command(
        help="print an example of a type as ROS's own tools do",
        module="cli.reading",
        examples=("firm-hdl proto geometry_msgs/msg/Twist",),
    ),
    "metrics": Command(
        help="print figures of message types: depth, leaves, sizes, alignment, features",
        module="cli.reading",
        examples=("firm-hdl metrics --all --path src --format csv",),
    ),
}
"""All commands by name, in the order in which ``--help`` lists them."""
