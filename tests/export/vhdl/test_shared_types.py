"""Two messages in one design share the VHDL types that they share in ROS."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest
from rosbags.typesys import Stores, get_typestore

from firm_hdl.export.build import BuildError, build
from firm_hdl.export.options import Options
from firm_hdl.export.vhdl.layer import user_layer
from firm_hdl.export.vhdl.wrapper import Core
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.export.test_packaging import STUBS, fusesoc, run
from tests.tools import need

WARM, PRESS = "sensor_msgs/msg/Temperature", "sensor_msgs/msg/FluidPressure"


@pytest.fixture(scope="module")
def folders(tmp_path_factory) -> list[Path]:
    out = tmp_path_factory.mktemp("built")
    return [
        each.folder / "vhdl"
        for each in build([WARM, PRESS], out, options=Options(extras=frozenset({"tools"})))
    ]


def unique_files(folders: Iterable[Path], listed: str) -> list[Path]:
    """List the files of several folders, each name once."""
    found: dict[str, Path] = {}
    for folder in folders:
        for name in (folder / listed).read_text().split():
            found.setdefault(name, folder / name)
    return list(found.values())


def packets(frame_id: str) -> tuple[bytes, bytes]:
    """Serialize a temperature, and a pressure of 0 that has its header."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    stamp = store.types["builtin_interfaces/msg/Time"](sec=-5, nanosec=7)
    header = store.types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame_id)
    warm = store.types[WARM](header, 0.5, 0.25)
    press = store.types[PRESS](header, 0.0, 0.0)
    return (
        bytes(store.serialize_cdr(warm, WARM)),
        bytes(store.serialize_cdr(press, PRESS)),
    )


DESIGN = """\
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.sensor_msgs_msg_temperature_cdr_8_pkg.all;
use work.sensor_msgs_msg_fluidpressure_cdr_8_pkg.all;

entity design is
end entity;

architecture sim of design is
  signal aclk, aresetn : std_logic := '0';
  signal s_data, m_data : std_logic_vector(63 downto 0);
  signal s_keep, m_keep : std_logic_vector(7 downto 0);
  signal s_last, s_valid, s_ready, m_last, m_valid, m_ready, m_user : std_logic;
  signal warm      : temperature_t;
  signal warm_rdy  : temperature_ready_t;
  signal press     : fluid_pressure_t;
  signal press_rdy : fluid_pressure_ready_t;
  signal sent, came, bytes, total : natural;
begin
  aclk <= not aclk after 5 ns when now < 100 us;
  aresetn <= '1' after 20 ns;

  source : entity work.firm_hdl_axis_source
    generic map (bus_bytes => 8, stimuli => "stimuli.txt", seed => 1, stalls => 30)
    port map (
      aclk => aclk, aresetn => aresetn, tdata => s_data, tkeep => s_keep, tlast => s_last,
      tvalid => s_valid, tready => s_ready, packets => sent, done => open);

  rx : entity work.sensor_msgs_msg_temperature_cdr_8_deserializer
    port map (
      aclk => aclk, aresetn => aresetn, s_axis_tdata => s_data, s_axis_tkeep => s_keep,
      s_axis_tlast => s_last, s_axis_tvalid => s_valid, s_axis_tready => s_ready,
      msg => warm, rdy => warm_rdy, m_axis_status_tdata => open, m_axis_status_tvalid => open,
      m_axis_status_tready => '1');

  process (all) begin
    warm_rdy <= TEMPERATURE_ALL_READY;
    warm_rdy.header <= press_rdy.header;
    press <= FLUID_PRESSURE_IDLE;
    press.header <= warm.header;
    press.fluid_pressure.valid <= '1';
    press.variance.valid <= '1';
  end process;

  tx : entity work.sensor_msgs_msg_fluidpressure_cdr_8_serializer
    port map (
      aclk => aclk, aresetn => aresetn, m_axis_tdata => m_data, m_axis_tkeep => m_keep,
      m_axis_tlast => m_last, m_axis_tuser => m_user, m_axis_tvalid => m_valid,
      m_axis_tready => m_ready, msg => press, rdy => press_rdy, m_axis_status_tdata => open,
      m_axis_status_tvalid => open, m_axis_status_tready => '1');

  sink : entity work.firm_hdl_axis_sink
    generic map (
      bus_bytes => 8, expected => "expected.txt", results => "results.txt", seed => 2, stalls => 30)
    port map (
      aclk => aclk, aresetn => aresetn, tdata => m_data, tkeep => m_keep, tlast => m_last,
      tuser => m_user, tvalid => m_valid, tready => m_ready, packets => came, bytes => bytes,
      total => total);

  process begin
    wait until came = 2 for 90 us;
    assert came = 2 report "FAIL: packets are missing" severity failure;
    report "PASS";
    wait;
  end process;
end architecture;
"""


def simulated(ghdl: str, folders: list[Path], work: Path, expected: Iterable[bytes]) -> str:
    (work / "design.vhd").write_text(DESIGN)
    sent = [packets(frame_id)[0] for frame_id in ("map", "a longer name")]
    (work / "stimuli.txt").write_text("".join(f"{packet.hex()}\n" for packet in sent))
    (work / "expected.txt").write_text("".join(f"{packet.hex()}\n" for packet in expected))
    files = [*unique_files(folders, "files.txt"), *unique_files(folders, "bench_files.txt")]
    files = [file for file in files if "_tb" not in file.name]
    options = ["--std=08", f"--workdir={work}"]
    status, output = run(
        [ghdl, "-a", *options, "--warn-error", *map(str, files), "design.vhd"], work
    )
    assert (status, output) == (0, "")
    return run([ghdl, "--elab-run", *options, "design", "--ieee-asserts=disable-at-0"], work)[1]


def test_header_of_one_message_goes_to_another(ghdl, folders, tmp_path):
    expected = [packets(frame_id)[1] for frame_id in ("map", "a longer name")]
    output = simulated(ghdl, folders, tmp_path, expected)
    assert "PASS" in output and "FAIL" not in output


def test_another_header_is_found(ghdl, folders, tmp_path):
    expected = [packets(frame_id)[1] for frame_id in ("map", "a longer Name")]
    output = simulated(ghdl, folders, tmp_path, expected)
    assert "FAIL packet 1" in output and "PASS" not in output


def test_package_of_a_type_is_the_same_wherever_the_type_is():
    library = Library("lyrical")
    texts: dict[str, tuple[str, str]] = {}
    names = [name for name in map(str, library.interfaces()) if name.startswith(PACKAGES)]
    assert len(names) > 40
    shared = 0
    for name in names:
        message = library.message(name)
        plan = build_plan(lay_out(message), bus_bytes=4)
        core = {way: Core(entity=way, names={}) for way in ("deserializer", "serializer")}
        made = user_layer(message, plan, name="t", cores=core)
        for each in made.shared:
            text = made.packages[f"{each.name}.vhd"]
            before, owner = texts.setdefault(each.name, (text, name))
            assert text == before, f"{each.name} in {name} and in {owner}"
            shared += owner != name
    assert shared > 100


def test_the_manifest_states_which_packages_each_one_uses(folders):
    for folder in folders:
        section = json.loads((folder.parent / "manifest.json").read_text())["vhdl"]
        for each in section["shared_packages"]:
            used = set(re.findall(r"\bwork\.(\w+)", (folder / each["file"]).read_text()))
            assert set(each["needs"]) == used - {each["name"], "firm_hdl_types_pkg"}, each
            assert (each["message"] is None) == (each["name"] == "firm_hdl_bus_8_pkg")


PACKAGES = ("geometry_msgs/", "sensor_msgs/", "nav_msgs/", "std_msgs/")


# `A` and `B` need packages with the same name, and so do `C` and `D`.
SIMILAR = {
    "p/Inner.msg": "uint8 x\n",
    "p/INNER.msg": "uint16 x\n",
    "p/A.msg": "Inner a\n",
    "p/B.msg": "INNER b\n",
    "p/Both.msg": "Inner a\nINNER b\n",
    "p_q/R.msg": "uint8 x\n",
    "p/q_R.msg": "uint16 x\n",
    "p/C.msg": "p_q/R a\n",
    "p/D.msg": "q_R b\n",
}


@pytest.fixture
def similar(tmp_path) -> Path:
    for name, text in SIMILAR.items():
        package, _, file = name.partition("/")
        (tmp_path / "ws" / package / "msg").mkdir(parents=True, exist_ok=True)
        (tmp_path / "ws" / package / "msg" / file).write_text(text)
        (tmp_path / "ws" / package / "package.xml").write_text(
            f"<package format='2'><name>{package}</name><version>1.0.0</version></package>"
        )
    return tmp_path / "ws"


@pytest.mark.parametrize(
    ("one", "other", "package", "types"),
    [
        ("p/A", "p/B", "p_inner_ros1_8_pkg", ("p/INNER", "p/Inner")),
        ("p/C", "p/D", "p_q_r_ros1_8_pkg", ("p/q_R", "p_q/R")),
        ("p/B", "p/Both", "p_inner_ros1_8_pkg", ("p/Inner", "p/INNER")),
    ],
)
def test_two_types_whose_package_has_one_name_are_not_built_side_by_side(
    similar, tmp_path, one, other, package, types
):
    options = {"library": Library("noetic", [similar])}
    output = f"{other}: the VHDL package '{package}' would be that of {types[0]}, but in .* it is "
    with pytest.raises(BuildError, match=f"^{output}that of {types[1]}; build one of them"):
        build([one, other], tmp_path / "at once", **options)
    assert not (tmp_path / "at once").exists()


@pytest.mark.usefixtures("hollow")
def test_earlier_builds_count(similar, tmp_path):
    options = {"out": tmp_path / "out", "library": Library("noetic", [similar])}
    (before,) = build(["p/A"], **options)
    with pytest.raises(BuildError, match=r"that of p/INNER, but in '.*p_A_ros1_8' it is that"):
        build(["p/B"], **options)
    assert [before.folder] == list(before.folder.parent.glob("[!.]*"))
    # A file that is no manifest is ignored.
    (before.folder / "manifest.json").write_text(
        '{"vhdl": 5, "inputs": {}, "files": {}, "inputs_sha256": ""}'
    )
    build(["p/B"], **options)


@pytest.mark.usefixtures("hollow")
def test_types_that_are_similar_within_a_message_have_packages_each(ghdl, similar, tmp_path):
    (built,) = build(["p/Both"], tmp_path / "out", library=Library("noetic", [similar]))
    files = (built.folder / "vhdl" / "files.txt").read_text().split()
    assert {"p_inner_ros1_8_pkg.vhd", "p_inner_ros1_8_2_pkg.vhd"} <= {*files}
    (tmp_path / "work").mkdir()
    options = ["--std=08", f"--workdir={tmp_path / 'work'}", "--warn-error"]
    assert run([ghdl, "-a", *options, *files], built.folder / "vhdl") == (0, "")


def test_tools_have_each_file_once(folders, tmp_path):
    tclsh = need("tclsh", shutil.which("tclsh"))
    (tmp_path / "stubs.tcl").write_text(STUBS)
    status, output = run(
        [tclsh, "stubs.tcl", *(str(folder / "vivado.tcl") for folder in folders)], tmp_path
    )
    assert status == 0, output
    read = [Path(line.split()[-1]).name for line in output.splitlines()]
    assert read == [path.name for path in unique_files(folders, "files.txt")]
    assert {"builtin_interfaces_msg_time_cdr_8_pkg.vhd", "std_msgs_msg_header_cdr_8_pkg.vhd"} <= {
        *read
    }
    shutil.copytree(folders[0].parents[1], tmp_path / "cores")
    (tmp_path / "both.core").write_text(
        "CAPI=2:\nname: my:own:both:1\nfilesets:\n  all:\n    depend:\n"
        "      - firm-hdl:lyrical:sensor_msgs_msg_temperature_cdr_8\n"
        "      - firm-hdl:lyrical:sensor_msgs_msg_fluidpressure_cdr_8\n"
        "targets:\n  default:\n    filesets: [all]\n"
        "  sim:\n    default_tool: ghdl\n    filesets: [all]\n    toplevel: x\n"
    )
    status, output = run([*fusesoc(), "run", "--setup", "--target=sim", "my:own:both"], tmp_path)
    assert status == 0, output
    (listed,) = (tmp_path / "build").rglob("*.eda.yml")
    text = listed.read_text()
    for path in unique_files(folders, "files.txt"):
        assert text.count(f"/{path.name}\n") == 1, path.name


HEADERS = """\
library mine;
use mine.sensor_msgs_msg_temperature_cdr_8_pkg.all;
use mine.sensor_msgs_msg_fluidpressure_cdr_8_pkg.all;
entity headers is end entity;
architecture sim of headers is
  signal warm : temperature_t;
  signal press : fluid_pressure_t;
begin
  press.header <= warm.header;
end architecture;
"""


def test_vhdl_compiles_as_a_library_of_vunit(ghdl, folders, tmp_path):
    (tmp_path / "headers.vhd").write_text(HEADERS)
    (tmp_path / "run.py").write_text(
        "import sys\nfrom pathlib import Path\nfrom vunit import VUnit\n"
        "folders = [Path(each) for each in sys.argv[1:3]]\n"
        "vunit = VUnit.from_argv(['--compile'], compile_builtins=False)\n"
        "library = vunit.add_library('mine')\n"
        "files = {}\n"
        "for folder in folders:\n"
        "    for name in (folder / 'files.txt').read_text().split():\n"
        "        files.setdefault(name, folder / name)\n"
        "for file in [*files.values(), 'headers.vhd']:\n"
        "    library.add_source_file(file, vhdl_standard='2008')\n"
        "vunit.main()\n"
    )
    done = subprocess.run(
        [sys.executable, "run.py", *map(str, folders)],
        cwd=tmp_path,
        env={**os.environ, "VUNIT_SIMULATOR": "ghdl"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
