"""Time rosbags in this Python, and genpy in the Python for which it is installed."""

from __future__ import annotations

import json
import platform
import tempfile
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

from firm_hdl.bench.tools import BenchError
from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.oracle import ROSBAGS_WIRES
from firm_hdl.cases.user_oracle import oracle_name, resolved_oracle
from firm_hdl.jobs import ProgramMissingError, ToolError, run_tool
from firm_hdl.verify.references.objects import full_text
from firm_hdl.verify.ros_python.worker import ROS_PYTHON
from lab.bench.software.sample import NoFigureError, Sample, Timed, check_written
from lab.bench.software.timing import best_ns

__all__ = ["genpy_versions", "rosbags_versions", "time_genpy", "time_rosbags"]

_SCRIPT = Path(__file__).with_name("genpy_timing.py")


def rosbags_versions() -> dict[str, str]:
    """Return the versions of rosbags, NumPy and Python."""
    found = {name: metadata.version(name) for name in ("rosbags", "numpy")}
    return {**found, "Python": platform.python_version()}


def time_rosbags(sample: Sample) -> Timed:
    """Time rosbags.

    Raises
    ------
    NoFigureError
        If it does not have the type or the wire format.
    BenchError
        If it does not write what it has read.
    """
    if sample.wire not in ROSBAGS_WIRES:
        raise NoFigureError(f"rosbags does not have the wire format {sample.wire}")
    try:
        store = resolved_oracle(sample.message).store
    except NotJudgedError as error:
        raise NoFigureError(str(error)) from None
    name = oracle_name(sample.message)
    # rosbags names its methods by the wire format, as firm-hdl does.
    reader: Any = getattr(store, f"deserialize_{sample.wire}")
    writer: Any = getattr(store, f"serialize_{sample.wire}")

    def read(packet: bytes) -> object:
        return reader(packet, name)

    def write(message: object) -> object:
        return writer(message, name)

    messages = [read(packet) for packet in sample.packets]
    for message, packet in zip(messages, sample.packets, strict=True):
        check_written(sample, bytes(writer(message, name)), packet)
    return Timed(deserialize=best_ns(read, sample.packets), serialize=best_ns(write, messages))


@cache
def genpy_versions() -> dict[str, str]:
    """Return the versions of genpy and of its Python.

    Raises
    ------
    ProgramMissingError
    """
    return dict(_ask({})["versions"])


def time_genpy(sample: Sample) -> Timed:
    """Time genpy.

    Raises
    ------
    ProgramMissingError
    NoFigureError
        If it does not have the type.
    BenchError
        If it fails, or does not write what it has read.
    """
    if sample.wire != "ros1" or sample.message.dialect != "ros1":
        raise NoFigureError("genpy has types and the wire format of ROS 1 only")
    answer = _ask(
        {
            "name": sample.message.name,
            "text": full_text(sample.message),
            "packets": [packet.decode("latin-1") for packet in sample.packets],
        }
    )
    if "wrong" in answer:
        raise BenchError(f"genpy, {sample.message.name}: {answer['wrong']}")
    return Timed(deserialize=answer["deserialize"], serialize=answer["serialize"])


def _ask(request: dict[str, Any]) -> dict[str, Any]:
    with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
        file = Path(folder, "request.json")
        file.write_text(json.dumps(request), encoding="ascii")
        try:
            said = run_tool([ROS_PYTHON, str(_SCRIPT), str(file)], with_errors=False)
        except OSError as error:
            raise ProgramMissingError(f"{ROS_PYTHON} cannot be run: {error.strerror}") from None
        except ToolError as error:
            raise BenchError(f"genpy failed: {str(error).splitlines()[-1]}") from None
    answer: dict[str, Any] = json.loads(said)
    if "missing" in answer:
        raise ProgramMissingError(
            f"genpy cannot be used: {answer['missing']} (Debian: python3-genpy)"
        )
    return answer
