"""The committed sample of output is what is built now."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from firm_hdl.cli import main

ROOT = Path(__file__).parents[2]
SAMPLE = ROOT / "vhdl_out" / "lyrical" / "geometry_msgs_msg_Twist_cdr_8"


def files(folder: Path) -> dict[str, bytes]:
    """Return the files of a folder, without what running the bench leaves there."""
    found = {path.relative_to(folder): path for path in folder.rglob("*") if path.is_file()}
    return {
        name.as_posix(): path.read_bytes()
        for name, path in found.items()
        if "work" not in name.parts
    }


@pytest.mark.snapshot
def test_sample_is_current(tmp_path, capsys):
    assert main(["build", "geometry_msgs/msg/Twist", "--out", str(tmp_path)]) == 0
    built = files(tmp_path / "lyrical" / SAMPLE.name)
    kept = files(SAMPLE)
    versions = [json.loads(each["manifest.json"])["inputs"]["generator"] for each in (built, kept)]
    if versions[0] != versions[1]:
        pytest.skip(f"made with {versions[1]}, and here is {versions[0]}")
    assert sorted(built) == sorted(kept)
    stale = [name for name in built if built[name] != kept[name]]
    assert not stale, "run: firm-hdl build --force geometry_msgs/msg/Twist"
