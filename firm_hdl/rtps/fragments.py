"""Samples in fragments: how a sample is cut (8.4.14.1)."""

from __future__ import annotations

from firm_hdl.rtps.wire.samples import Data, DataFrag

__all__ = ["fragment", "fragment_count"]


def fragment_count(sample_bytes: int, fragment_bytes: int) -> int:
    """Return the number of fragments of a sample."""
    return -(-sample_bytes // fragment_bytes)


def fragment(sample: Data, number: int, fragment_bytes: int) -> DataFrag:
    """Return fragment `number`, from 1 on, of a sample with a payload."""
    assert sample.payload is not None
    start = (number - 1) * fragment_bytes
    return DataFrag(
        reader=sample.reader,
        writer=sample.writer,
        sequence_number=sample.sequence_number,
        first=number,
        count=1,
        fragment_bytes=fragment_bytes,
        sample_bytes=len(sample.payload),
        payload=sample.payload[start : start + fragment_bytes],
        inline=sample.inline,
    )
