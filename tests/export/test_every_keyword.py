"""Each keyword of VHDL and SystemVerilog as a field, a message and a package, in each tool."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path

import pytest

from firm_hdl.export.build import build
from firm_hdl.export.vhdl.layer import user_layer
from firm_hdl.export.vhdl.wrapper import Core
from firm_hdl.frontend import Library
from firm_hdl.names import identifiers as names
from firm_hdl.names.keywords import KEYWORDS, VERILOG, VHDL
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.depth import THOROUGH, by_depth
from tests.export.test_packaging import run
from tests.frontend.workspace import make_files

# Building circuits with fields for all keywords takes 20 s.
ALL = THOROUGH
LANGUAGES = ("2001", "2005", "2005-sv", "2009", "2012")
STEP = by_depth(120, 60)
SPOT = sorted({*sorted(VHDL)[::STEP], *sorted(VERILOG)[::STEP], "buffer", "final"})


def definitions(words: Iterable[str]) -> dict[str, str]:
    """Return ROS 1 definitions, because ROS 1 allows more names than ROS 2, in any case.

    ``all_words/Fields`` has the words as fields; ``all_words/Types`` uses messages and packages of
    these names. Some words occur in several cases.
    """
    files, types = {}, ""
    for number, word in enumerate(words):
        for name in (word.title(), *([word] if word in SPOT else [])):
            files[f"k/{name}.msg"] = f"uint8 {word}\nuint8 {word.upper()}=1\n"
            types += f"k/{name} t{number}_{name}\n"
        files[f"{word}/Signal.msg"] = "uint8 x\n"
        types += f"{word}/Signal p{number}\n"
    fields = "".join(
        f"uint8 {case(word)}\n"
        for word in words
        for case in ((str, str.title, str.upper) if word in SPOT else (str,))
    )
    return {**files, "all_words/Fields.msg": fields, "all_words/Types.msg": types}


def write_packages(folder: Path, words: Iterable[str]) -> Path:
    files = definitions(words)
    for name in {path.split("/")[0] for path in files}:
        files[f"{name}/package.xml"] = (
            f"<package format='2'><name>{name}</name><version>1.0.0</version></package>"
        )
    moved = {
        path if path.endswith(".xml") else path.replace("/", "/msg/"): text
        for path, text in files.items()
    }
    return make_files(folder, moved)


def records(folder: Path, name: str, work: Path) -> list[str]:
    """Write the packages of a message, without its circuits; return their names."""
    message = Library("noetic", [folder]).message(name)
    plan = build_plan(lay_out(message), bus_bytes=8)
    cores = {way: Core(entity=way, names={}) for way in ("deserializer", "serializer")}
    layer = user_layer(message, plan, name="t", cores=cores)
    packages = {n: t for n, t in layer.packages.items() if not n.startswith("t_components")}
    for file, text in packages.items():
        (work / file).write_text(text)
    return list(packages)


@pytest.mark.parametrize("name", ["all_words/Fields", "all_words/Types"])
@pytest.mark.thorough
def test_records_take_every_word(ghdl, tmp_path, name):
    folder = write_packages(tmp_path / "ws", sorted(KEYWORDS))
    files = records(folder, name, tmp_path)
    assert len(files) > (600 if "Types" in name else 2)
    assert run([ghdl, "-a", "--std=08", "--warn-error", *files], tmp_path) == (0, "")


def test_keyword_as_a_name_is_refused(ghdl, tmp_path, monkeypatch):
    folder = write_packages(tmp_path / "ws", ["buffer"])
    monkeypatch.setattr(names, "KEYWORDS", frozenset())
    files = records(folder, "all_words/Fields", tmp_path)
    status, output = run([ghdl, "-a", "--std=08", *files], tmp_path)
    assert status != 0 and "buffer" in output


@pytest.mark.thorough
def test_every_tool_takes_every_word(ghdl, iverilog, verilator, tmp_path):
    words = sorted(KEYWORDS) if ALL else SPOT
    # The names of packages and messages are in VHDL and SystemVerilog only: as above, and in
    # systemverilog/test_structs.py.
    types = ["all_words/Fields", *by_depth([], ["all_words/Types"])]
    folder = write_packages(tmp_path / "ws", words)
    for built in build(types, tmp_path / "out", library=Library("noetic", [folder])):
        vhdl = built.folder / "vhdl"
        files = [*(vhdl / "files.txt").read_text().split()]
        files += (vhdl / "bench_files.txt").read_text().split()
        (tmp_path / "work").mkdir()
        options = ["-a", "--std=08", f"--workdir={tmp_path / 'work'}"]
        assert run([ghdl, *options, *files], vhdl) == (0, "")
        shutil.rmtree(tmp_path / "work")
        for verilog in built.folder.glob("*.v"):
            for each in LANGUAGES:
                assert run([iverilog, f"-g{each}", "-t", "null", verilog.name], built.folder) == (
                    0,
                    "",
                )
            lint = [verilator, "--lint-only", "-Wall", "waivers.vlt", verilog.name]
            for each in ("1364-2005", "1800-2017"):
                assert run([*lint, "--default-language", each], built.folder) == (0, "")
