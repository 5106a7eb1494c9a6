"""Defaults of `build`: the folder `vhdl_out`, and a bus of 8 bytes."""

from __future__ import annotations

from firm_hdl.export.build import build


def test_files_go_where_the_documentation_looks_for_them(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (built,) = build(["std_msgs/msg/Bool"])
    assert [path.name for path in tmp_path.iterdir()] == ["vhdl_out"]
    folder = tmp_path / "vhdl_out" / "lyrical" / "std_msgs_msg_Bool_cdr_8"
    assert folder.is_dir() and built.folder.resolve() == folder
