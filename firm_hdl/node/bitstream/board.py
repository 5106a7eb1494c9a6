"""Boards: FPGA, clock and pins, as files in YAML say.

Each board of ours is a file in ``boards``, and a user may write others; ``docs/reference/board.md``
has the keys. Such a file has facts only, which can be compared with the documents of a board.
amaranth-boards, from which most facts are, has a program for each board: it would have to be
installed, it lacks some boards, and a board of one's own would be written in Python.
"""

from __future__ import annotations

import os
import re
from codecs import BOM_UTF8
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from firm_hdl.errors import DefinitionError, Diagnostic, Source, UserError
from firm_hdl.files import read_file
from firm_hdl.node.bitstream.families import DEVICES, Family, Pin
from firm_hdl.node.marked_yaml import Entry, Marked, parse

__all__ = ["Board", "board_list", "board_names", "read_board"]

MOST_BYTES = 1 << 18

LINKS = ("uart", "rgmii")
"""Links with pins of their own: names of a board's groups, and how names of ports begin."""

_BOARDS = Path(__file__).with_name("boards")

_ELECTRICAL = {
    "standard": ("[A-Z][A-Z0-9_]{,31}", "a standard of the FPGA, such as LVCMOS33"),
    "pull": ("up|down|none", "up, down or none"),
    "drive": ("4|8|12|16", "4, 8, 12 or 16 mA"),
    "slew": ("fast|slow", "fast or slow"),
}
"""Options of a pin that become constraints: what they look like, and how errors say it."""

_OF_PINS = ("active", *_ELECTRICAL)
_REQUIRED = ("title", "device", "package", "clock")
_KEYS = (*_REQUIRED, "like", "speed", "standard", "reset", "high", "low", "load", "pins")

_SITE = "[A-Z]{1,2}[0-9]{1,2}|[0-9]{1,3}"
_A_SITE = "a pin of the package, such as B2 or 35"
_NAME = "[A-Za-z0-9][A-Za-z0-9_+-]{,31}"
_A_NAME = "letters, digits, '_', '+' and '-'"


@dataclass(frozen=True, slots=True, kw_only=True)
class Board:
    """A board."""

    name: str
    title: str
    family: Family
    # As nextpnr names them; the speed grade is empty if there are none.
    device: str
    package: str
    speed: str
    clock: Pin
    clock_hz: float
    is_pll_pad: bool  # Whether the pin of the clock is that of the PLL (iCE40).
    reset: Pin | None  # A button that resets the node.
    constants: tuple[tuple[Pin, bool], ...]  # Pins that have one level for ever.
    pins: Mapping[str, Pin]  # All others by their names, such as `led.0` and `uart.rx`.
    # The command that loads a bitstream; the name of the bitstream comes last, or in place of
    # `{bitstream}`.
    load: str

    def groups(self) -> dict[str, list[Pin]]:
        """Return the pins by the first part of their names, such as ``led``."""
        found: dict[str, list[Pin]] = {}
        for name, pin in self.pins.items():
            found.setdefault(name.partition(".")[0], []).append(pin)
        return found


def board_names() -> list[str]:
    """List the names of the boards that firm-hdl has."""
    return sorted(path.stem for path in _BOARDS.glob("*.yaml"))


def board_list() -> Iterator[str]:
    """Yield a line for each board: its name, what it is, and the links that it has pins for."""
    for name in board_names():
        board = read_board(name)
        links = " ".join(each for each in board.groups() if each in LINKS)
        yield f"{board.name:18}  {board.title:50}  {links}"


def read_board(name: str) -> Board:
    """Read a board: one of ours by its name, or a file of the user's by its path.

    Raises `UserError` if there is no such board. Raises `DefinitionError`: with all mistakes in the
    file.
    """
    is_file = name.endswith((".yaml", ".yml")) or os.sep in name
    if not is_file and name not in board_names():
        close = get_close_matches(name, board_names(), n=1)
        hint = f"; did you mean '{close[0]}'?" if close else "."
        names = ", ".join(board_names())
        raise UserError(
            f"there is no board '{name}'{hint} Boards are {names}, or a file in YAML of your own"
        )
    path = Path(name) if is_file else _BOARDS / f"{name}.yaml"
    marked, keys, groups = _entries(path, name)
    board = _board(marked, path.stem, keys, groups)
    marked.check()
    return board


def _entries(path: Path, name: str) -> tuple[Marked, dict[str, Entry], dict[str, Entry]]:
    """Read the keys of a board, and its groups of pins, with those of the board that it is like."""
    try:
        text = read_file(path, MOST_BYTES).removeprefix(BOM_UTF8).decode("utf-8")
    except OSError as error:
        message = f"cannot read '{name}': {error.strerror or error}"
        raise DefinitionError([Diagnostic(message=message)]) from None
    except UnicodeDecodeError as error:
        message = f"'{name}' is not UTF-8 text: {error.reason} at byte {error.start}"
        raise DefinitionError([Diagnostic(message=message)]) from None
    marked, node = parse(Source(name=name, text=text.replace("\r\n", "\n")))
    given = marked.mapping(node, "a board", "{title: My board, like: ulx3s-85f}")
    own = marked.known(given, _KEYS, "a board")
    keys: dict[str, Entry] = {}
    groups: dict[str, Entry] = {}
    if "like" in own:
        other = own.pop("like").choice(board_names(), "")
        marked.check()
        _, keys, groups = _entries(_BOARDS / f"{other}.yaml", other)
    if "pins" in own:
        groups |= marked.mapping(own.pop("pins").value, "'pins'", "{led: {pins: B2 C2}}")
    keys |= own
    # What is no mapping, or has a wrong key, would lack all the others, too.
    marked.check()
    for key in _REQUIRED:
        if key not in keys:
            marked.error_at_start(f"a board needs '{key}', or 'like' with the name of another")
    marked.check()
    return marked, keys, groups


def _board(
    marked: Marked, name: str, keys: Mapping[str, Entry], groups: Mapping[str, Entry]
) -> Board:
    """Read the values; what is wrong is noted in `marked`."""
    device = keys["device"].choice(DEVICES, next(iter(DEVICES)))
    family = DEVICES[device]
    is_ecp5 = family.name == "ECP5"
    usual = _electrical({"standard": keys["standard"]} if "standard" in keys else {}, {})
    if is_ecp5:
        usual = {"standard": "LVCMOS33", **usual}

    def pin(what: str, *options: str) -> tuple[Pin, dict[str, Entry]] | None:
        entries = _options(keys[what], ("pin", *options), "{pin: G2}")
        if entries is None:
            return None
        site = _word(entries["pin"], _SITE, _A_SITE)
        found = Pin(
            name=what, site=site, is_low=_is_low(entries), electrical=_electrical(entries, usual)
        )
        return found, entries

    clock, clock_hz, is_pll_pad = Pin(name="clock", site=""), 0.0, False
    if found := pin("clock", "mhz", "pll", *_ELECTRICAL):
        clock, entries = found
        if "mhz" in entries:
            clock_hz = 1e6 * entries["mhz"].number(0.0, 1.0, 1000.0)
        else:
            keys["clock"].error_at_key("'clock' has no 'mhz', its frequency")
        is_pll_pad = "pll" in entries and entries["pll"].choice(("pad", "core"), "core") == "pad"
    reset = pin("reset", *_OF_PINS) if "reset" in keys else None
    return Board(
        name=name,
        title=" ".join(keys["title"].text().split()),
        family=family,
        device=device,
        package=_word(keys["package"], "[A-Za-z0-9:]{1,16}", "the name that nextpnr has for it"),
        speed=_word(keys["speed"], "[678]", "6, 7 or 8") if "speed" in keys and is_ecp5 else "",
        clock=clock,
        clock_hz=clock_hz,
        is_pll_pad=is_pll_pad,
        reset=reset[0] if reset else None,
        constants=tuple(
            (Pin(name=level, site=site, electrical=usual), level == "high")
            for level in ("high", "low")
            if level in keys
            for site in _words(keys[level], _SITE, _A_SITE)
        ),
        pins={
            pin.name: pin for group, entry in groups.items() for pin in _group(group, entry, usual)
        },
        load=" ".join(keys["load"].text().split()) if "load" in keys else "openFPGALoader",
    )


def _group(group: str, entry: Entry, usual: Mapping[str, str]) -> Iterator[Pin]:
    """Read the pins of a group, such as ``led``."""
    if not re.fullmatch(_NAME, group):
        entry.error_at_key(f"the name of pins has {_A_NAME}")
    entries = _options(entry, ("pins", "names", "from", *_OF_PINS), "{pins: B2 C2}")
    if entries is None:
        return
    sites = _words(entries["pins"], f"{_SITE}|-", f"{_A_SITE}, or - for none")
    first = entries["from"].integer(0, 0, 1000) if "from" in entries else 0
    names = [str(first + number) for number in range(len(sites))]
    if "names" in entries:
        names = _words(entries["names"], _NAME, _A_NAME)
        if len(names) != len(sites):
            entries["names"].error(f"there are {len(names)} names of {len(sites)} pins")
    is_low, electrical = _is_low(entries), _electrical(entries, usual)
    seen: set[str] = {"-"}
    for name, site in zip(names, sites, strict=False):
        if site not in seen:
            yield Pin(name=f"{group}.{name}", site=site, is_low=is_low, electrical=electrical)
        elif site != "-":
            entries["pins"].error(f"'{group}' has the pin '{site}' twice")
        seen.add(site)
    if len(set(names)) < len(names):
        entries["names"].error(f"'{group}' has a name twice")


def _options(entry: Entry, keys: tuple[str, ...], example: str) -> dict[str, Entry] | None:
    """Read a mapping with some keys, the first of which is needed; `None` without that."""
    before = entry.marked.noted
    given = entry.marked.mapping(entry.value, f"'{entry.name}'", example)
    known = entry.marked.known(given, keys, f"'{entry.name}'")
    if keys[0] in known:
        return known
    if entry.marked.noted == before:
        entry.error_at_key(f"'{entry.name}' has no '{keys[0]}'")
    return None


def _words(entry: Entry, pattern: str, what: str) -> list[str]:
    """Read words that look like a pattern; `what` says it."""
    found = entry.words()
    for word, span in found:
        if not re.fullmatch(pattern, word):
            message = f"'{entry.name}' must be {what}, not '{word}'"
            entry.marked.note(Diagnostic(message=message, span=span))
    return [word for word, _ in found]


def _word(entry: Entry, pattern: str, what: str) -> str:
    words = _words(entry, pattern, what)
    if len(words) > 1:
        entry.error(f"'{entry.name}' must be one word, not {len(words)}")
    return words[0] if words else ""


def _is_low(entries: Mapping[str, Entry]) -> bool:
    return "active" in entries and entries["active"].choice(("high", "low"), "high") == "low"


def _electrical(entries: Mapping[str, Entry], usual: Mapping[str, str]) -> dict[str, str]:
    given = {key: _word(entries[key], *_ELECTRICAL[key]) for key in _ELECTRICAL if key in entries}
    return {**usual, **given}
