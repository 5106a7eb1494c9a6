"""Faults in exported Verilog, each with the rule that the fuzzer must find broken."""

from __future__ import annotations

import re
from dataclasses import dataclass

__all__ = ["FAULTS", "Fault"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """A fault.

    Attributes
    ----------
    name : str
        What is wrong.
    circuit : str
        The circuit that is fuzzed.
    module : str
        The file of Verilog that is changed.
    changes : tuple of (str, str)
        Regular expressions, and what takes their place.
    rule : str
        A regular expression for the rule in the report.
    """

    name: str
    circuit: str
    module: str
    changes: tuple[tuple[str, str], ...]
    rule: str

    def alter(self, module: str, text: str) -> str:
        """Change a file of Verilog, and make sure that it is another one."""
        if module == self.module:
            for old, new in self.changes:
                before = text
                text, number = re.subn(old, new, text)
                assert number, f"the Verilog has no {old!r}"
                assert text != before
        return text


def _faults(
    circuit: str,
    module: str,
    *rows: tuple[str, str, str, str] | tuple[str, str, str, str, str, str],
) -> list[Fault]:
    """List faults: each row has a name, patterns with their replacements, and a rule."""
    made = []
    for name, *changes, rule in rows:
        pairs = tuple(zip(changes[::2], changes[1::2], strict=True))
        made.append(Fault(name=name, circuit=circuit, module=module, changes=pairs, rule=rule))
    return made


# Names of registers are those of `std_msgs/msg/String` on a bus of 4 bytes.
_ITEMS = "message__data__items"
_WAITS = f"({_ITEMS}__valid & ~{_ITEMS}__ready)"

FAULTS = [
    *_faults(
        "deserializer",
        "deserializer",
        (
            "a wrong code",
            r"\{ 5'h00, status__payload \}",
            "{ 5'h00, status__payload == 3'h3 ? 3'h1 : status__payload }",
            "a wrong value on status",
        ),
        (
            "a dropped status",
            r"status__valid <= (\S+) ;",
            r"status__valid <= \1 & (status_now != 3'h2);",
            "no status in time|a wrong value on status|wire order|withdrawn",
        ),
        (
            "an error that is forgotten",
            r"new_error <= (\S+) ;",
            r"new_error <= 1'h0;",
            "a wrong value|an extra transfer|no status",
        ),
        (
            "items that are not zeroed",
            r"(items_good\[2\] \? .*) : 8'h00;",
            r"\1 : items_word[23:16];",
            "a wrong value on data.items",
        ),
        (
            "a length that is not zeroed after an error",
            r"(assign choice_\w+\s+= \S+\s+\? .*) : 32'd0;",
            r"\1 : 32'd1;",
            "a wrong value on data.length",
        ),
        (
            "last is missing from some transfers",
            r"last_now <= (\S+) ;",
            r"last_now <= \1 & ~items_good[3];",
            "a wrong value on data.items",
        ),
        (
            "a leaf that is withdrawn",
            rf"{_ITEMS}__valid <= (\S+) ;",
            rf"{_ITEMS}__valid <= \1 & ~{_WAITS};",
            "valid was withdrawn",
        ),
        (
            "a payload that changes",
            rf"{_ITEMS}__payload <= (\S+) ;",
            rf"{_ITEMS}__payload <= \1 ^ {_WAITS};",
            "a payload changed|a wrong value on data.items",
        ),
        (
            "a path from the status to the input",
            r"\.packets__ready\(s_axis_tready\)",
            ".packets__ready(is_free)",
            r"assign packets__ready = s_axis_tready;",
            "wire is_free;"
            "assign s_axis_tready = is_free | (m_axis_status_tready & ~s_axis_tvalid);",
            "ready of the input depends",
        ),
        (
            "no reset",
            r"assign rst = .*;",
            "assign rst = 1'h0;",
            "a stream is valid after a reset|a wrong value|an extra transfer",
        ),
    ),
    *_faults(
        "loop",
        "serializer",
        (
            "an error flag on each packet",
            r"\.packet_error\(m_axis_tuser\)",
            ".packet_error(is_bad)",
            r"assign packet_error = m_axis_tuser;",
            "wire is_bad; assign m_axis_tuser = is_bad | (m_axis_tlast & m_axis_tkeep == 4'h1);",
            "a wrong beat",
        ),
        (
            "a byte too much in the last beat",
            r"(assign m_axis_tkeep = \{) (\S+) , (\S+) ",
            r"\1 \3 , \3 ",
            "a wrong beat",
        ),
    ),
    *_faults(
        "gate-wait",
        "gate_wait",
        (
            "bad packets pass",
            r"\.abort\(abort\)",
            ".abort(abort & ~(status__ready & packets_out__ready))",
            "a wrong packet|no status in time",
        ),
        (
            "a wrong counter",
            r"counters\[95:64\] \+ 1'h1",
            "counters[95:64] + 2'h2",
            "a wrong counter of TRAILING",
        ),
        (
            "a wrong size",
            r"assign size = \{ words, 2'h0 \} \+",
            "assign size = { words, 2'h0 } + (words[3]) +",
            "a wrong packet",
        ),
    ),
    *_faults(
        "gate-drop",
        "gate_drop",
        (
            "packets are dropped without need",
            r"(assign refused = \S+ +)& (\S+) ;",
            r"\1& (\2 | (beat[7:0] == 8'h55));",
            "a wrong value on status|an extra|no status|a wrong packet",
        ),
    ),
]
