"""The driver in C++: it is compiled without a warning, and runs against the model of the DMA."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from firm_hdl.node.boards.zynq_header import zynq_header
from firm_hdl.node.messages import MessageSender
from tests.node.boards.chip import ServedChip
from tests.node.boards.dma_model import SLV_ERR, Streams
from tests.node.boards.test_zynq import BUFFER_BYTES, MEMORY, system
from tests.node.bridge.fakes import FakeNode
from tests.tools import need

__all__ = ["system"]

_PROGRAM = Path(__file__).with_name("zynq_driver.cpp")
_WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror"]


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    folder = tmp_path_factory.mktemp("zynq")
    (folder / "echo_zynq.hpp").write_text(zynq_header(MEMORY, "echo"))
    compiler = need("g++", shutil.which("g++"))
    options = ["-std=c++17", *_WARNINGS, "-O0", f"-I{folder}", "-o", folder / "program"]
    subprocess.run([compiler, *options, _PROGRAM], check=True, timeout=300)
    return folder / "program"


def run(program, *arguments):
    done = subprocess.run([program, *arguments], capture_output=True, timeout=120, check=True)
    return done.stdout.decode().splitlines()


def test_messages_and_errors_of_the_driver_in_cpp(program, tmp_path):
    """Messages of one frame and of several go there and back, and each error is survived."""
    node = FakeNode(MEMORY.fingerprint)
    node.sender = MessageSender(BUFFER_BYTES)

    def take(frame):
        chip.dma.packets += node.take(frame)
        match frame[16:]:
            case b"MM2S" | b"S2MM":
                chip.dma.fails[frame[16:].decode()] = SLV_ERR
            case b"long":
                chip.dma.packets.append(bytes(BUFFER_BYTES + 1))

    with ServedChip(tmp_path, Streams(take)) as chip:
        said = run(program, "chip", tmp_path)
    assert said == [
        "100 right, 0 lost",
        "answer 77: 1",
        "the DMA has stopped: MM2S DMASlvErr",
        "the DMA has stopped: S2MM DMASlvErr",
        "the DMA has stopped: S2MM DMAIntErr",
    ]
    assert node.seconds == 7


def test_devices_of_the_driver_in_cpp(program, system):
    """Files in place of devices: what is written is where the driver in Python writes it."""
    said = run(program, "files", system)
    folder = system / "sys/class/u-dma-buf/udmabuf0"
    assert said == [
        "12345678 14 1024 70400000",
        "the reset of the DMA does not end; does its clock run?",
    ]
    assert (system / "dev/udmabuf0").read_bytes()[64:65] == b"a"
    assert (folder / "sync_for_device").read_text() == "0x0000004000000085"
    assert (folder / "sync_for_cpu").read_text() == "0x0000010000000109"
    (system / "sys/class/u-dma-buf/udmabuf0/phys_addr").unlink()
    (said,) = run(program, "files", system)
    assert said.endswith("phys_addr': No such file or directory")
