# amaranth: UnusedElaboratable=no
"""Mistakes of accelerators, as users make them in a file beside a description."""

from __future__ import annotations

import gc
import sys
from pathlib import Path

import pytest
from amaranth.hdl import Fragment

from firm_hdl.cli import main
from firm_hdl.node import Node, read_description

NAME = "mistaken"
TEXT = f"""\
node: double
distro: jazzy
accelerator: {NAME}:Double
subscribe:
  /number: {{type: std_msgs/msg/Int32}}
publish:
  /double: {{type: std_msgs/msg/Int32}}
"""


def double():
    """Return the accelerator of the tutorial."""
    page = Path(__file__).parents[2] / "docs" / "tutorial" / "first-node.md"
    return page.read_text(encoding="utf-8").split("```py\n")[1].split("```")[0]


MISTAKES = {
    "elaborate raises": (
        ("m = Module()", "m = Module(); [][1]"),
        "'mistaken:Double' raised IndexError at FILE:12: list index out of range",
    ),
    "no such field": (
        ("number.data", "number.dat"),
        "at FILE:13: Message std_msgs/msg/Int32 has no member 'dat'; it has data",
    ),
    "returns nothing": (
        ("        return m", ""),
        "'mistaken:Double' raised ",
    ),
    "two drivers": (
        ("return m", "m.submodules.n = n = Module(); n.d.comb += sent.valid.eq(1); return m"),
        "'mistaken:Double': Signal (sig publish__double__data__valid) bit 0 driven from",
    ),
    "two connections": (
        ("return m", "m.d.comb += sent.valid.eq(came.ready); return m"),
        "Stream 'publish.double.data' is connected twice: only the last connection would count",
    ),
    "another clock": (
        ("return m", "m.d.fast += __import__('amaranth.hdl').hdl.Signal().eq(1); return m"),
        "the accelerator uses the clock domain 'fast', which it does not have",
    ),
    "syntax": (("class Double(", "class Double(("), "'mistaken' has a mistake at FILE:7: "),
    "ends Python": (
        ("class Double", "raise SystemExit(3)\nclass Double"),
        "'mistaken' raised SystemExit at FILE:7: 3",
    ),
    "zero": (("class Double", "1 / 0\nclass Double"), "raised ZeroDivisionError at FILE:7: "),
}


def run(*arguments):
    """Run the command; what a mistake left unfinished is collected before warnings count again."""
    status = main(["node", *arguments])
    gc.collect()
    return status


@pytest.fixture(scope="module", autouse=True)
def older_objects():
    """Leave objects of earlier tests out of each collection, which would take most of the time."""
    gc.collect()
    gc.freeze()


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the description; modules are forgotten after the test."""
    (tmp_path / "double.yaml").write_text(TEXT)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    yield tmp_path
    sys.modules.pop(NAME, None)


# Only the text of a design shows two drivers.
@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("action", "mistake"),
    [
        *(("info", each) for each in MISTAKES if each != "two drivers"),
        *(("build", each) for each in MISTAKES),
        *(("run", each) for each in list(MISTAKES)[:2]),
    ],
)
def test_a_mistake_is_an_error_at_the_name(folder, capsys, action, mistake):
    change, message = MISTAKES[mistake]
    text = double()
    assert text.count(change[0]) == 1
    (folder / f"{NAME}.py").write_text(text.replace(*change))
    options = ["--engine", "amaranth", "--graph", "none"] if action == "run" else []
    assert run(action, "double.yaml", *options) == 1
    said = [line for line in capsys.readouterr().err.splitlines() if "error" in line]
    assert len(said) == 1 and said[0].startswith("double.yaml:3:14: error: ")
    assert message in said[0].replace(str(folder / f"{NAME}.py"), "FILE").replace(
        f"{NAME}.py:", "FILE:"
    )


CANNOT_BE_LOADED = {
    "not there": (double(), "", "cannot import 'mistaken': No module named 'mistaken'"),
    "needs another": (
        "class Double",
        "import not_there\nclass Double",
        "cannot import 'mistaken' at FILE:7: No module named 'not_there'",
    ),
    "needs another later": (
        "super()",
        "import not_there; super()",
        "'mistaken:Double' raised ModuleNotFoundError at FILE:9: No module named 'not_there'",
    ),
    "other name": ("class Double(", "class Single(", "'mistaken' has no 'Double'"),
    "fails in a library": (
        "class Double",
        "import json; json.loads('')\nclass Double",
        "'mistaken' raised JSONDecodeError at FILE:7: Expecting value",
    ),
    "no Exception": (
        "class Double",
        "raise GeneratorExit('gone')\nclass Double",
        "'mistaken' raised GeneratorExit at FILE:7: gone",
    ),
    "an error without a text": (
        "class Double",
        "class Odd(Exception):\n    __str__ = None\nraise Odd\nclass Double",
        "'mistaken' raised Odd at FILE:9: its text cannot be read",
    ),
    "attributes": (
        "class Double(",
        "def __getattr__(name):\n    return {}[name]\nclass Single(",
        "'mistaken' raised KeyError at FILE:8: 'Double'",
    ),
    "another member": (
        "accelerator_signature(description)",
        "{}",
        "the accelerator has no 'subscribe' with the ports of its topics",
    ),
    "a signature that fails": (
        "    def elaborate",
        "    @property\n    def signature(self):\n        return 1 // 0\n    def elaborate",
        "'mistaken:Double' raised ",
    ),
}


@pytest.mark.parametrize("mistake", CANNOT_BE_LOADED)
def test_info_loads_the_accelerator(folder, capsys, mistake):
    change, new, message = CANNOT_BE_LOADED[mistake]
    text = double()
    assert text.count(change) == 1
    if mistake != "not there":
        (folder / f"{NAME}.py").write_text(text.replace(change, new))
    assert run("info", "double.yaml") == 1
    out, said = capsys.readouterr()
    assert not out and said.startswith("double.yaml:3:14: error: ")
    assert f"\n{' ' * 13}^^^^^^" in said and "Traceback" not in said
    assert message in said.replace(str(folder / f"{NAME}.py"), "FILE")


def test_info_of_an_accelerator_that_can_be_loaded_warns_of_nothing(folder, capsys):
    (folder / f"{NAME}.py").write_text(double())
    assert run("info", "double.yaml") == 0
    assert "accelerator mistaken:Double" in capsys.readouterr().out


def test_each_description_has_the_module_of_its_own_folder(tmp_path):
    """Also if that of another folder has the same name, and one beside it."""
    for name in ("a", "b", "a"):
        (tmp_path / name).mkdir(exist_ok=True)
        (tmp_path / name / "beside.py").write_text(f"here = '{name}'\n")
        (tmp_path / name / f"{NAME}.py").write_text(f"from beside import here\n{double()}")
        (tmp_path / name / "double.yaml").write_text(TEXT)
        accelerator = Node(read_description(tmp_path / name / "double.yaml")).accelerator
        module = sys.modules[type(accelerator).__module__]
        assert module.here == name
    sys.modules.pop(NAME)


@pytest.mark.parametrize("taken", ["sys", "json", "amaranth"])
def test_a_module_whose_name_is_taken_is_an_error_at_the_name(folder, capsys, taken):
    (folder / "double.yaml").write_text(TEXT.replace(NAME, taken))
    (folder / f"{taken}.py").write_text(double())
    assert run("build", "double.yaml") == 1
    said = capsys.readouterr().err
    assert said.startswith(f"double.yaml:3:14: error: '{taken}' is the name of another module, ")


def test_a_clock_of_its_own_is_no_mistake(folder):
    """The accelerator has the domain, and drives its clock."""
    text = double().replace("import Module\n", "import ClockDomain, Module, Signal\n")
    own = "m.domains.fast = ClockDomain(); m.d.fast += Signal().eq(1); return m"
    (folder / f"{NAME}.py").write_text(text.replace("return m", own))
    assert Fragment.get(Node(read_description("double.yaml")), None)


def test_a_file_in_place_of_a_module(folder, capsys):
    (folder / "double.yaml").write_text(TEXT.replace(f"{NAME}:", f"{NAME}.py:"))
    (folder / f"{NAME}.py").write_text(double())
    assert run("build", "double.yaml") == 1
    assert f"; write '{NAME}:Double'" in capsys.readouterr().err
