"""Figures as standalone files, with a style sheet for light and for dark mode."""

from __future__ import annotations

from firm_hdl.drawing.svg import Figure

__all__ = ["document"]

STYLE = """
svg { --paper: #ffffff; --ink: #1a1d21; --soft: #5b6470; --rule: #dde1e6;
  --c1: #0072b2; --c2: #d55e00; --c3: #009e73; --c4: #b0538d;
  font-family: system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; }
@media (prefers-color-scheme: dark) {
  svg { --paper: #14171b; --ink: #e6e9ed; --soft: #9aa4b1; --rule: #323943;
    --c1: #56b4e9; --c2: #f0883e; --c3: #35c19a; --c4: #d98bbd; } }
.paper { fill: var(--paper); }
text { fill: var(--soft); font-size: 12px; } text.label { fill: var(--ink); }
text.row { fill: var(--ink); font-size: 13px; }
.grid { stroke: var(--rule); } .axis { stroke: var(--soft); }
.c1 { --c: var(--c1); } .c2 { --c: var(--c2); } .c3 { --c: var(--c3); } .c4 { --c: var(--c4); }
.bar { fill: var(--c); } .curve { fill: none; stroke: var(--c); stroke-width: 2; }
.whisker { stroke: var(--ink); stroke-width: 1.5; }
.goal { stroke: var(--c2); stroke-width: 1.5; stroke-dasharray: 6 4; }
"""


def document(figure: Figure) -> str:
    """Write a figure as a file, with a background."""
    head, mark, rest = str(figure).partition(">")
    size = f'width="{figure.width}" height="{figure.height}"'
    head = head.replace("<svg", f'<svg xmlns="http://www.w3.org/2000/svg" {size}', 1)
    parts = rest.replace("><", ">\n<")
    return f'{head}{mark}\n<style>{STYLE}</style>\n<rect {size} class="paper"/>\n{parts}\n'
