"""Datasheets: pages that are well formed, complete, and show definitions as text."""

from __future__ import annotations

import html
import re
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser
from pathlib import Path

import pytest
from amaranth.back import rtlil

from firm_hdl.cli import main
from firm_hdl.export.top import DIRECTIONS, ports_of
from firm_hdl.frontend import Library
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.export.test_packaging import run
from tests.frontend.workspace import library

VOID = frozenset({"meta", "i", "circle", "line", "path", "rect"})
EVIL = "</pre></title><script>alert(1)</script>&amp;\u202e"
TEXTS = {
    "p/Robot": f"# {EVIL}\nName name\nfloat64[3] wheels  # speed {EVIL} [m/s]\n",
    "p/Name": "string text\n",
}


class Page(HTMLParser):
    """A page whose elements are balanced; `elements` counts them, and `links` are to elsewhere."""

    def __init__(self, text: str):
        super().__init__()
        self.open: list[str] = []
        self.elements: list[str] = []
        self.links: list[str] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.elements.append(tag)
        self.links += [v for k, v in attrs if k in ("src", "href") and not v.startswith("#")]
        if tag != "meta":
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.elements.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def pictures(text: str) -> list[ElementTree.Element]:
    return [ElementTree.fromstring(each) for each in re.findall("<svg.*?</svg>", text, re.DOTALL)]


def codes(text: str) -> list[tuple[str, str]]:
    """Return the texts to be copied, each with its title."""
    found = re.findall(r'<summary>([\w ]+)</summary><pre class="code">(.*?)</pre>', text, re.DOTALL)
    return [(name, html.unescape(code)) for name, code in found]


@pytest.fixture(scope="module")
def built(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("datasheet")
    library(folder / "src", TEXTS)
    words = ["p/Robot", "--path", str(folder / "src"), "--out", str(folder), "--datasheet"]
    assert main(["build", *words, "--with", "systemverilog"]) == 0
    return folder / "lyrical" / "p_msg_Robot_cdr_8"


def test_page_is_whole_and_shows_definitions_as_text(built):
    text = (built / "datasheet.html").read_text()
    page = Page(text)
    assert "script" not in page.elements and page.links == []
    shown = re.sub("\N{REPLACEMENT CHARACTER}", "\u202e", html.unescape(text))
    assert shown.count(EVIL) == text.count("&lt;script&gt;") == 3
    message = Library("lyrical", [built.parents[1] / "src"]).message("p/Robot")
    for direction in DIRECTIONS:
        for port in ports_of(build_plan(lay_out(message)), direction):
            assert f"<td><code>{port.name}</code></td>" in text
    drawn = pictures(text)
    # The layout, the plan, and two waveforms of each converter at least.
    assert len(drawn) >= 6
    words = {each.text for figure in drawn for each in figure.iter("text")}
    assert {"name.text.length", "wheels.items", "rest", "abc", "3.5", "OK"} <= words


def test_the_readme_has_the_contract_of_the_page_and_names_files_that_exist(built):
    text, page = (built / "README.md").read_text(), (built / "datasheet.html").read_text()
    named = set(re.findall(r"`([\w/]+\.(?:vhd|v|txt|json|sh))`", text))
    files = {str(path.relative_to(built)) for path in built.rglob("*") if path.is_file()}
    assert len(named) > 10 and named <= files | {path.removeprefix("vhdl/") for path in files}
    assert "\u202e" not in text and f"    # {EVIL[:-1]}" in text
    _, _, contract = text.partition("## Contract")
    rules = re.findall(r"^\* (.*)", contract.partition("##")[0], re.MULTILINE)
    assert len(rules) > 8 and all(rule.replace("\\_", "_") in html.unescape(page) for rule in rules)


def test_the_page_of_ros1_has_what_is_of_its_circuit(tmp_path):
    library(tmp_path / "src", {"p/Long": "float64[6] values\n"})
    words = ["--path", str(tmp_path / "src"), "--out", str(tmp_path), "--datasheet"]
    options = ["p/Long", "--distro", "noetic", "--bus-bytes", "1"]
    assert main(["build", *options, *words]) == 0
    text = (tmp_path / "noetic" / "p_Long_ros1_1" / "datasheet.html").read_text()
    assert f"<code>firm-hdl bench {' '.join(options)} --device ecp5</code>" in text
    assert re.search("encapsulation|CDR|padding<", text) is None
    assert re.search(r"Cycles \d+ to \d+; 30 to \d+ are left out", text)


def test_instances_compile(built, tmp_path, ghdl, iverilog, verilator):
    found = iter(codes((built / "datasheet.html").read_text()))
    texts = {
        language: [next(found)[1] for _ in DIRECTIONS]
        for language in ("VHDL", "Verilog", "SystemVerilog", "Amaranth")
    }
    files = (built / "vhdl" / "files.txt").read_text().split()
    vhdl = [f"{built}/vhdl/{name}" for name in files]
    assert run([ghdl, "-a", "--std=08", *vhdl], tmp_path) == (0, "")
    for number, text in enumerate(texts["VHDL"]):
        context, signals, statements = re.split("-- .*:\n", text)[1:]
        design = f"entity top{number} is port (aclk, aresetn : in std_logic); end entity;"
        body = f"architecture a of top{number} is\n{signals}begin\n{statements}end architecture;\n"
        (tmp_path / "top.vhd").write_text(f"{context}{design}\n{body}")
        assert run([ghdl, "-a", "--std=08", "top.vhd"], tmp_path) == (0, "")
    listed = (built / "systemverilog" / "files.f").read_text().split()
    for text, source in zip(texts["Verilog"], sorted(built.glob("*_verilog.v")), strict=True):
        around = f"module top(input aclk, input aresetn);\n{text}endmodule\n"
        (tmp_path / "top.v").write_text(around)
        command = [iverilog, "-g2005", "-t", "null", "-s", "top", "top.v", str(source)]
        assert run(command, tmp_path) == (0, "")
    for text in texts["SystemVerilog"]:
        (tmp_path / "top.sv").write_text(
            f"module top(input logic aclk, input logic aresetn);\n{text}endmodule\n"
        )
        sources = [f"{built}/systemverilog/{name}" for name in listed]
        command = [verilator, "--lint-only", "-Wno-lint", "-Wno-UNDRIVEN", "--top-module", "top"]
        assert run([*command, *sources, "top.sv"], tmp_path) == (0, "")
    for text in texts["Amaranth"]:
        code = text.replace('distro="lyrical"', f"paths=[{str(built.parents[1] / 'src')!r}]")
        values: dict = {}
        exec(code, values)
        assert "module" in rtlil.convert(values["m"], ports=[])
