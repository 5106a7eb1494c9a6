"""Attacks by output folders, files that the command wrote itself, options, and tools."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from firm_hdl.verify.results.file import FORMAT
from tests.attacks.table import Attack, files

__all__ = ["other_attacks"]

BOOL = "std_msgs/msg/Bool"
FOLDER = "out/lyrical/std_msgs_msg_Bool_cdr_8"
BUILD = ("build", BOOL, "--out", "out")
MANIFEST = f"{FOLDER}/manifest.json"
RECORD: dict[str, Any] = {
    "test": {"system": "ts2", "distro": "lyrical", "type": BOOL, "same": ["lyrical"]},
    "verdict": {"verdict": "passed", "cases": 1},
}
WRONG: tuple[dict[str, Any], ...] = (
    {"test": {**RECORD["test"], "same": ["humble", 7]}},
    {"test": {**RECORD["test"], "bus_bytes": "8"}},
    {"test": {**RECORD["test"], "age": 3}},
    {"verdict": {"verdict": []}},
    {"verdict": {"verdict": "failed", "failures": 7}},
    {"seconds": 7},
    {"seconds": {"testing": None}},
    {"coverage": []},
    {"metrics": {"steps": None}},
    {"verdicts": [None]},
    {"written_by": [True]},
)
LINES = (
    *("7", "[]", "null", "{", "[" * 50_000, '{"session": 7}', '{"session": {"started": 7}}'),
    *('{"record": 7}', '{"record": null}', '{"record": {}}', '{"record": {"test": 7}}'),
    *(json.dumps({"record": {**RECORD, **wrong}}) for wrong in WRONG),
)
HEADS: dict[str, tuple[Any, ...]] = {
    "format": (4, [], "firm-hdl results 1"),
    "options": (7, [], None),
    "planned": (7, ["x"], [7], [{"system": 7}]),
}


def other_attacks() -> Iterator[Attack]:
    """Yield the attacks of this kind."""
    yield from _folders()
    yield from _results()
    yield from _golden()
    yield from _options()


def _folders() -> Iterator[Attack]:
    def attack(name: str, make: Callable[[Path], None]) -> Attack:
        return Attack(name=f"out_{name}", argv=BUILD, make=make, fails=True)

    def special(name: str, how: str) -> Callable[[Path], None]:
        def make(root: Path) -> None:
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            if how == "fifo":
                os.mkfifo(root / name)
            elif how == "loop":
                (root / name).symlink_to(Path(name).name)
            elif how == "sparse":
                (root / name).write_bytes(b"")
                os.truncate(root / name, 1 << 30)
            else:
                (root / name).symlink_to(how)

        return make

    good = {"inputs_sha256": "0", "inputs": {"message": "p/msg/A"}, "files": {}}
    for name, text in {
        "empty": "",
        "binary": bytes(range(256)),
        "list": "[]",
        "number": "7",
        "null": "null",
        "deep": "[" * 100_000,
        "digits": "9" * 5000,
        "no_inputs": json.dumps({**good, "inputs": None}),
        "inputs_list": json.dumps({**good, "inputs": [1]}),
        "files_list": json.dumps({**good, "files": [1]}),
        "of_another": json.dumps(good),
        "message_list": json.dumps({**good, "inputs": {"message": [1]}}),
    }.items():
        fill = files({MANIFEST: text, f"{FOLDER}/thesis.tex": "ten years"})
        yield attack(f"manifest_{name}", fill)
    yield attack("file", files({"out": "mine"}))
    yield attack("distro_is_file", files({"out/lyrical": "mine"}))
    yield attack("folder_is_file", files({FOLDER: "mine"}))
    yield attack("folder_is_fifo", special(FOLDER, "fifo"))
    yield attack("folder_is_link_to_itself", special(FOLDER, "loop"))
    yield attack("manifest_is_fifo", special(MANIFEST, "fifo"))
    yield attack("manifest_is_device", special(MANIFEST, "/dev/zero"))
    yield attack("manifest_is_sparse", special(MANIFEST, "sparse"))
    yield attack("of_somebody_else", files({f"{FOLDER}/thesis.tex": "ten years"}))
    yield attack("is_link_to_file", special("out", "/dev/null"))
    for name, out in {
        "device": "/dev/null",
        "below_device": "/dev/null/x",
        "nul": "a\0b",
        "long": "a" * 300,
        "proc": "/proc/firm-hdl",
        "empty": "",
    }.items():
        yield Attack(
            name=f"out_option_{name}",
            argv=("build", "no_msgs/msg/No" if name == "empty" else BOOL, "--out", out),
            fails=True,
        )


def _results() -> Iterator[Attack]:
    head = {"format": FORMAT, "options": {}, "planned": []}
    for number, line in enumerate(LINES):
        yield _report(f"line_{number}", f"{json.dumps(head)}\n{line}\n", fails=True)
    for key, values in HEADS.items():
        for number, value in enumerate(values):
            text = json.dumps({**head, key: value})
            yield _report(f"{key}_{number}", f"{text}\n", fails=True)
    for name, text in {
        "empty": b"",
        "binary": bytes(range(256)) + b"\n",
        "json": b"{}\n",
        "list": b"[]\n",
        "number": b"7\n",
        "deep": b"[" * 100_000 + b"\n",
        "no_line_end": b"x" * 1000,
    }.items():
        yield _report(name, text, fails=None if name in ("empty", "no_line_end") else True)

    def fifo(root: Path) -> None:
        os.mkfifo(root / "r.jsonl")

    def sparse(root: Path) -> None:
        (root / "r.jsonl").write_bytes(b"")
        os.truncate(root / "r.jsonl", 1 << 30)

    for name, make in {"fifo": fifo, "sparse": sparse}.items():
        yield Attack(name=f"report_{name}", argv=("report", "r.jsonl"), make=make, fails=True)
        yield Attack(
            name=f"results_{name}",
            argv=("verify", BOOL, "--systems", "ts2", "--results", "r.jsonl"),
            make=make,
            fails=True,
        )
    yield Attack(
        name="results_of_somebody_else",
        argv=("verify", BOOL, "--systems", "ts2", "--results", "thesis.tex"),
        make=files({"thesis.tex": "ten years\nof work"}),
        fails=True,
    )
    yield Attack(name="report_missing", argv=("report", "r.jsonl"), fails=True)
    yield Attack(name="report_folder", argv=("report", "."), fails=True)
    yield Attack(
        name="report_out_is_folder",
        argv=("report", "r.jsonl", "--out", "x.md"),
        make=files({"r.jsonl": "", "x.md/thesis": "mine"}),
        fails=True,
    )


def _report(name: str, text: str | bytes, fails: bool | None) -> Attack:
    fill = files({"r.jsonl": text})
    return Attack(name=f"report_{name}", argv=("report", "r.jsonl"), make=fill, fails=fails)


def _golden() -> Iterator[Attack]:
    plan = "golden/lyrical/x.yaml"
    for name, text in {
        "empty": b"",
        "binary": bytes(range(256)),
        "not_yaml": b"{{{",
        "list": b"[]",
        "number": b"7",
        "deep": b"[" * 2000,
        "keys": b"format: 1\nmessage: [1]\nsteps: 7\n",
        "tag": b"!!python/object/apply:os.system ['touch owned']",
        "laughs": b"a: &a [x, x]\nb: &b [*a, *a]\nc: [*b, *b]\n",
        "null": b"null",
        "digits": b"format: " + b"9" * 5000,
    }.items():
        yield Attack(
            name=f"golden_{name}",
            argv=("golden", "check", "golden"),
            make=files({plan: text}),
            fails=True,
        )

    def fifo(root: Path) -> None:
        (root / plan).parent.mkdir(parents=True)
        os.mkfifo(root / plan)

    def sparse(root: Path) -> None:
        files({plan: b""})(root)
        os.truncate(root / plan, 1 << 30)

    for name, make in {"fifo": fifo, "sparse": sparse}.items():
        yield Attack(
            name=f"golden_{name}", argv=("golden", "accept", "golden"), make=make, fails=True
        )
    for name, text in {"binary": bytes(range(256)), "empty": b"", "odd": b"a/b/c/d\n"}.items():
        yield Attack(
            name=f"cover_check_{name}",
            argv=("cover", BOOL, "--check", "x"),
            make=files({"x": text}),
            fails=True,
        )
    yield Attack(
        name="cover_check_device", argv=("cover", BOOL, "--check", "/dev/zero"), fails=True
    )


def _options() -> Iterator[Attack]:
    for number, argv in enumerate(
        [
            (),
            ("",),
            ("nothing",),
            ("--nothing",),
            ("-",),
            ("--",),
            ("build",),
            ("build", ""),
            ("build", "/"),
            ("build", "a//b"),
            ("build", "../../etc/passwd"),
            ("build", "a" * 100_000),
            ("build", "std_msgs/msg/\0"),
            ("build", "std_msgs/msg/\x1b[2J"),
            ("build", "std_msgs/msg/\udcff"),
            ("plan", BOOL, "--bus-bytes", "3"),
            ("plan", BOOL, "--bus-bytes", "9" * 5000),
            ("plan", BOOL, "--bus-bytes", "-8"),
            ("plan", BOOL, "--max-message-bytes", "0"),
            ("plan", BOOL, "--max-message-bytes", "9" * 5000),
            ("plan", BOOL, "--max-message-bytes", "1e3"),
            ("plan", BOOL, "--max-message-bytes", "1"),
            ("plan", BOOL, "--distro", "groovy"),
            ("plan", BOOL, "--wire", "morse"),
            ("plan", BOOL, "--bag", "a", "--path", "b"),
            ("plan", BOOL, "--depends", "nowhere"),
            ("md5", "std_msgs/msg/Bool", "--distro", "humble"),
            ("hash", "std_msgs/Bool", "--distro", "noetic"),
            ("md5",),
            ("md5", "std_msgs/Bool", "--all"),
            ("verify",),
            ("verify", BOOL, "--depends", "x"),
            ("verify", BOOL, "--seed", "x"),
            ("verify", BOOL, "--jobs", "0"),
            ("verify", BOOL, "--systems", "ts9"),
            ("verify", BOOL, "--report", "x.html"),
            ("golden", "check", "nowhere"),
            ("golden", "burn", "nowhere"),
            ("cover", BOOL, "--check", "nowhere"),
            ("prove", BOOL, "--timeout", "0"),
            ("list", "--path", "nowhere"),
            ("show", "std_msgs/msg/Boool"),
            ("metrics", "--format", "poem", BOOL),
        ]
    ):
        yield Attack(name=f"argv_{number}", argv=argv, fails=True)
