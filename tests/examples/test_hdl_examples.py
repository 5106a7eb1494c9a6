"""The designs in `examples/` drop damaged packets; benches fail on designs that do not."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from firm_hdl.cli import main
from tests.depth import THOROUGH
from tests.examples.test_examples import ROOT, load
from tests.tools import need
from tests.vhdl.ghdl import GHDL

EXAMPLES = ROOT / "examples"

# The change that makes a design naive: it acts on `valid` and ignores the status.
NAIVE = {
    "vhdl_motor": ("motor.vhd", r"take = '1' and status = STATUS_OK", "msg_valid = '1'"),
    "vhdl_two_types": ("restamp.vhd", r"good <= '1' when [^;]*;", "good <= '1';"),
    "sv_motor": (
        "motor.sv",
        r"status.tvalid && status.tdata == STATUS_OK",
        "msg.linear.x.valid",
    ),
    "cocotb_motor": (
        "motor.v",
        r"m_axis_status_tvalid && m_axis_status_tdata == OK",
        "linear_x_valid",
    ),
}


@pytest.fixture
def example_copies(tmp_path):
    """Copies of the examples, which build into themselves."""
    need("make", shutil.which("make"))
    shutil.copytree(EXAMPLES, tmp_path / "examples", ignore=shutil.ignore_patterns("work"))
    return tmp_path / "examples"


def make(folder: Path) -> tuple[int, str]:
    """Make an example as users do, with this Python's environment active."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    done = subprocess.run(
        ["make", "-C", str(folder)],
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr


def make_naive(example_copies: Path, name: str) -> None:
    """Replace a design by its naive form."""
    file, safe, naive = NAIVE[name]
    text, count = re.subn(safe, naive, (example_copies / name / file).read_text())
    assert count == 1
    (example_copies / name / file).write_text(text)


def passes(example_copies: Path, name: str, expected: str = "PASS 8 packets, 4 speeds") -> None:
    status, output = make(example_copies / name)
    assert status == 0 and expected in output, output


def fails(example_copies: Path, name: str, expected: str = "FAIL after") -> None:
    status, output = make(example_copies / name)
    assert status != 0 and expected in output and not re.search(r"PASS (?!=)", output), output


def build_for_all(example_copies: Path) -> None:
    """Give the converters of `vhdl_motor`, which are built, to the other two motors."""
    twist = "firm-hdl build geometry_msgs/msg/Twist --bus-bytes 4"
    out = example_copies / "vhdl_motor" / "work"
    extras = {"sv_motor": " --with systemverilog,tools", "cocotb_motor": ""}
    assert main([*(twist + extras["sv_motor"]).split()[1:], "--out", str(out)]) == 0
    for name, more in extras.items():
        commands = re.findall(
            r"^\t(firm-hdl build .*)$", (example_copies / name / "Makefile").read_text(), re.M
        )
        assert commands == [f"{twist}{more} --out $(WORK)"]
        (example_copies / name / "work").mkdir()
        (example_copies / name / "work" / "lyrical").symlink_to(
            example_copies / "vhdl_motor" / "work" / "lyrical"
        )


def compile_verilog(example_copies: Path) -> None:
    """Compile the other two motors with the converters, as their Makefiles do, and no more."""
    motor, name = example_copies / "sv_motor", "geometry_msgs_msg_Twist_cdr_4"
    made = Path("work", "lyrical", name)
    lint = ["verilator", "--lint-only", "--timing", "--timescale", "1ns/1ps"]
    lint += ["--top-module", "motor_tb", str(made / "waivers.vlt")]
    lint += [str(made / "systemverilog" / "waivers.vlt"), "-F"]
    lint += [str(made / "systemverilog" / "files.f"), "motor.sv", "motor_tb.sv"]
    elaborate = ["iverilog", "-g2012", "-t", "null", "-s", "motor", "motor.v"]
    elaborate += [str(made / f"{name}_deserializer_verilog.v")]
    for command, folder in ((lint, motor), (elaborate, example_copies / "cocotb_motor")):
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr


def test_motors_obey_good_packets_alone(example_copies):
    """One test for the three, because all need the converters of a Twist.

    In `make test` the one in VHDL runs, and the others are compiled, because Verilator's C++ takes
    twenty seconds.
    """
    need("GHDL", GHDL)
    need("Icarus Verilog", shutil.which("iverilog"))
    need("Verilator", shutil.which("verilator"))
    passes(example_copies, "vhdl_motor")
    build_for_all(example_copies)
    compile_verilog(example_copies)
    if THOROUGH:
        passes(example_copies, "sv_motor")
    make_naive(example_copies, "vhdl_motor")
    fails(example_copies, "vhdl_motor")
    if not THOROUGH:
        return
    found = find_spec("cocotb") and find_spec("cocotbext") and find_spec("cocotbext.axi")
    make_naive(example_copies, "sv_motor")
    fails(example_copies, "sv_motor")
    need("cocotbext-axi", "here" if found else None)
    passes(example_copies, "cocotb_motor", "PASS=1 FAIL=0")
    make_naive(example_copies, "cocotb_motor")
    fails(example_copies, "cocotb_motor", "PASS=0 FAIL=1")


def test_wheels_get_their_speeds(example_copies):
    """In `make test`, those in VHDL run, and node tests compile the others."""
    need("GHDL", GHDL)
    folders = ["wheels_vhdl"]
    if THOROUGH:
        need("Verilator", shutil.which("verilator"))
        folders.append("wheels_sv")
    for folder in folders:
        passes(example_copies, f"nodes/{folder}", "PASS: 6 commands")
        file = example_copies / "nodes" / folder / ("wheels.vhd", "wheels.sv")["sv" in folder]
        text = file.read_text()
        file.write_text(text.replace("forward - ", "forward + "))
        fails(example_copies, f"nodes/{folder}", "left ")


# It is as the motor in VHDL, with circuits that take longer.
@pytest.mark.thorough
def test_clouds_with_headers_of_scans_are_good_ones_alone(example_copies):
    need("GHDL", GHDL)
    passes(example_copies, "vhdl_two_types", "PASS 8 scans and clouds, 3 clouds with new headers")
    make_naive(example_copies, "vhdl_two_types")
    fails(example_copies, "vhdl_two_types", "FAIL packet")


@pytest.mark.thorough
def test_a_filter_that_looks_at_the_next_encoding_changes_wrong_pixels(tmp_path, capsys):
    text = (EXAMPLES / "image_filter.py").read_text()
    for leaf in ("length", "items"):
        safe = f"name.{leaf}.valid & name.{leaf}.ready"
        assert text.count(safe) == 1
        text = text.replace(safe, f"name.{leaf}.valid")
    (tmp_path / "naive_filter.py").write_text(text)
    assert load(tmp_path / "naive_filter.py").main() == 1
    assert "wrong" in capsys.readouterr().out


def test_make_examples_runs_every_one():
    text = (ROOT / "Makefile").read_text()
    (named,) = re.findall(r"^HDL_EXAMPLES := (.*)$", text, re.M)
    found = [*EXAMPLES.glob("*/Makefile"), *EXAMPLES.glob("nodes/wheels_*/Makefile")]
    names = [path.parent.relative_to(EXAMPLES).as_posix() for path in found]
    assert sorted(named.split()) == sorted(names)
    page = (ROOT / "docs" / "howto" / "index.md").read_text()
    assert all(f"`examples/{name}`" in page for name in named.split())
