"""Test benches in VHDL for each message type, and a script that runs them in GHDL.

Packets from a file go through the deserializer, an accelerator that does nothing, and the
serializer, all with random stalls. The packets that come out are compared byte for byte with
another file. The bench writes all packets and all transfers of leaves to files.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from firm_hdl.export.top import DIRECTIONS
from firm_hdl.export.vhdl.bench_views import View
from firm_hdl.export.vhdl.constants import comment

__all__ = ["RUN_SCRIPT", "STIMULI", "bench", "run_script"]

STIMULI = "stimuli.txt"
"""The file with packets, in the folder of the script."""

RUN_SCRIPT = "run_ghdl.sh"


def bench(
    top: str, view: View, *, bus_bytes: int, what: str, files: str = "", header: str = ""
) -> str:
    """Write a test bench.

    Parameters
    ----------
    top : str
        Name of the entity.
    what : str
        Description of the converters, for the last line that the bench prints.
    files : str
        Suffix of the names of the files that the bench writes.
    header : str
        Lines of a comment at the head of the file.
    """
    return "".join(
        [
            *comment(header, ""),
            *comment(f"Test bench of the converters of {what}. Simulation only.", ""),
            _ENTITY.format(uses=view.uses, top=top, files=files),
            _ARCHITECTURE.format(
                top=top,
                bus_bytes=bus_bytes,
                count=len(view.channels),
                declarations=view.declarations,
            ),
            _PACKETS,
            *_converters(view, bus_bytes),
            *_accelerator(view),
            *_log(view),
            _CONTROL.format(what=what, end=f"end architecture sim;  -- of {top}"),
        ]
    )


_ENTITY = """\
--
-- The bench ends by itself: it prints a line that starts with PASS, or ends with a failure.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;

{uses}
entity {top} is
  generic (
    stimuli   : string  := "stimuli.txt";    -- packets to send, one per line, in hexadecimal
    expected  : string  := "stimuli.txt";    -- packets that must come out
    results   : string  := "results{files}.txt";    -- packets that came out
    transfers : string  := "transfers{files}.txt";  -- cycle, leaf and data of each leaf's transfer
    seed      : natural := 1;
    stalls    : natural range 0 to 99 := 40; -- percent of the cycles in which a stream stalls
    patience  : positive := 100_000          -- cycles without a beat after which the bench fails
  );
  port (
    over : out boolean := false  -- the bench has passed
  );
end entity;
"""

_ARCHITECTURE = """
architecture sim of {top} is

  constant BUS_BYTES : positive := {bus_bytes};
  constant LEAVES    : positive := {count};

  signal aclk    : std_logic := '0';
  signal aresetn : std_logic := '0';
  signal cycle   : natural := 0;

  signal i_tdata, o_tdata   : std_logic_vector(8 * BUS_BYTES - 1 downto 0);
  signal i_tkeep, o_tkeep   : std_logic_vector(BUS_BYTES - 1 downto 0);
  signal i_tlast, o_tlast   : std_logic;
  signal i_tvalid, o_tvalid : std_logic;
  signal i_tready, o_tready : std_logic;
  signal o_tuser            : std_logic;
  signal i_done             : boolean;
  signal i_packets          : natural;
  signal o_packets          : natural;
  signal o_bytes            : natural;
  signal o_total            : natural;

  signal rx_tdata, tx_tdata   : std_logic_vector(7 downto 0);
  signal rx_tvalid, tx_tvalid : std_logic;
  signal rx_tready, tx_tready : std_logic := '0';
  signal rx_count, tx_count   : natural := 0;

  -- Per leaf: the gate is open; the deserializer offers a transfer; the serializer is ready for it.
  signal gate    : std_logic_vector(LEAVES - 1 downto 0) := (others => '1');
  signal offered : std_logic_vector(LEAVES - 1 downto 0);
  signal taken   : std_logic_vector(LEAVES - 1 downto 0);

  -- Message of the deserializer (rx) and of the serializer (tx).
{declarations}
begin
"""

_PACKETS = """
  source : entity work.firm_hdl_axis_source
    generic map (bus_bytes => BUS_BYTES, stimuli => stimuli, seed => seed, stalls => stalls)
    port map (
      aclk => aclk, aresetn => aresetn, tdata => i_tdata, tkeep => i_tkeep, tlast => i_tlast,
      tvalid => i_tvalid, tready => i_tready, packets => i_packets, done => i_done
    );

  sink : entity work.firm_hdl_axis_sink
    generic map (
      bus_bytes => BUS_BYTES, expected => expected, results => results, seed => seed,
      stalls => stalls
    )
    port map (
      aclk => aclk, aresetn => aresetn, tdata => o_tdata, tkeep => o_tkeep, tlast => o_tlast,
      tuser => o_tuser, tvalid => o_tvalid, tready => o_tready, packets => o_packets,
      bytes => o_bytes, total => o_total
    );
"""


def _converters(view: View, bus_bytes: int) -> Iterator[str]:
    for direction in DIRECTIONS:
        side, (far, near) = (
            ("rx", ("i", "s")) if direction == "deserializer" else ("tx", ("o", "m"))
        )
        packets = ["tdata", "tkeep", "tlast", *(["tuser"] * (side == "tx")), "tvalid", "tready"]
        names = view.packet_names[direction]
        ports = [(names.get(port, port), port) for port in ("aclk", "aresetn")]
        for name in packets:
            bit = "(0)" if name == "tkeep" and view.bit_keep and bus_bytes == 1 else ""
            port = f"{near}_axis_{name}"
            ports.append((names.get(port, port), f"{far}_{name}{bit}"))
        ports += view.message_ports[direction]
        for name in ("tdata", "tvalid", "tready"):
            port = f"m_axis_status_{name}"
            ports.append((names.get(port, port), f"{side}_{name}"))
        width = max(len(port) for port, _ in ports)
        joined = ",\n".join(f"      {port:{width}} => {signal}" for port, signal in ports)
        yield f"\n  {side} : {view.instances[direction]}\n    port map (\n{joined}\n    );\n"


def _accelerator(view: View) -> Iterator[str]:
    yield "\n  -- The accelerator passes all data on, with stalls.\n"
    for k, channel in enumerate(view.channels):
        rx, tx = channel.rx, channel.tx
        yield f"\n  {tx['data']} <= {rx['data']};\n"
        if "last" in rx:
            yield f"  {tx['last']} <= {rx['last']};\n"
        yield (
            f"  {tx['valid']} <= {rx['valid']} and gate({k});\n"
            f"  {rx['ready']} <= {tx['ready']} and gate({k});\n"
            f"  offered({k}) <= {rx['valid']};\n"
            f"  taken({k}) <= {tx['ready']};\n"
        )
    yield _STALLING


_STALLING = """
  -- A gate that is open stays open while an offered transfer is not yet taken.
  stalling : process
    variable random : random_t := random_from(seed, 3);
    variable stall : boolean;
  begin
    wait until rising_edge(aclk);
    for k in gate'range loop
      if offered(k) = '1' and (gate(k) = '0' or taken(k) = '1') then
        draw(random, stalls, stall);
        gate(k) <= '0' when stall else '1';
      end if;
    end loop;
  end process;
"""


def _log(view: View) -> Iterator[str]:
    yield _LOGGING
    for k, channel in enumerate(view.channels):
        last = f", {channel.rx['last']}" if "last" in channel.rx else ""
        yield (
            f"      if (offered({k}) and gate({k}) and taken({k})) = '1' then\n"
            f'        note("{channel.label}", {channel.image}{last});\n'
            "      end if;\n"
        )
    yield "    end if;\n  end process;\n"


_LOGGING = """
  -- The first item of a transfer is rightmost; an asterisk marks a transfer with last set.
  logging : process (aclk)
    file record_of : text open write_mode is transfers;

    procedure note (leaf : string; data : string; last : std_logic := '0') is
    begin
      write(record_of, integer'image(cycle) & " " & leaf & " " & data);
      if last = '1' then
        write(record_of, " *");
      end if;
      write(record_of, "" & LF);
    end procedure;
  begin
    if rising_edge(aclk) and aresetn = '1' then
"""

_CONTROL = """
  aclk <= not aclk after 5 ns when not over;

  control : process
    variable random : random_t := random_from(seed, 4);
    variable stall : boolean;
    variable idle, first, final : natural := 0;
    variable started : boolean := false;

    procedure check (what : string; status : std_logic_vector(7 downto 0); number : natural) is
    begin
      assert status = STATUS_OK
        report "FAIL packet " & integer'image(number) & ": the " & what & " says " &
          status_name(status)
        severity failure;
    end procedure;
  begin
    wait until rising_edge(aclk) and not over;
    cycle <= cycle + 1;
    if cycle = 3 then
      aresetn <= '1';
    end if;

    if (rx_tvalid and rx_tready) = '1' then
      check("deserializer", rx_tdata, rx_count);
      rx_count <= rx_count + 1;
    end if;
    draw(random, stalls, stall);
    rx_tready <= '0' when stall else '1';
    if (tx_tvalid and tx_tready) = '1' then
      check("serializer", tx_tdata, tx_count);
      tx_count <= tx_count + 1;
    end if;
    draw(random, stalls, stall);
    tx_tready <= '0' when stall else '1';

    idle := idle + 1;
    if (i_tvalid and i_tready) = '1' then
      idle := 0;
      if not started then
        first := cycle;
        started := true;
      end if;
    end if;
    if (o_tvalid and o_tready) = '1' then
      idle := 0;
      final := cycle;
    end if;
    assert idle < patience
      report "FAIL nothing moves: " & integer'image(o_packets) & " of " & integer'image(o_total) &
        " packets came out, " & integer'image(i_packets) & " went in, with " &
        integer'image(rx_count) & " and " & integer'image(tx_count) & " statuses"
      severity failure;

    -- Wait 100 cycles more, in case that unexpected data comes.
    if i_done and o_packets = o_total and i_packets = o_total and rx_count = o_total and
        tx_count = o_total and idle > 100 then
      assert o_total > 0 report "FAIL there are no packets" severity failure;
      assert (o_tvalid or rx_tvalid or tx_tvalid or (or offered)) = '0'
        report "FAIL something is left over" severity failure;
      write(output,
        "PASS {what}: " &
        integer'image(o_packets) & " packets, " & integer'image(o_bytes) & " bytes, " &
        integer'image(final - first + 1) & " cycles" & LF);
      over <= true;
    end if;
  end process;

{end}
"""


def run_script(files: Iterable[str], top: str) -> str:
    """Write the script that runs the benches in GHDL.

    Parameters
    ----------
    files : iterable of str
        Names of the files in compile order, in the folder of the script.
    top : str
        Entity of the bench that runs by default.
    """
    listed = " \\\n".join(f'  "$from/{name}"' for name in files)
    return f"""\
#!/bin/sh
# Run the test bench in GHDL. Arguments go to the simulation, such as -gseed=7 or --wave=tb.ghw.
# Files of GHDL and of the bench are written to work/ beside this script. Environment variables:
# WORK names another folder, GHDL the command of GHDL, and BENCH another bench of this folder.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
work=${{WORK:-$here/work}}
ghdl=${{GHDL:-}}
if [ -z "$ghdl" ]; then
  for name in ghdl ghdl-mcode ghdl-llvm ghdl-gcc; do
    if command -v "$name" >/dev/null 2>&1; then ghdl=$name; break; fi
  done
fi
if [ -z "$ghdl" ]; then
  echo "{RUN_SCRIPT}: GHDL is not installed (Debian, Ubuntu: apt install ghdl)" >&2
  exit 127
fi
if [ ! -f "$here/{STIMULI}" ]; then
  echo "{RUN_SCRIPT}: write packets to $here/{STIMULI}, one per line, in hexadecimal" >&2
  exit 2
fi
mkdir -p "$work"
cd "$work"
printf '*\\n' > .gitignore
# GHDL gets relative names only: it does not accept a folder whose name has a quotation mark.
from=..
if [ -n "${{WORK:-}}" ]; then
  from=source
  rm -f "$from"
  ln -s "$here" "$from"
fi
"$ghdl" -a --std=08 \\
{listed}
exec "$ghdl" --elab-run --std=08 "${{BENCH:-{top}}}" --ieee-asserts=disable-at-0 \\
  -gstimuli="$from/{STIMULI}" -gexpected="$from/{STIMULI}" "$@"
"""
