# amaranth: UnusedElaboratable=no
"""Accelerators in VHDL, Verilog and SystemVerilog."""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.cli import main
from firm_hdl.equivalence.vhdl_side import read_vhdl
from firm_hdl.errors import DefinitionError
from firm_hdl.jobs.programs import find_ghdl
from firm_hdl.node import read_description
from firm_hdl.node.accelerator import load_accelerator
from firm_hdl.node.build import build_node
from firm_hdl.node.hdl import new_accelerator
from firm_hdl.node.hdl.copies import accelerator_files
from firm_hdl.node.hdl.netlist import verilog_of
from tests.node.samples import LIBRARY, PACKAGES
from tests.tools import run_script

DESCRIPTION = """\
node: Relay
distro: jazzy
bus_bytes: 4
subscribe:
  /came: {type: std_msgs/msg/UInt16}
  /text: {type: std_msgs/msg/String, memory_bytes: 256}
publish:
  /goes: {type: std_msgs/msg/UInt16}
serve:
  ~/calibrate: {type: robot_msgs/srv/Calibrate, memory_bytes: 256}
"""

PORT = "subscribe_came_data_data"


SMALL = """\
node: Relay
distro: jazzy
bus_bytes: 4
subscribe:
  /came: {type: std_msgs/msg/UInt16}
publish:
  /goes: {type: std_msgs/msg/UInt16}
"""


def described(folder, value="", text=DESCRIPTION):
    text += f"accelerator: {value}\n" if value else ""
    (folder / "node.yaml").write_text(text)
    return read_description(folder / "node.yaml", library=LIBRARY)


@pytest.fixture
def written(tmp_path):
    """Write the skeleton of an accelerator, with changes; return its description."""

    def write(language, *changes, description=DESCRIPTION, with_records=False):
        place, value = new_accelerator(
            described(tmp_path, text=description), language, with_records=with_records
        )
        text = Path(place).read_text()
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        Path(place).write_text(text)
        return described(tmp_path, value, description)

    return write


@pytest.mark.sampled(2)
@pytest.mark.parametrize("language", ["amaranth", "vhdl", "verilog", "sv"])
def test_what_node_new_writes_is_an_accelerator(language, tmp_path, monkeypatch, capsys):
    described(tmp_path)
    monkeypatch.chdir(tmp_path)
    command = ["node", "new", "node.yaml", "--language", language, "--path", str(PACKAGES)]
    assert main(command) == 0
    said = capsys.readouterr().out
    (value,) = [line for line in said.splitlines() if line.startswith("accelerator: ")]
    description = described(tmp_path, value.removeprefix("accelerator: "))
    accelerator = load_accelerator(description)
    accelerator._MustUse__used = True
    suffix = {"amaranth": "py", "vhdl": "vhd", "verilog": "v", "sv": "sv"}[language]
    text = (tmp_path / f"Relay.{suffix}").read_text()
    # It has each member, and passes messages on where types are the same.
    for member in ("subscribe.came.data", "subscribe.text.data.items", "publish.goes.data"):
        assert member.replace(".", "." if language == "amaranth" else "_") in text
    # A second one would overwrite the user's work.
    assert main(command) == 1
    assert "is already there, and stays as it is" in capsys.readouterr().err


def test_members_are_listed(tmp_path, capsys):
    described(tmp_path)
    file = str(tmp_path / "node.yaml")
    assert main(["node", "info", file, "--members", "--path", str(PACKAGES)]) == 0
    said = capsys.readouterr().out
    assert "/text, std_msgs/msg/String: take\n  subscribe.text.data.length " in said
    assert " items of uint8, 4 in a transfer\n" in said
    assert "Calibrate_Response: offer\n" in said


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--board", "udp://localhost"], "the board udp://localhost has no waveform"),
        (["--wave", "."], "cannot write '.': Is a directory"),
        (["--wave", "a.ghw"], "cannot write 'a.ghw': Verilator has the formats .vcd and .fst"),
    ],
)
def test_a_waveform_needs_a_simulation_and_a_file(tmp_path, capsys, options, text):
    described(tmp_path, "firm_hdl.node.loop:Loop")
    command = ["node", "run", str(tmp_path / "node.yaml"), "--path", str(PACKAGES)]
    assert main([*command, "--graph", "none", "--wave", "node.vcd", *options]) == 1
    assert text in capsys.readouterr().err


MISTAKES = [
    ("vhdl", ("begin\n", "begin begin\n"), r"^\S*Relay\.vhd:\d+:\d+: error: .*begin"),
    ("vhdl", ("Relay is", "other is"), "there is no entity 'Relay' in 'Relay.vhd'"),
    ("vhdl", (PORT, "x"), f"'Relay' has no port '{PORT}'"),
    ("vhdl", (f"{PORT}  ", f"more : in bit; {PORT}  "), "no member for the port 'more'"),
    (
        "vhdl",
        (": out std_logic_vector(31", ": out std_logic_vector(30"),
        "must have 32 bits, not 31",
    ),
    (
        "vhdl",
        (": out std_logic_vector(31", ": out unsigned(31"),
        r"std_logic_vector\(31 downto 0\)",
    ),
    ("sv", ("endmodule", "end"), r"^\S*Relay\.sv:\d+:\d+: error: "),
    ("sv", ("module Relay", "module other"), "there is no module 'Relay' in 'Relay.sv'"),
    ("sv", (PORT, "x"), f"'Relay' has no port '{PORT}'"),
    ("sv", ("module Relay (", "module Relay ( input more,"), "no member for the port 'more'"),
    ("sv", (f"[15:0] {PORT}", f"[14:0] {PORT}"), f"port '{PORT}' of 'Relay' must have 16 bits"),
]


@pytest.mark.sampled(2)
@pytest.mark.parametrize(("language", "change", "text"), MISTAKES)
def test_mistakes_are_shown_where_they_are(written, language, change, text):
    with pytest.raises(DefinitionError) as caught:
        load_accelerator(written(language, change))
    assert re.search(text, str(caught.value)), str(caught.value)


GOES = "publish_goes_data_data"
CAME = "subscribe_came_data_data"
FLOAT = f"to_float({CAME} & {CAME})"

# Of an accelerator with two topics.
MORE_MISTAKES = [
    (
        "vhdl",
        [(f"{GOES}    : out", f"{GOES} : inout")],
        f"port '{GOES}' of 'Relay' must be an input or an output, not an inout",
    ),
    (
        "vhdl",
        [("\narchitecture", "/*"), ("end architecture;", "*/")],
        "'Relay' has no architecture",
    ),
    (
        "vhdl",
        [
            ("numeric_std.all;", "numeric_std.all; use ieee.float_pkg.all;"),
            (
                f"{GOES}    <= subscribe_came_data_data",
                f"{GOES} <= std_logic_vector(to_unsigned(to_integer({FLOAT}), 16))",
            ),
        ],
        "GHDL cannot synthesize ieee's package 'float_pkg', used in 'Relay.vhd'",
    ),
    # The port became a variable inside.
    (
        "sv",
        [(f"output logic [15:0] {GOES},", ""), (");\n", f");\n  logic [15:0] {GOES};\n")],
        f"'Relay' has no port '{GOES}'",
    ),
    (
        "vhdl",
        [
            ("entity Relay", "use work.p.all;\nentity Relay"),
            (
                "library",
                "library ieee; use ieee.std_logic_1164.all; package p is subtype word_t is ",
            ),
            ("ieee;\nuse ieee.std", "std_logic_vector(0 to 15); end;\nlibrary ieee;\nuse ieee.std"),
            (f"{CAME}  : in  std_logic_vector(15 downto 0)", f"{CAME} : in word_t"),
            (f"{GOES}    <= ", f"{GOES}(11 downto 2) <= "),
            (f"<= {CAME}", f"<= {CAME}(2 to 11)"),
        ],
        [
            rf"Relay\.vhd:\d+:5: error: port '{CAME}' of 'Relay' has an ascending range",
            rf"Relay\.vhd:\d+:5: error: nothing drives bit 0, 1, 12, .* of the output '{GOES}'",
        ],
    ),
    # Verilator compares no widths while a port is missing.
    (
        "sv",
        [
            (f"input  logic [15:0] {CAME}", f"input  logic [0:15] {CAME}"),
            (f"assign {GOES}", "assign publish_goes_data_last"),
            ("publish_goes_data_ready", "publish_goes_ready"),
            ("input  logic [31:0] time_sec", "input  logic [30:0] time_sec"),
        ],
        [
            r"Relay\.sv:\d+:8: error: 'Relay' has no port 'publish_goes_data_ready'",
            r"Relay\.sv:\d+:\d+: error: .* no member for the port 'publish_goes_ready'",
            r"Relay\.sv:\d+:25: error: port 'time_sec' of 'Relay' must have 32 bits, not 31",
            rf"port '{CAME}' of 'Relay' has an ascending range.*\[15:0\]",
            rf"nothing drives the output '{GOES}' of 'Relay'",
        ],
    ),
]


@pytest.mark.sampled(2)
@pytest.mark.parametrize(("language", "changes", "texts"), MORE_MISTAKES)
def test_mistakes_that_tools_describe_badly(written, language, changes, texts):
    with pytest.raises(DefinitionError) as caught:
        load_accelerator(written(language, *changes, description=SMALL))
    for text in [re.escape(texts)] if isinstance(texts, str) else texts:
        assert re.search(text, str(caught.value)), str(caught.value)


KIND = "work.std_msgs_msg_uint16_cdr_4_pkg.u_int16"
STRUCT = "std_msgs_msg_uint16_cdr_4_sv_pkg::u_int16_t"

# Of an accelerator whose ports are records.
RECORD_MISTAKES = [
    # As wide as the right one.
    (
        "vhdl",
        [
            (f"in  {KIND}_ready_t", f"in {KIND}_array_ready_t"),
            ("<= publish_goes_rdy", "<= publish_goes_rdy.item"),
        ],
        f"port 'publish_goes_rdy' of 'Relay' must have the type {KIND}_ready_t",
    ),
    (
        "vhdl",
        [("publish_goes <= subscribe_came", "publish_goes.data.data <= subscribe_came.data.data")],
        "nothing drives 'publish_goes.data.valid' of 'Relay'",
    ),
    (
        "sv",
        [(f"output {STRUCT}", "output logic [3:0]")],
        f"port 'publish_goes' of 'Relay' must have the type {STRUCT}, which has 17 bits, not 4",
    ),
    ("sv", [("endmodule", "assign publish_goes.data.size.w = 0; endmodule")], "'size' not found"),
]


@pytest.mark.sampled(2)
@pytest.mark.parametrize(("language", "changes", "text"), RECORD_MISTAKES)
def test_mistakes_in_records(written, language, changes, text):
    with pytest.raises(DefinitionError, match=r"Relay\.\w+:\d+:\d+: error: ") as caught:
        load_accelerator(written(language, *changes, description=SMALL, with_records=True))
    # Verilator reports a wrong member twice.
    assert text in str(caught.value) and "Unsupported" not in str(caught.value)


def test_packages_that_are_not_there(written):
    description = written("vhdl", description=SMALL, with_records=True)
    hdl = replace(description.hdl, has_records=False)
    with pytest.raises(DefinitionError, match=r"uint16_cdr_4_pkg.* with 'ports: records'"):
        load_accelerator(replace(description, hdl=hdl))


BENCH_OF_RECORDS = """module tb;
  reg [15:0] came;
  wire [15:0] goes;
  reg valid, ready;
  wire valid_out, ready_out;
  integer n;
  Relay_plain dut (
    .aclk(1'b0), .aresetn(1'b1), .time_sec(32'd0), .time_nanosec(32'd0),
    .subscribe_came_data_data(came), .subscribe_came_data_valid(valid),
    .subscribe_came_data_ready(ready_out), .publish_goes_data_data(goes),
    .publish_goes_data_valid(valid_out), .publish_goes_data_ready(ready)
  );
  initial begin
    for (n = 0; n < 100; n = n + 1) begin
      came = $random; {valid, ready} = n;
      #1 if (goes !== came || {valid_out, ready_out} !== {valid, ready}) $display("wrong %d", n);
    end
    $display("done");
    $finish;
  end
endmodule
"""


@pytest.mark.parametrize("language", ["vhdl", pytest.param("sv", marks=pytest.mark.thorough)])
def test_records_have_the_bits_of_plain_ports(written, tmp_path, language, ghdl, iverilog):
    accelerator = load_accelerator(written(language, description=SMALL, with_records=True))
    accelerator._MustUse__used = True
    (name,) = accelerator.modules
    (tmp_path / name).write_text(accelerator.modules[name])
    (tmp_path / "tb.v").write_text(BENCH_OF_RECORDS)
    make, run = "iverilog -o tb", "./tb"
    if language == "sv":
        # Icarus Verilog has no structs in packages.
        make, run = "verilator --binary --timing --timescale 1ns/1ns -Wno-fatal -O0", "obj_dir/Vtb"
        make += " --top-module tb -MAKEFLAGS OPT_FAST=-O0"
    said = subprocess.run(
        [*make.split(), name, "tb.v"], cwd=tmp_path, capture_output=True, text=True
    )
    assert said.returncode == 0, said.stderr
    done = subprocess.run([run], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("done")


@pytest.mark.parametrize(
    ("language", "text"),
    [
        ("vhdl", "entity 'relay' is declared in two files, 'Relay.vhd' and 'again.vhd'"),
        ("systemverilog", "'Relay' is declared in two files, 'Relay.sv' and 'again.sv'"),
    ],
)
def test_one_name_in_two_files_is_refused(written, tmp_path, language, text):
    written("vhdl" if language == "vhdl" else "sv", description=SMALL)
    suffix = {"vhdl": "vhd"}.get(language, "sv")
    (tmp_path / f"again.{suffix}").write_bytes((tmp_path / f"Relay.{suffix}").read_bytes())
    files = f"{{{language}: [Relay.{suffix}, again.{suffix}], entity: Relay}}"
    with pytest.raises(DefinitionError, match=r"node\.yaml:\d+:14: error: ") as caught:
        load_accelerator(described(tmp_path, files, SMALL))
    assert text in str(caught.value)


READ = [
    ("{vhdl: a.vhd}", ("vhdl", ("a.vhd",), "a")),
    ("{verilog: a.v, ports: structs}", "Verilog has no records: write 'systemverilog' as the key"),
    ("{verilog: [b.v, x/a.v], entity: Top}", ("verilog", ("b.v", "x/a.v"), "Top")),
    ("{vdhl: a.vhd}", "an accelerator has no 'vdhl'; did you mean 'vhdl'?"),
    ("{entity: a}", "an accelerator has the files of one of vhdl, verilog, systemverilog"),
    ("{vhdl: a.vhd, verilog: a.v}", "an accelerator has the files of one of"),
    ("{vhdl: 3.vhd}", "'3' is no name of an entity or a module: name the 'entity'"),
    ("{vhdl: design.vhd}", "'design' is a keyword of VHDL or SystemVerilog: name the 'entity'"),
    ("{vhdl: a.vhd, entity: firm_hdl_pkg}", "'firm_hdl_pkg' is a name as of firm-hdl's own units"),
    ("{verilog: a.vhd}", "'a.vhd' ends as files of vhdl do: write 'vhdl' as the key"),
    ("{vhdl: [a.vhd, a.sv]}", "'a.sv' ends as files of systemverilog do"),
    ("{vhdl: a.vhd, entity: 'a b'}", "'a b' is no name of an entity"),
    ("a.vhd", "or as {vhdl: wheels.vhd, entity: wheels}"),
    ("{vhdl: []}", "'vhdl' has no file"),
]


@pytest.mark.parametrize(("value", "want"), READ)
def test_the_description_names_files(tmp_path, value, want):
    if isinstance(want, str):
        with pytest.raises(DefinitionError, match=re.escape(want)):
            described(tmp_path, value)
    else:
        hdl = described(tmp_path, value).hdl
        assert (hdl.language, hdl.files, hdl.entity) == want


def test_a_file_that_is_not_there(tmp_path):
    description = described(tmp_path, "{vhdl: a.vhd}")
    with pytest.raises(DefinitionError, match=r"node.yaml:\d+:14: error: cannot read '.*a\.vhd'"):
        load_accelerator(description)


def test_a_node_of_vhdl_is_built_and_runs(written, tmp_path, ghdl):
    description = written("vhdl", description=SMALL, with_records=True)
    source = tmp_path / "Relay.vhd"
    data = source.read_bytes().replace(b"\n", b"\r\n") + "-- r\u00fchrt\r\n".encode("latin-1")
    source.write_bytes(data)
    built = build_node(description, tmp_path, stimuli=stimuli)
    manifest = json.loads((built.folder / "manifest.json").read_text())
    # A change of the user's file makes the folder outdated.
    digests = manifest["inputs"]["accelerator_files"]
    assert digests["vhdl/accelerator/Relay.vhd"] == hashlib.sha256(data).hexdigest()
    # A copy has the bytes of the file.
    assert (built.folder / "vhdl" / "accelerator" / "Relay.vhd").read_bytes() == data
    assert build_node(description, tmp_path, stimuli=stimuli).was_current
    # Node and entity have one name.
    assert built.folder.name == "Relay_node"
    files = (built.folder / "vhdl" / "files.txt").read_text().split()
    assert [file for file in files if not file.endswith("_pkg.vhd")][:2] == [
        "accelerator/Relay.vhd",
        "Relay_plain.vhd",
    ]
    core = yaml.safe_load((built.folder / "Relay_node.core").read_text().partition("\n")[2])
    assert core["targets"]["sim"]["filesets"][:2] == ["accelerator", "vhdl"]
    assert "sim_verilog" not in core["targets"]
    assert not (built.folder / "run_iverilog.sh").exists()
    assert manifest["records"] == {"built": False, "reason": "The accelerator takes all messages"}
    assert not (built.folder / "systemverilog").exists()
    run = built.folder / "vhdl" / "run_ghdl.sh"
    status, output = run_script(run, "--wave=node.ghw", folder=tmp_path)
    assert status == 0 and "PASS node Relay_node: " in output
    assert (tmp_path / "node.ghw").read_bytes().startswith(b"GHDLwave")


@pytest.mark.thorough
def test_a_node_of_systemverilog_is_built_and_runs(written, tmp_path, iverilog, verilator):
    (tmp_path / "ready.svh").write_text("`define TAKEN 1'b1\n")
    include = [
        ("module Relay", '`include "ready.svh"\nmodule Relay'),
        ("endmodule", "wire taken = `TAKEN;\nendmodule"),
    ]
    description = written("sv", *include, description=SMALL)
    built = build_node(description, tmp_path, stimuli=stimuli)
    core = yaml.safe_load((built.folder / "Relay_node.core").read_text().partition("\n")[2])
    assert core["filesets"]["accelerator"]["files"] == [
        "accelerator/Relay.sv",
        {"accelerator/ready.svh": {"is_include_file": True}},
    ]
    run = ["sh", built.folder / "run_iverilog.sh"]
    said = subprocess.run(run, capture_output=True, text=True, check=True)
    assert "PASS node Relay_node: " in said.stdout


@pytest.mark.thorough
def test_a_node_with_structs_is_built_and_runs(written, tmp_path, verilator):
    description = written("sv", description=SMALL, with_records=True)
    folder = build_node(description, tmp_path, stimuli=stimuli).folder
    assert not (folder / "run_iverilog.sh").exists()
    status, output = run_script(folder / "run_verilator.sh", "--wave=node.vcd", folder=tmp_path)
    assert status == 0 and "PASS node Relay_node: " in output, output
    assert "$timescale" in (tmp_path / "node.vcd").read_text()


def test_files_that_are_included_keep_their_folders(written, tmp_path, iverilog, verilator):
    include = [("module Relay", '`include "inc/one.svh"\n`include "../two.svh"\nmodule Relay')]
    (tmp_path / "rtl" / "inc").mkdir(parents=True)
    (tmp_path / "rtl" / "inc" / "one.svh").write_text("`define ONE 1'b1\n")
    (tmp_path / "two.svh").write_text("`define TWO `ONE\n")
    written("sv", *include, ("endmodule", "wire two = `TWO;\nendmodule"), description=SMALL)
    (tmp_path / "Relay.sv").rename(tmp_path / "rtl" / "Relay.sv")
    description = described(tmp_path, "{systemverilog: rtl/Relay.sv}", SMALL)
    folder = build_node(description, tmp_path, stimuli=stimuli).folder
    core = yaml.safe_load((folder / "Relay_node.core").read_text().partition("\n")[2])
    assert core["filesets"]["accelerator"]["files"] == [
        "accelerator/rtl/Relay.sv",
        {
            "accelerator/rtl/inc/one.svh": {
                "is_include_file": True,
                "include_path": "accelerator/rtl",
            }
        },
        {"accelerator/two.svh": {"is_include_file": True, "include_path": "accelerator/rtl"}},
    ]
    run = folder / "run_iverilog.sh"
    status, output = run_script(run, "--wave=node.fst", folder=tmp_path)
    assert status == 0 and "PASS node Relay_node: " in output
    # The header of FST has 329 bytes.
    assert (tmp_path / "node.fst").read_bytes().startswith(b"\0\0\0\0\0\0\0\1\x49")


def test_an_include_by_an_absolute_path_is_refused(written, tmp_path, verilator):
    header = tmp_path / "one.svh"
    header.write_text("\n")
    include = ("module Relay", f'`include "{header}"\nmodule Relay')
    description = written("sv", include, description=SMALL)
    accelerator = load_accelerator(description)
    accelerator._MustUse__used = True
    with pytest.raises(DefinitionError, match="by an absolute path"):
        accelerator_files(accelerator)


# What a netlist of GHDL can have: memories, long constants, signed arithmetic, both edges.
DESIGN = """\
library ieee; use ieee.std_logic_1164.all; use ieee.numeric_std.all;
entity noise is
  port (aclk, aresetn : in std_logic; o : out std_logic_vector(127 downto 0));
end entity;
architecture rtl of noise is
  type memory_t is array (0 to 15) of unsigned(7 downto 0);
  signal memory : memory_t := (others => x"5a");
  constant TABLE : memory_t := (x"11", x"22", x"33", others => x"7f");
  constant LONG : unsigned(63 downto 0) := x"123456789abcdef0";
  signal n : unsigned(31 downto 0) := x"00000001";
  signal a, b, c, d : signed(7 downto 0) := (others => '0');
  signal q : unsigned(7 downto 0) := (others => '0');
  signal late : std_logic := '0';
  signal s : unsigned(2 downto 0);
begin
  a <= signed(n(7 downto 0));
  b <= signed(n(18 downto 11));
  s <= n(30 downto 28);
  process (aclk) begin
    if rising_edge(aclk) then
      n <= n(30 downto 0) & (n(31) xor n(21) xor n(1) xor n(0));
      memory(to_integer(n(3 downto 0))) <= unsigned(a xor b);
      q <= memory(to_integer(n(9 downto 6)));
      case s is
        when "000" => c <= a + b;
        when "001" => c <= a - b;
        when "010" | "011" => c <= not a;
        when "100" => c <= abs a;
        when "101" => c <= a ror to_integer(s);
        when "110" => null;
        when others => c <= -b;
      end case;
    end if;
    if falling_edge(aclk) then
      late <= n(5);
    end if;
  end process;
  process (aclk, aresetn) begin
    if aresetn = '0' then d <= x"a5"; elsif rising_edge(aclk) then d <= d + a; end if;
  end process;
  o <= std_logic_vector(a * b) & std_logic_vector(a / 3) & std_logic_vector(a rem 5)
    & std_logic_vector(a mod 5) & std_logic_vector(shift_right(a, to_integer(s)))
    & std_logic_vector(minimum(a, b)) & std_logic_vector(maximum(unsigned(a), unsigned(b)))
    & std_logic_vector(c) & std_logic_vector(d) & std_logic_vector(q)
    & std_logic_vector(TABLE(to_integer(n(3 downto 0))))
    & std_logic_vector(LONG(63 downto 33) xor n(30 downto 0)) & (late xor (xor c));
end architecture;
"""

BENCH = """\
library ieee; use ieee.std_logic_1164.all; use std.textio.all;
entity tb is end entity;
architecture sim of tb is
  signal aclk : std_logic := '0';
  signal aresetn : std_logic := '1';
  signal o : std_logic_vector(127 downto 0);
begin
  dut : entity work.noise port map (aclk => aclk, aresetn => aresetn, o => o);
  process
  begin
    for n in 0 to 299 loop
      aresetn <= '0' when n mod 50 = 1 else '1';
      wait for 4 ns;
      write(output, to_string(o) & LF);
      aclk <= '1';
      wait for 4 ns;
      aclk <= '0';
      wait for 4 ns;
    end loop;
    wait;
  end process;
end architecture;
"""

BENCH_VERILOG = """\
module tb;
  reg aclk = 0, aresetn = 1;
  wire [127:0] o;
  integer n;
  noise dut (.aclk(aclk), .aresetn(aresetn), .o(o));
  initial for (n = 0; n < 300; n = n + 1) begin
    aresetn = n % 50 != 1;
    #4 $display("%b", o);
    aclk = 1;
    #4 aclk = 0;
    #4;
  end
endmodule
"""


def test_the_netlist_of_an_entity_does_what_the_vhdl_does(tmp_path, ghdl, iverilog):
    (tmp_path / "design.vhd").write_text(DESIGN)
    (tmp_path / "tb.vhd").write_text(BENCH)
    (tmp_path / "tb.v").write_text(BENCH_VERILOG)

    def run(*command):
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
        return done.stdout

    run(find_ghdl(), "-a", "--std=08", "design.vhd", "tb.vhd")
    dump = run(find_ghdl(), "--synth", "--std=08", "-dm", "--out=dump", "noise")
    (tmp_path / "design.v").write_text(verilog_of(read_vhdl(dump), name="noise", names={}))
    run("iverilog", "-g2012", "-o", "tb.vvp", "design.v", "tb.v")
    want = run(find_ghdl(), "--elab-run", "--std=08", "tb", "--ieee-asserts=disable").split()
    assert len(want) == 300 and len({*want}) > 290
    assert run("vvp", "-n", "tb.vvp").split() == want
