"""The files of a node's registers, by PeakRDL and by a C compiler."""

from __future__ import annotations

import re
import shutil
import subprocess
from importlib.util import find_spec

from firm_hdl.node.register_map import register_files
from tests.node.samples import read
from tests.tools import need

MAIN = """\
#include "n_registers.h"
#include "peakrdl.h"
int main(void)
{
  uint32_t sec, nanosec, registers[256] = {0};
  if (wheels_node_is(registers))
    return 1;
  wheels_node_set_time(registers, 7, 8);
  registers[8] = registers[12];
  registers[9] = registers[13];
  wheels_node_get_time(registers, &sec, &nanosec);
  wheels_node_set_rate(registers, WHEELS_NODE_NEW_RATE_RESET);
  return sec == 7 && nanosec == 8 && registers[14] == 8u << 22 ? 0 : 2;
}
"""


def test_peakrdl_and_a_compiler_agree_with_the_header(tmp_path):
    found = find_spec("systemrdl") and find_spec("peakrdl_cheader")
    need("peakrdl-cheader", "here" if found else None)
    from peakrdl_cheader.exporter import CHeaderExporter
    from systemrdl import RDLCompiler

    files = register_files(read(clock_mhz="125", registers="axi4lite"), "n", "A test */")
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    compiler = RDLCompiler()
    compiler.compile_file(str(tmp_path / "n_registers.rdl"))
    CHeaderExporter().export(compiler.elaborate(), str(tmp_path / "peakrdl.h"))
    names = re.findall(r"#define WHEELS_NODE_(\w+) 0x[0-9a-f]+  ", files["n_registers.h"])
    assert {"ID", "NODE_CONTROL", "REQUEST_ROBOT_WHEELS_CALIBRATE_BYTES_HIGH"} <= set(names)
    same = "".join(
        f'_Static_assert(offsetof(wheels_node_t, {name.lower()}) == WHEELS_NODE_{name}, "");\n'
        for name in names
    )
    (tmp_path / "main.c").write_text(MAIN + same)
    cc, cxx = (need("a compiler", shutil.which(each)) for each in ("cc", "c++"))
    strict = ["-Wall", "-Wextra", "-Werror"]
    subprocess.run([cc, "-std=c11", *strict, "-o", "main", "main.c"], cwd=tmp_path, check=True)
    subprocess.run([tmp_path / "main"], check=True)
    command = [cxx, "-std=c++17", *strict, "-fsyntax-only", "-x", "c++", "n_registers.h"]
    subprocess.run(command, cwd=tmp_path, check=True)
