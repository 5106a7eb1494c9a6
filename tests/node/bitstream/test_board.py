"""Boards: those of firm-hdl, and files of users."""

from __future__ import annotations

import pytest

from firm_hdl.cli import main
from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.node.bitstream.board import board_names, read_board
from firm_hdl.node.bitstream.families import FAMILIES, Pin

LIKE = "like: ulx3s-85f\n"
OWN = """\
title: My board
device: iCE40HX4K
package: tq144
clock: {pin: 21, mhz: 12}
"""


def own(tmp_path, text):
    file = tmp_path / "mine.yaml"
    file.write_text(text)
    return read_board(str(file))


def test_each_board_has_the_pins_of_its_links_and_none_twice():
    rgmii = {"rst_n", "mdc", "mdio", "txc", "tx_ctl", "rxc", "rx_ctl"}
    rgmii |= {f"{way}d{bit}" for way in ("rx", "tx") for bit in range(4)}
    for name in board_names():
        board = read_board(name)
        groups = board.groups()
        assert {pin.name for pin in groups["uart"]} == {"uart.rx", "uart.tx"}, name
        if "rgmii" in groups:
            assert {pin.name.partition(".")[2] for pin in groups["rgmii"]} == rgmii, name
        ours = [board.clock, *(pin for pin, _ in board.constants), *groups["uart"]]
        ours += [*groups.get("rgmii", ()), *([board.reset] if board.reset else ())]
        assert len({pin.site for pin in ours}) == len(ours), name
        assert board.speed or board.family.name == "iCE40", name


def test_all_boards_are_listed(capsys):
    with pytest.raises(SystemExit) as ended:
        main(["node", "build", "--board", "list"])
    assert not ended.value.code
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == board_names()


def test_an_unknown_board_is_refused_with_the_names_of_all():
    with pytest.raises(UserError, match=r"'ecpix5'; did you mean '.*'\? Boards are .*icebreaker"):
        read_board("ecpix5")


def test_a_board_is_like_another_but_for_what_it_says(tmp_path):
    text = (
        f"{LIKE}speed: 8\nclock: {{pin: A1, mhz: 8}}\nstandard: LVCMOS25\n"
        "pins: {led: {pins: C1 - 'B1', from: 1, active: low}}\n"
    ).replace("'", "")
    board, other = own(tmp_path, text), read_board("ulx3s-85f")
    assert (board.name, board.title, board.speed, board.clock_hz) == ("mine", other.title, "8", 8e6)
    electrical = {"standard": "LVCMOS25"}
    assert [pin for pin in board.pins.values() if pin.name.startswith("led")] == [
        Pin(name="led.1", site="C1", is_low=True, electrical=electrical),
        Pin(name="led.3", site="B1", is_low=True, electrical=electrical),
    ]
    assert board.pins["uart.rx"].site == other.pins["uart.rx"].site
    assert board.pins["uart.rx"].electrical == {**electrical, "pull": "up"}


@pytest.mark.parametrize(
    ("text", "errors"),
    [
        ("- 1\n", ["1:1: a board must be a mapping of names to values"]),
        ("titel: x\n", ["1:1: a board has no 'titel'; did you mean 'title'?"]),
        ("like: ulx\n", ["1:7: 'like' must be"]),
        ("title: x\n", [f"1:1: a board needs '{key}'" for key in ("device", "package", "clock")]),
        (OWN.replace("HX4K", "HX9K"), ["2:9: 'device' must be"]),
        (OWN.replace("pin: 21, ", ""), ["4:1: 'clock' has no 'pin'"]),
        (OWN.replace(", mhz: 12", ""), ["4:1: 'clock' has no 'mhz'"]),
        (OWN.replace("12}", "0}"), ["4:23: 'mhz' must be from 1 to 1000"]),
        (OWN + 'high: 1 2"\n', ["5:9: 'high' must be a pin of the package"]),
        (LIKE + "pins: {led: B2}\n", ["2:13: 'led' must be a mapping"]),
        (LIKE + "pins: {led: {}}\n", ["2:8: 'led' has no 'pins'"]),
        (LIKE + "pins: {led: {pins: B2 b3}}\n", ["2:23: 'pins' must be a pin of the package"]),
        (LIKE + "pins: {led: {pins: [B2, {}]}}\n", ["2:20: 'pins' must be words, not a mapping"]),
        (LIKE + "pins: {led: {pins: B2 B2}}\n", ["2:20: 'led' has the pin 'B2' twice"]),
        (LIKE + "pins: {led: {pins: B2, names: a b}}\n", ["2:31: there are 2 names of 1 pins"]),
        (LIKE + "pins: {led: {pins: B2 C2, names: a a}}\n", ["2:34: 'led' has a name twice"]),
        (LIKE + "pins: {led: {pins: B2, pull: x}}\n", ["2:30: 'pull' must be up, down or none"]),
        (LIKE + "pins: {led: {pins: B2, standard: L;}}\n", ["2:34: 'standard' must be"]),
        (LIKE + "pins: {l.d: {pins: B2}}\n", ["2:8: the name of pins has"]),
        (LIKE + "reset: {pin: A2, active: no}\n", ["2:26: 'active' must be text, not a boolean"]),
    ],
)
def test_each_mistake_in_a_file_is_reported_with_its_place(tmp_path, text, errors):
    with pytest.raises(DefinitionError) as raised:
        own(tmp_path, text)
    found = [f"{p.span.line}:{p.span.column}: {p.message}" for p in raised.value.diagnostics]
    assert [each[: len(want)] for each, want in zip(found, errors, strict=True)] == errors


def test_a_file_that_cannot_be_read_is_an_error(tmp_path):
    (tmp_path / "latin.yaml").write_bytes(b"title: \xe4\n")
    for name, reason in (("none", "cannot read"), ("latin", "is not UTF-8 text")):
        with pytest.raises(DefinitionError, match=reason):
            read_board(str(tmp_path / f"{name}.yaml"))


@pytest.mark.parametrize("family", FAMILIES, ids=lambda each: each.name)
def test_a_pll_makes_each_usual_clock_of_each_usual_quartz(family):
    for source in (12e6, 25e6, 50e6, 100e6):
        for wanted in (25e6, 50e6, 100e6, 125e6):
            pll = family.pll(source, wanted, False)
            # A VCO of iCE40 has whole multiples of the quartz alone.
            assert abs(pll.hz / wanted - 1) < (1e-9 if family.name == "ECP5" else 0.01)


def test_a_quartz_outside_of_the_range_of_a_pll_has_none():
    assert all(family.pll(1e6, 50e6, False) is None for family in FAMILIES)
