"""Attacks on the command: each ends with a message of firm-hdl, and no file of the user is lost."""

from __future__ import annotations

import re
import signal
import stat
from pathlib import Path

import pytest

from firm_hdl.cli import main
from tests.attacks.definitions import definition_attacks
from tests.attacks.others import other_attacks
from tests.attacks.recordings import recording_attacks
from tests.attacks.table import Attack

ATTACKS = [*definition_attacks(), *recording_attacks(), *other_attacks()]

# Messages of Python that show an error in the program.
INTERNAL_ERROR = re.compile(
    r"Traceback|\bErrno\b|object has no attribute|object is not|NoneType|codec can't|"
    r"\b[A-Z]\w*(?:Error|Exception)\b|invalid literal|index out of range|unpack|"
    r"unsupported operand|argument must be|recursion depth|Exceeds the limit"
)
# These build a type before they fail, as `out_file` does.
SLOW = {"out_distro_is_file", "out_is_link_to_file"}
# A command that hangs is stopped after this time.
MOST_SECONDS = 120


class HangError(BaseException):
    """A command takes longer than any attack should."""


def contents(root: Path) -> dict[str, bytes]:
    """Return the contents of all small files below a folder, and the kind of special files."""
    found = {}
    for path in sorted(root.rglob("*")):
        status = path.lstat()
        if stat.S_ISREG(status.st_mode) and status.st_size < 1 << 24:
            found[path.relative_to(root).as_posix()] = path.read_bytes()
        elif not stat.S_ISDIR(status.st_mode):
            found[path.relative_to(root).as_posix()] = str(stat.S_IFMT(status.st_mode)).encode()
    return found


def exit_status(arguments: tuple[str, ...]) -> int:
    """Run a command in this process; return its exit status."""

    def hang(*_: object) -> None:
        raise HangError

    before = signal.signal(signal.SIGALRM, hang)
    signal.alarm(MOST_SECONDS)
    try:
        return main(arguments)
    except SystemExit as end:
        assert isinstance(end.code, int)
        return end.code
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def check_end(
    attack: Attack, status: int, output: str, before: dict[str, bytes], root: Path
) -> None:
    """Check exit status, messages and files after a command."""
    assert status in {None: (0, 1, 2), True: (1, 2), False: (0,)}[attack.fails], output
    assert not INTERNAL_ERROR.search(output), output[:2000]
    assert attack.says in output
    assert "\x1b" not in output
    assert "\0" not in output
    assert bool(output.strip()) or status == 0, "a failure without a word"
    after = contents(root)
    for name, text in before.items():
        assert name in attack.changes or after.get(name) == text, f"{name} is lost"


@pytest.mark.parametrize(
    "attack",
    [
        pytest.param(each, id=each.name, marks=[pytest.mark.thorough] * (each.name in SLOW))
        for each in ATTACKS
    ],
)
@pytest.mark.sampled(6)
def test_attack(attack, tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    for name in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
        monkeypatch.delenv(name, raising=False)
    attack.make(tmp_path)
    before = contents(tmp_path)
    status = exit_status(attack.argv)
    out, err = capfd.readouterr()
    # `verify` prints results of tests, and types that it could not judge, on standard output.
    check_end(attack, status, err or out * (attack.argv[:1] == ("verify",)), before, tmp_path)


def test_names_are_distinct_and_there_are_many():
    names = [attack.name for attack in ATTACKS]
    assert len(names) == len(set(names))
    assert len(names) >= 200
