"""The committed sample equals the output of a build now."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from firm_hdl.cli import main
from tests.export.strikes import left_when_outdated
from tests.tools import run_script

ROOT = Path(__file__).parents[2]
SAMPLE = ROOT / "vhdl_out" / "lyrical" / "geometry_msgs_msg_Twist_cdr_8"
AGAIN = "firm-hdl build --force geometry_msgs/msg/Twist"


def files(folder: Path) -> dict[str, bytes]:
    """Return the files of a folder, without those that running the bench leaves."""
    found = {path.relative_to(folder): path for path in folder.rglob("*") if path.is_file()}
    return {
        name.as_posix(): path.read_bytes()
        for name, path in found.items()
        if "work" not in name.parts
    }


def generator(manifest: bytes) -> dict[str, str]:
    """Return the versions with which a folder was built."""
    found: dict[str, str] = json.loads(manifest)["inputs"]["generator"]
    return found


def need_same(here: dict[str, str], kept: dict[str, str]) -> None:
    """Skip the test if the sample was built with other versions of the tools; in CI, fail it."""
    if here != kept:
        message = f"made with {kept}, and here is {here}; run: {AGAIN}"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)


def test_each_of_its_files_goes_when_it_is_outdated(tmp_path):
    """Their names are like those of firm-hdl, which alone are deleted."""
    assert left_when_outdated(SAMPLE, tmp_path / SAMPLE.name) == set()


@pytest.mark.snapshot
def test_sample_is_current(tmp_path, capsys):
    assert main(["build", "geometry_msgs/msg/Twist", "--out", str(tmp_path)]) == 0
    built = files(tmp_path / "lyrical" / SAMPLE.name)
    kept = files(SAMPLE)
    need_same(*(generator(each["manifest.json"]) for each in (built, kept)))
    assert sorted(built) == sorted(kept)
    stale = [name for name in built if built[name] != kept[name]]
    assert not stale, f"run: {AGAIN}"


def test_its_bench_passes(ghdl, tmp_path):
    """A command of the README."""
    status, output = run_script(SAMPLE / "vhdl" / "run_ghdl.sh", GHDL=ghdl, WORK=str(tmp_path))
    assert status == 0 and output.startswith("PASS geometry_msgs/msg/Twist, "), output
