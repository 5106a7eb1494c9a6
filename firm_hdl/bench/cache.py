"""A cache of figures. The key has all inputs that determine the figures."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from firm_hdl.bench.devices import Device
from firm_hdl.bench.flow import PREPARATIONS, Measured, measure
from firm_hdl.bench.results import measured_from_json, measured_to_json
from firm_hdl.bench.tools import versions
from firm_hdl.files import write_file

__all__ = ["measure_once"]

FORMAT = 1
"""A part of the key. Change it if the figures of a circuit change for a reason not in the key."""


def measure_once(
    rtlil: str, device: Device, seeds: Sequence[int], *, mapping: str, folder: Path | None
) -> Measured:
    """Measure a circuit, unless the folder has its figures. Parameters as for `measure`.

    A file's name is a hash of the RTLIL, the device's options, the seeds, and the versions of the
    tools. A result without clock rates for all seeds is not kept.

    Parameters
    ----------
    folder : Path or None
        Created if it does not exist; `None`: measure always.
    """
    if folder is None:
        return measure(rtlil, device, seeds, mapping=mapping)
    # Without seeds, nextpnr is not run, and may be missing.
    tools = versions(device, with_placer=bool(seeds))
    parts = [FORMAT, rtlil, repr(device), PREPARATIONS, list(seeds), mapping, tools]
    key = hashlib.sha256(json.dumps(parts).encode()).hexdigest()
    file = folder / f"{key}.json"
    with suppress(OSError, ValueError, KeyError, TypeError):
        return measured_from_json(json.loads(file.read_text(encoding="utf-8")))
    found = measure(rtlil, device, seeds, mapping=mapping)
    if not found.problem:
        # Another process may write or read the same file.
        write_file(file, json.dumps(measured_to_json(found)))
    return found
