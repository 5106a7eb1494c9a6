"""The documentation is true: examples run, and quoted commands print the quoted output."""

from __future__ import annotations

import importlib.util
import re
import shlex
import struct
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from amaranth.sim import Simulator
from rosbags.typesys import Stores

import firm_hdl
from firm_hdl.cli import main as firm_hdl_command
from firm_hdl.sim import encode, send_packets
from tests.depth import THOROUGH, by_depth
from tests.frontend.recordings import make_recording
from tests.verify.robot import robot, write

ROOT = Path(firm_hdl.__file__).parent.parent
DOCS = ROOT / "docs"
PAGES = sorted([ROOT / "README.md", ROOT / "CHANGELOG.md", *DOCS.rglob("*.md")])
EXAMPLES = sorted(path.stem for path in (ROOT / "examples").glob("*.py"))
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)")
# What takes seconds. The tests of `prove`, `build`, `verify --bag` and `build_component` see its
# faults, with smaller types.
SLOW = {"trust-0", "own-packages-0", "own-packages-1", "recordings-1", "parts-4"}
TWIST = "geometry_msgs/msg/Twist"


def load(path: Path) -> ModuleType:
    """Import a script without running it."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    # Dataclasses look their module up there.
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module


def blocks(language: str) -> Iterator[object]:
    """Yield the code blocks of a language on all pages."""
    for page in PAGES:
        found = [m[2] for m in BLOCK.finditer(page.read_text(encoding="utf-8")) if m[1] == language]
        for number, text in enumerate(found):
            name = f"{page.stem}-{number}"
            yield pytest.param(text, id=name, marks=[pytest.mark.thorough] * (name in SLOW))


def quoted_commands(text: str) -> Iterator[tuple[list[str], str]]:
    """Yield the arguments of each `firm-hdl` in a console block, with its quoted output."""
    for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        line, _, output = part.partition("\n")
        program, *arguments = shlex.split(line)
        if program == "firm-hdl":
            yield arguments, output


@pytest.fixture
def workdir(tmp_path, monkeypatch):
    """A working directory with the documentation and the recordings that it mentions."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "docs").symlink_to(ROOT / "docs")
    make_recording(tmp_path, "bag")
    write(tmp_path / "drive", "bag", robot("bag", 30))
    return tmp_path


# Simulations of seconds, of converters that other examples have, too.
LONG = {"cloud_filter", "image_filter", "soc_part"}


@pytest.mark.snapshot
@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.thorough] * (name in LONG)) for name in EXAMPLES],
)
def test_examples_run(workdir, capsys, name):
    example = load(ROOT / "examples" / f"{name}.py")
    if name == "bench":
        # The other widths take as long as all other examples together, and so do many packets.
        example.BUSES = by_depth((8,), (8, 64))
        if not THOROUGH:
            example.MESSAGES = {TWIST: (10, example.MESSAGES[TWIST][1])}
    if name == "demo":
        time = example.Example(
            type="builtin_interfaces/msg/Time",
            distro="lyrical",
            store=Stores.ROS2_LYRICAL,
            make=example.stamp,
        )
        example.EXAMPLES = by_depth((time,), example.EXAMPLES)
    if name == "fast_simulation":
        # Compiling takes long.
        example.PACKETS = by_depth({"amaranth": 5}, {"verilator": 1000, "amaranth": 5})
    assert example.main() == 0
    printed = capsys.readouterr().out
    if name == "demo":
        assert all(each.type in printed for each in example.EXAMPLES) and "  yes\n" in printed
        assert "from /double  data: 42\n" in printed
    if name == "bench":
        # All columns but the last, which is a time.
        table = [line.split()[:-1] for line in printed.splitlines()[1:]]
        if not THOROUGH:
            assert table == [[TWIST, *"8 10 520 70 81 1.157".split()]]


@pytest.mark.parametrize("text", list(blocks("python")))
def test_python_runs(workdir, text):
    exec(compile(text, "<documentation>", "exec"), {"__name__": "__main__"})


QUOTES = [
    ("tutorial/first-node.md", "py", "nodes/double/double.py"),
    ("tutorial/first-node.md", "yaml", "nodes/double/double.yaml"),
    ("../README.md", "yaml", "nodes/double/double.yaml"),
    ("tutorial/first-converter.md", "vhdl", "vhdl_motor/motor.vhd"),
    ("tutorial/robot.md", "yaml", "nodes/wheels/wheels.yaml"),
    ("tutorial/robot.md", "py", "nodes/wheels/wheels.py"),
    ("howto/accelerator.md", "vhdl", "nodes/wheels_vhdl/wheels.vhd"),
    ("howto/floats.md", "vhdl", "nodes/wheels_vhdl/float_fixed_pkg.vhd"),
    ("howto/systemverilog.md", "systemverilog", "sv_motor/motor.sv"),
    ("howto/verilog.md", "verilog", "cocotb_motor/motor.v"),
    ("howto/cocotb.md", "py", "cocotb_motor/test_motor.py"),
    ("howto/amaranth.md", "py", "half_speed.py image_filter.py cloud_filter.py soc_part.py"),
]


@pytest.mark.parametrize(("page", "language", "examples"), QUOTES)
def test_pages_quote_the_examples(page, language, examples):
    files = [ROOT / "examples" / name for name in examples.split()]
    text = "".join(file.read_text(encoding="utf-8") for file in files)
    page_text = (DOCS / page).read_text(encoding="utf-8")
    quoted = [m[2] for m in BLOCK.finditer(page_text) if m[1] == language]
    assert quoted and all(part in text for part in quoted)


def test_amaranth_code_of_the_readme_acts_on_good_packets_only():
    """Its register changes with the second of three packets; the others are cut and too long."""
    page = (ROOT / "README.md").read_text(encoding="utf-8")
    (text,) = [m[2] for m in BLOCK.finditer(page) if m[1] == "python"]
    names: dict[str, Any] = {}
    exec(compile(text, "README.md", "exec"), names)

    def packet(speed: float) -> bytes:
        value = {"linear": {"x": speed, "y": 0.0, "z": 0.0}, "angular": dict.fromkeys("xyz", 0.0)}
        return encode(names["twist"], [value]).packets[0]

    other = packet(9.0)
    sent = [other[:-1], packet(1.5), other + bytes(4)]
    seen = []

    async def sender(ctx):
        await send_packets(ctx, names["rx"].packets, sent)

    async def watcher(ctx):
        for _ in range(60):
            await ctx.tick()
            seen.append(ctx.get(names["speed"]))

    simulator = Simulator(names["m"])
    simulator.add_clock(1e-6)
    simulator.add_testbench(sender)
    simulator.add_testbench(watcher)
    simulator.run()
    assert sorted({*seen}) == [0, int.from_bytes(struct.pack(">d", 1.5), "big")]


def test_the_readme_is_short_and_its_commands_are_run():
    page = (ROOT / "README.md").read_bytes()
    assert len(page) <= 6000
    lines = [
        line.removeprefix("$ ")
        for m in BLOCK.finditer(page.decode())
        if m[1] in ("sh", "console")
        for line in m[2].splitlines()
        if m[1] == "sh" or line.startswith("$ ")
    ]
    assert lines == [
        "make demo",  # test_examples_run, and CI.
        "python3 -m venv venv",  # These three: tests.test_installed.
        ". venv/bin/activate",
        "pip install .",
        "firm-hdl build geometry_msgs/msg/Twist",  # test_commands_print_what_is_quoted.
        # tests.export.test_sample.
        "vhdl_out/lyrical/geometry_msgs_msg_Twist_cdr_8/vhdl/run_ghdl.sh",
        "firm-hdl node run examples/nodes/double/double.yaml",  # tests.examples.test_node_examples.
    ]


@pytest.mark.snapshot
@pytest.mark.parametrize("text", list(blocks("console")))
def test_commands_print_what_is_quoted(workdir, capsys, text):
    for arguments, output in quoted_commands(text):
        status = firm_hdl_command(arguments)
        out, err = capsys.readouterr()
        if arguments[0] == "prove":
            # Proofs that run at the same time end in any order.
            out, output = (in_order(text) for text in (out, output))
        if arguments[0] == "build":
            # Folders that are written at the same time are in any order, too.
            out, output = (written_in_order(text) for text in (out, output))
        # A line `...` stands for any number of lines.
        parts = re.split(r"^\.\.\.\n", output.strip("\n") + "\n", flags=re.MULTILINE)
        pattern = r"(?:.*\n)*?".join(map(re.escape, parts))
        # Times differ from machine to machine.
        pattern = re.sub(r"(?:\\ )+\d+\\\.\d\\ s\b", r"\\ +\\d+\\.\\d\\ s", pattern)
        pattern = re.sub(r"(^|\?)\d+\\ s,", r"\1\\d+\\ s,", pattern, flags=re.MULTILINE)
        assert re.fullmatch(pattern, (out + err).strip("\n") + "\n"), out + err
        assert status == (1 if "error:" in output else 0)


def in_order(text: str) -> str:
    """Return lines sorted by their text without times."""
    return "\n".join(sorted(text.splitlines(), key=lambda line: line.split("s  ")[-1]))


def written_in_order(text: str) -> str:
    """Return lines, with the leading lines of written folders sorted."""
    lines = text.splitlines()
    count = next((n for n, line in enumerate(lines) if not line.startswith("wrote ")), len(lines))
    return "\n".join([*sorted(lines[:count]), *lines[count:]])


def test_links_have_existing_targets():
    for page in PAGES:
        for link in LINK.findall(page.read_text(encoding="utf-8")):
            if "://" in link:
                continue
            path, _, anchor = link.partition("#")
            target = (page.parent / path).resolve() if path else page
            # Pictures of the gallery are drawn when the site is built.
            assert target.exists() or "gallery/" in path, f"{page.name}: {link}"
            if anchor and target.suffix == ".md":
                text = target.read_text(encoding="utf-8")
                headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
                anchors = {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}
                assert anchor in anchors, f"{page.name}: {link}"


def test_tests_that_pages_name_exist():
    for page in PAGES:
        for path, name in re.findall(r"`(tests/[\w/]+\.py)(?:::(\w+))?`", page.read_text("utf-8")):
            assert (ROOT / path).exists(), f"{page.name}: {path}"
            text = (ROOT / path).read_text(encoding="utf-8")
            assert f"def {name}(" in text if name else True, f"{page.name}: {path}::{name}"
