"""Flip-flops around ports, and chains of them on devices where ports have to be pins."""

from __future__ import annotations

from typing import Any

import pytest

from firm_hdl.bench import DEVICES, BenchError
from firm_hdl.bench.devices import Placer
from firm_hdl.bench.surroundings import surround
from tests.bench.netlists import lut, small


def placer(name: str) -> Placer:
    found = DEVICES[name].placer
    assert found is not None
    return found


def added(top: dict[str, Any]) -> dict[str, dict[str, list[int]]]:
    """Return the cells that are not of the circuit, with their connections."""
    return {
        name: cell["connections"]
        for name, cell in top["cells"].items()
        if name not in small()["cells"]
    }


def test_each_bit_of_a_port_gets_a_register_outside() -> None:
    top = small()
    assert surround(top, placer("ecp5")) == 3
    assert {name: port["bits"] for name, port in top["ports"].items()} == {
        "clk": [2],
        "rst": [3],
        "i": [10, 11],
        "o": [12, "0"],
    }
    added = {name: c["connections"] for name, c in top["cells"].items() if name.startswith("port")}
    assert added == {
        "port i[0]": {"CLK": [2], "DI": [10], "Q": [4]},
        "port i[1]": {"CLK": [2], "DI": [11], "Q": [5]},
        "port o[0]": {"CLK": [2], "DI": [7], "Q": [12]},
    }
    # The circuit itself is unchanged.
    assert top["cells"]["fill_LUT4_A_Z_LUT4_Z"] == lut(6, 5, 7, 8)


@pytest.mark.parametrize("place", ["port", "cell", "name"])
def test_new_nets_have_numbers_that_no_other_net_has(place: str) -> None:
    top = small()
    if place == "port":
        top["ports"]["i"]["bits"][1] = 40
    elif place == "cell":
        top["cells"]["$1"]["connections"]["Q"] = [40]
    else:
        top["netnames"]["unused"] = {"bits": ["0", 40, 30]}
    surround(top, placer("ecp5"))
    assert top["ports"]["i"]["bits"] == [41, 42]


def test_a_circuit_without_a_clock_has_no_clock_rate() -> None:
    top = small()
    del top["ports"]["clk"]
    with pytest.raises(BenchError, match=r"^the circuit has no clock 'clk', so it has no clock r"):
        surround(top, placer("ecp5"))


def test_without_pins_for_all_ports_their_registers_form_a_chain() -> None:
    top = small()
    top["ports"]["o"]["bits"] = [7, 6]
    assert surround(top, placer("ice40")) == 4
    assert {name: port["bits"] for name, port in top["ports"].items()} == {
        "clk": [2],
        "rst": [3],
        "scan_in": [14],
        "scan_out": [16],
    }
    assert added(top) == {
        # A chain from one pin drives the inputs.
        "port i[0]": {"C": [2], "D": [14], "Q": [4]},
        "port i[1]": {"C": [2], "D": [4], "Q": [5]},
        "port o[0]": {"C": [2], "D": [7], "Q": [12]},
        "port o[1]": {"C": [2], "D": [6], "Q": [13]},
        # All outputs and the end of that chain are joined to the other pin.
        "sum 0": {"I0": [5], "I1": [12], "I2": [13], "I3": [5], "O": [15]},
        "sum register 0": {"C": [2], "D": [15], "Q": [16]},
    }
    assert top["cells"]["sum 0"]["parameters"] == {"LUT_INIT": "0110100110010110"}


def test_pins_get_buffers_where_nextpnr_adds_none() -> None:
    top = small()
    assert surround(top, placer("gowin")) == 3
    buffers = {name: bits for name, bits in added(top).items() if name.startswith("pin ")}
    assert buffers == {
        "pin clk": {"I": [16], "O": [2]},
        "pin rst": {"I": [17], "O": [3]},
        "pin scan_in": {"I": [18], "O": [13]},
        "pin scan_out": {"I": [15], "O": [19]},
    }
    kinds = {name: top["cells"][name]["type"] for name in buffers}
    assert kinds == {**dict.fromkeys(buffers, "IBUF"), "pin scan_out": "OBUF"}
    assert [port["bits"] for port in top["ports"].values()] == [[16], [17], [18], [19]]


@pytest.mark.parametrize("count", [1, 2, 3, 4, 7])
def test_every_output_is_in_the_sum_once(count: int) -> None:
    top = small()
    top["ports"]["o"]["bits"] = [20 + index for index in range(count)]
    surround(top, placer("ice40"))
    cells = added(top)
    outputs = {bits["Q"][0] for name, bits in cells.items() if name.startswith("port o")}
    ends = {bits["Q"][0] for name, bits in cells.items() if name.startswith("sum register")}
    for name, bits in cells.items():
        if name.startswith("sum ") and "register" not in name:
            taken = [bits[port][0] for port in ("I0", "I1", "I2", "I3")]
            # A net that comes twice fills a look-up table up; it is not an output.
            assert {bit for bit in taken if taken.count(bit) > 1} <= {5, *ends}
            outputs -= set(taken)
    assert outputs == set() and len(ends) == -(-count // 3)
