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
_ITEMS = "message_data_items"
_WAITS = f"{_ITEMS}_valid_q && !{_ITEMS}_ready"

FAULTS = [
    *_faults(
        "deserializer",
        "deserializer",
        (
            "a wrong code",
            r"\{5'd0, status_payload\}",
            "{5'd0, status_payload == 3'd3 ? 3'd1 : status_payload}",
            "a wrong value on status",
        ),
        (
            "a dropped status",
            r"status_valid_q <= 1'b1;",
            r"status_valid_q <= status_now != 3'd2;",
            "no status in time|a wrong value on status|wire order|withdrawn",
        ),
        (
            "an error that is forgotten",
            r"new_error <= stops & .*;",
            r"new_error <= 1'b0;",
            "a wrong value|an extra transfer|no status",
        ),
        (
            "items that are not zeroed",
            r"(items_payload_q\[23:16\] <= )8'd0;",
            r"\1items_word[23:16];",
            "a wrong value on data.items",
        ),
        (
            "a length that is not zeroed after an error",
            r"(length_payload_q <= )32'd0;",
            r"\g<1>32'd1;",
            "a wrong value on data.length",
        ),
        (
            "last is missing from some transfers",
            r"payload_q\[32\] <= last;",
            r"payload_q[32] <= last & ~items_good[3];",
            "a wrong value on data.items",
        ),
        (
            "a leaf that is withdrawn",
            rf"if \({_ITEMS}_ready\) begin",
            rf"if ({_ITEMS}_ready || {_ITEMS}_valid_q) begin",
            "valid was withdrawn",
        ),
        (
            "a payload that changes",
            rf"    if \(go_data_items_rest\) begin(?=\n      {_ITEMS}_payload)",
            rf"    if ({_WAITS}) {_ITEMS}_payload_q[0] <= !{_ITEMS}_payload_q[0];\n"
            "    else if (go_data_items_rest) begin",
            "a payload changed|a wrong value on data.items",
        ),
        (
            "a path from the status to the input",
            r"(  deserializer_core core \((?s:.*)\.packets_ready +)\(s_axis_tready\)",
            r"  wire is_free;\n\1(is_free)",
            r"assign packets_ready = s_axis_tready;",
            "assign s_axis_tready = is_free | (m_axis_status_tready & ~s_axis_tvalid);",
            "ready of the input depends",
        ),
        (
            "no reset",
            r"assign rst = .*;",
            "assign rst = 1'b0;",
            "a stream is valid after a reset|a wrong value|an extra transfer",
        ),
    ),
    *_faults(
        "loop",
        "serializer",
        (
            "an error flag on each packet",
            r"(  serializer_core core \((?s:.*)\.packet_error +)\(m_axis_tuser\)",
            r"  wire is_bad;\n\1(is_bad)",
            r"assign packet_error = m_axis_tuser;",
            "assign m_axis_tuser = is_bad | (m_axis_tlast & m_axis_tkeep == 4'h1);",
            "a wrong beat",
        ),
        (
            "a byte too much in the last beat",
            r"(assign m_axis_tkeep = \{\S+ > 3'd)3",
            r"\g<1>2",
            "a wrong beat",
        ),
    ),
    *_faults(
        "gate-wait",
        "gate_wait",
        (
            "bad packets pass",
            r"(?s)(\.abort +)\(abort\)(?!.*\.abort +\(abort\))",
            r"\1(abort & ~(status__ready & packets_out__ready))",
            "a wrong packet|no status in time",
        ),
        (
            "a wrong counter",
            r"counters_trailing\} \+ 33'd1",
            "counters_trailing} + 33'd2",
            "a wrong counter of TRAILING",
        ),
        (
            "a wrong size",
            r"assign size = \{1'd0, words, 2'd0\} \+",
            "assign size = {1'd0, words, 2'd0} + {8'd0, words[3]} +",
            "a wrong packet",
        ),
    ),
    *_faults(
        "gate-drop",
        "gate_drop",
        (
            "packets are dropped without need",
            r"(assign refused = \S+ +)& (\S+);",
            r"\1& (\2 | (beat[7:0] == 8'h55));",
            "a wrong value on status|an extra|no status|a wrong packet",
        ),
    ),
]
