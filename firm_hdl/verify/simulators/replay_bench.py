"""A bench in VHDL that knows nothing but ports: rows of inputs in, rows of outputs out.

The rows are those of :mod:`firm_hdl.verify.simulators.trace`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from firm_hdl.verify.simulators.trace import ARESETN, Pin, Trace

__all__ = ["replay_bench"]

_HEAD = """\
library ieee;
use ieee.std_logic_1164.all;
use std.textio.all;

entity replay is end entity;

architecture sim of replay is
  signal aclk    : std_logic := '0';
  signal aresetn : std_logic := '0';
"""

_BEGIN = """
  process
    file stimuli : text open read_mode is "stimuli.txt";
    file results : text open write_mode is "results.txt";
    variable row, seen : line;
    variable is_compared, number : natural;
    variable bit_read : std_ulogic;
"""

_LOOP = """\
  begin
    while not endfile(stimuli) loop
      readline(stimuli, row);
      read(row, is_compared);
      while row'length > 0 loop
        read(row, number);
        case number is
"""

_SETTLE = """\
          when others => report "no such input" severity failure;
        end case;
      end loop;
      wait for 5 ns;
      if is_compared = 1 then
"""

_END = """\
        writeline(results, seen);
      end if;
      aclk <= '1';
      wait for 5 ns;
      aclk <= '0';
    end loop;
    wait;
  end process;
end architecture;
"""


def replay_bench(trace: Trace, ports: Sequence[Mapping[str, str]]) -> str:
    """Write the bench, whose entity is ``replay``.

    Parameters
    ----------
    ports : sequence of mapping of str to str
        For each device, what its ports are called in VHDL.
    """
    return "".join(
        [
            _HEAD,
            *(f"  signal i{pin.number} : {_type(pin)} := {_zero(pin)};\n" for pin in trace.inputs),
            *(f"  signal o{pin.number} : {_type(pin)};\n" for pin in trace.outputs),
            "begin\n",
            *_devices(trace, ports),
            _BEGIN,
            *_variables(trace),
            _LOOP,
            *_reading(trace),
            _SETTLE,
            *_writing(trace),
            _END,
        ]
    )


def _type(pin: Pin) -> str:
    width = pin.port.width
    return "std_logic" if width == 1 else f"std_logic_vector({width - 1} downto 0)"


def _zero(pin: Pin) -> str:
    return "'0'" if pin.port.width == 1 else "(others => '0')"


def _devices(trace: Trace, ports: Sequence[Mapping[str, str]]) -> Iterator[str]:
    for number, (device, names) in enumerate(zip(trace.devices, ports, strict=True)):
        pairs = [f"{names['aclk']} => aclk", f"{names['aresetn']} => aresetn"]
        for prefix, pins in (("i", trace.inputs), ("o", trace.outputs)):
            mine = [pin for pin in pins if pin.device == number]
            pairs += [f"{names[pin.port.name]} => {prefix}{pin.number}" for pin in mine]
        joined = ",\n    ".join(pairs)
        yield f"  {device.direction} : entity work.{device.name} port map (\n    {joined});\n"


def _variables(trace: Trace) -> Iterator[str]:
    for width in sorted({pin.port.width for pin in trace.inputs} - {1}):
        yield f"    variable read_{width} : std_ulogic_vector({width - 1} downto 0);\n"
    for pin in trace.outputs:
        yield f"    variable was{pin.number} : {_type(pin)};\n"


def _reading(trace: Trace) -> Iterator[str]:
    yield f"          when {ARESETN} => read(row, bit_read); aresetn <= bit_read;\n"
    for pin in trace.inputs:
        variable = "bit_read" if pin.port.width == 1 else f"read_{pin.port.width}"
        yield (
            f"          when {pin.number} => read(row, {variable}); i{pin.number} <= {variable};\n"
        )


def _writing(trace: Trace) -> Iterator[str]:
    # Before the first row, all are 'U', which none is afterwards.
    for pin in trace.outputs:
        n = pin.number
        yield f"""\
        if o{n} /= was{n} then
          was{n} := o{n};
          write(seen, {n});
          write(seen, ' ');
          write(seen, o{n});
          write(seen, ' ');
        end if;
"""
