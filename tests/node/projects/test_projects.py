# amaranth: UnusedElaboratable=no
"""Projects of boards: block design and IP, device tree, commands, notebook."""

from __future__ import annotations

import atexit
import itertools
import json
import math
import re
import shutil
import subprocess
import sys
import threading
import time
import types
from collections import Counter
from dataclasses import replace
from importlib.machinery import ModuleSpec
from pathlib import Path

import numpy as np
import pytest

from firm_hdl.cli import main
from firm_hdl.errors import UserError
from firm_hdl.export.registers import register_maps
from firm_hdl.frontend import Library
from firm_hdl.node import Node, read_description
from firm_hdl.node.top import node_ports
from firm_hdl.plan import build_plan
from firm_hdl.registers import c_header
from firm_hdl.wire import lay_out
from tests.node.accelerators import echo_text
from tests.node.boards.dma_model import AxiDma
from tests.node.bridge.fakes import FakeNode
from tests.node.samples import PACKAGES
from tests.tools import need

LOOP = """\
node: little
link: {kind: axi_dma, buffer_bytes: 65520}
bus_bytes: BUS
clock_mhz: 75
accelerator: firm_hdl.node.loop:Loop
subscribe: {/cmd: {type: std_msgs/msg/Bool}}
publish: {/back: {type: std_msgs/msg/Bool}}
"""


def init(board, text, folder, name="node.yaml"):
    """Write a description and its project; return both paths."""
    file, out = folder / name, folder / "out"
    file.write_text(text)
    assert main(["board", "init", board, str(file), "-o", str(out)]) == 0
    return file, out


# Pins by the names of the manuals: PG201, PG082, PG021, PG164, PG247, PB046.
PINS = {
    "zynq_ultra_ps_e": (
        "in maxihpm0_fpd_aclk saxihp0_fpd_aclk pl_ps_irq0 out pl_clk0 pl_resetn0 "
        "master M_AXI_HPM0_FPD slave S_AXI_HP0_FPD"
    ),
    "processing_system7": (
        "in M_AXI_GP0_ACLK S_AXI_HP0_ACLK out FCLK_CLK0 FCLK_RESET0_N "
        "master M_AXI_GP0 slave S_AXI_HP0"
    ),
    "axi_dma": (
        "in s_axi_lite_aclk m_axi_mm2s_aclk m_axi_s2mm_aclk axi_resetn out mm2s_prmry_reset_out_n "
        "s2mm_prmry_reset_out_n mm2s_introut s2mm_introut master M_AXI_MM2S M_AXI_S2MM M_AXIS_MM2S "
        "slave S_AXI_LITE S_AXIS_S2MM"
    ),
    "proc_sys_reset": "in slowest_sync_clk ext_reset_in out peripheral_aresetn",
    "smartconnect": "in aclk aresetn slave S00_AXI S01_AXI master M00_AXI M01_AXI",
    "util_vector_logic": "in Op1 Op2 out Res",
    "ilvector_logic": "in Op1 Op2 out Res",
}


def pins_of(words):
    """Return the direction of each pin, and whether it is an interface."""
    found, way = {}, ""
    for word in words.split():
        if word in ("in", "out", "master", "slave"):
            way = word
        else:
            found[word] = way
    return found


def node_pins(description):
    """Return the pins of a node's IP: streams, and ports that are in none; and widths of ports."""
    found, widths = {}, {}
    for port in node_ports(Node(description)):
        stream = re.match(r"([sm])_axis(?=_t)|(s)_axi(?=_)", port.name)
        ways = {"s": "slave", "m": "master"}
        way = ways[stream[1] or stream[2]] if stream else port.direction
        found[stream[0] if stream else port.name] = way
        widths[port.name] = port.width
    return found, widths


RECORDER = """\
proc unknown {args} {puts [join $args \\x1f]; return [lindex $args end]}
proc get_board_parts {args} {return xilinx.com:k26c:part0:1.4}
proc get_ipdefs {args} {return {CATALOG}}
proc get_property {name object} {
  set values {CONFIG.ACTUAL 75.0007 STATS.WNS 0.5 STATS.WHS 0.01 STATS.TPWS 0 PROGRESS 100% VALUES}
  return [dict get $values [regsub {[.].*ACT_.*} $name .ACTUAL]]
}
source design.tcl
"""


@pytest.mark.parametrize(
    ("board", "bus", "gate", "more"),
    [
        ("kria", 8, "ip:util_vector_logic", "registers: axi4lite"),
        ("kria", 8, "inline_hdl:ilvector_logic:1.0", ""),
        ("pynq", 1, "", ""),
    ],
)
def test_the_block_design_connects_all_of_the_ip(tmp_path, board, bus, gate, more):
    file, out = init(board, LOOP.replace("BUS", str(bus)) + more, tmp_path)
    places = ("system.runs/impl_1", "system.gen/sources_1/bd/system/hw_handoff")
    for place, made in zip(places, ("system_wrapper.bit", "system.hwh"), strict=True):
        (out / "build/vivado" / place).mkdir(parents=True)
        (out / "build/vivado" / place / made).write_text(made)
    catalog = "gate" if "inline" in gate else ""
    command = [need("tclsh", shutil.which("tclsh")), "run.tcl"]

    def run(values=""):
        text = RECORDER.replace("CATALOG", catalog).replace("VALUES", values)
        (out / "run.tcl").write_text(text)
        return subprocess.run(command, cwd=out, capture_output=True, text=True, check=False)

    for values, said in (
        ("CONFIG.ACTUAL 76.92", "plans 76.92 MHz in place of 75"),
        ("STATS.WHS -0.01", "WHS is -0.01 ns"),
        ("STATS.TPWS -1", "TPWS is -1 ns"),
        ("STATS.WNS {}", "does not tell WNS"),
    ):
        done = run(values)
        assert done.returncode == 1 and said in done.stderr, done.stderr
        assert not (out / "build/little.bit").exists()
    done = run()
    assert done.returncode == 0, done.stderr
    assert (out / "build/little.bit").is_file() and (out / "build/little.hwh").is_file() == (
        board == "pynq"
    )
    calls = [line.split("\x1f") for line in re.split(r"\n(?=\w+\x1f)", done.stdout)]
    (repository,) = (call[2] for call in calls if call[:2] == ["set_property", "ip_repo_paths"])
    assert repository == str(out / "build/little/ip")
    own, widths = node_pins(read_description(file))
    kinds = {call[-1]: call[-2] for call in calls if call[0] == "create_bd_cell"}
    assert kinds["node"] == "firm-hdl:node:little"
    assert kinds.get("interrupt", "xilinx.com:") == f"xilinx.com:{gate}"
    assert kinds["ps"].endswith("zynq_ultra_ps_e" if board == "kria" else "processing_system7")
    ways = {
        f"{cell}/{pin}": way
        for cell, kind in kinds.items()
        for pin, way in (own if cell == "node" else pins_of(PINS[kind.split(":")[2]])).items()
    }
    # Inputs that are open on purpose: one of a SmartConnect with one slave, and no pins of a node.
    del ways["control/S01_AXI"], ways["memory/M01_AXI"]
    if not more:
        del ways["control/M01_AXI"]
    wires = Counter()
    for call in calls:
        if call[0].startswith("connect_bd_"):
            one, other = call[1:]
            both = {ways[one], ways[other]}
            assert both == ({"out", "in"} if call[0] == "connect_bd_net" else {"master", "slave"})
            wires.update(each for each in (one, other) if ways[each] != "out")
    assert wires == {each: 1 for each, way in ways.items() if way != "out"}
    clock = {"kria": "ps/pl_clk0", "pynq": "ps/FCLK_CLK0"}[board]
    nets = {tuple(call[1:]) for call in calls if call[0] == "connect_bd_net"}
    assert {to for by, to in nets if by == clock} == {
        pin for pin, way in ways.items() if way == "in" and re.search("clk$", pin, re.I)
    }
    for channel in ("mm2s", "s2mm"):
        assert (f"dma/{channel}_prmry_reset_out_n", f"node/{channel}_aresetn") in nets
    streams = {frozenset(call[1:]) for call in calls if call[0] == "connect_bd_intf_net"}
    assert {"dma/M_AXIS_MM2S", "node/s_axis"} in streams
    assert {"dma/S_AXIS_S2MM", "node/m_axis"} in streams
    settings = {
        call[-1]: call[2].split() for call in calls if call[:2] == ["set_property", "-dict"]
    }
    dma = dict(zip(settings["dma"][::2], settings["dma"][1::2], strict=True))
    width = widths["s_axis_tdata"]
    assert dma["CONFIG.c_m_axis_mm2s_tdata_width"] == f"{{{width}}}" and width == 8 * bus
    assert dma["CONFIG.c_include_sg"] == "{0}" and dma["CONFIG.c_sg_length_width"] == "{16}"
    assert "{75}" in settings["ps"]


BASE = """\
/dts-v1/;
/ {
	#address-cells = <2>;
	#size-cells = <2>;
	gic: interrupt-controller { phandle = <1>; interrupt-controller; #interrupt-cells = <3>; };
	zynqmp_clk: clock-controller { phandle = <2>; #clock-cells = <1>; };
	zynqmp_reset: reset-controller { phandle = <3>; #reset-cells = <1>; };
	fpga_full: fpga-full { };
	amba: axi { #address-cells = <2>; #size-cells = <2>; };
};
"""


@pytest.mark.parametrize("name", ["node.yaml", "it's $my #1 node.yaml"])
def test_make_makes_what_xmutil_loads(tmp_path, monkeypatch, name):
    for tool in ("make", "dtc", "fdtget", "fdtoverlay"):
        need(tool, shutil.which(tool))
    file, out = init("kria", LOOP.replace("BUS", "8"), tmp_path, name)
    tools = {
        "firm-hdl": "mkdir -p build/little; file=build/little/manifest.json; "
        '[ -e $file ] || printf "%s\\n" "$@" >$file',
        "vivado": 'echo "$@" >>vivado.txt; echo bits >build/little.bit',
        "bootgen": 'cp "$(sed -n "s/.* = pl\\] //p" "$2")" "$6"',
    }
    for tool, text in tools.items():
        (tmp_path / tool).write_text(f"#!/bin/sh\n{text}\n")
        (tmp_path / tool).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{Path('/bin')}:{Path('/usr/bin')}")
    for _ in range(2):
        done = subprocess.run(["make"], cwd=out, capture_output=True, text=True, check=False)
        assert done.returncode == 0 and not done.stderr, done.stderr
    asked = (out / "build/little/manifest.json").read_text().splitlines()
    assert asked[:2] == ["node", "build"] and (out / asked[2]).samefile(file)
    assert len((out / "vivado.txt").read_text().splitlines()) == 1
    app = out / "app/little"
    assert {each.name for each in app.iterdir()} == {
        *("little.bit.bin", "little.dtbo", "shell.json")
    }
    assert (app / "little.bit.bin").read_text() == "bits\n"
    assert json.loads((app / "shell.json").read_text()) == {
        "shell_type": "XRT_FLAT",
        "num_slots": "1",
    }
    # The overlay finds its labels in a tree like that of a Kria.
    (tmp_path / "base.dts").write_text(BASE)
    whole = str(tmp_path / "whole.dtb")
    for command in (
        ["dtc", "-q", "-@", "-O", "dtb", "-o", "base.dtb", "base.dts"],
        ["fdtoverlay", "-i", "base.dtb", "-o", whole, str(app / "little.dtbo")],
    ):
        subprocess.run(command, cwd=tmp_path, check=True)

    numbers = {
        "/axi/dma@a0000000 reg": "0 a0000000 0 10000",
        "/axi/dma@a0000000 interrupts": "0 59 4",
        "/axi/dma@a0000000 interrupt-parent": "1",
        "/axi/dma@a0000000 xlnx,sg-length-width": "10",
        "/axi/udmabuf0 size": "100000",
        "/axi/clocking0 assigned-clock-rates": f"{75_000_000:x}",
        "/fpga-full resets": "3 74",
    }
    for kind, wanted in (("x", numbers), ("s", {"/fpga-full firmware-name": "little.bit.bin"})):
        words = " ".join(wanted).split()
        command = ["fdtget", "-t", kind, whole, *words]
        read = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        assert read.splitlines() == [*wanted.values()]


S2MM_DMASR, HALTED = 0x34, 1


class Memory(np.ndarray):
    """A buffer of PYNQ, of which the DMA sees what was flushed."""

    def __array_finalize__(self, other):
        self.shared = getattr(other, "shared", None)

    def _part(self):
        start = self.__array_interface__["data"][0] - self.shared[0]
        assert start % 64 == self.nbytes % 64 == 0
        return slice(start, start + self.nbytes)

    def flush(self):
        self.shared[1][self._part()] = self

    def invalidate(self):
        self[:] = self.shared[1][self._part()]


class Fabric:
    """A node on the streams of a DMA."""

    has_sent = True

    def __init__(self, node):
        self.node = node

    def __call__(self, frame):
        self.dma.packets += self.node.take(frame)

    send = __call__

    def let_packet_come(self):
        pass

    reset = let_packet_come


class Clocks(type):
    """PYNQ's clocks, with a PLL of 1000 MHz; at first, divisors for one of 1600 MHz are set."""

    divisors = 16, 1

    @property
    def fclk0_mhz(cls):
        return 1000 / math.prod(cls.divisors)

    @fclk0_mhz.setter
    def fclk0_mhz(cls, mhz):
        both = itertools.product(range(1, 64), repeat=2)
        cls.divisors = min(both, key=lambda each: abs(1000 / math.prod(each) - mhz))


def fake_pynq(node, address=0x1000_0000, size=1 << 19):
    """Return a module like PYNQ's: an overlay with a DMA, and a node behind it."""
    seen, lock = np.zeros(size, "u1"), threading.RLock()
    fabric = Fabric(node)
    fabric.dma = dma = AxiDma(memoryview(seen), address, fabric, length_bits=16)
    is_loading, stuck = threading.Event(), []

    class Mmio:
        def __init__(self, where, length):
            assert (where, length) == (0x4040_0000, 0x10000)

        def read(self, offset):
            with lock:
                if is_loading.is_set():
                    stuck.append(offset)
                dma.step()
                return dma.read(offset)

        def write(self, offset, value):
            with lock:
                dma.write(offset, value)

    class Overlay:
        def __init__(self, file):
            assert file == "echo.bit"
            parameters = {"c_sg_length_width": "16"}
            self.ip_dict = {
                "dma": {
                    "phys_addr": 0x4040_0000,
                    "addr_range": 0x10000,
                    "parameters": parameters,
                }
            }
            self.download()

        def download(self):
            is_loading.set()
            time.sleep(0.02)
            is_loading.clear()

    def allocate(shape, dtype):
        array = np.zeros(shape, dtype).view(Memory)
        array.shared, array.device_address = (array.__array_interface__["data"][0], seen), address
        return array

    module = types.ModuleType("pynq")
    module.__spec__ = ModuleSpec("pynq", None)
    module.MMIO, module.Overlay, module.allocate = Mmio, Overlay, allocate
    module.Clocks = Clocks("Clocks", (), {})
    module.dma, module.stuck = dma, stuck
    return module


def test_the_notebook_runs_on_pynq(tmp_path, monkeypatch, capsys):
    text = echo_text(link="axi_dma", paths=str(PACKAGES))
    file, out = init("pynq", text, tmp_path)
    book = json.loads((out / "echo.ipynb").read_text())
    cells = ["".join(cell["source"]) for cell in book["cells"] if cell["cell_type"] == "code"]
    node = FakeNode(read_description(file).fingerprint)
    module = fake_pynq(node)
    monkeypatch.setitem(sys.modules, "pynq", module)
    monkeypatch.delitem(sys.modules, "firm_hdl.node.boards.pynq", raising=False)
    monkeypatch.chdir(out)
    at_exit = []
    monkeypatch.setattr(atexit, "register", lambda each: at_exit.append(each) or each)
    values = {}
    shown = []
    for cell in cells:
        *lines, last = cell.splitlines()
        exec("\n".join(lines), values)
        try:
            shown.append(eval(last, values))
        except SyntaxError:
            exec(last, values)
    assert values["packet"].hex() in shown and any(values["packet"][4:])
    assert any("std_msgs__msg__String" in type(each).__name__ for each in shown)
    printed = capsys.readouterr().out
    assert "\nPYNQ loads echo.bit\nboard pynq: ready\n" in printed
    assert re.search(r"/heard +subscribe +1 +0\n/said +publish +0 +1\n", printed)
    # The clock is that of the description, or none.
    assert module.Clocks.fclk0_mhz == 100
    # Nothing reads while the FPGA is loaded, and the DMA stops: in the first cell once more, in a
    # download beside an open node, and at the end of the program.
    for _ in range(2):
        exec(cells[0], values)
    assert not module.dma.read(S2MM_DMASR) & HALTED
    for _ in range(2):
        values["NodeOverlay"]("echo.bit")
    assert not module.stuck and module.dma.read(S2MM_DMASR) & HALTED
    exec(cells[0], values)
    assert not module.dma.read(S2MM_DMASR) & HALTED
    for each in at_exit:
        each()
    assert module.dma.read(S2MM_DMASR) & HALTED
    values["node"].close()
    other = replace(values["description"], clock_hz=75e6)
    with pytest.raises(UserError, match=r"nearest clock to 75 MHz is 76\.9231 MHz"):
        values["NodeOverlay"]("echo.bit").board(other)
    # Anything that names PYNQ's module would be stale in other tests.
    monkeypatch.delitem(sys.modules, "firm_hdl.node.boards.pynq")
    # No simulation takes the place of a PYNQ that cannot be imported.
    monkeypatch.delattr(module, "Clocks")
    with pytest.raises(ImportError, match="Clocks"):
        exec(cells[0], {})


MIXED = """\
uint8 int
float64 b
string name
bool c
Empty nothing
float32[2] f
Point[] points
"""
STUBS = {
    "stdio.h": "typedef int FILE;\nextern FILE *const stdout;\n#define FDEV_SETUP_STREAM(...) 0\n"
    "int printf(const char *, ...) __attribute__((format(printf, 1, 2)));\n",
    "generated/csr.h": "int uart_txfull_read(void), uart_txempty_read(void);\n"
    "int reader_messages_read(void), reader_errors_read(void);\n"
    "void uart_rxtx_write(int), report_ev_enable_write(int), main_finish_write(int);\n",
    "generated/mem.h": "#define COMMAND_BASE 0x1000UL\n#define REPORT_BASE 0x2000UL\n",
    "generated/soc.h": "#define REPORT_INTERRUPT 1\n",
    "irq.h": "void irq_setmask(unsigned), irq_setie(unsigned);\n",
}


def test_a_soc_of_litex_is_for_the_type_of_the_user(tmp_path, monkeypatch):
    package = tmp_path / "it's $my #1" / "mix_msgs"
    texts = {"Mixed": MIXED, "Empty": "", "Point": "float64 x\nint8 y\n"}
    for name, text in texts.items():
        (package / "msg" / f"{name}.msg").parent.mkdir(parents=True, exist_ok=True)
        (package / "msg" / f"{name}.msg").write_text(text)
    (package / "package.xml").write_text("<package><name>mix_msgs</name></package>")
    out = tmp_path / "out"
    type_file = str(package / "msg" / "Mixed.msg")
    assert main(["board", "init", "litex", type_file, "--distro", "jazzy", "-o", str(out)]) == 0
    soc, base = (out / "soc.py").read_text(), "mix_msgs_msg_Mixed_cdr_8"
    assert f'NAME = "{base}"' in soc and compile(soc, "soc.py", "exec")
    found = re.findall(r"self.reader.m_axis_(\w+).connect\(self.writer.s_axis_(\w+)\),", soc)
    leaves = (
        "int_field b name_length name_items c nothing_structure_needs_at_least_one_member f_items "
        "points_length points_item_x points_item_y"
    )
    assert found == [(each, each) for each in leaves.split()]
    # The firmware, with the headers of the build.
    message = Library("jazzy", paths=[package]).message("mix_msgs/msg/Mixed")
    layouts = register_maps(message, build_plan(lay_out(message), bus_bytes=8))
    headers = {f"{base}_{way}_registers.h": c_header(each) for way, each in layouts.items()}
    for name, text in (STUBS | headers).items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    cc = [need("a C compiler", shutil.which("cc")), "-fsyntax-only", "-Wall", "-Werror"]
    subprocess.run([*cc, "-I", tmp_path, out / "main.c"], check=True)
    # `make` asks for it with the user's folder.
    (tmp_path / "firm-hdl").write_text('#!/bin/sh\nprintf "%s\\n" "$@" >asked.txt\n')
    (tmp_path / "firm-hdl").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    make = [need("make", shutil.which("make")), f"work/jazzy/{base}/manifest.json"]
    subprocess.run(make, cwd=out, check=True)
    asked = (out / "asked.txt").read_text().splitlines()
    assert asked[:5] == ["build", "mix_msgs/msg/Mixed", "--distro", "jazzy", "--path"]
    assert (out / asked[5]).samefile(package)
    assert asked[6:] == ["--registers", "--ip", "litex", "--out", "work"]


def test_the_page_of_litex_quotes_the_project(tmp_path):
    assert main(["board", "init", "litex", "-o", str(tmp_path / "out")]) == 0
    page = (Path(__file__).parents[3] / "docs/howto/litex.md").read_text()
    quotes = re.findall(r"^```(py|c)\n(.*?)^```", page, re.M | re.S)
    files = {"py": "soc.py", "c": "main.c"}
    assert {kind for kind, _ in quotes} == files.keys()
    for kind, text in quotes:
        assert text in (tmp_path / "out" / files[kind]).read_text()


@pytest.mark.parametrize(
    ("board", "mhz", "warns"),
    [("kria", 75, True), ("kria", 62.5, False), ("pynq", 75, True), ("pynq", 66.7, False)],
)
def test_a_clock_that_no_divisor_makes_is_warned_of(tmp_path, capsys, board, mhz, warns):
    text = LOOP.replace("BUS", "8").replace("clock_mhz: 75", f"clock_mhz: {mhz}")
    init(board, text, tmp_path)
    assert ("runs the node at 76.92 MHz in place of 75" in capsys.readouterr().err) is warns


def test_what_is_no_project_is_refused_and_changes_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["board", "init", "kv261"]) == 1
    assert "there are no projects for 'kv261', but for kria, kv260" in capsys.readouterr().err
    for arguments, said in (
        (["std_msgs/msg/String"], "std_msgs/msg/String cannot have registers"),
        (["node.yaml"], "for a node, 'node build --ip litex' writes a module"),
    ):
        assert main(["board", "init", "litex", *arguments]) == 1
        assert said in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["board", "init", "kria", "--path", "."])
    assert "a node has its own" in capsys.readouterr().err
    Path("n.yaml").write_text("node: n\nlink: udp\nsubscribe: {/a: {type: std_msgs/msg/Bool}}\n")
    assert main(["board", "init", "KV260", "n.yaml"]) == 1
    assert "n.yaml:2:7: error: a project for 'kria' needs the link 'axi_dma'" in (
        capsys.readouterr().err
    )
    assert [each.name for each in tmp_path.iterdir()] == ["n.yaml"]
    assert main(["board", "init", "kria"]) == 0
    before = {each: each.read_text() for each in Path("twist_kria").iterdir()}
    assert main(["board", "init", "kria"]) == 1
    assert "'twist_kria' is already there, and stays as it is" in capsys.readouterr().err
    assert before == {each: each.read_text() for each in Path("twist_kria").iterdir()}
