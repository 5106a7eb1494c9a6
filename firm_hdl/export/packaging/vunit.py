"""A script for VUnit, and an entity that runs the benches as test cases of VUnit."""

from __future__ import annotations

from firm_hdl.export.packaging.facts import Manifest, remark

__all__ = ["vunit_bench", "vunit_script"]


def vunit_script(manifest: Manifest) -> str:
    """Write the script that runs the benches with VUnit."""
    section = manifest["vhdl"]
    files = [*section["files"], *section["bench"]["files"], f"tb_{section['name']}_vunit.vhd"]
    listed = "".join(f'    "{file}",\n' for file in files)
    return f'''\
"""Run the test benches of {remark(manifest)} with VUnit 4 (pip install vunit_hdl)."""


from pathlib import Path

from vunit import VUnit

HERE = Path(__file__).resolve().parent
FILES = [
{listed}]

vunit = VUnit.from_argv(compile_builtins=False)
vunit.add_vhdl_builtins()
library = vunit.add_library("firm_hdl")
for file in FILES:
    library.add_source_file(HERE / file, vhdl_standard="2008")
bench = library.test_bench("tb_{section["name"]}_vunit")
bench.set_sim_option("ghdl.sim_flags", ["--ieee-asserts=disable-at-0"])
for stalls in (0, 40):
    bench.add_config(f"stalls_{{stalls}}", generics={{"stalls": stalls, "folder": f"{{HERE}}/"}})
vunit.main()
'''


def vunit_bench(manifest: Manifest) -> str:
    """Write the entity that runs the benches as test cases of VUnit."""
    section = manifest["vhdl"]
    bench = section["bench"]
    signals = "".join(f"  signal over_{k} : boolean;\n" for k, _ in enumerate(bench["entities"]))
    tests = ""
    instances = ""
    for k, entity in enumerate(bench["entities"]):
        word = "elsif" if k else "if"
        tests += f'      {word} run("{entity}") then\n        wait until over_{k};\n'
        instances += f"""
  bench_{k} : if case_name = "{entity}" generate
  begin
    bench : entity work.{entity}
      generic map (
        stimuli => folder & "{bench["stimuli"]}", expected => folder & "{bench["stimuli"]}",
        results => output_path(runner_cfg) & "results.txt",
        transfers => output_path(runner_cfg) & "transfers.txt", stalls => stalls
      )
      port map (over => over_{k});
  end generate;
"""
    return _VUNIT_BENCH.format(
        message=manifest["inputs"]["message"],
        top=f"tb_{section['name']}_vunit",
        signals=signals,
        instances=instances,
        tests=tests,
    )


_VUNIT_BENCH = """\
-- The test benches of {message} as test cases of VUnit. Simulation only.

library vunit_lib;
context vunit_lib.vunit_context;

entity {top} is
  generic (
    runner_cfg : string;
    folder     : string;
    stalls     : natural
  );
end entity;

architecture sim of {top} is

  constant case_name : string := enabled_test_cases(runner_cfg);

{signals}
begin
{instances}
  main : process
  begin
    test_runner_setup(runner, runner_cfg);
    while test_suite loop
{tests}      end if;
    end loop;
    test_runner_cleanup(runner);
  end process;

end architecture;
"""
