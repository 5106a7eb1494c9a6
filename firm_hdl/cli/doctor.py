"""The command ``doctor``: what is installed here, what each enables, and how to get the rest.

Everything is found by the functions that the other commands find it with.
"""

from __future__ import annotations

import argparse
import os
import platform
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from glob import glob
from importlib import import_module, metadata
from importlib.util import find_spec
from pathlib import Path
from textwrap import indent
from typing import TYPE_CHECKING

from firm_hdl.arguments import add_json
from firm_hdl.errors import UserError, described
from firm_hdl.jobs import ToolError, run_tool

if TYPE_CHECKING:
    from firm_hdl.jobs.programs import Program
    from firm_hdl.node.bitstream.families import Family
    from firm_hdl.verify.simulators.programs import TextSimulator

__all__ = ["add_doctor", "documentation"]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Item:
    """Something that may be installed."""

    group: str
    name: str
    version: str | None  # `None`: it is not here.
    enables: str
    how: str = ""  # How to get it, if it is not here.


def add_doctor(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl doctor``."""
    add_json(command)
    command.set_defaults(run=_doctor)


def _doctor(args: argparse.Namespace) -> None:
    import firm_hdl

    versions = {"firm_hdl": firm_hdl.__version__, "python": platform.python_version()}
    pages = documentation()
    args.document |= {**versions, "prefix": sys.prefix, "documentation": pages, "items": []}
    if not args.as_json:
        print(f"firm-hdl {versions['firm_hdl']}, Python {versions['python']} in {sys.prefix}")
        print(f"documentation: {pages or 'not installed'}")
    group = ""
    for item in _items():
        args.document["items"].append({**asdict(item), "is_here": item.version is not None})
        if args.as_json:
            continue
        if item.group != group:
            group = item.group
            print(f"\n{group}")
        here = "no " if item.version is None else "yes"
        version = f" {item.version}" if item.version else ""
        print(f"  {here}  {item.name}{version}: {item.enables}", flush=True)
        if item.version is None and item.how:
            print(indent(item.how, " " * 7))


def documentation() -> str | None:
    """Return the first page of the documentation: in the installed package, or in a checkout."""
    import firm_hdl

    pages = [Path(firm_hdl.__file__).parent.parent / "docs" / "index.md"]
    try:
        files = metadata.distribution("firm-hdl").files or []
    except metadata.PackageNotFoundError:
        files = []
    # Resolved, because the folder is above that of packages.
    pages += [Path(str(each.locate())).resolve() for each in files if each.match("docs/index.md")]
    return next((str(page) for page in pages if page.is_file()), None)


def _items() -> Iterator[_Item]:
    yield from _programs()
    yield from _graphs()
    yield from _libraries()
    yield from _oracles()


def _found(group: str, name: str, enables: str, find: Callable[[], str]) -> _Item:
    """Look for something; `find` returns its version, or raises an error that says how to get it.

    A tool that is broken is none, and no reason to stop.
    """
    try:
        version = find().removeprefix(name).strip()
        return _Item(group=group, name=name, version=version, enables=enables)
    except Exception as error:
        how = str(error) if isinstance(error, ToolError) else described(error)
        return _Item(group=group, name=name, version=None, enables=enables, how=how)


def _programs() -> Iterator[_Item]:
    from firm_hdl.bench.devices import DEVICES
    from firm_hdl.bench.tools import find_nextpnr
    from firm_hdl.jobs.programs import find_compiler, find_verilator, find_yosys
    from firm_hdl.node.bitstream.families import FAMILIES
    from firm_hdl.verify.simulators.programs import SIMULATORS

    group = "Programs"
    uses = {
        "ghdl": ("GHDL", "benches in VHDL, verify --simulator ghdl, prove"),
        "iverilog": ("Icarus Verilog", "benches in Verilog, verify --simulator iverilog"),
        "verilator": ("verilator of the system", "verify --simulator verilator"),
    }
    for name, simulator in SIMULATORS.items():
        title, enables = uses.get(name, (name, f"verify --simulator {name}"))
        yield _found(group, title, enables, partial(_version_of, simulator))
    fast = "with the other of Verilator and a C++ compiler: fast simulation, as in node run"
    user = "A fast simulation"
    yield _found(group, "Verilator", fast, lambda: _said(find_verilator(user)))
    yield _found(group, "C++ compiler", fast, lambda: _said(find_compiler(user, with_zig=True)))
    # Packages of WebAssembly are not run here: each is compiled for a minute before its first run.
    install = ": pip install 'firm-hdl[prove]'"
    yield _found(group, "Yosys", "prove, bench", lambda: find_yosys(install, is_run=False).version)
    for device in DEVICES.values():
        if (placer := device.placer) is not None:
            find = partial(find_nextpnr, placer.package, placer.program, is_run=False)
            enables = f"clock rates in bench --device {device.name}"
            yield _found(group, placer.program, enables, partial(_tool_version, find))
    for family in FAMILIES:
        title = f"{family.placer} and {family.packer}"
        enables = f"with Yosys: node build --board for boards with {family.name}"
        yield _found(group, title, enables, partial(_board_tools, family))
    loads = "loads what node build --board makes"
    yield _found(group, "openFPGALoader", loads, _loader)


def _version_of(make: Callable[[], TextSimulator]) -> str:
    return make().version.partition("; ")[0]


def _tool_version(find: Callable[[], Program]) -> str:
    return find().version


def _board_tools(family: Family) -> str:
    from firm_hdl.node.bitstream.build import find_tools

    return find_tools(family, is_run=False).placer.version


def _loader() -> str:
    from firm_hdl.jobs.programs import find_program

    path = find_program("openFPGALoader", "OPENFPGALOADER", ["openFPGALoader"], "openfpgaloader")
    return _said([path]).removeprefix("openFPGALoader")


def _said(command: Sequence[str]) -> str:
    return run_tool([*command, "--version"]).strip().partition("\n")[0]


def _graphs() -> Iterator[_Item]:
    from firm_hdl.frontend.search import ENVIRONMENT, environment_origins

    group = "Graphs of ROS, for node run"
    for dialect, variable in ENVIRONMENT.items():
        origins = list(environment_origins(dialect, os.environ))
        packages = {package for origin in origins for package in origin.packages}
        ros = "ROS 1" if dialect == "ros1" else "ROS 2"
        yield _Item(
            group=group,
            name=f"workspace of {ros}",
            version=f"{len(packages)} packages" if origins else None,
            enables=f"types of its packages without --path ({variable})",
            how="source the setup file of the workspace",
        )
    yield _found(group, "rclpy", "--graph ros2 as a node of ROS 2 itself", _rclpy)
    yield _Item(
        group=group,
        name="rtps",
        version="",
        enables="--graph rtps: ROS 2 without an installation of ROS; part of firm-hdl",
    )
    yield _found(group, "rospy", "--graph ros1", _rospy)


def _rclpy() -> str:
    from firm_hdl.node.graphs.ros2 import has_rclpy

    if has_rclpy():
        return os.environ.get("ROS_DISTRO", "")
    found = sorted(glob("/opt/ros/*/local_setup.bash"))
    setup = (
        f"source {Path(found[-1]).with_name('setup.bash')}"
        if found
        else ("install ROS 2 and source its setup file")
    )
    raise UserError(
        f"{setup}; it has to be for Python {_python()}, which runs firm-hdl. Without it, "
        "--graph ros2 is rtps"
    )


def _rospy() -> str:
    try:
        return str(getattr(import_module("rospy"), "__version__", ""))
    except ImportError as error:
        missing = f"import rospy: {error}"
    from firm_hdl.verify.ros_python.worker import ROS_PYTHON

    if find_spec("rospy") is not None:
        raise UserError(missing)
    code = "import rospy, sys; print('.'.join(map(str, sys.version_info[:2])))"
    try:
        other = run_tool([ROS_PYTHON, "-c", code], with_errors=False).strip()
    except (ToolError, OSError):
        raise UserError(
            "source the setup file of ROS 1, or apt install python3-rospy (Debian, Ubuntu)"
        ) from None
    if other != _python():
        raise UserError(
            f"{ROS_PYTHON} has it, which is Python {other}, and firm-hdl runs in {_python()}: make "
            f"an environment with {ROS_PYTHON} -m venv --system-site-packages DIR, and install "
            "firm-hdl there"
        )
    raise UserError(
        f"{ROS_PYTHON} has it, and this environment does not see it: make the environment with "
        f"{ROS_PYTHON} -m venv --system-site-packages DIR, or write include-system-site-packages "
        f"= true into {os.path.join(sys.prefix, 'pyvenv.cfg')}"
    )


def _python() -> str:
    return ".".join(map(str, sys.version_info[:2]))


def _libraries() -> Iterator[_Item]:
    from firm_hdl.verify.references.clients import CLIENTS, WRITERS

    for name in CLIENTS:
        confirms = "; confirms bytes in verify" if name in WRITERS else ""
        enables = f"verify --sut {name}{confirms}"
        yield _found("Client libraries, for verify", name, enables, partial(_library, name))


def _library(name: str) -> str:
    from firm_hdl.verify.references.clients import find_clients

    versions, missing = find_clients([name])
    if missing:
        raise UserError(missing[name])
    return versions[name]


def _oracles() -> Iterator[_Item]:
    from firm_hdl.verify.ts1.oracles import ORACLES

    group = "Readers of definitions, for verify --systems ts1"
    for name in ORACLES:
        enables = f"verify --systems ts1 --oracle {name}"
        yield _found(group, name, enables, partial(_oracle, name))


def _oracle(name: str) -> str:
    from firm_hdl.frontend import DISTROS
    from firm_hdl.verify.ts1.oracles import ORACLES
    from firm_hdl.verify.ts1.universe import Universe

    kind = ORACLES[name]
    oracle = kind(Universe(next(d.name for d in DISTROS.values() if d.dialect in kind.languages)))
    try:
        if (why := oracle.missing()) is not None:
            raise UserError(why)
        return oracle.version()
    finally:
        oracle.close()
