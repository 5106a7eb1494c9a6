"""SystemVerilog packages and stubs of messages, and linters for them."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path

from firm_hdl.export.backend import Converters
from firm_hdl.export.options import Options
from firm_hdl.export.systemverilog.backend import wrapper_name
from firm_hdl.export.systemverilog.backend import write as write_systemverilog
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


# The wrapper converts Verilog vectors to arrays and signed numbers, which slang reports.
SLANG = "slang --single-unit -Wextra -Wno-packed-array-conv -Wno-sign-conversion".split()

# The same steps as in slang's own command.
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
    """Read files as one design with slang; return its output."""
    need("slang (pyslang)", "here" if find_spec("pyslang") else None)
    command = [sys.executable, "-c", RUN_SLANG, *SLANG, *options, *files]
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=300, check=False
    )
    output = done.stdout + done.stderr
    assert done.returncode == 0 or output
    return output


def stub(plan: Plan, direction: Direction, module: str) -> str:
    """Return a module with the ports of a converter, whose outputs are all 0."""
    ports = ports_of(plan, direction)

    def range_(port: Port) -> str:
        return f"[{port.width - 1}:0] " if port.width > 1 else ""

    lines = ",\n".join(f"  {port.direction}put wire {range_(port)}{port.name}" for port in ports)
    outputs = "".join(f"  assign {p.name} = 0;\n" for p in ports if p.direction == "out")
    return f"module {module} (\n{lines}\n);\n{outputs}endmodule\n"


class Design:
    """A folder with the SystemVerilog of several messages, and a module that instantiates all."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.texts: dict[str, str] = {}
        self.instances: list[str] = []

    def add(self, message: Message, bus_bytes: int = 8) -> dict:
        """Add a message's files except `files.f`; return their section of the manifest."""
        plan = plan_of(message, bus_bytes)
        name = f"{identifier(message.name)}_{plan.wire}_{bus_bytes}"
        options = Options(bus_bytes=bus_bytes)
        made = write_systemverilog(
            Converters(message=message, plan=plan, name=name, options=options)
        )
        section = made.manifest["systemverilog"]
        for file in section["files"]:
            if not file.startswith("../"):
                text = made.files[f"systemverilog/{file}"]
                # Shared files are the same for all types.
                assert self.texts.setdefault(file, text) == text
        for way in DIRECTIONS:
            core, wrapper = module_name(name, way), wrapper_name(name, way)
            assert self.texts.setdefault(f"{core}.v", stub(plan, way, core))
            self.instances.append(f"  {wrapper} u{len(self.instances)} ();\n")
        self.texts["waivers.vlt"] = made.files["systemverilog/waivers.vlt"]
        return section

    def write(self) -> list[str]:
        """Write all files; return those for a compiler, in order."""
        self.texts["all.sv"] = f"module all_of_them;\n{''.join(self.instances)}endmodule\n"
        for name, text in self.texts.items():
            (self.folder / name).write_text(text)
        packages = [name for name in self.texts if name.endswith("_pkg.sv")]
        return [*packages, *(n for n in self.texts if n not in (*packages, "waivers.vlt"))]

    def lint(self, verilator: str) -> str:
        """Lint all files with Verilator; return its output."""
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
