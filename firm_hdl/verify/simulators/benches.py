"""Benches that know nothing but ports: rows of inputs in, rows of outputs out.

Each is a template beside this file, filled with the pins of a trace; what the rows are, see
:mod:`firm_hdl.verify.simulators.trace`.
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
        Of the template, without ``.j2``.
    **more
        What else the template is to be told.
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
