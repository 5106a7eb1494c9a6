"""Comments of a definition stay comments in all output, and are pragmas for no tool."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from firm_hdl.export.build import build
from firm_hdl.export.options import Options
from firm_hdl.frontend import Library
from tests.export.conftest import EVERYTHING
from tests.export.systemverilog.hdl import slang

ORDERS = (
    "synthesis translate_off",
    "pragma translate_off",
    "synopsys translate_off",
    "rtl_synthesis off",
    "psl default clock is nothing;",
    "verilator lint_off WIDTH",
    "/* verilator lint_off WIDTH */",
    "vhdl_comp_off",
    "coverage off",
    "*/ end package; /*",
    "`protect begin",
    "$(shell touch x) [exec touch x] `touch x`",
    "\x1b[2J\x08\x07\x9b\u202e \\",
    "grün °C 雪",
)
COMMENTS = "".join(f"# {order}\n#{order}\n" for order in ORDERS)
UNIT = "# [m\n#   end record;]\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """The output for a definition whose comments look like pragmas of tools."""
    here = tmp_path_factory.mktemp("orders")
    messages = here / "my_msgs" / "msg"
    messages.mkdir(parents=True)
    (here / "my_msgs" / "package.xml").write_text(
        "<package format='3'><name>my_msgs</name><version>1.0.0</version></package>"
    )
    fields = "".join(f"{COMMENTS}{UNIT}int32 f{k} # {order}\n" for k, order in enumerate(ORDERS))
    text = f"{COMMENTS}\n\n{COMMENTS}int8 A=1 # psl x\n{UNIT}int8 B=2\n{fields}"
    text += 'string S="-- synthesis translate_off"\nInner[2] inner\n'
    (messages / "Orders.msg").write_text(text, encoding="utf-8", newline="")
    (messages / "Inner.msg").write_text(f"{COMMENTS}float64 x # pragma translate_off\n")
    (built,) = build(
        ["my_msgs/msg/Orders"],
        here / "out",
        library=Library("lyrical", [here]),
        options=Options(extras=EVERYTHING),
    )
    return built.folder


def ghdl_output(ghdl: str, files: list[str], folder: Path, work: Path) -> tuple[str, str]:
    """Return the messages of GHDL, and the synthesized deserializer."""
    options = ["--std=08", "-fpsl", f"--workdir={work}"]
    analysed = subprocess.run(
        [ghdl, "-a", *options, "--warn-error", *files], cwd=folder, capture_output=True, text=True
    )
    entity = "my_msgs_msg_orders_cdr_8_deserializer"
    netlist = subprocess.run(
        [ghdl, "--synth", *options, "--out=raw-vhdl", *files, "-e", entity],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    # GHDL also reports memories; these notes are removed.
    notes = re.sub(r"^\S+:note: found RAM .*\n.*\n +\^\n", "", netlist.stderr, flags=re.MULTILINE)
    return analysed.stdout + analysed.stderr + notes, netlist.stdout


def test_ghdl_sees_all_declarations(ghdl, folder, tmp_path):
    files = (folder / "vhdl" / "files.txt").read_text().split()
    complaints, netlist = ghdl_output(ghdl, files, folder / "vhdl", tmp_path)
    assert complaints == ""
    for number in range(len(ORDERS)):
        assert f"f{number}" in netlist


def test_unescaped_pragmas_in_vhdl_take_effect(ghdl, folder, tmp_path):
    files = (folder / "vhdl" / "files.txt").read_text().split()
    (tmp_path / "work").mkdir()
    for name in files:
        text = (folder / "vhdl" / name).read_text()
        (tmp_path / name).write_text(re.sub(r"-- # (?=synthesis)", "-- ", text))
    complaints, _ = ghdl_output(ghdl, files, tmp_path, tmp_path / "work")
    assert "translate_off" in complaints


def lint_output(verilator: str, folder: Path) -> str:
    """Return what Verilator and slang print about the structs."""
    list_ = (folder / "systemverilog" / "files.f").read_text().split()
    top = [name for name in list_ if name.endswith("_deserializer_sv.sv")]
    waived = ["../waivers.vlt", "waivers.vlt", "--top-module", top[0].removesuffix(".sv")]
    done = subprocess.run(
        [verilator, "--lint-only", "-Wall", *waived, "-F", "files.f"],
        cwd=folder / "systemverilog",
        capture_output=True,
        text=True,
        check=False,
    )
    orders = ["--translate-off-format", "synthesis,translate_off,translate_on"]
    ghdl_output = slang(list_, folder / "systemverilog", "-Wno-case-overlap", *orders)
    return done.stdout + done.stderr + ghdl_output


def test_linters_see_all_declarations_of_structs(verilator, folder):
    assert lint_output(verilator, folder) == ""


def test_unescaped_pragmas_in_structs_take_effect(verilator, folder, tmp_path):
    shutil.copytree(folder, tmp_path / "copy")
    for path in (tmp_path / "copy" / "systemverilog").glob("*_sv_pkg.sv"):
        path.write_text(re.sub(r"// # (?=synthesis)", "// ", path.read_text()))
    assert "error: " in lint_output(verilator, tmp_path / "copy")


def head_of(path: Path) -> str:
    """Return the beginning of a file, with each comment in one line; lines may end at a hyphen."""
    return re.sub(r"\n(?:--|//) ?", " ", path.read_text())[:1000].replace("firm- hdl", "firm-hdl")


def test_files_of_one_type_say_what_made_them_and_shared_files_do_not(folder):
    manifest = json.loads((folder / "manifest.json").read_text())
    inputs, vhdl = manifest["inputs"], manifest["vhdl"]
    assert inputs["definition_sha256"] != inputs["plan_sha256"]
    facts = [
        f" of my_msgs/msg/Orders, made by firm-hdl {inputs['generator']['firm-hdl']}.",
        "lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes",
        f"definition (SHA-256): {inputs['definition_sha256']}",
    ]
    shared = {*vhdl["common_files"], *vhdl["bench"]["common_files"]}
    shared |= {each["file"] for each in vhdl["shared_packages"]}
    for name in [*vhdl["files"], *vhdl["bench"]["files"]]:
        head = head_of(folder / "vhdl" / name)
        assert [fact in head for fact in facts] == [name not in shared] * 3, name
    others = [*folder.glob("*.v"), *folder.glob("*.veo")]
    others += folder.glob("systemverilog/*serializer_sv.sv")
    assert len(others) == 6
    for path in others:
        # Each says which converter it is.
        way = "deserializer" if "_deserializer_" in path.name else "serializer"
        assert head_of(path).startswith(f"// {path.stem}: the {way} of "), path
        assert all(fact in head_of(path) for fact in facts), path


WORDS = "synthesis|pragma|synopsys|rtl_synthesis|psl|verilator|vhdl_comp_off|coverage|protect"
STARTS = re.compile(rf"(?:--|//|/\*|^\s*#)\s*(?:{WORDS})\b", re.MULTILINE)
QUOTED = re.compile(r"(?:--|//) # .*")


def test_no_comment_of_any_file_begins_with_a_pragma(folder):
    tried = 0
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        text = path.read_bytes().decode()
        assert not {*text} & {chr(code) for code in range(32)} - {"\n", "\t"}, path
        if path.suffix in (".json", ".md"):
            continue  # They are no input of tools of hardware.
        assert text.isascii(), path
        tried += len(re.findall(WORDS, text))
        assert not STARTS.search(QUOTED.sub("", text)), path
    assert tried > 100
