"""The folder of a design of one top level: when it is written, and what its files say."""

from __future__ import annotations

import hashlib
import json
from importlib.metadata import version
from pathlib import Path

import pytest
import yaml

import firm_hdl
from firm_hdl.errors import UserError
from firm_hdl.export.design import (
    BuiltDesign,
    core_file,
    design_folder,
    inputs_of_design,
    write_design,
)
from firm_hdl.export.manifest import to_json

FACTS = {"part": "fifo", "parameters": {"widths": (1, 2)}}
FILES = {"gate_verilog.v": "module\n", "vhdl/gate.vhd": "entity\n"}
PORTS = [{"name": "aclk"}, {"name": "aresetn"}]


def write(folder: Path, *, design: str = "rtlil", **options: object) -> BuiltDesign:
    inputs = inputs_of_design(FACTS, design)
    given = {"facts": FACTS, "ports": PORTS, "make_files": lambda: FILES, **options}
    return write_design(folder, inputs=inputs, **given)


def test_a_design_is_written_if_it_is_new_or_changed_or_asked_for(tmp_path):
    folder = tmp_path / "gate"
    assert not write(folder).was_current
    # Tuples among the facts are read back as lists.
    assert write(folder).was_current
    assert not write(folder, force=True).was_current
    assert not write(folder, design="other rtlil").was_current
    assert write(folder, design="other rtlil").was_current
    (folder / "vhdl" / "gate.vhd").unlink()
    assert not write(folder, design="other rtlil").was_current
    assert (folder / "vhdl" / "gate.vhd").read_text() == "entity\n"


def test_files_of_a_user_are_kept_and_refused_where_they_are_in_the_way(tmp_path):
    folder = tmp_path / "gate"
    write(folder)
    (folder / "gate_verilog.v").write_text("mine\n")
    with pytest.raises(UserError, match=r"'.*gate' has files of yours, .*: gate_verilog\.v$"):
        write(folder, force=True)
    built = write(folder, make_files=lambda: {"gate.core": "x"}, force=True)
    assert built == BuiltDesign(folder=folder, was_current=False, kept=("gate_verilog.v",))


def test_the_manifest_names_the_module_the_entity_and_every_file(tmp_path):
    write(tmp_path / "gate")
    manifest = json.loads((tmp_path / "gate" / "manifest.json").read_text())
    assert manifest["verilog"] == {"module": "gate_verilog", "file": "gate_verilog.v"}
    assert manifest["vhdl"] == {"entity": "gate", "files": "vhdl/files.txt"}
    assert manifest["ports"] == PORTS
    assert manifest["part"] == "fifo" and manifest["parameters"] == {"widths": [1, 2]}
    assert manifest["files"] == {
        name: hashlib.sha256(text.encode()).hexdigest() for name, text in FILES.items()
    }
    inputs = manifest["inputs"]
    assert inputs["design_sha256"] == hashlib.sha256(b"rtlil").hexdigest()
    assert inputs["parameters"] == {"widths": [1, 2]}
    assert inputs["generator"] == {
        "firm-hdl": firm_hdl.__version__,
        "amaranth": version("amaranth"),
    }
    text = to_json(inputs)
    assert manifest["inputs_sha256"] == hashlib.sha256(text.encode()).hexdigest()


def test_only_folders_that_firm_hdl_made_and_empty_ones_are_written(tmp_path):
    assert design_folder(tmp_path, "new") == tmp_path / "new"
    (tmp_path / "empty").mkdir()
    assert design_folder(tmp_path, "empty") == tmp_path / "empty"
    write(tmp_path / "ours")
    assert design_folder(tmp_path, "ours") == tmp_path / "ours"
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "thesis").write_text("mine")
    (tmp_path / "file").write_text("mine")
    (tmp_path / "link").symlink_to("empty")
    for name, why in (("full", "is not .* made"), ("file", "cannot be"), ("link", "cannot be")):
        with pytest.raises(UserError, match=rf"{name}' {why}"):
            design_folder(tmp_path, name)


def test_an_error_names_the_file_that_cannot_be_written(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(UserError, match=r"/gate' cannot be written: .*/file'\)$"):
        write(tmp_path / "file" / "gate")


def test_a_core_has_both_languages_and_what_is_added():
    more = {
        "filesets": {"bench": {"files": ["vhdl/tb.vhd"]}},
        "targets": {"sim": {"filesets": ["vhdl", "bench"]}},
        "parameters": {"seed": {"datatype": "int"}},
    }
    [(name, text)] = core_file(
        "gate", ["b.vhd", "a.vhd"], kind="part", description="A gate", more=more
    ).items()
    assert name == "gate.core" and text.startswith("CAPI=2:\n")
    assert yaml.safe_load(text.partition("\n")[2]) == {
        "name": f"firm-hdl:part:gate:{firm_hdl.__version__}",
        "description": "A gate",
        "filesets": {
            "vhdl": {"files": ["vhdl/b.vhd", "vhdl/a.vhd"], "file_type": "vhdlSource-2008"},
            "verilog": {"files": ["gate_verilog.v"], "file_type": "verilogSource-2005"},
            **more["filesets"],
        },
        "targets": {
            "default": {"filesets": ["vhdl"], "toplevel": "gate"},
            "verilog": {"filesets": ["verilog"], "toplevel": "gate_verilog"},
            **more["targets"],
        },
        "parameters": more["parameters"],
    }
