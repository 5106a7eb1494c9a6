"""The command ``part``: packet parts as designs of their own."""

from __future__ import annotations

import argparse

from firm_hdl.arguments import add_bus_bytes, add_options, add_origins, number_between
from firm_hdl.cli.building import tell
from firm_hdl.cli.types import library_of

__all__ = ["add_part"]

# Default, least and largest number, and the help text.
_NUMBERS = {
    "memory_bytes": (1 << 16, 1, 1 << 20, "size of the memory, a power of two"),
    "packets": (64, 1, 1 << 12, "most packets that are stored"),
    "beats": (16, 1, 1 << 16, "beats in the FIFO, a power of two"),
    "inputs": (2, 1, 64, "number of inputs"),
    "topics": (2, 1, 64, "number of outputs"),
    "topic_bits": (16, 1, 32, "bits of tdest"),
    "side_bits": (0, 0, 1024, "bits beside each beat, as tuser"),
}


def add_part(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl part``."""
    from firm_hdl.export.parts import KINDS

    kinds = command.add_subparsers(dest="kind", metavar="PART", required=True)
    for kind, about in KINDS.items():
        text = about.text
        part = kinds.add_parser(kind, help=text, description=f"Write a part: {text}.")
        if kind == "gate":
            add_origins(part)
            part.add_argument("type", metavar="TYPE", help="such as sensor_msgs/msg/Imu")
            add_options(part)
        elif "bus_bytes" in about.parameters:
            add_bus_bytes(part)
        for name in about.parameters:
            _add_parameter(part, name)
        part.add_argument("--name", type=_name, help="name of the design; default: by its options")
        part.add_argument("--out", default="parts_out", help="folder to write to (%(default)s)")
        part.add_argument(
            "--force", action="store_true", help="also write a folder that is current"
        )
    command.set_defaults(run=_part)


def _add_parameter(part: argparse.ArgumentParser, name: str) -> None:
    option = f"--{name.replace('_', '-')}"
    if name in _NUMBERS:
        default, least, most, text = _NUMBERS[name]

        def number(value: str) -> int:
            return number_between(value, least, most)

        part.add_argument(
            option, type=number, default=default, metavar="N", help=f"{text}; default: %(default)s"
        )
    elif name == "when_full":
        part.add_argument(
            option,
            choices=["wait", "drop"],
            default="wait",
            help="without room, hold the link, or drop the packet; default: %(default)s",
        )
    elif name in ("in_bytes", "out_bytes"):
        from firm_hdl.plan import BUS_BYTES

        part.add_argument(
            option,
            type=int,
            choices=BUS_BYTES,
            required=True,
            metavar="N",
            help=f"bytes per beat: {', '.join(map(str, BUS_BYTES))}",
        )


def _name(text: str) -> str:
    from firm_hdl.names.identifiers import identifier

    if identifier(text) != text:
        raise argparse.ArgumentTypeError(f"{text!r} is not a name in VHDL and Verilog")
    return text


def _part(args: argparse.Namespace) -> None:
    message = library_of(args).message(args.type) if args.kind == "gate" else None
    from firm_hdl.export.parts import KINDS, build_part, make_part

    given = {name: getattr(args, name) for name in KINDS[args.kind].parameters}
    part = make_part(args.kind, message=message, name=args.name, **given)
    built = build_part(part, args.out, force=args.force)
    tell(built)
