"""Kill builds, and look what is left: before each system call in turn, at random, and in parallel.

This is a program, so that it may fork. It prints what was wrong, as JSON.
"""

from __future__ import annotations

import json
import os
import random
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from firm_hdl.export import folder as module
from firm_hdl.export.manifest import MANIFEST, digest

VERSIONS = (
    ("T_verilog.v", "plan.yaml", "vhdl/T.vhd", "vhdl/T_old.vhd", "systemverilog/T_sv.sv"),
    ("T_verilog.v", "plan.yaml", "vhdl/T.vhd", "vhdl/run_ghdl.sh", "waivers.vlt"),
    ("T_verilog.v", "plan.yaml", "vhdl/T.vhd", "waivers.vlt"),
)
USERS = {"notes.txt": "ten years", "vhdl/mine.vhd": "entity", "sim/deep/run.do": "run"}


def texts(version: int) -> dict[str, str]:
    """Return the files of a version; the plan is the same in all."""
    return {name: f"{name != 'plan.yaml' and version} {name}\n" * 99 for name in VERSIONS[version]}


def manifest(files: dict[str, str], **inputs: Any) -> dict[str, Any]:
    sums = {name: digest(text) for name, text in files.items()}
    return {"inputs": inputs, "inputs_sha256": "", "files": sums}


def write(folder: Path, files: dict[str, str], **inputs: Any) -> tuple[str, ...] | None:
    """Build a folder of files."""
    return module.build_folder(
        folder.parent, folder, inputs, lambda: (files, manifest(files, **inputs))
    )


def build(folder: Path, version: int) -> None:
    write(folder, texts(version), version=version)


def left_when_outdated(folder: Path, copy: Path) -> set[str]:
    """Return the files of a built folder that a build without any file would leave."""
    listed = json.loads((folder / MANIFEST).read_text())["files"]
    for name in (*listed, MANIFEST):
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_bytes((folder / name).read_bytes())
    write(copy, {})
    return {*tree(copy)} - {MANIFEST}


def tree(root: Path) -> dict[str, str]:
    return {
        path.relative_to(root).as_posix(): path.read_text()
        for path in sorted(root.rglob("*"))
        if path.is_file()
    }


def problems(folder: Path, *, is_done: bool) -> Iterator[str]:
    """Yield what is wrong with a folder, after a build or after a kill."""
    found = {name: text for name, text in tree(folder).items() if name not in USERS}
    if {name: text for name, text in tree(folder).items() if name in USERS} != USERS:
        yield "a user's file is lost"
    made = json.loads(found.pop(MANIFEST))
    if "unfinished" not in made:
        right = texts(made["inputs"]["version"])
        left = found.keys() - right
        if any(found.get(name) != right[name] for name in right):
            yield "the folder is not complete, and its manifest does not say so"
        if is_done and left:
            yield f"there are {sorted(left)}"
    elif is_done:
        yield "the folder is not complete"
    for name, text in found.items():
        known = [texts(version).get(name) for version in range(3)]
        if not name.startswith(".firm-hdl-") and text not in known:
            yield f"{name} is not whole"


def killed(folder: Path, run: Callable[[], None], seconds: float | None = None) -> bool:
    """Run a build in a process, which may be killed; return whether it was."""
    child = os.fork()
    if child == 0:
        run()
        os._exit(0)
    if seconds is not None:
        time.sleep(seconds)
        os.kill(child, signal.SIGKILL)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) != 0


def strike_before(number: int) -> None:
    """End this process before a system call, or in the middle of writing a file."""
    left, original = number, module.write_new

    def count() -> bool:
        nonlocal left
        left -= 1
        return left < 0

    def look(event: str, arguments: tuple[Any, ...]) -> None:
        is_write = event == "open" and arguments[2] & os.O_WRONLY
        if (is_write or event in ("os.rename", "os.remove", "os.mkdir", "os.rmdir")) and count():
            os._exit(137)

    def write_half(path: str, data: bytes, mode: int, *, folder: int) -> None:
        if count():
            original(path, data[: len(data) // 2], mode, folder=folder)
            os._exit(137)
        original(path, data, mode, folder=folder)

    module.write_new = write_half  # type: ignore[assignment]
    sys.addaudithook(look)


def set_up(root: str) -> Path:
    folder = Path(root, "lyrical", "T")
    build(folder, 0)
    for name, text in USERS.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder


def everywhere() -> Iterator[str]:
    """Kill a build before each system call; another build, killed as well, and a third follow."""

    def run(folder: Path, number: int, version: int) -> bool:
        def struck() -> None:
            strike_before(number)
            build(folder, version)

        return killed(folder, struck)

    for number in range(400):
        with tempfile.TemporaryDirectory() as root:
            folder = set_up(root)
            was_killed = run(folder, number, 1)
            found = [*problems(folder, is_done=False)]
            run(folder, number * 7 % 31, 2)
            found += problems(folder, is_done=False)
            build(folder, number % 3)
            found += problems(folder, is_done=True)
            yield from (f"strike {number}: {problem}" for problem in found)
        if not was_killed:
            break
    if not 30 < number < 399:
        yield f"the build has {number} system calls"


def first_builds() -> Iterator[str]:
    """Kill the first build of a folder before each system call."""
    for number in range(400):
        with tempfile.TemporaryDirectory() as root:
            folder = Path(root, "T")

            def struck(folder: Path = folder, number: int = number) -> None:
                strike_before(number)
                build(folder, 1)

            was_killed = killed(folder, struck)
            build(folder, 0)
            if sorted(tree(folder)) != sorted([*VERSIONS[0], MANIFEST]):
                yield f"strike {number}: the folder has {sorted(tree(folder))}"
        if not was_killed:
            return


def at_random(kills: int) -> Iterator[str]:
    """Kill processes that build one folder again and again."""
    with tempfile.TemporaryDirectory() as root:
        folder = set_up(root)

        def run() -> None:
            while True:
                build(folder, random.randrange(3))

        for number in range(kills):
            killed(folder, run, random.uniform(0, 0.03))
            found = [*problems(folder, is_done=False)]
            if number % 2:
                build(folder, number // 2 % 3)
                found += problems(folder, is_done=True)
            yield from (f"kill {number}: {problem}" for problem in found)


def in_parallel() -> Iterator[str]:
    """Build one folder eight times at once."""
    with tempfile.TemporaryDirectory() as root:
        folder = Path(root, "T")
        children = []
        for number in range(8):
            children.append(os.fork())
            if children[-1] == 0:
                for turn in range(9):
                    build(folder, (number + turn) % 2)
                os._exit(0)
        if any(os.waitpid(child, 0)[1] for child in children):
            yield "a build failed"
        version = json.loads((folder / MANIFEST).read_text())["inputs"]["version"]
        if sorted(tree(folder)) != sorted([*VERSIONS[version], MANIFEST]):
            yield f"the folder has {sorted(tree(folder))}"


if __name__ == "__main__":
    found = [*everywhere(), *first_builds(), *at_random(int(sys.argv[1])), *in_parallel()]
    print(json.dumps(found))
