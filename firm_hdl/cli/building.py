"""The commands that turn definitions into converters: ``build``, ``plan`` and ``info``."""

from __future__ import annotations

import argparse
import os
from typing import TYPE_CHECKING

from firm_hdl.arguments import TYPE_HELP, add_jobs, add_json, add_options
from firm_hdl.cli.types import library_of
from firm_hdl.export.options import EXTRAS, IPS, LEAF_PORTS, PORTS, Extra, Options
from firm_hdl.garbage import search_rarely
from firm_hdl.terminal import stage

if TYPE_CHECKING:
    from firm_hdl.export.build import Built
    from firm_hdl.export.design import BuiltDesign
    from firm_hdl.model import Message
    from firm_hdl.plan import Plan

__all__ = ["add_build", "add_info", "add_ip", "add_plan", "tell"]


def add_ip(command: argparse._ActionsContainer) -> None:
    """Add ``--ip``."""
    command.add_argument(
        "--ip",
        choices=IPS,
        help="also write IP for this tool: vivado and quartus, a folder ip with a component for "
        "each design; litex, a Python file with its modules",
    )


class _Gone(argparse.Action):
    """An option that was removed; the error says why."""

    def __call__(self, *_: object) -> None:
        raise argparse.ArgumentError(
            self, "there is no such option any more: converters take two bus words in each cycle"
        )


def add_build(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl build``."""
    _add_types(command)
    _add_options(command)
    command.add_argument("--out", default="vhdl_out", help="folder to write to (%(default)s)")
    command.add_argument(
        "--ports",
        choices=PORTS,
        default="records",
        help="whether the VHDL has records, or plain vectors only; default: %(default)s",
    )
    command.add_argument(
        "--with",
        dest="extras",
        type=_extras,
        default=frozenset(),
        metavar="EXTRA,...",
        help=f"more files: {', '.join(EXTRAS)}, or all",
    )
    command.add_argument(
        "--datasheet",
        action="store_true",
        help="also write datasheet.html, with pictures, ports, cycles and area; --with documents",
    )
    command.add_argument(
        "--registers",
        action="store_true",
        help="also write converters whose messages are registers on AXI4-Lite, with SystemRDL and "
        "C headers; of fields of fixed size",
    )
    add_ip(command)
    command.add_argument(
        "--leaf-ports",
        choices=LEAF_PORTS,
        help="axis: also modules whose leaves are AXI4-Stream, m_axis_linear_x_tdata; "
        "default: plain, but axis with --ip",
    )
    command.add_argument("--force", action="store_true", help="also write folders that are current")
    add_jobs(command)
    command.set_defaults(run=_build)


def _extras(text: str) -> frozenset[Extra]:
    """Read names of extras, separated by commas."""
    chosen = {each for name in text.split(",") for each in (EXTRAS if name == "all" else [name])}
    if unknown := chosen - {*EXTRAS}:
        listed = ", ".join([*EXTRAS, "all"])
        raise argparse.ArgumentTypeError(f"{min(unknown)!r} is not one of {listed}")
    return frozenset(each for each in EXTRAS if each in chosen)


def _build(args: argparse.Namespace) -> None:
    from firm_hdl.frontend import load_all

    search_rarely()
    library = library_of(args)
    # Errors in definitions are reported before Amaranth is imported, which takes time.
    messages = load_all(library, args.types)
    stage(f"build: {messages[0].name}" if len(messages) == 1 else "build")
    from firm_hdl.export.build import build

    def packets_of(message: Message, plan: Plan) -> list[bytes]:
        # Import late: NumPy and rosbags take time, which a failing build does not need.
        from firm_hdl.cases.stimuli import stimuli

        return stimuli(message, plan)

    written = 0

    def report(built: Built) -> None:
        nonlocal written
        written += 1
        stage("build: types", written, len(messages))
        tell(built)

    done = build(
        args.types,
        args.out,
        library=library,
        options=Options(
            wire=args.wire,
            bus_bytes=args.bus_bytes,
            max_message_bytes=args.max_message_bytes,
            ports=args.ports,
            extras=args.extras | ({"documents"} if args.datasheet else set()),
            registers=args.registers,
            leaf_ports=args.leaf_ports or ("axis" if args.ip else "plain"),
            ip=args.ip,
        ),
        force=args.force,
        stimuli=packets_of,
        report=report,
        jobs=args.jobs,
    )
    for built in done:
        print(built.description)
    for built in done[:1]:
        script = built.folder / "vhdl" / "run_ghdl.sh"
        run = f"{script} runs a test bench in GHDL; " if script.is_file() else ""
        print(f"next: {run}--with all adds SystemVerilog, scripts and a datasheet")


def tell(built: Built | BuiltDesign, end: str = os.sep) -> None:
    """Print the name of a folder that was built, and those of files that made way and stay."""
    print(f"{'current' if built.was_current else 'wrote':8}{built.folder}{end}", flush=True)
    for name in built.kept:
        print(f"kept    {built.folder / name}, which you changed", flush=True)


def add_plan(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl plan``."""
    command.add_argument("type", metavar="TYPE", help=TYPE_HELP)
    command.add_argument(
        "--program",
        action="store_true",
        help="print what the circuits of both directions make of the plan: their states",
    )
    _add_options(command)
    command.set_defaults(run=_plan)


def _plan(args: argparse.Namespace) -> None:
    from firm_hdl.frontend import load_all
    from firm_hdl.plan import to_yaml
    from firm_hdl.program.table import program_text

    for index, message in enumerate(load_all(library_of(args), [args.type])):
        plan = _planned(message, args)
        if args.program:
            print("\n" * bool(index) + program_text(plan), end="")
        else:
            print("---\n" * bool(index) + to_yaml(plan), end="")


def add_info(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl info``."""
    _add_types(command)
    _add_options(command)
    add_json(command)
    command.set_defaults(run=_info)


def _info(args: argparse.Namespace) -> None:
    from firm_hdl.estimates import estimate_text
    from firm_hdl.frontend import load_all
    from firm_hdl.timing import describe, recovery_text, timing

    messages = args.document["messages"] = []
    for message in load_all(library_of(args), args.types):
        plan = _planned(message, args)
        figures = timing(plan)
        if args.as_json:
            # Not before a type can be carried: it imports much.
            from firm_hdl.export.manifest import figures_of

            messages.append(
                {
                    "name": message.name,
                    "wire": plan.wire,
                    "bus_bytes": plan.bus_bytes,
                    **figures_of(plan, figures),
                }
            )
            continue
        print(describe(message.name, plan, figures))
        print(recovery_text(figures))
        if estimate := estimate_text(plan):
            print(estimate)
    if not args.as_json:
        print("next: firm-hdl build, with the same arguments, writes them in VHDL and Verilog")


def _planned(message: Message, args: argparse.Namespace) -> Plan:
    from firm_hdl.export.build import plan_of

    return plan_of(message, args.wire, args.bus_bytes, args.max_message_bytes)


def _add_options(command: argparse.ArgumentParser) -> None:
    add_options(command)
    hidden = argparse.SUPPRESS
    command.add_argument("--window-words", action=_Gone, nargs="?", default=hidden, help=hidden)


def _add_types(command: argparse.ArgumentParser) -> None:
    command.add_argument("types", nargs="+", metavar="TYPE", help=TYPE_HELP)
