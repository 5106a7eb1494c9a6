"""Limits of expansion: recordings that expand too far are refused, others are read."""

from __future__ import annotations

import bz2
import tempfile
from pathlib import Path

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.recordings import Recording, limits
from tests.recordings.bombs import BOMBS
from tests.recordings.files import messages

MIB = 1 << 20


def sizes(path: Path) -> list[int]:
    """Read a recording; return the sizes of its messages."""
    return [len(data) for _, _, data in messages(path)]


@pytest.fixture
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder for temporary files."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


@pytest.mark.parametrize("form", BOMBS)
def test_recordings_that_expand_too_far_are_refused_at_that_point(
    tmp_path: Path, form: str, monkeypatch: pytest.MonkeyPatch, temporary: Path
) -> None:
    monkeypatch.setattr(limits, "MIN_BUDGET_BYTES", 4 * MIB)
    monkeypatch.setattr(limits, "MAX_RATIO", 1)
    path = BOMBS[form](tmp_path, 8 * MIB)
    with pytest.raises(DefinitionError) as caught:
        sizes(path)
    want = f"it expands to more than {4 * MIB} bytes"
    assert str(caught.value) == f"error: '{path}' cannot be read as a recording: {want}"
    assert list(temporary.iterdir()) == []


@pytest.mark.parametrize("form", BOMBS)
def test_recordings_that_expand_to_little_are_no_bombs(
    tmp_path: Path, form: str, temporary: Path
) -> None:
    path = BOMBS[form](tmp_path, 2 * MIB)
    try:
        found = sizes(path)
    except DefinitionError as error:
        # Decompressed zeros are no chunk.
        assert form in ("mcap of zstd", "mcap of lz4", "bag of bz2", "bag of lz4")
        assert "it is damaged" in str(error)
    else:
        assert found == {"compressed message": [2 * MIB], "compressed database": [5]}.get(form, [])


@pytest.mark.parametrize("form", ["mcap of zstd", "mcap of lz4", "bag of bz2"])
def test_a_single_chunk_has_a_limit_of_its_own(
    tmp_path: Path, form: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(limits, "MAX_BLOCK_BYTES", 4 * MIB)
    path = BOMBS[form](tmp_path, 8 * MIB)
    with pytest.raises(DefinitionError, match=f"it has a chunk of more than {4 * MIB} bytes$"):
        sizes(path)
    # A chunk of exactly that size is read. It is refused for another reason: it has zeros only.
    monkeypatch.setattr(limits, "MAX_BLOCK_BYTES", 8 * MIB)
    with pytest.raises(DefinitionError, match="it is damaged"):
        sizes(path)
    assert sizes(BOMBS["mcap of many chunks"](tmp_path, 8 * MIB)) == []


def test_large_recordings_may_expand_to_more(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = BOMBS["compressed message"](tmp_path, 8 * MIB)
    monkeypatch.setattr(limits, "MIN_BUDGET_BYTES", 1)
    # The compressed message counts, too.
    size = next(path.glob("*.db3")).stat().st_size
    monkeypatch.setattr(limits, "MAX_RATIO", 8 * MIB // size)
    with pytest.raises(DefinitionError, match="it expands to more than"):
        sizes(path)
    monkeypatch.setattr(limits, "MAX_RATIO", 8 * MIB // size + 2)
    assert sizes(path) == [8 * MIB]


def test_a_chunk_that_does_not_have_its_size_is_damage(tmp_path: Path) -> None:
    path = BOMBS["mcap of zstd"](tmp_path, MIB)
    data = path.read_bytes()
    for size in (MIB - 1, MIB + 1):
        path.write_bytes(data.replace(MIB.to_bytes(8, "little"), size.to_bytes(8, "little")))
        with pytest.raises(DefinitionError, match="a chunk has not the size that it states"):
            Recording(path)


def test_rosbags_is_left_as_it_is() -> None:
    from rosbags.rosbag1 import reader as rosbag1
    from rosbags.rosbag2 import storage_mcap

    assert rosbag1.decompressors["bz2"] is bz2.decompress
    for decompress in storage_mcap.DECOMPRESSORS.values():
        assert not str(decompress.__module__).startswith("firm_hdl")
