"""The module between a node and the pins of a board: clock, PLL, reset, and the pins themselves."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from math import ceil, log2
from typing import Any, TypeAlias

from firm_hdl.errors import DefinitionError, Diagnostic, Span
from firm_hdl.export.ports import verilog_range
from firm_hdl.node.bitstream.board import LINKS, Board, board_names, read_board
from firm_hdl.node.bitstream.families import MOST_DEVIATION, Pin, Pll
from firm_hdl.node.description import Description
from firm_hdl.node.summary import area_of, facts_of

__all__ = ["BoardTop", "board_top"]

Problem: TypeAlias = Callable[[Span | None, str], None]
"""Notes a mistake at a place."""

RESET_SECONDS = 20e-6
"""How long the node is reset after the start. Block RAMs of iCE40 have their contents only 10 us
after it."""

NONCE = "nonce"
"""A port of a participant of ROS 2 without pins: at 0, the time of the first datagram counts."""

_RGMII_HZ = 125e6

_ENDS = {"i": "in", "o": "out", "oe": "out"}
"""Members of one pin, as `amaranth.lib.io` names them, with their directions."""

_DIRECTIONS = {
    ("i",): "input",
    ("o",): "output",
    ("o", "oe"): "inout",
    ("i", "o", "oe"): "inout",
}
"""The direction of a pin by its members."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardTop:
    """A top level."""

    verilog: str  # The module `top`.
    constraints: str  # The file of constraints for nextpnr.
    clock_hz: float  # Frequency of the node's clock.


@dataclass(frozen=True, slots=True, kw_only=True)
class _Port:
    """A port of the top level with its pins, and the ports of the node behind it.

    `inner` has them by `i`, `o` and `oe`.
    """

    name: str
    direction: str
    pins: Sequence[Pin]
    inner: Mapping[str, str]


def board_top(
    description: Description, ports: Sequence[Mapping[str, Any]], module: str, board: Board
) -> BoardTop:
    """Write the top level of a node for a board.

    * `ports`: the ports of the node, as its manifest has them.
    * `module`: name of the node's module in Verilog.

    Raises `DefinitionError`: with all that does not fit together, at its place in the description.
    """
    problems: list[Diagnostic] = []

    def problem(span: Span | None, message: str) -> None:
        problems.append(Diagnostic(message=message, span=span))

    pll = _pll(description, board, problem)
    if description.registers:
        what = f"{board.name} has no processor for the registers; the top level is yours to write"
        problem(description.registers_span, what)
    found = _link(description, ports, board, problem)
    constants = list(board.constants)
    is_rgmii = any(port.name.startswith("rgmii_") for port in found)
    if is_rgmii and "rgmii.rst_n" in board.pins:
        constants.append((board.pins["rgmii.rst_n"], True))
    fixed = [board.clock, *([board.reset] if board.reset else ())]
    taken = {pin.site: f"the board ('{pin.name}')" for pin in fixed}
    taken |= {pin.site: f"the board, which holds it at {level:d}" for pin, level in constants}
    for pin in (pin for port in found for pin in port.pins):
        if pin.site in taken:
            problem(
                description.link_span,
                f"the pin '{pin.name}' of the link, {pin.site}, is already that of "
                f"{taken[pin.site]}",
            )
        taken[pin.site] = f"the link ('{pin.name}')"
    if description.accelerator:
        found += _io(description, ports, board, taken, problem)
    else:
        problem(
            description.node_span,
            "a node whose messages come out of it has too many pins: it needs an 'accelerator', "
            "such as 'firm_hdl.node.loop:Loop', which sends all messages back",
        )
    if problems:
        raise DefinitionError(sorted(problems, key=lambda p: p.span.start if p.span else -1))
    header = f"{description.node} on {board.title}: clock, reset and pins, made by firm-hdl"
    clock_hz = board.clock_hz if pll is None else pll.hz
    return BoardTop(
        verilog=_verilog(
            header,
            module,
            board,
            constants,
            pll,
            clock_hz,
            found,
            {port["name"]: port["width"] for port in ports if port["name"] == NONCE},
        ),
        constraints=board.family.constrain(
            list(_sites(board, constants, found)),
            {"clk": board.clock_hz, **({"rgmii_rxc": _RGMII_HZ} if is_rgmii else {})},
        ),
        clock_hz=clock_hz,
    )


def _pll(description: Description, board: Board, problem: Problem) -> Pll | None:
    """Return the PLL that makes the clock of the node; `None` if the board has this clock."""
    wanted = description.clock_hz
    if abs(board.clock_hz / wanted - 1) <= MOST_DEVIATION:
        return None
    pll = board.family.pll(board.clock_hz, wanted, board.is_pll_pad)
    if pll is None or abs(pll.hz / wanted - 1) > MOST_DEVIATION:
        near = (board.clock_hz if pll is None else pll.hz) / 1e6
        area = area_of(facts_of(description))
        hint = f"near is 'clock_mhz: {near:.9g}'"
        if near > area["mhz"]:
            hint = f"the node itself reaches about {area['mhz']:.4g} MHz on {area['part']}"
        problem(
            description.clock_span or description.node_span,
            f"the clock of {board.name}, {board.clock_hz / 1e6:g} MHz, gives no {wanted / 1e6:g} "
            f"MHz; {hint}",
        )
    return pll


def _link(
    description: Description, ports: Sequence[Mapping[str, Any]], board: Board, problem: Problem
) -> list[_Port]:
    """Give the ports of the link the pins of the same names."""
    where = description.link_span or description.node_span
    of_link = [port for port in ports if port["member"].startswith("link.")]
    group = of_link[0]["name"].partition("_")[0]
    there = [each for each in LINKS if each in board.groups()]
    if group in LINKS and group not in there:
        others = [name for name in board_names() if group in read_board(name).groups()]
        message = f"{board.name} has no {group.upper()}; boards that have one: {', '.join(others)}"
        problem(where, message)
        return []
    if group not in LINKS:
        link = description.link
        is_udp = link.kind in ("udp", "rtps")
        ways = {
            "rgmii": "'ethernet: rgmii'" if is_udp else "'link: {kind: udp, ethernet: rgmii, ...}'",
            "uart": "'link: {kind: uart}'",
        }
        needs = " or ".join(ways[each] for each in ways if each in there)
        what = f"ethernet: {link.ethernet}" if link.has_ethernet else link.kind
        problem(
            where,
            f"{board.name} has {' and '.join(there) or 'no link'}"
            f"{needs and f', so the description needs {needs}'}; for '{what}', the top level is "
            "yours to write",
        )
        return []
    found, missing = [], []
    for port in of_link:
        if port["name"] == NONCE:
            continue
        width = port["width"]
        names = [f"{port['name']}{bit if width > 1 else ''}" for bit in range(width)]
        names = [name.replace("_", ".", 1) for name in names]
        missing += [name for name in names if name not in board.pins]
        pins = [board.pins[name] for name in names if name in board.pins]
        inner = {port["direction"][0]: port["name"]}
        direction = f"{port['direction']}put"
        found.append(_Port(name=port["name"], direction=direction, pins=pins, inner=inner))
    if missing:
        problem(where, f"{board.name} lacks pins of the link: {', '.join(missing)}")
    return found


def _io(
    description: Description,
    ports: Sequence[Mapping[str, Any]],
    board: Board,
    taken: dict[str, str],
    problem: Problem,
) -> list[_Port]:
    """Give the members of the accelerator the pins that the description names."""
    members: dict[str, dict[str, Mapping[str, Any]]] = {}
    for port in (port for port in ports if port["member"].startswith("io.")):
        member = port["member"].removeprefix("io.")
        stem, _, end = member.rpartition(".")
        if not stem or _ENDS.get(end) != port["direction"]:
            stem, end = member, port["direction"][0]
        members.setdefault(stem, {})[end] = port
    given = {each.name: each for each in description.pins}
    for name in given.keys() - members.keys():
        close = get_close_matches(name, members, n=1)
        hint = f"; did you mean '{close[0]}'?" if close else ""
        problem(given[name].span, f"the accelerator has no member '{name}'{hint}")
    found = []
    for name, inner in members.items():
        direction = _DIRECTIONS.get(tuple(sorted(inner)))
        widths = {end: port["width"] for end, port in inner.items()}
        bits = widths.get("o", widths.get("i", 1))
        if name not in given:
            problem(
                description.accelerator_span,
                f"'{name}' of the accelerator has no pin: write 'pins: {{{name}: [{_some(bits)}]}}'"
                f" into the description; {board.name} has {', '.join(board.groups())}",
            )
            continue
        if direction is None or widths != {end: 1 if end == "oe" else bits for end in inner}:
            members_of = ", ".join(f"{end} of {width} bits" for end, width in widths.items())
            problem(given[name].span, f"'{name}' is no pin: it has {members_of}")
            continue
        pins: list[Pin] = []
        for word, span in zip(given[name].pins, given[name].spans, strict=True):
            chosen = _chosen(board, word)
            if not chosen:
                problem(span, _unknown(board, word))
            for pin in chosen:
                if pin.site in taken:
                    site = f", {pin.site}," if word != pin.site else ""
                    problem(span, f"the pin '{word}'{site} is already that of {taken[pin.site]}")
                taken.setdefault(pin.site, f"'{name}'")
            pins += chosen
        if len(pins) != bits and len(pins) >= len(given[name].pins):
            problem(given[name].span, f"'{name}' has {bits} bits, and is given {len(pins)} pins")
        names = {end: port["name"] for end, port in inner.items()}
        end, port = next(iter(inner.items()))
        outer = port["name"]
        if port["member"] != f"io.{name}":
            outer = outer.removesuffix(f"_{end}")
        found.append(_Port(name=outer, direction=direction, pins=pins, inner=names))
    return found


def _some(bits: int) -> str:
    return ", ".join(["..."] * min(bits, 4))


def _chosen(board: Board, word: str) -> list[Pin]:
    """Return the pins that a word means: one by its name or its site, or all of a group."""
    if word in board.pins:
        return [board.pins[word]]
    for pin in board.pins.values():
        if pin.site == word:
            # As it is on the board: what is active low is so for its name alone.
            return [Pin(name=word, site=word, electrical=pin.electrical)]
    return board.groups().get(word, [])


def _unknown(board: Board, word: str) -> str:
    names = [*board.pins, *(pin.site for pin in board.pins.values()), *board.groups()]
    close = get_close_matches(word, names, n=1)
    group = word.partition(".")[0]
    if group in board.groups():
        rest = [pin.name.partition(".")[2] for pin in board.groups()[group]]
        return f"{board.name} has no pin '{word}'; '{group}' has {', '.join(rest)}"
    hint = f"; did you mean '{close[0]}'?" if close else "."
    return f"{board.name} has no pin '{word}'{hint} It has {', '.join(board.groups())}"


def _sites(
    board: Board, constants: Sequence[tuple[Pin, bool]], ports: Sequence[_Port]
) -> Iterator[tuple[str, Pin]]:
    """Yield each bit of a port of the top level, with its pin."""
    yield "clk", board.clock
    if board.reset:
        yield "reset", board.reset
    for pin, _ in constants:
        yield f"constant_{pin.site}", pin
    for port in ports:
        for bit, pin in enumerate(port.pins):
            yield (port.name if len(port.pins) == 1 else f"{port.name}[{bit}]"), pin


def _verilog(
    header: str,
    module: str,
    board: Board,
    constants: Sequence[tuple[Pin, bool]],
    pll: Pll | None,
    clock_hz: float,
    ports: Sequence[_Port],
    zeros: Mapping[str, int],
) -> str:
    declared = ["input wire clk"]
    if board.reset:
        declared.append("input wire reset")
    declared += [f"output wire constant_{pin.site}" for pin, _ in constants]
    inside, connected = [], [".aclk(aclk)", ".aresetn(aresetn)"]
    connected += [f".{name}({width}'d0)" for name, width in zeros.items()]
    for pin, level in constants:
        inside.append(f"  assign constant_{pin.site} = 1'b{int(level)};\n")
    for port in ports:
        width = len(port.pins)
        vector = verilog_range(width)
        declared.append(f"{port.direction} wire {vector}{port.name}")
        low = "".join(str(int(pin.is_low)) for pin in reversed(port.pins))
        inverted = f" ^ {width}'b{low}" if "1" in low else ""
        for end, name in port.inner.items():
            if end == "i":
                connected.append(f".{name}({port.name}{inverted})")
                continue
            inside.append(f"  wire {vector if end == 'o' else ''}node_{name};\n")
            connected.append(f".{name}(node_{name})")
        if "o" in port.inner:
            value = f"node_{port.inner['o']}{inverted}"
            if "oe" in port.inner:
                value = f"node_{port.inner['oe']} ? {value} : {{{width}{{1'bz}}}}"
            inside.append(f"  assign {port.name} = {value};\n")
    bits = max(1, ceil(log2(RESET_SECONDS * clock_hz)))
    start = "locked"
    if board.reset:
        start += " & reset" if board.reset.is_low else " & ~reset"
    clock = pll.verilog if pll else "  assign aclk = clk;\n  assign locked = 1'b1;\n"
    listed, joined = ",\n  ".join(declared), ",\n    ".join(connected)
    return f"""\
// {header}

module top (
  {listed}
);
  wire aclk, locked;
{clock}
  // The node is reset for {2**bits} cycles after the clock is there.
  reg [1:0] started = 0;
  reg [{bits}:0] cycles = 0;
  wire aresetn = cycles[{bits}];
  always @(posedge aclk) begin
    started <= {{started[0], {start}}};
    if (!started[1]) cycles <= 0;
    else if (!aresetn) cycles <= cycles + 1;
  end

{"".join(inside)}
  {module} node (
    {joined}
  );
endmodule
"""
