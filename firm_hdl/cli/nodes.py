# amaranth: UnusedElaboratable=no
"""The command ``node``: designs with several topics behind one link."""

from __future__ import annotations

import argparse
import shlex
import sys
import warnings
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from firm_hdl.arguments import add_engine, add_json, add_path, number_between, seconds
from firm_hdl.cli.building import add_ip, tell
from firm_hdl.model import Message
from firm_hdl.plan import Plan
from firm_hdl.terminal import stage

if TYPE_CHECKING:
    from firm_hdl.export.design import BuiltDesign
    from firm_hdl.node import Description
    from firm_hdl.node.bitstream import Board

__all__ = ["add_node"]


def add_node(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl node``."""
    actions = command.add_subparsers(
        title="actions", dest="action", metavar="ACTION", required=True
    )
    for action, (text, add, examples) in _ACTIONS.items():
        sub = actions.add_parser(
            action,
            help=text,
            description=f"{text[0].upper()}{text[1:]}.",
            examples=examples,
        )
        sub.add_argument(
            "file",
            metavar="FILE",
            help="description of the node, in YAML; reference/node.md of the documentation has its "
            "keys, and firm-hdl doctor says where the documentation is",
        )
        add_path(sub)
        add(sub)
    command.set_defaults(run=_node)


def _add_new(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--language",
        choices=["amaranth", "vhdl", "verilog", "sv"],
        help="language of the accelerator (default: that of the description, else amaranth)",
    )
    command.add_argument(
        "--ports",
        choices=["plain", "records", "structs"],
        help="ports of VHDL or SystemVerilog: records or structs are one for each message "
        "(default: those of the description, else plain)",
    )


def _add_info(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--members",
        action="store_true",
        help="also list the fields that an accelerator has to take and to offer",
    )
    add_json(command)


class _Board(argparse.Action):
    """Keep the board that is named; `list` prints all, and needs no description."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        if values == "list":
            from firm_hdl.node.bitstream import board_list

            print("\n".join(board_list()))
            parser.exit()
        setattr(namespace, self.dest, values)


def _add_build(command: argparse.ArgumentParser) -> None:
    command.add_argument("--out", default="node_out", help="folder to write to (%(default)s)")
    command.add_argument(
        "--datasheet",
        action="store_true",
        help="also write datasheet.html, with topics, ports, pictures, cycles and area",
    )
    add_ip(command)
    command.add_argument("--force", action="store_true", help="also write a folder that is current")
    command.add_argument(
        "--sim", action="store_true", help="also compile the simulation, for firm-hdl node run"
    )
    add_engine(command, "--sim")
    command.add_argument(
        "--board",
        # `--board` of other actions is how a board is reached.
        dest="target",
        action=_Board,
        metavar="BOARD",
        help="also make the bitstream of a board: its name, or a file in YAML; list prints all",
    )


def _add_run(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--board",
        default="sim",
        metavar="BOARD",
        help="sim, udp://HOST[:PORT], tcp://HOST:PORT, serial:///dev/DEVICE[?baud=RATE] or "
        "zynq://UIO/BUFFER (%(default)s)",
    )
    command.add_argument(
        "--graph",
        choices=["ros2", "ros1", "rtps", "none"],
        help="ros2 is rclpy if an environment of ROS 2 is active, else rtps; rtps needs "
        "no ROS; ros1 is rospy; none: lines of JSON (default: by the distro)",
    )
    command.add_argument("--domain", type=_domain, help="domain of ROS 2 (ROS_DOMAIN_ID)")
    command.add_argument("--interface", help="network interface of rtps, such as lo")
    command.add_argument("--seconds", type=seconds, help="end after so long (default: at Ctrl-C)")
    command.add_argument(
        "--wave",
        metavar="FILE",
        type=Path,
        help="write the waveform of --board sim, as VCD or FST (FILE.vcd, FILE.fst)",
    )
    add_engine(command, "--board sim")
    command.add_argument(
        "--phc",
        metavar="DEVICE",
        help="let the clock of the node follow a PTP hardware clock, such as /dev/ptp0 (default: "
        "the clock of the system)",
    )
    command.add_argument("--quiet", action="store_true", help="print no figures")


_ACTIONS: dict[str, tuple[str, Callable[[argparse.ArgumentParser], None], tuple[str, ...]]] = {
    "new": (
        "write a file to begin the accelerator with, beside the description",
        _add_new,
        ("firm-hdl node new double.yaml --language vhdl",),
    ),
    "info": (
        "check a description and its accelerator, and print topics, sizes, cycles, clocks and area",
        _add_info,
        ("firm-hdl node info double.yaml",),
    ),
    "build": (
        "write the design as VHDL and Verilog, with benches",
        _add_build,
        (
            "firm-hdl node build double.yaml --out node_out",
            "firm-hdl node build double.yaml --board ulx3s-85f",
        ),
    ),
    "run": (
        "join a board, or the design in simulation, with a graph of ROS",
        _add_run,
        (
            "firm-hdl node run double.yaml",
            "firm-hdl node run double.yaml --graph none --seconds 60",
            "firm-hdl node run double.yaml --board udp://192.168.1.50",
        ),
    ),
}
"""Help, function that adds the arguments, and examples of each action."""


def _domain(text: str) -> int:
    return number_between(text, 0, 232)


def _stimuli(message: Message, plan: Plan) -> list[bytes]:
    # rosbags takes time to import, and only benches need it.
    from firm_hdl.cases.stimuli import stimuli

    return stimuli(message, plan)


def _node(args: argparse.Namespace) -> None:
    from firm_hdl.errors import DefinitionError
    from firm_hdl.node import read_description

    description = read_description(args.file, paths=args.path)
    try:
        if args.action == "info" and description.accelerator:
            from firm_hdl.node.accelerator import elaborate_accelerator, load_accelerator

            elaborate_accelerator(description, load_accelerator(description), None)
            _leave_unused()
        _act(args, description)
    except DefinitionError:
        # A mistake of an accelerator leaves circuits unfinished.
        _leave_unused()
        raise


def _leave_unused() -> None:
    """Let Amaranth not warn of circuits that were made and not used."""
    if (hdl := sys.modules.get("amaranth.hdl")) is not None:
        warnings.simplefilter("ignore", hdl.UnusedElaboratable)


def _act(args: argparse.Namespace, description: Description) -> None:
    if args.action == "new":
        from firm_hdl.node.hdl import new_accelerator

        with_records = args.ports in ("records", "structs")
        place, value = new_accelerator(description, args.language, with_records=with_records)
        print(f"wrote   {place}")
        if not description.accelerator:
            print(f"Add this line to {args.file}:\n\naccelerator: {value}")
        if "ports: " in value:
            print(
                "\nfirm-hdl adds the packages with the types itself. firm-hdl node build writes "
                "them, too, for benches and editors."
            )
        return
    if args.action == "run":
        from firm_hdl.node.bridge.command import run_bridge

        run_bridge(
            description,
            args.board,
            graph=args.graph,
            domain=args.domain,
            interface=args.interface,
            seconds=args.seconds,
            engine=args.engine,
            quiet=args.quiet,
            wave=args.wave,
            phc=args.phc,
        )
        return
    from firm_hdl.node.summary import facts_of, summary, warnings_of

    if args.action == "info" and args.as_json:
        facts = facts_of(description)
        args.document |= {**facts, "warnings": list(warnings_of(description, facts))}
        if args.members:
            from firm_hdl.node.hdl.members import accelerator_streams

            args.document["members"] = [
                {
                    "topic": each.topic.name,
                    "message": each.message,
                    "member": each.member,
                    "direction": each.direction,
                    "type": each.type,
                    "ports": [asdict(port) for port in each.ports],
                }
                for each in accelerator_streams(description)
            ]
        return
    if args.action == "build":
        from firm_hdl.node.bitstream import read_board
        from firm_hdl.node.bitstream.top import board_top
        from firm_hdl.node.build import build_node
        from firm_hdl.node.node import Node
        from firm_hdl.node.top import node_ports

        # What is wrong with it is found before anything is written.
        board = None if args.target is None else read_board(args.target)
        if board is not None:
            ports = [asdict(port) for port in node_ports(Node(description))]
            board_top(description, ports, "", board)
        options: dict[str, Any] = {
            "stimuli": _stimuli,
            "datasheet": args.datasheet,
            "ip": args.ip,
        }
        built = build_node(description, args.out, force=args.force, **options)
        tell(built, end="")
        if args.sim:
            _compile(description, args)
    print(summary(description))
    if args.action == "build" and board is not None:
        _make_bitstream(description, built, board, force=args.force)
        if args.datasheet:
            # It says what was reached.
            build_node(description, args.out, **options)
    if args.action == "info" and args.members:
        from firm_hdl.node.hdl.members import members_text

        print(f"\n{members_text(description)}")


def _make_bitstream(
    description: Description, built: BuiltDesign, board: Board, *, force: bool
) -> None:
    from firm_hdl.node.bitstream.build import build_bitstream

    def report(text: str) -> None:
        print(f"board {board.name}: {text}", file=sys.stderr, flush=True)
        stage(f"board {board.name}: {text}")

    sys.stdout.flush()
    made = build_bitstream(description, built, board, force=force, report=report)
    print(f"\n{'current' if made.was_current else 'wrote':8}{made.file.parent}")
    for clock in made.facts["clocks"].values():
        print(f"clock   {clock['needed_mhz']:g} MHz needed, {clock['reached_mhz']:g} MHz reached")
    used = ", ".join(f"{name} {n} of {of}" for name, (n, of) in made.facts["cells"].items())
    print(f"cells   {used}")
    name = shlex.quote(str(made.file))
    load = board.load if "{bitstream}" in board.load else f"{board.load} {{bitstream}}"
    print(f"load    {load.replace('{bitstream}', name)}")
    print("No board was at hand: the bitstream was never tried on one.")


def _compile(description: Description, args: argparse.Namespace) -> None:
    from firm_hdl.node.boards.simulated import SimulatedBoard

    def report(text: str) -> None:
        print(f"board sim: {text}", file=sys.stderr, flush=True)
        stage(f"board sim: {text}")

    SimulatedBoard(description, engine=args.engine, report=report).compile()
