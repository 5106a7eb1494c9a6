"""Type libraries shared by the tests of a process."""

from __future__ import annotations

from firm_hdl.verify.systems.tasks import library_of
from tests.frontend.workspace import make_files


def test_a_relative_folder_is_that_of_the_working_folder(tmp_path, monkeypatch):
    found = []
    for name in ("One", "Two"):
        make_files(tmp_path / name / "src", {f"p/msg/{name}.msg": "int8 x\n"})
        monkeypatch.chdir(tmp_path / name)
        library = library_of("lyrical", ("src",))
        assert library is library_of("lyrical", ("src",))
        found.append([each for each in library.interfaces() if each.startswith("p/")])
    assert found == [["p/msg/One"], ["p/msg/Two"]]
