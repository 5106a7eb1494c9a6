"""Crash injection for `firm_hdl.export.folder`: end a build before each system call in turn.

This is a program, so that it may fork. Each crash ends a process of its own as SIGKILL would,
without any ``finally``. The folder is checked after the crash, and again after another build. The
program prints the number of crashes and the problems.

The program can also poll: before each system call, it reads the manifest as another program would.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from firm_hdl.export import folder as module

OLD = {name: f"old {name}\n" for name in ("a.v", "vhdl/b.vhd", "gone.txt")}
NEW = {name: f"new {name}\n" for name in ("a.v", "vhdl/b.vhd", "vhdl/c.sh", "mine.txt")}
# One file has the name of a file that is new in the new version.
USERS = {
    "notes": "ten years",
    "mine.txt": "a file of mine",
    "vhdl/mine.vhd": "entity",
    "sim/deep/run.do": "run",
}
EVENTS = ("os.", "open", "shutil.")
MOST_STRIKES = 400


def with_manifest(files: dict[str, str]) -> dict[str, str]:
    made = {"inputs_sha256": "0", "inputs": {}, "files": dict.fromkeys(files, "0")}
    return {**files, "manifest.json": json.dumps(made)}


def is_change(event: str, arguments: tuple[Any, ...]) -> bool:
    """Return whether a system call changes a file or folder."""
    if event == "open":
        return bool(arguments[2] & (os.O_WRONLY | os.O_RDWR))
    return event.startswith(EVENTS) and event not in ("os.listdir", "os.scandir", "os.fork")


def strike_before(number: int) -> None:
    """End this process before a system call, or in the middle of writing a file."""
    left = number

    def look(event: str, arguments: tuple[Any, ...]) -> None:
        nonlocal left
        if is_change(event, arguments):
            left -= 1
            if left < 0:
                os._exit(137)

    sys.addaudithook(look)
    original = Path.write_text

    def write_text(self: Path, text: str, **options: Any) -> int:
        nonlocal left
        left -= 1
        if left < 0:
            self.write_bytes(text.encode()[: len(text) // 2])
            os._exit(137)
        return original(self, text, **options)

    Path.write_text = write_text  # type: ignore[method-assign, assignment]


def set_up(root: Path) -> Path:
    target = root / "lyrical" / "type"
    module.replace(target, with_manifest(OLD))
    for name, text in USERS.items():
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        (target / name).write_text(text)
    # A folder that another program left under the name of an ended process.
    other = root / "lyrical" / f".type.{os.getpid() + 1}.old"
    other.mkdir()
    (other / "thesis.tex").write_text("mine")
    return target


def texts(root: Path) -> dict[str, str]:
    return {
        path.relative_to(root).as_posix(): path.read_text()
        for path in sorted(root.rglob("*"))
        if path.is_file()
    }


def problems(target: Path, *, has_exchange: bool) -> Iterator[str]:
    """Yield what is wrong right after a crash."""
    everything = set(texts(target.parent).values())
    for name, text in {**USERS, "another program's": "mine"}.items():
        if text not in everything:
            yield f"{name} is lost"
    if not target.is_dir():
        if has_exchange:
            yield "there is no folder"
        return
    found = texts(target)
    if "manifest.json" not in found:
        yield "there is no manifest"
        return
    files = json.loads(found["manifest.json"])["files"]
    want = OLD if files.keys() == OLD.keys() else NEW
    yield from (f"{name} is not whole" for name in want if found.get(name) != want[name])
    if has_exchange:
        here = set(found.values())
        yield from (f"{name} is not in place" for name, text in USERS.items() if text not in here)


def problems_after(target: Path) -> Iterator[str]:
    """Yield what is wrong after the next build."""
    found = texts(target)
    want = {**with_manifest(NEW), **USERS, "mine.txt": NEW["mine.txt"]}
    want["mine.txt.kept"] = USERS["mine.txt"]
    if found != want:
        yield f"the next build made {sorted(found)}"
    rest = sorted(path.name for path in target.parent.iterdir())
    if len(rest) != 2:
        yield f"the next build left {rest}"


def look_on() -> None:
    """Count the system calls before which the manifest is incomplete; print the count."""
    manifests = {with_manifest(files)["manifest.json"] for files in (OLD, NEW)}
    looks, misses, looking = 0, 0, False

    with tempfile.TemporaryDirectory() as root:
        target = set_up(Path(root))

        def look(event: str, arguments: tuple[Any, ...]) -> None:
            nonlocal looks, misses, looking
            if looking or not is_change(event, arguments):
                return
            looking = True  # Reading is a system call, too.
            looks += 1
            try:
                misses += (target / "manifest.json").read_text() not in manifests
            except OSError:
                misses += 1
            looking = False

        sys.addaudithook(look)
        for files in (NEW, OLD):
            module.replace(target, with_manifest(files))
        looking = True
    print(json.dumps({"looks": looks, "misses": misses}))


def strike(has_exchange: bool) -> None:
    """End builds before each system call in turn; print the problems."""
    wrong: list[str] = []
    for number in range(MOST_STRIKES):
        with tempfile.TemporaryDirectory() as root:
            target = set_up(Path(root))
            child = os.fork()
            if child == 0:
                strike_before(number)
                module.replace(target, with_manifest(NEW))
                os._exit(0)
            status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
            found = [*problems(target, has_exchange=has_exchange)]
            module.replace(target, with_manifest(NEW))
            found += problems_after(target)
            wrong += [f"strike {number}: {problem}" for problem in found]
            if status == 0:
                break
    else:
        wrong.append("the build never came through")
    print(json.dumps({"strikes": number, "wrong": wrong}))


def main(has_exchange: str, does: str = "strike") -> None:
    if has_exchange == "fallback":
        module.exchange = lambda one, other: False  # type: ignore[attr-defined]
    if does == "look":
        look_on()
    else:
        strike(has_exchange == "exchange")


if __name__ == "__main__":
    main(*sys.argv[1:])
