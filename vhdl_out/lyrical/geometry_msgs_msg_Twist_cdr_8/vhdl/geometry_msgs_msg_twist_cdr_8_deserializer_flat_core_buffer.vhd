-- geometry_msgs_msg_Twist_cdr_8: converters of geometry_msgs/msg/Twist, made by firm-hdl 0.1.0.
-- lyrical, wire cdr, bus of 8 bytes, messages of at most 16777216 bytes
-- definition (SHA-256): f3c5214cf198c004c7af8f0d4f3458f1c32eed4081e18a1527a25d1c0b9ee20a
-- What each port means: manifest.json.
-- Module geometry_msgs_msg_Twist_cdr_8_deserializer.core.buffer of the Amaranth design.
-- 11 registers at rising_edge(aclk), synchronous reset rst = '1'.
-- 1 register at rising_edge(aclk), no reset.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.firm_hdl_pkg.all;

entity geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_buffer is
  port (
    rst             : in  std_logic;
    aclk            : in  std_logic;
    packets_valid   : in  std_logic;
    next_sig        : in  std_logic;
    freed           : in  unsigned(3 downto 0);
    packets_payload : in  unsigned(68 downto 0);
    beat            : out unsigned(73 downto 0);
    packets_ready   : out std_logic;
    limit_sig       : out unsigned(6 downto 0);
    following       : out unsigned(3 downto 0);
    ended           : out std_logic
  );
end entity;

architecture rtl of geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_buffer is

  -- Registers.
  signal packets_ready_q : std_logic := '1';
  signal limit_sig_q     : unsigned(6 downto 0) := (others => '0');
  signal following_q     : unsigned(3 downto 0) := (others => '0');
  signal ended_q         : std_logic := '0';
  signal full            : std_logic := '0';
  signal payload         : unsigned(68 downto 0) := (others => '0');
  signal arrived         : unsigned(3 downto 0) := (others => '0');
  signal at              : unsigned(3 downto 0) := (others => '0');
  signal second          : unsigned(10 downto 0) := (others => '0');
  signal has_second      : std_logic := '0';
  signal pushed          : unsigned(3 downto 0) := (others => '0');
  signal popped          : unsigned(3 downto 0) := (others => '0');

  -- Combinational signals.
  signal arrives        : std_logic;
  signal used           : unsigned(3 downto 0);
  signal next_beat      : unsigned(3 downto 0);
  signal ends_now       : std_logic;
  signal add_3          : unsigned(6 downto 0);
  signal newest_0       : unsigned(6 downto 0);
  signal stored         : std_logic;
  signal more           : std_logic;
  signal follows        : std_logic;
  signal or_14          : std_logic;
  signal mux_15         : unsigned(10 downto 0);
  signal mux_22         : std_logic;
  signal ends_read_data : unsigned(10 downto 0);

  -- Signals that no logic reads, for simulation.
  signal room            : std_logic;
  signal ends_write_addr : unsigned(2 downto 0);
  signal ends_write_data : unsigned(10 downto 0);
  signal ends_write_en   : std_logic;
  signal ends_read_addr  : unsigned(2 downto 0);
  signal end_sig         : unsigned(10 downto 0);
  signal newest          : unsigned(10 downto 0);

  type ends_array is array (0 to 7) of unsigned(10 downto 0);
  signal ends : ends_array := (others => (others => '0'));
begin

  arrives <= packets_valid and packets_ready_q;
  used <= arrived - freed;
  next_beat <= at + 1;
  ends_now <= full and payload(68);
  add_3 <= unsigned'(at & "000") + payload(67 downto 64);
  newest_0 <= add_3 when ends_now = '1' else mux(full, next_beat, at) & "000";
  stored <= '1' when pushed /= popped else '0';
  more <= stored or ends_now;
  follows <= ended_q and ends_now;
  or_14 <= next_sig or not ended_q;
  mux_15 <= second when has_second = '1' else next_beat & newest_0;
  mux_22 <= mux(next_sig, more, '1') when has_second = '1' else mux(next_sig, '0', follows);

  process (aclk)
  begin
    if rising_edge(aclk) then
      ends(to_integer(pushed(2 downto 0))) <= next_beat & add_3;
    end if;
  end process;

  ends_read_data <= ends(to_integer(popped(2 downto 0)));

  p_aclk : process (aclk)
  begin
    if rising_edge(aclk) then
      if rst = '1' then
        full <= '0';
        arrived <= (others => '0');
        at <= (others => '0');
        packets_ready_q <= '1';
        limit_sig_q <= (others => '0');
        following_q <= (others => '0');
        ended_q <= '0';
        second <= (others => '0');
        has_second <= '0';
        pushed <= (others => '0');
        popped <= (others => '0');
      else
        full <= arrives;
        arrived <= arrived + arrives;
        at <= at + full;
        packets_ready_q <= not used(3) and not (to_std_logic(used = 7) and arrives);
        if or_14 = '1' then
          limit_sig_q <= mux_15(6 downto 0);
          following_q <= mux_15(10 downto 7);
          ended_q <= has_second or ends_now;
        end if;
        if next_sig = '1' or has_second = '0' then
          if stored = '1' then
            second <= ends_read_data;
          else
            second <= next_beat & add_3;
          end if;
        end if;
        has_second <= mux_22;
        if has_second = '1' and ends_now = '1' then
          pushed <= pushed + 1;
        end if;
        if next_sig = '1' and has_second = '1' and more = '1' then
          popped <= popped + 1;
        end if;
      end if;
    end if;
  end process;

  p_aclk_2 : process (aclk)
  begin
    if rising_edge(aclk) then
      payload <= packets_payload;
    end if;
  end process;

  beat <= full & at & payload;

  packets_ready <= packets_ready_q;
  limit_sig <= limit_sig_q;
  following <= following_q;
  ended <= ended_q;

  room <= packets_ready_q;
  ends_write_addr <= pushed(2 downto 0);
  ends_write_data <= next_beat & add_3;
  ends_write_en <= '1';
  ends_read_addr <= popped(2 downto 0);
  end_sig <= next_beat & add_3;
  newest <= next_beat & newest_0;

end architecture;
