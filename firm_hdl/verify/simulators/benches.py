"""Benches that replay a trace: they read rows of inputs, and write rows of outputs.

Each bench is a template beside this file, and knows nothing of the devices but their ports.
:mod:`firm_hdl.verify.simulators.trace` describes the rows.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from firm_hdl.verify.simulators.trace import ARESETN, Trace

__all__ = ["RESULTS", "STIMULI", "written"]

STIMULI = "stimuli.txt"
RESULTS = "results.txt"


def written(name: str, trace: Trace, **more: Any) -> str:
    """Write a bench for a trace.

    Parameters
    ----------
    name : str
        The name of the template, without ``.j2``.
    **more
        Other variables of the template.
    """
    text = _templates().get_template(f"{name}.j2")
    files = {"STIMULI": STIMULI, "RESULTS": RESULTS}
    return text.render(trace=trace, ARESETN=ARESETN, **files, **more)


@cache
def _templates() -> Environment:
    return Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
