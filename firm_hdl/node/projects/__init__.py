"""Projects that put a node into a chip beside its processor: a block design of Vivado, and Linux.
:mod:`.converters` puts those of a type into a SoC of LiteX.

What Linux and ``xmutil`` take is in the manual of dfx-mgr and in AMD's firmware of the Kria. No
tool of AMD has read what is written here.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.files import write_new
from firm_hdl.node.build import design_name
from firm_hdl.node.description import Description
from firm_hdl.node.projects.notebook import notebook
from firm_hdl.node.register_map import register_map

__all__ = [
    "BOARDS",
    "EXAMPLE",
    "ProjectBoard",
    "board_named",
    "clock_problem",
    "render",
    "write_folder",
    "write_project",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class ProjectBoard:
    """A board, or boards that take the same files."""

    title: str  # For people.
    names: tuple[str, ...]  # Other names of the board.
    part: str  # The chip, as Vivado names it.
    # The PLL of the FPGA's clock, as boot loaders may set it. Linux divides its frequency.
    plls_mhz: tuple[int, ...]
    # Names of templates beside this module, in which `NAME` is that of the node.
    files: tuple[str, ...]


BOARDS = {
    "kria": ProjectBoard(
        title="Kria K26 (KV260, KR260)",
        names=("kv260", "kr260", "k26"),
        part="xck26-sfvc784-2LV-c",
        plls_mhz=(1000, 1500),
        files=("kria/README.md", "kria/Makefile", "kria/NAME.dtso", "kria/shell.json"),
    ),
    "pynq": ProjectBoard(
        title="PYNQ-Z2",
        names=("pynq-z2", "pynq-z1"),
        part="xc7z020clg400-1",
        plls_mhz=(1000,),
        files=("pynq/README.md", "pynq/Makefile"),
    ),
}

EXAMPLE = """\
# Each command comes back. firm-hdl's reference/node.md has the keys.
node: twist
distro: jazzy
clock_mhz: 100
link: axi_dma
accelerator: firm_hdl.node.loop:Loop
subscribe:
  /cmd_vel: {type: geometry_msgs/msg/Twist}
publish:
  /cmd_vel_back: {type: geometry_msgs/msg/Twist}
"""
"""The description of a project whose user has none yet."""


def board_named(name: str) -> str:
    """Return the key of a board in `BOARDS`, or ``litex``; raises `UserError` if it is neither."""
    known = {word: key for key, each in BOARDS.items() for word in (key, *each.names)}
    known["litex"] = "litex"
    if name.lower() in known:
        return known[name.lower()]
    close = get_close_matches(name.lower(), known, n=1, cutoff=0.5)
    hint = f"; did you mean '{close[0]}'?" if close else ""
    raise UserError(f"there are no projects for '{name}', but for {', '.join(known)}{hint}")


_DIVISORS = sorted({one * other for one in range(1, 64) for other in range(1, 64)})
"""Of a PLL: two numbers of 6 bits (UG585, UG1085)."""


def clock_problem(board: str, description: Description) -> str | None:
    """Return what is wrong with the clock of a node; `None` if the board makes it.

    * `board`: a key of `BOARDS`.
    """
    mhz = description.clock_hz / 1e6
    for pll in BOARDS[board].plls_mhz:
        real = min((pll / each for each in _DIVISORS), key=lambda each: abs(each - mhz))
        if abs(real / mhz - 1) > 1e-3:
            return (
                f"with a PLL of {pll} MHz, {BOARDS[board].title} runs the node at {real:.4g} MHz "
                f"in place of {mhz:g}, which neither its time nor its timing is made for; 50, "
                "62.5, 100 and 125 are safe values of clock_mhz"
            )
    return None


def write_project(
    board: str,
    description: Description,
    file: str | None,
    folder: str | os.PathLike[str] | None = None,
    *,
    sample: Sequence[bytes] = (),
) -> Path:
    """Write the project of a node into a new folder; return the folder.

    * `board`: a key of `BOARDS`.
    * `description`: its link is `axi_dma`.
    * `file`: the description; `None`: it is `EXAMPLE`, which becomes ``node.yaml`` in the folder.
    * `folder`: `None` is ``NODE_BOARD``.
    * `sample`: packets for the first subscription, of which a notebook sends one.

    Raises `DefinitionError` if the link is another one. Raises `UserError` if the folder exists, or
    cannot be written.
    """
    if description.link.kind != "axi_dma":
        raise DefinitionError.of(
            f"a project for '{board}' needs the link 'axi_dma', through which node and processor "
            f"exchange frames, not '{description.link.kind}'",
            description.link_span or description.node_span,
        )
    about, name = BOARDS[board], design_name(description)
    out = Path(folder or f"{name}_{board}")
    node = "node.yaml" if file is None else os.path.relpath(file, out)
    values: dict[str, Any] = {
        "name": name,
        "board": about,
        "family": board,
        "bus_bits": 8 * description.bus_bytes,
        "clock_mhz": f"{description.clock_hz / 1e6:g}",
        "clock_hz": round(description.clock_hz),
        "node": node,
        "node_word": shlex.quote(node),
        "node_file": shlex.quote(os.path.basename(node)),
        "has_accelerator": bool(description.accelerator),
        # Bits of an address of the node's own registers; 0: it has none on AXI.
        "register_bits": register_map(description).address_bits
        if description.registers == "axi4lite"
        else 0,
    }
    files = {
        template.rpartition("/")[2].replace("NAME", name): render(template, **values)
        for template in ("design.tcl", *about.files)
    }
    if board == "pynq":
        cells = notebook(description, name, node, sample)
        files[f"{name}.ipynb"] = json.dumps(cells, indent=1, ensure_ascii=False) + "\n"
    if file is None:
        files["node.yaml"] = EXAMPLE
    write_folder(out, files)
    return out


def write_folder(folder: Path, files: dict[str, str]) -> None:
    """Write files into a new folder, all or none.

    Raises `UserError` if the folder exists, or cannot be written.
    """
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir()
    except FileExistsError:
        raise UserError(
            f"'{folder}' is already there, and stays as it is; name another folder with --out"
        ) from None
    except OSError as error:
        raise UserError(f"cannot make '{folder}': {error.strerror or error}") from None
    try:
        for name, text in files.items():
            write_new(folder / name, text.encode())
    except BaseException as error:
        shutil.rmtree(folder, ignore_errors=True)
        if isinstance(error, OSError):
            raise UserError(f"cannot write '{folder}': {error.strerror or error}") from None
        raise


_templates = Environment(
    loader=FileSystemLoader(Path(__file__).parent),
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
    keep_trailing_newline=True,
)


def render(template: str, **values: Any) -> str:
    """Return the text of a template beside this module, whose name lacks its ``.j2``."""
    return _templates.get_template(f"{template}.j2").render(values)
