"""A test bench in VHDL for each message type, and a script that runs it in GHDL.

Packets from a file go through the deserializer, an accelerator that does nothing, and the
serializer, all with random stalls; what comes out is compared byte for byte with another file.
Everything that passes, leaf transfers included, is written down.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from firm_hdl.export.vhdl_types import UserLayer
from firm_hdl.export.vhdl_user_constants import comment
from firm_hdl.export.vhdl_user_parts import PARTS
from firm_hdl.export.vhdl_user_types import TYPES_NAME, primitive_name
from firm_hdl.model import Message
from firm_hdl.plan import Plan

__all__ = ["RUN_SCRIPT", "STIMULI", "Bench", "bench", "run_script"]

STIMULI = "stimuli.txt"
"""The file with packets, beside the script."""

RUN_SCRIPT = "run_ghdl.sh"


@dataclass(frozen=True, slots=True, kw_only=True)
class Bench:
    """A test bench.

    Attributes
    ----------
    top : str
        Its entity.
    files : dict of str to str
        Texts by file name, in compile order, after all other files.
    """

    top: str
    files: dict[str, str]


def bench(message: Message, plan: Plan, layer: UserLayer, *, header: str = "") -> Bench:
    """Write the test bench of a message type."""
    top = f"{layer.name}_tb"
    text = "".join(
        [
            *comment(header, ""),
            *_entity(message, plan, layer, top),
            *_converters(plan, layer),
            *_accelerator(plan, layer),
            *_log(plan, layer),
            _CONTROL.format(
                what=f"{message.name}, {plan.wire}, bus of {plan.bus_bytes} bytes",
                end=f"end architecture sim;  -- of {top}",
            ),
        ]
    )
    return Bench(top=top, files={**PARTS, f"{top}.vhd": text})


def _entity(message: Message, plan: Plan, layer: UserLayer, top: str) -> Iterator[str]:
    root = layer.tree.root
    last = len(plan.leaves) - 1
    yield f"""\
-- Test bench of the converters of {message.name}. Simulation only.
--
-- Ends by itself, with a line that starts with PASS, or with a failure.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;

use work.firm_hdl_bench_pkg.all;
use work.{TYPES_NAME}.all;
use work.{layer.package}.all;

entity {top} is
  generic (
    stimuli   : string  := "stimuli.txt";    -- packets to send, one a line, in hexadecimal
    expected  : string  := "stimuli.txt";    -- packets that have to come out
    results   : string  := "results.txt";    -- packets that came out
    transfers : string  := "transfers.txt";  -- cycle, leaf and data of each transfer of a leaf
    seed      : natural := 1;
    stalls    : natural range 0 to 99 := 40; -- percent of the cycles in which a stream stalls
    patience  : positive := 100_000          -- cycles without a beat after which it has failed
  );
end entity;

architecture sim of {top} is

  constant BUS_BYTES : positive := {plan.bus_bytes};
  constant LEAVES    : positive := {last + 1};

  signal aclk    : std_logic := '0';
  signal aresetn : std_logic := '0';
  signal over    : boolean := false;
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

  -- From the deserializer, and to the serializer.
  signal rx_msg, tx_msg : {root.type};
  signal rx_rdy, tx_rdy : {root.ready_type};

  -- Per leaf: whether it may pass, whether it is offered, whether it would be taken.
  signal gate    : std_logic_vector(LEAVES - 1 downto 0) := (others => '1');
  signal offered : std_logic_vector(LEAVES - 1 downto 0);
  signal taken   : std_logic_vector(LEAVES - 1 downto 0);

begin
"""


def _converters(plan: Plan, layer: UserLayer) -> Iterator[str]:
    yield """
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
    yield f"""
  rx : {layer.entities["deserializer"]}
    port map (
      aclk => aclk, aresetn => aresetn, s_axis_tdata => i_tdata, s_axis_tkeep => i_tkeep,
      s_axis_tlast => i_tlast, s_axis_tvalid => i_tvalid, s_axis_tready => i_tready,
      msg => rx_msg, rdy => rx_rdy, m_axis_status_tdata => rx_tdata,
      m_axis_status_tvalid => rx_tvalid, m_axis_status_tready => rx_tready
    );

  tx : {layer.entities["serializer"]}
    port map (
      aclk => aclk, aresetn => aresetn, m_axis_tdata => o_tdata, m_axis_tkeep => o_tkeep,
      m_axis_tlast => o_tlast, m_axis_tuser => o_tuser, m_axis_tvalid => o_tvalid,
      m_axis_tready => o_tready, msg => tx_msg, rdy => tx_rdy, m_axis_status_tdata => tx_tdata,
      m_axis_status_tvalid => tx_tvalid, m_axis_status_tready => tx_tready
    );
"""


def _accelerator(plan: Plan, layer: UserLayer) -> Iterator[str]:
    yield "\n  -- The accelerator: it does nothing, but stalls.\n"
    for node in layer.tree.root.leaves():
        assert node.leaf is not None
        k, at = node.leaf, node.access
        yield f"\n  tx_msg.{at}.data <= rx_msg.{at}.data;\n"
        if plan.leaves[k].kind == "items":
            yield f"  tx_msg.{at}.last <= rx_msg.{at}.last;\n"
        yield (
            f"  tx_msg.{at}.valid <= rx_msg.{at}.valid and gate({k});\n"
            f"  rx_rdy.{at} <= tx_rdy.{at} and gate({k});\n"
            f"  offered({k}) <= rx_msg.{at}.valid;\n"
            f"  taken({k}) <= tx_rdy.{at};\n"
        )
    yield """
  -- What was offered stays offered until it is taken.
  stalling : process (aclk)
    variable random : random_t := random_from(seed, 3);
    variable stall : boolean;
  begin
    if rising_edge(aclk) then
      for k in gate'range loop
        if offered(k) = '1' and (gate(k) = '0' or taken(k) = '1') then
          draw(random, stalls, stall);
          gate(k) <= '0' when stall else '1';
        end if;
      end loop;
    end if;
  end process;
"""


def _log(plan: Plan, layer: UserLayer) -> Iterator[str]:
    yield """
  -- Items are written with the first one to the right; a last transfer has an asterisk.
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
    for node in layer.tree.root.leaves():
        assert node.leaf is not None
        leaf = plan.leaves[node.leaf]
        data = f"rx_msg.{node.access}.data"
        more = ""
        if leaf.kind == "items":
            image, more = f"to_hstring(to_slv({data}))", f", rx_msg.{node.access}.last"
        elif primitive_name(leaf) == "bool":
            image = f"to_string({data})"
        else:
            image = f"to_hstring({data})"
        k = node.leaf
        yield (
            f"      if (offered({k}) and gate({k}) and taken({k})) = '1' then\n"
            f'        note("{leaf}", {image}{more});\n'
            "      end if;\n"
        )
    yield "    end if;\n  end process;\n"


_CONTROL = """
  aclk <= not aclk after 5 ns when not over;

  control : process (aclk)
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
    if rising_edge(aclk) and not over then
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

      -- A while longer, in case that something comes that should not.
      if i_done and o_packets = o_total and i_packets = o_total and rx_count = o_total and
          tx_count = o_total and idle > 100 then
        assert o_total > 0 report "FAIL there are no packets" severity failure;
        assert (o_tvalid or rx_tvalid or tx_tvalid or (or offered)) = '0'
          report "FAIL something is left over" severity failure;
        write(output, "PASS {what}: " & integer'image(o_packets) & " packets, " &
          integer'image(o_bytes) & " bytes, " & integer'image(final - first + 1) & " cycles" & LF);
        over <= true;
      end if;
    end if;
  end process;

{end}
"""


def run_script(files: Iterable[str], top: str) -> str:
    """Write the script that runs a bench in GHDL.

    Parameters
    ----------
    files : iterable of str
        In compile order, beside the script.
    top : str
        The bench's entity.
    """
    listed = " \\\n".join(f'  "$here/{name}"' for name in files)
    return f"""\
#!/bin/sh
# Run the test bench in GHDL. Arguments go to the simulation, such as -gseed=7 or --wave=tb.ghw.
# What GHDL and the bench write is in work/ beside this script; WORK names another folder, and GHDL
# another command than the first that is found.
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
  echo "{RUN_SCRIPT}: write packets to $here/{STIMULI}, one a line, in hexadecimal" >&2
  exit 2
fi
mkdir -p "$work"
cd "$work"
printf '*\\n' > .gitignore
"$ghdl" -a --std=08 \\
{listed}
exec "$ghdl" --elab-run --std=08 {top} --ieee-asserts=disable-at-0 \\
  -gstimuli="$here/{STIMULI}" -gexpected="$here/{STIMULI}" "$@"
"""
