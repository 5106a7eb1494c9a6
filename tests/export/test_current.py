"""A folder is current, and is not written, if neither its inputs nor its files have changed."""

from __future__ import annotations

import pytest

import firm_hdl
from tests.export.test_build import build_one, tree


@pytest.mark.usefixtures("hollow")
def test_current_folder_is_left_alone(tmp_path):
    first = build_one(tmp_path)
    assert not first.was_current
    (first.folder / "vhdl" / "files.txt").touch()
    times = {path: path.stat().st_mtime_ns for path in first.folder.iterdir()}
    again = build_one(tmp_path)
    assert again.was_current
    assert again.description == first.description
    assert times == {path: path.stat().st_mtime_ns for path in first.folder.iterdir()}
    assert not build_one(tmp_path, force=True).was_current


@pytest.mark.usefixtures("hollow")
def test_a_folder_that_lacks_a_file_or_has_another_manifest_is_written_again(tmp_path):
    built = build_one(tmp_path)
    before = tree(built.folder)
    (built.folder / "vhdl" / "files.txt").unlink()
    assert not build_one(tmp_path).was_current
    manifest = built.folder / "manifest.json"
    manifest.write_text(manifest.read_text().replace(firm_hdl.__version__, "0.0.9"))
    assert not build_one(tmp_path).was_current
    assert tree(built.folder) == before


@pytest.mark.usefixtures("hollow")
def test_other_options_and_definitions_are_built_anew(tmp_path, monkeypatch):
    build_one(tmp_path)
    assert not build_one(tmp_path, max_message_bytes=1000).was_current
    assert build_one(tmp_path, max_message_bytes=1000).was_current
    assert not build_one(tmp_path, max_message_bytes=1000, ports="flat").was_current
    assert not build_one(tmp_path, max_message_bytes=1000).was_current
    with_tools = {"max_message_bytes": 1000, "extras": frozenset({"tools"})}
    built = build_one(tmp_path, **with_tools)
    assert not built.was_current and build_one(tmp_path, **with_tools).was_current
    assert (built.folder / "waivers.vlt").exists()
    # What is not asked for any more goes.
    assert not build_one(tmp_path, max_message_bytes=1000).was_current
    assert not (built.folder / "waivers.vlt").exists()
    assert build_one(tmp_path, bus_bytes=4).folder.name == "std_msgs_msg_Bool_cdr_4"
    monkeypatch.setattr(firm_hdl, "__version__", "9.9.9")
    assert not build_one(tmp_path, max_message_bytes=1000).was_current


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    "packets", [[b"\1", b"\2\4"], [b"\1\2", b"\3"], [b"\2\3", b"\1"], [b"\1\2\3"], [b"\1"], []]
)
@pytest.mark.usefixtures("hollow")
def test_other_packets_of_the_bench_are_built_anew(tmp_path, packets):
    # The same bytes in other packets, or in another order, are other packets.
    build_one(tmp_path, stimuli=lambda message, plan: [b"\1", b"\2\3"])
    assert build_one(tmp_path, stimuli=lambda message, plan: [b"\1", b"\2\3"]).was_current
    assert not build_one(tmp_path, stimuli=lambda message, plan: packets).was_current


@pytest.mark.parametrize("option", [{"registers": True}, {"leaf_ports": "axis"}, {"ip": "vivado"}])
@pytest.mark.usefixtures("hollow")
def test_a_folder_without_what_an_option_adds_is_built_anew(tmp_path, option):
    build_one(tmp_path)
    assert not build_one(tmp_path, **option).was_current
    assert build_one(tmp_path, **option).was_current
    assert not build_one(tmp_path).was_current
