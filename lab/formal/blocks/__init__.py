"""Scenes of blocks: what drives each of them, and what is claimed."""

from __future__ import annotations

from lab.formal.blocks import (
    assembling,
    axi_lite,
    claims,
    converters,
    crossings,
    drop_gate,
    ethernet,
    fifos,
    frames,
    history,
    judges,
    records,
    rtps,
    serializers,
    slices,
    tail_drop,
)
from lab.formal.catalog import Study

__all__ = ["all_studies"]


def all_studies() -> list[Study]:
    """Return all studies, in the order of the table."""
    modules = (
        slices,
        fifos,
        tail_drop,
        crossings,
        claims,
        records,
        converters,
        serializers,
        judges,
        drop_gate,
        axi_lite,
        ethernet,
        rtps,
        history,
        frames,
        assembling,
    )
    return [study for module in modules for study in module.studies()]
