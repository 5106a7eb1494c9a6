"""A SoC of LiteX whose firmware exchanges Twists with hardware, in LiteX's simulator.

    processor -> command (registers) -> packets -> motor -> values
    processor <- report (registers)  <- packets <- sensor <-'

Run by `make`, with the folder of the converters: `python soc.py FOLDER`.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

import litex
from litex.build.generic_platform import Pins, Subsignal
from litex.build.io import CRG
from litex.build.sim import SimPlatform
from litex.build.sim.config import SimConfig
from litex.soc.integration.builder import Builder
from litex.soc.integration.common import get_mem_data
from litex.soc.integration.soc import SoCRegion
from litex.soc.integration.soc_core import SoCCore
from litex.soc.interconnect.csr import CSRStorage
from migen import Finish, If

HERE = Path(__file__).resolve().parent
NAME = "geometry_msgs_msg_Twist_cdr_8"

PINS = [
    ("sys_clk", 0, Pins(1)),
    (
        "serial",
        0,
        *(
            Subsignal(f"{way}_{name}", Pins(width))
            for way in ("source", "sink")
            for name, width in (("valid", 1), ("ready", 1), ("data", 8))
        ),
    ),
]


class TwistSoC(SoCCore):
    def __init__(self, converters, cpu, work):
        platform = SimPlatform("SIM", PINS)
        self.converters, self.work = converters, work
        self.crg = CRG(platform.request("sys_clk"))
        SoCCore.__init__(
            self,
            platform,
            clk_freq=int(1e6),
            cpu_type=cpu,
            integrated_rom_size=0x10000,
            integrated_sram_size=0x2000,
            uart_name="sim",
            ident="Twist",
        )
        # The modules that `firm-hdl build --ip litex` has written.
        sys.path.append(str(converters))
        twist = __import__(f"{NAME}_litex")
        self.command = twist.SerializerRegisters(platform)
        self.motor = twist.Deserializer(platform)
        self.sensor = twist.Serializer(platform)
        self.report = twist.DeserializerRegisters(platform)
        for name in ("command", "report"):
            region = SoCRegion(size=0x1000, cached=False)
            self.bus.add_slave(name, getattr(self, name).bus, region)
        if self.irq.enabled:
            self.irq.add("report")
        self.comb += [
            self.command.source.connect(self.motor.sink),
            self.motor.m_axis_linear_x.connect(self.sensor.s_axis_linear_x),
            self.motor.m_axis_angular_z.connect(self.sensor.s_axis_angular_z),
            self.sensor.source.connect(self.report.sink, omit={"user"}),
        ]
        self.finish = CSRStorage()
        self.sync += If(self.finish.re, Finish())

    def init_mems(self, **_):
        """Compile the firmware: LiteX has just written the headers, and now asks for memories."""
        software = Path(litex.__file__).parent / "soc" / "software"
        cpu = Path(sys.modules[type(self.cpu).__module__].__file__).parent
        compiler = "riscv64-unknown-elf-"
        subprocess.run(
            [
                # Names of the instructions that Debian's compiler has libraries for.
                *(f"{compiler}gcc", "-misa-spec=2.2", "-march=rv32i", "-mabi=ilp32"),
                *(f"-D__{self.cpu.name}__", "-O2", "-Wall", "-Werror"),
                *("--specs=picolibc.specs", "-nostartfiles"),
                *(f"-I{software / 'include'}", f"-I{cpu}", f"-I{self.builder.include_dir}"),
                *(f"-I{self.converters}", f"-L{self.builder.include_dir}"),
                *("-T", software / "bios" / "linker.ld", cpu / "crt0.S", HERE / "main.c"),
                *("-o", self.work / "main.elf"),
            ],
            check=True,
        )
        subprocess.run(
            [f"{compiler}objcopy", "-O", "binary", self.work / "main.elf", self.work / "main.bin"],
            check=True,
        )
        image = get_mem_data(
            str(self.work / "main.bin"), data_width=32, endianness=self.cpu.endianness
        )
        self.init_rom("rom", image, auto_size=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("converters", type=Path, help="folder that firm-hdl build has written")
    parser.add_argument("--cpu", default="vexriscv", help="or serv; default: %(default)s")
    parser.add_argument("--work", type=Path, default=Path("work"))
    args = parser.parse_args()
    work = args.work.resolve()
    work.mkdir(exist_ok=True)
    soc = TwistSoC(args.converters.resolve(), args.cpu, work)
    config = SimConfig()
    config.add_clocker("sys_clk", freq_hz=int(1e6))
    config.add_module("serial2console", "serial")
    builder = Builder(soc, output_dir=work / "build", compile_software=False)
    # Without a number of jobs, LiteX starts all compilers at once.
    options = {"jobs": os.cpu_count(), "opt_level": "O0", "verbose": False}
    builder.build(sim_config=config, interactive=False, **options)


if __name__ == "__main__":
    main()
