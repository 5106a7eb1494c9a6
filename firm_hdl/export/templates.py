"""Generated files and templates that are data of this package, beside the modules that use them.

A file that is the same for every type is stored as it is. A file with few variables is a template
of jinja2. Text that depends on the type in most lines is written by Python instead.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

__all__ = ["render", "templates", "text_of"]

_FOLDER = Path(__file__).parent


def text_of(name: str) -> str:
    """Return the text of a file, given its path in this package."""
    return _FOLDER.joinpath(name).read_text(encoding="utf-8")


def render(template: str, **values: Any) -> str:
    """Fill a template.

    * `template`: path in this package, without ``.j2``, such as ``"vhdl/bench.vhd"``.
    * `**values`: the variables of the template.
    """
    return templates(_FOLDER).get_template(f"{template}.j2").render(values)


@cache
def templates(folder: Path) -> Environment:
    """Return the templates in a folder; they may extend those of this package."""
    return Environment(
        loader=FileSystemLoader([folder, _FOLDER]),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
