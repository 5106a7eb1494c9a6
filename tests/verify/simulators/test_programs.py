"""The programs of simulators: which ones are run, with what, and what they have to say."""

from __future__ import annotations

import os
from pathlib import Path
from types import SimpleNamespace

import pytest

import firm_hdl.verify.simulators.ghdl as ghdl
import firm_hdl.verify.simulators.icarus as icarus
import firm_hdl.verify.simulators.verilated as verilated
from firm_hdl.jobs.processes import ToolError
from firm_hdl.verify.simulators.verilated import Runtime, runtime_of, runtime_parts


def program(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("#!/bin/sh\n")
    path.chmod(0o755)
    return path


def test_vvp_is_that_beside_its_compiler(monkeypatch, tmp_path):
    compiler = program(tmp_path / "own" / "iverilog")
    elsewhere = program(tmp_path / "elsewhere" / "vvp")
    monkeypatch.setenv("IVERILOG", str(compiler))
    monkeypatch.setenv("PATH", os.pathsep.join([str(elsewhere.parent), os.environ["PATH"]]))
    assert icarus.Icarus().run_path == str(elsewhere)
    beside = program(tmp_path / "own" / "vvp")
    assert icarus.Icarus().run_path == str(beside)


def test_verilator_is_that_of_the_environment(monkeypatch, tmp_path):
    own = program(tmp_path / "my-verilator")
    monkeypatch.setenv("VERILATOR", str(own))
    assert verilated.find_verilator() == str(own)


def test_icarus_reads_the_language_that_was_asked_for(monkeypatch, tmp_path):
    monkeypatch.setenv("IVERILOG", str(program(tmp_path / "iverilog")))
    program(tmp_path / "vvp")
    monkeypatch.setattr(icarus, "write_inputs", lambda *_: ["a.v", "b.v"])
    monkeypatch.setattr(icarus, "written", lambda *_, **__: "")
    monkeypatch.setattr(icarus, "modules_of", lambda trace: [])
    asked = []

    def run(command, folder):
        asked.append(command[1:])
        (folder / "replay.vvp").write_text("x")
        (folder / "results.txt").write_text("0 x1z\n1 0\n")

    monkeypatch.setattr(icarus, "run_tool", run)
    rows = icarus.Icarus("2005").replay(None, list, tmp_path)
    assert asked[0] == ["-g2005", "-s", "replay", "-o", "replay.vvp", "a.v", "b.v", "replay.v"]
    assert asked[1][-1] == "replay.vvp" and len(asked) == 2
    # Undefined bits are capital letters in every simulator.
    assert rows == ["0 X1Z", "1 0"]


def test_ghdl_gets_every_file_in_order_and_every_row(monkeypatch, tmp_path):
    monkeypatch.setattr(ghdl, "find_ghdl", lambda: "own-ghdl")
    asked, described, results = [], {}, ["0 X1", "", "1 0"]

    def convert(top, *, name):
        # The outermost entity is the last one.
        entities = {
            part: SimpleNamespace(ports={"a": f"{part} of {top}"}) for part in ("in", "out")
        }
        texts = {f"{name}_{part}.vhd": f"{part} of {top}" for part in ("in", "out")}
        return SimpleNamespace(files=texts, entities=entities)

    def written(name, trace, **more):
        described.update({name: more})
        return "the bench"

    def run(command, folder):
        asked.append(command)
        assert folder == tmp_path and (tmp_path / "stimuli.txt").read_text() == "1 0 1\n0\n"
        (folder / "results.txt").write_text("".join(f"{row}\n" for row in results))

    monkeypatch.setattr(ghdl, "convert", convert)
    monkeypatch.setattr(ghdl, "written", written)
    monkeypatch.setattr(ghdl, "run_tool", run)
    devices = [SimpleNamespace(name="d"), SimpleNamespace(name="s")]
    trace = SimpleNamespace(devices=devices, stimuli=["1 0 1", "0"])
    assert ghdl.Ghdl().replay(trace, lambda: ["one", "two"], tmp_path) == results
    files = ["d_in.vhd", "d_out.vhd", "s_in.vhd", "s_out.vhd", "replay.vhd"]
    assert asked[0] == ["own-ghdl", "-a", "--std=08", *files]
    assert asked[1][:4] == ["own-ghdl", "--elab-run", "--std=08", "replay"] and len(asked) == 2
    texts = ["in of one", "out of one", "in of two", "out of two", "the bench"]
    assert [(tmp_path / name).read_text() for name in files] == texts
    assert described == {"replay.vhd": {"ports": [{"a": "out of one"}, {"a": "out of two"}]}}
    with pytest.raises(ValueError, match="zip"):
        ghdl.Ghdl().replay(trace, lambda: ["one"], tmp_path)


def test_a_ghdl_that_writes_nothing_has_failed(monkeypatch, tmp_path):
    monkeypatch.setattr(ghdl, "find_ghdl", lambda: "own-ghdl")
    monkeypatch.setattr(ghdl, "written", lambda *_, **__: "")
    monkeypatch.setattr(ghdl, "run_tool", lambda *_: "")
    trace = SimpleNamespace(devices=[], stimuli=[])
    with pytest.raises(ToolError, match=r"GHDL .*results\.txt"):
        ghdl.Ghdl().replay(trace, list, tmp_path)


MAKEFILE = """# Verilated -*- Makefile -*-
VM_CLASSES_FAST += \\
\tVreplay \\

VM_GLOBAL_FAST += \\
\tverilated \\
\tverilated_threads \\

VM_GLOBAL_SLOW += \\
\tverilated_slow \\
"""


def test_the_parts_of_the_runtime_are_all_that_the_makefile_names(tmp_path):
    makefile = tmp_path / "classes.mk"
    makefile.write_text(MAKEFILE)
    assert runtime_parts(makefile) == ("verilated", "verilated_threads")
    makefile.write_text(MAKEFILE.replace("GLOBAL_FAST", "GLOBAL_OTHER"))
    with pytest.raises(ToolError, match="which parts of its runtime"):
        runtime_parts(makefile)


@pytest.fixture
def folder(monkeypatch, tmp_path):
    """Make runtimes in a folder of the test."""
    made = SimpleNamespace(name=str(tmp_path))
    monkeypatch.setattr(verilated.tempfile, "TemporaryDirectory", lambda **_: made)


@pytest.fixture
def asked(folder, monkeypatch):
    """The commands that a runtime is made with; the first asks for Verilator's folder."""
    found = []
    monkeypatch.setattr(
        verilated, "run_tool", lambda command, folder: found.append(command) or "/root\n"
    )
    return found


OWN = (Path("/one/a.cpp"), Path("/one/b.cpp"), Path("/two/c.cpp"))


def test_a_runtime_has_every_source_as_an_object(asked):
    made = Runtime("verilator", ["g++", "-m64"], ["-O0"], OWN, ["verilated"])
    assert asked[0] == ["verilator", "--getenv", "VERILATOR_ROOT"]
    assert made.includes == ["-I/root/include", "-I/one", "-I/two"]
    sources = [*map(str, OWN), "/root/include/verilated.cpp"]
    assert [command[: command.index("-o") + 1] for command in asked[1:]] == [
        ["g++", "-m64", "-O0", *made.includes, "-c", source, "-o"] for source in sources
    ]
    assert made.objects == [command[-1] for command in asked[1:]]
    assert [Path(each).name for each in made.objects] == ["a.o", "b.o", "c.o", "verilated.o"]


def test_a_runtime_is_made_once_for_each_set_of_options(asked):
    given = ("verilator-own", ("g++",), ("-O0",), OWN, ("verilated",))
    assert runtime_of(*given) is runtime_of(*given)
    assert runtime_of(*given[:2], ("-O3",), *given[3:]) is not runtime_of(*given)
    assert runtime_of(*given[:4], ()) is not runtime_of(*given)


def test_a_verilator_that_does_not_know_its_folder_is_an_error(folder, monkeypatch):
    monkeypatch.setattr(verilated, "run_tool", lambda command, folder: "\n")
    with pytest.raises(ToolError, match="did not say where its runtime is"):
        Runtime("verilator", ["g++"], [], OWN, ["verilated"])
