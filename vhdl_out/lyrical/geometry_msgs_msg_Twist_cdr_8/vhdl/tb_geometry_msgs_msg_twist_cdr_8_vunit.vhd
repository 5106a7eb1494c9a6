-- The test benches of geometry_msgs/msg/Twist as test cases of VUnit. Simulation only.

library vunit_lib;
context vunit_lib.vunit_context;

entity tb_geometry_msgs_msg_twist_cdr_8_vunit is
  generic (
    runner_cfg : string;
    folder     : string;
    stalls     : natural
  );
end entity;

architecture sim of tb_geometry_msgs_msg_twist_cdr_8_vunit is

  constant case_name : string := enabled_test_cases(runner_cfg);

  signal over_0 : boolean;
  signal over_1 : boolean;

begin

  bench_0 : if case_name = "geometry_msgs_msg_twist_cdr_8_tb" generate
  begin
    bench : entity work.geometry_msgs_msg_twist_cdr_8_tb
      generic map (
        stimuli => folder & "stimuli.txt", expected => folder & "stimuli.txt",
        results => output_path(runner_cfg) & "results.txt",
        transfers => output_path(runner_cfg) & "transfers.txt", stalls => stalls
      )
      port map (over => over_0);
  end generate;

  bench_1 : if case_name = "geometry_msgs_msg_twist_cdr_8_record_tb" generate
  begin
    bench : entity work.geometry_msgs_msg_twist_cdr_8_record_tb
      generic map (
        stimuli => folder & "stimuli.txt", expected => folder & "stimuli.txt",
        results => output_path(runner_cfg) & "results.txt",
        transfers => output_path(runner_cfg) & "transfers.txt", stalls => stalls
      )
      port map (over => over_1);
  end generate;

  main : process
  begin
    test_runner_setup(runner, runner_cfg);
    while test_suite loop
      if run("geometry_msgs_msg_twist_cdr_8_tb") then
        wait until over_0;
      elsif run("geometry_msgs_msg_twist_cdr_8_record_tb") then
        wait until over_1;
      end if;
    end loop;
    test_runner_cleanup(runner);
  end process;

end architecture;
