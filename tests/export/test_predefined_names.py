# amaranth: UnusedElaboratable=no
"""Constants may have names that VHDL's own packages declare, without a conflict.

The names are read from GHDL's sources of these packages.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.export.constants import named_constants
from firm_hdl.names.keywords import KEYWORDS
from firm_hdl.plan import build_plan
from firm_hdl.vhdl.names import PREDEFINED, USED
from firm_hdl.wire import lay_out
from tests.export.vhdl.test_layer import analyse, vhdl_of, write
from tests.frontend.workspace import library
from tests.tools import need, run_script
from tests.vhdl.ghdl import GHDL

# Packages that benches use; nearly every design uses the first three.
PACKAGES = {
    "std.standard": "std/v08/standard.vhdl",
    "ieee.std_logic_1164": "ieee2008/std_logic_1164.vhdl",
    "ieee.numeric_std": "ieee2008/numeric_std.vhdl",
    "std.textio": "std/v08/textio.vhdl",
    "std.env": "std/env.vhdl",
    "ieee.math_real": "ieee2008/math_real.vhdl",
}
COMMON = list(PACKAGES)[:3]
# Subprograms that a type declares implicitly (IEEE Std 1076-2008, 5.2.6, 5.4.2 and 5.5.2).
IMPLICIT = {"minimum", "maximum", "to_string"}
# GHDL declares two types that no text can name (5.2.3.1).
ANONYMOUS = {"universal_integer", "universal_real"}
OF_FILES = {"file_open", "file_close", "endfile", "flush", "deallocate"}


def declared(text: str) -> set[str]:
    """List what a package declares, in lower case."""
    # Character literals are not names, and contain brackets and semicolons.
    text = re.sub(r"'.'", "0", re.sub(r"--.*", "", text))
    # Parameters of subprograms are not names of the package.
    text = re.sub(r"\b(function|procedure)\s+(\w+)\s*\([^)]*\)", r"\1 \2", text, flags=re.I)
    kinds = "function|procedure|type|subtype|constant|file|alias|attribute"
    found = set(re.findall(rf"^\s*(?:{kinds})\s+([a-z]\w*)", text, re.I | re.M))
    for literals in re.findall(r"\btype\s+\w+\s+is\s*\(([^;]*)\)\s*;", text, re.I):
        found |= set(re.findall(r"\b[a-z]\w*", literals, re.I))
    for units in re.findall(r"\bunits\b(.*?)end\s+units", text, re.I | re.S):
        found |= set(re.findall(r"^\s*(\w+)", units, re.M))
    return {name.lower() for name in found}


@pytest.fixture(scope="module")
def names() -> dict[str, set[str]]:
    """The names that each package declares."""
    ghdl = need("GHDL", GHDL)
    output = subprocess.run([ghdl, "--disp-config"], capture_output=True, text=True, check=True)
    (prefix,) = re.findall(r"^library prefix: (.*)$", output.stdout, re.MULTILINE)
    sources = Path(prefix).parent / "src"
    need("GHDL's source of its packages", "here" if sources.is_dir() else None)
    found = {
        package: declared((sources / file).read_text("latin-1"))
        for package, file in PACKAGES.items()
    }
    found["std.standard"] = found["std.standard"] - ANONYMOUS | IMPLICIT
    found["std.textio"] |= OF_FILES
    return found


def test_names_that_every_design_sees_are_known(names):
    seen = set().union(*(names[package] for package in COMMON))
    assert {name for name in seen if name not in KEYWORDS} <= PREDEFINED | USED


DESIGN = """\
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.p_msg_t_cdr_8_pkg.all;
entity design is
end entity;
architecture sim of design is
begin
  process
  begin
    wait for 5 ns;
    assert now = 5 ns and minimum(1, 2) = 1 and to_01(unsigned'("H1")) = 3;
{tests}
    report "all " & integer'image({count}) & " are right" & LF;
    wait;
  end process;
end architecture;
"""


@pytest.fixture(scope="module")
def message(names, tmp_path_factory):
    """A message with a constant of each name."""
    every = sorted({name.upper() for found in names.values() for name in found})
    assert len(every) > 230
    lines = [f"uint8 {name}={number % 256}" for number, name in enumerate(every)]
    text = "\n".join([*lines, "int16 x", "float64[2] y"])
    message = library(tmp_path_factory.mktemp("src"), {"p/T": text}).message("p/T")
    assert [constant.name for constant in message.constants] == every
    return message


def with_bench(message, ports: str):
    plan = build_plan(lay_out(message), bus_bytes=8)
    return vhdl_of(message, 8, stimuli(message, plan), ports=ports)[0]


@pytest.fixture(scope="module")
def vhdl(message):
    """The message's converters with records, and their benches."""
    return with_bench(message, "records")


def test_constants_of_every_name_are_read_in_a_users_design(ghdl, names, message, vhdl, tmp_path):
    found = named_constants(message, ())
    common = set().union(*(names[package] for package in COMMON)) | USED
    for each in found:
        name = each.constant.name
        # Keywords of one of the languages, such as `input`, have a suffix of their own.
        end = "_CONSTANT" if name.lower() in common else "_field" * (name.lower() in KEYWORDS)
        assert each.name == name + end
    tests = "".join(
        f"    assert {each.name} = {each.constant.value} severity failure;\n" for each in found
    )
    write(tmp_path, {**vhdl.files, "design.vhd": DESIGN.format(tests=tests, count=len(found))})
    analyse(ghdl, tmp_path, [*vhdl.manifest["files"], "design.vhd"])
    output = subprocess.run(
        [ghdl, "--elab-run", "--std=08", "design", "--ieee-asserts=disable-at-0"],
        cwd=tmp_path, capture_output=True, text=True, timeout=300, check=True,
    )  # fmt: skip
    assert f"all {len(found)} are right" in output.stdout + output.stderr


@pytest.mark.parametrize("ports", ["records", "flat"])
@pytest.mark.sampled(2)
def test_benches_run_with_constants_of_every_name(ghdl, message, vhdl, tmp_path, ports):
    if ports == "flat":
        vhdl = with_bench(message, "flat")
    write(tmp_path / "vhdl", vhdl.files)
    benches = [name for name in vhdl.manifest["bench"]["files"] if name.endswith("_tb.vhd")]
    assert len(benches) == (2 if ports == "records" else 1)
    for bench in benches:
        status, output = run_script(
            tmp_path / "vhdl" / "run_ghdl.sh", GHDL=ghdl, BENCH=bench.removesuffix(".vhd")
        )
        assert status == 0 and output.startswith("PASS p/msg/T"), output


def test_bench_that_uses_everything_does_not_compile(ghdl, vhdl, tmp_path):
    write(tmp_path, vhdl.files)
    (bench,) = [name for name in vhdl.files if name.endswith("t_cdr_8_tb.vhd")]
    text, count = re.subn(r"(?<=_t_cdr_8_pkg);", ".all;", vhdl.files[bench])
    assert count == 1
    (tmp_path / bench).write_text(text)
    with pytest.raises(AssertionError, match="p_msg_t_"):
        analyse(ghdl, tmp_path, [*vhdl.manifest["files"], *vhdl.manifest["bench"]["files"]])
