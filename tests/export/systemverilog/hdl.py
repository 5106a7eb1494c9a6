"""SystemVerilog of messages without circuits, and linters that read it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path

from firm_hdl.export.backend import Converters, Options
from firm_hdl.export.systemverilog.backend import SystemVerilog, wrapper_name
from firm_hdl.export.top import DIRECTIONS, Direction, Port, ports_of
from firm_hdl.export.verilog import module_name
from firm_hdl.model import Message
from firm_hdl.names.identifiers import identifier
from firm_hdl.plan import Plan, build_plan
from firm_hdl.wire import lay_out
from tests.tools import need

__all__ = ["Design", "plan_of", "slang"]


def plan_of(message: Message, bus_bytes: int = 8) -> Plan:
    return build_plan(lay_out(message), bus_bytes=bus_bytes)


# A vector of the Verilog becomes an array of items, and a number with a sign.
SLANG = "slang --single-unit -Wextra -Wno-packed-array-conv -Wno-sign-conversion".split()

# As slang's own command does it.
RUN_SLANG = """\
import sys
from pyslang.driver import Driver
driver = Driver()
driver.addStandardArgs()
right = driver.parseCommandLine(" ".join(f'"{word}"' for word in sys.argv[1:]))
right = right and driver.processOptions() and driver.parseAllSources()
if right:
    compilation = driver.createCompilation()
    driver.reportCompilation(compilation, True)
    driver.runAnalysis(compilation)
    right = driver.reportDiagnostics(True)
sys.exit(not right)
"""


def slang(files: Iterable[str], folder: Path, *options: str) -> str:
    """Have slang read files as one design; give all that it says."""
    need("slang (pyslang)", "here" if find_spec("pyslang") else None)
    command = [sys.executable, "-c", RUN_SLANG, *SLANG, *options, *files]
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=300, check=False
    )
    said = done.stdout + done.stderr
    assert done.returncode == 0 or said
    return said


def stub(plan: Plan, direction: Direction, module: str) -> str:
    """A module with the ports of a converter, which offers nothing and takes nothing."""
    ports = ports_of(plan, direction)

    def range_(port: Port) -> str:
        return f"[{port.width - 1}:0] " if port.width > 1 else ""

    lines = ",\n".join(f"  {port.direction}put wire {range_(port)}{port.name}" for port in ports)
    outputs = "".join(f"  assign {p.name} = 0;\n" for p in ports if p.direction == "out")
    return f"module {module} (\n{lines}\n);\n{outputs}endmodule\n"


class Design:
    """A folder with the SystemVerilog of several messages, and a module with all of theirs."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.texts: dict[str, str] = {}
        self.instances: list[str] = []

    def add(self, message: Message, bus_bytes: int = 8) -> dict:
        """Write a message's files but for `files.f`; give what the manifest says of them."""
        plan = plan_of(message, bus_bytes)
        name = f"{identifier(message.name)}_{plan.wire}_{bus_bytes}"
        options = Options(bus_bytes=bus_bytes)
        made = SystemVerilog().write(
            Converters(message=message, plan=plan, name=name, options=options)
        )
        section = made.manifest["systemverilog"]
        for file in section["files"]:
            if not file.startswith("../"):
                text = made.files[f"systemverilog/{file}"]
                # What types share is the same for all.
                assert self.texts.setdefault(file, text) == text
        for way in DIRECTIONS:
            core, wrapper = module_name(name, way), wrapper_name(name, way)
            assert self.texts.setdefault(f"{core}.v", stub(plan, way, core))
            self.instances.append(f"  {wrapper} u{len(self.instances)} ();\n")
        self.texts["waivers.vlt"] = made.files["systemverilog/waivers.vlt"]
        return section

    def write(self) -> list[str]:
        """Write all files; give those for a compiler, in order."""
        self.texts["all.sv"] = f"module all_of_them;\n{''.join(self.instances)}endmodule\n"
        for name, text in self.texts.items():
            (self.folder / name).write_text(text)
        packages = [name for name in self.texts if name.endswith("_pkg.sv")]
        return [*packages, *(n for n in self.texts if n not in (*packages, "waivers.vlt"))]

    def lint(self, verilator: str) -> str:
        """Have Verilator look at all; give what it says."""
        waived = (
            '`verilator_config\nlint_off -file "*_verilog.v"\n'
            'lint_off -rule PINMISSING -file "*all.sv"\n'
            'lint_off -rule DECLFILENAME -file "*all.sv"\n'
        )
        files = self.write()
        (self.folder / "stubs.vlt").write_text(waived)
        command = [verilator, "--lint-only", "-Wall", "stubs.vlt", "waivers.vlt", *files]
        done = subprocess.run(
            [*command, "--top-module", "all_of_them"],
            cwd=self.folder,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        return done.stdout + done.stderr
