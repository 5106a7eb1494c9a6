"""The documentation is true: examples run, and quoted commands print the quoted output."""

from __future__ import annotations

import importlib.util
import re
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

import firm_hdl
from firm_hdl.cli import main as firm_hdl_command
from tests.depth import THOROUGH, by_depth
from tests.frontend.recordings import make_recording
from tests.verify.robot import robot, write

ROOT = Path(firm_hdl.__file__).parent.parent
PAGES = sorted([ROOT / "README.md", ROOT / "CHANGELOG.md", *(ROOT / "docs").glob("*.md")])
EXAMPLES = sorted(path.stem for path in (ROOT / "examples").glob("*.py"))
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)")
# Quoted commands that take seconds. The tests of `prove`, of `build` and of `verify --bag` see
# their faults, with smaller types.
SLOW = {"equivalence-0", "README-2", "README-6"}
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


def rows(page: str) -> set[str]:
    """Return the lines of a page with runs of spaces reduced to one space."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return {" ".join(line.split()) for line in text.splitlines()}


@pytest.fixture
def workdir(tmp_path, monkeypatch):
    """A working directory with the documentation and the recordings that it mentions."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "docs").symlink_to(ROOT / "docs")
    make_recording(tmp_path, "bag")
    write(tmp_path / "drive", "bag", robot("bag", 30))
    return tmp_path


@pytest.mark.snapshot
@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_run(workdir, capsys, name):
    example = load(ROOT / "examples" / f"{name}.py")
    if name == "bench":
        # The other widths take as long as all other examples together, and so do many packets.
        example.BUSES = by_depth((8,), (8, 64))
        if not THOROUGH:
            example.MESSAGES = {TWIST: (10, example.MESSAGES[TWIST][1])}
    if name == "demo":
        # The fastest of three types. Its row is in README.md, as those of the others.
        example.EXAMPLES = by_depth(example.EXAMPLES[:1], example.EXAMPLES)
    if name == "fast_simulation":
        # Compiling takes long.
        example.PACKETS = by_depth({"amaranth": 5}, {"verilator": 1000, "amaranth": 5})
    assert example.main() == 0
    printed = capsys.readouterr().out
    if name == "demo":
        # The output of GHDL follows after another empty line, if GHDL is installed.
        table = printed.split("\n\n")[2]
        assert {" ".join(line.split()) for line in table.splitlines()} <= rows("README.md")
    if name == "bench":
        # Compare all columns but the last, which is a time. Figures of ten packets are on no page.
        table = [line.split()[:-1] for line in printed.splitlines()[1:]]
        printed_rows = {f"| {' | '.join(line)} |" for line in table}
        if THOROUGH:
            assert printed_rows <= rows("docs/interface.md")
        else:
            assert printed_rows == {f"| {TWIST} | 8 | 10 | 520 | 70 | 81 | 1.157 |"}


@pytest.mark.parametrize("text", list(blocks("python")))
def test_python_runs(workdir, text):
    exec(compile(text, "<documentation>", "exec"), {"__name__": "__main__"})


def test_the_readme_quotes_an_example():
    page = (ROOT / "README.md").read_text(encoding="utf-8")
    example = (ROOT / "examples" / "half_speed.py").read_text(encoding="utf-8")
    quoted = [m[2] for m in BLOCK.finditer(page) if m[1] == "py"]
    assert quoted and all(part in example for part in quoted)


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
            assert target.exists(), f"{page.name}: {link}"
            if anchor and target.suffix == ".md":
                text = target.read_text(encoding="utf-8")
                headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
                anchors = {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}
                assert anchor in anchors, f"{page.name}: {link}"


def test_tests_that_pages_name_exist():
    for page in PAGES:
        for path, name in re.findall(r"`(tests/[\w/]+\.py)(?:::(\w+))?`", page.read_text("utf-8")):
            if "NAME" in path:
                continue  # A file that a reader is to write: see tests.test_contributing.
            assert (ROOT / path).exists(), f"{page.name}: {path}"
            text = (ROOT / path).read_text(encoding="utf-8")
            assert f"def {name}(" in text if name else True, f"{page.name}: {path}::{name}"


@pytest.mark.parametrize("figure", ["deserializer", "serializer"])
def test_waveforms_are_up_to_date(figure):
    waveform = load(ROOT / "docs" / "figures" / "waveform.py")
    drawn = (ROOT / "docs" / "figures" / f"{figure}.json5").read_text(encoding="utf-8")
    assert waveform.source_of(figure) == drawn
