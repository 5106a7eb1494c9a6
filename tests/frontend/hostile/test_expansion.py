"""Limits of expansion: recordings that expand too far are refused, others are read."""

from __future__ import annotations

import io
import tempfile

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import expansion
from firm_hdl.frontend.recordings import use_recording
from tests.frontend.hostile.bombs import BOMBS

MIB = 1 << 20


def sizes(reader):
    """Read a recording; return the sizes of its messages."""
    return [len(data) for _, _, data in reader.messages(connections=reader.connections)]


@pytest.fixture
def temporary(tmp_path, monkeypatch):
    """The folder in which rosbags puts a database that it decompresses."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


@pytest.mark.parametrize("form", BOMBS)
def test_recordings_that_expand_too_far_are_refused_at_that_point(
    tmp_path, form, monkeypatch, temporary
):
    monkeypatch.setattr(expansion, "MIN_BUDGET_BYTES", 4 * MIB)
    monkeypatch.setattr(expansion, "MAX_RATIO", 1)
    path = BOMBS[form](tmp_path, 8 * MIB)
    with pytest.raises(DefinitionError) as caught:
        use_recording(str(path), sizes)
    want = f"it decompresses to more than {4 * MIB} bytes"
    assert str(caught.value) == f"error: '{path}' cannot be read as a recording: {want}"
    assert list(temporary.iterdir()) == []


@pytest.mark.parametrize("form", BOMBS)
def test_recordings_that_expand_to_little_are_no_bombs(tmp_path, form, temporary):
    path = BOMBS[form](tmp_path, 2 * MIB)
    try:
        found = use_recording(str(path), sizes)
    except DefinitionError as error:
        # Decompressed zeros are no chunk.
        assert form in ("mcap of zstd", "mcap of lz4", "bag of bz2", "bag of lz4")
        assert "decompresses to" not in str(error) and "has a chunk" not in str(error)
    else:
        assert found == {"compressed message": [2 * MIB], "compressed database": [5]}.get(form, [])


@pytest.mark.parametrize("form", ["mcap of zstd", "mcap of lz4", "bag of bz2"])
def test_a_single_chunk_has_a_limit_of_its_own(tmp_path, form, monkeypatch):
    monkeypatch.setattr(expansion, "MAX_CHUNK_BYTES", 4 * MIB)
    path = BOMBS[form](tmp_path, 8 * MIB)
    with pytest.raises(DefinitionError, match=f"it has a chunk of more than {4 * MIB} bytes$"):
        use_recording(str(path), sizes)
    # A chunk of exactly that size is read. It is refused for another reason: it has zeros only.
    monkeypatch.setattr(expansion, "MAX_CHUNK_BYTES", 8 * MIB)
    with pytest.raises(DefinitionError, match=r"cannot be read as a recording: (?!it has a chunk)"):
        use_recording(str(path), sizes)
    assert use_recording(str(BOMBS["mcap of many chunks"](tmp_path, 8 * MIB)), sizes) == []


def test_large_recordings_may_expand_to_more(tmp_path, monkeypatch):
    path = BOMBS["compressed message"](tmp_path, 8 * MIB)
    monkeypatch.setattr(expansion, "MIN_BUDGET_BYTES", 1)
    size = sum(each.stat().st_size for each in path.iterdir())
    monkeypatch.setattr(expansion, "MAX_RATIO", 8 * MIB // size)
    with pytest.raises(DefinitionError, match="it decompresses to more than"):
        use_recording(str(path), sizes)
    monkeypatch.setattr(expansion, "MAX_RATIO", 8 * MIB // size + 1)
    assert use_recording(str(path), sizes) == [8 * MIB]


def test_recordings_may_expand_to_all_of_the_limit(tmp_path, monkeypatch):
    path = BOMBS["compressed message"](tmp_path, 8 * MIB)
    monkeypatch.setattr(expansion, "MAX_RATIO", 0)
    monkeypatch.setattr(expansion, "MIN_BUDGET_BYTES", 8 * MIB)
    assert use_recording(str(path), sizes) == [8 * MIB]
    monkeypatch.setattr(expansion, "MIN_BUDGET_BYTES", 8 * MIB - 1)
    with pytest.raises(DefinitionError, match=f"it decompresses to more than {8 * MIB - 1} bytes"):
        use_recording(str(path), sizes)


def test_rosbags_is_unchanged_outside_of_firm_hdl(tmp_path, monkeypatch):
    from rosbags.rosbag2 import Reader

    (tmp_path / "before").mkdir()
    use_recording(str(BOMBS["compressed message"](tmp_path / "before", MIB)), sizes)
    monkeypatch.setattr(expansion, "MIN_BUDGET_BYTES", 1)
    monkeypatch.setattr(expansion, "MAX_RATIO", 0)
    monkeypatch.setattr(expansion, "MAX_CHUNK_BYTES", 1)
    for form in ("compressed message", "compressed database"):
        (tmp_path / form).mkdir()
        with Reader(BOMBS[form](tmp_path / form, MIB)) as reader:
            assert len(sizes(reader)) == 1


def test_a_counted_file_is_closed_at_the_end_of_its_block():
    file = io.BytesIO(b"12345")
    with expansion._CountedFile(file, expansion.Budget(0)) as counted:
        assert counted.read(2) == b"12" and not file.closed
    assert file.closed
    file = io.BytesIO()
    with pytest.raises(KeyError), expansion._CountedFile(file, expansion.Budget(0)):
        raise KeyError
    assert file.closed
