"""Figures as standalone files, and pages of HTML with figures, for light and for dark mode."""

from __future__ import annotations

import re
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from firm_hdl.drawing.svg import Figure

__all__ = ["document", "pages", "style"]

_FOLDER = Path(__file__).parent
_UNPRINTABLE = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
"""Control characters, those that reverse the text after them, and bytes that are not UTF-8."""


def style(*names: str) -> str:
    """Return style sheets of this package: ``figure``, and ``page`` for what is around figures."""
    return "".join((_FOLDER / f"{name}.css").read_text(encoding="utf-8") for name in names)


def document(figure: Figure) -> str:
    """Write a figure as a file, with a background."""
    head, mark, rest = str(figure).partition(">")
    size = f'width="{figure.width}" height="{figure.height}"'
    head = head.replace("<svg", f'<svg xmlns="http://www.w3.org/2000/svg" {size}', 1)
    style_sheet = f"<style>{style('figure')}</style>"
    parts = rest.replace("><", ">\n<")
    return f'{head}{mark}\n{style_sheet}\n<rect {size} class="paper"/>\n{parts}\n'


def pages(*folders: Path) -> Environment:
    """Return a Jinja environment for pages of HTML.

    All text is escaped, so that nothing in it is a tag, and has no characters that are not shown.

    * `*folders`: folders with templates; those of this package can be used, too.
    """
    found = Environment(
        loader=FileSystemLoader([*folders, _FOLDER]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=_shown,
    )
    found.globals["style"] = style
    return found


def _shown(value: object) -> object:
    if isinstance(value, Figure):
        return Markup(str(value))
    if isinstance(value, str) and not isinstance(value, Markup):
        return _UNPRINTABLE.sub("\N{REPLACEMENT CHARACTER}", value)
    return value
