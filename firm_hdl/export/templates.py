"""Generated files that are templates of jinja2, each beside the module that fills it.

A template is a file of the output with a few variables, so that it can be read as such. Text that
depends on the type in every line is written by Python instead.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

__all__ = ["render"]


def render(template: str, **values: Any) -> str:
    """Fill a template.

    Parameters
    ----------
    template : str
        Path in this package, without ``.j2``, such as ``"vhdl/bench.vhd"``.
    **values
        The variables of the template.
    """
    return _environment().get_template(f"{template}.j2").render(values)


@cache
def _environment() -> Environment:
    return Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
