"""What tools want to be told of a folder's VHDL: lists of files, FuseSoC, Vivado, make, VUnit.

Everything comes from the manifest; each function makes the text of one file. The packages that are
the same for all types are packaged apart, so that a project with several types has them once.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

__all__ = [
    "core",
    "makefile",
    "packaging",
]

Manifest = Mapping[str, Any]

COMMON = "firm_hdl_common"
BENCH = "firm_hdl_bench"
"""Cores of FuseSoC with what all types share: packages, and parts of test benches."""


def packaging(manifest: Manifest) -> dict[str, str]:
    """Write all files, by name; they are to be in the folder of the VHDL."""
    name = str(manifest["vhdl"]["name"])
    files = {
        "files.txt": _design_list(manifest),
        "bench_files.txt": _bench_list(manifest),
        f"{COMMON}.core": _common_core(manifest, COMMON),
        f"{BENCH}.core": _common_core(manifest, BENCH),
        **{f"{each['name']}.core": _shared_core(manifest, each) for each in _shared(manifest)},
        f"{name}.core": core(manifest),
        "vivado.tcl": _vivado_script(manifest),
        "Makefile": makefile(manifest),
    }
    if manifest["vhdl"]["bench"]["stimuli"] is not None:
        files["vunit_run.py"] = _vunit_script(manifest)
        files[f"tb_{name}_vunit.vhd"] = _vunit_bench(manifest)
    return files


def _design_list(manifest: Manifest) -> str:
    """List what is to be synthesized, a file a line, in the order in which it compiles."""
    return _lines(manifest["vhdl"]["files"])


def _bench_list(manifest: Manifest) -> str:
    """List the files of the test benches, which compile after the design, for simulation only."""
    return _lines(manifest["vhdl"]["bench"]["files"])


def _lines(files: Iterable[str]) -> str:
    return "".join(f"{file}\n" for file in files)


def _remark(manifest: Manifest) -> str:
    inputs = manifest["inputs"]
    options = inputs["options"]
    return (
        f"{inputs['message']} ({inputs['distro']}, {options['wire']}, "
        f"bus of {options['bus_bytes']} bytes)"
    )


def _version(manifest: Manifest) -> str:
    return str(manifest["inputs"]["generator"]["firm-hdl"])


def _shared(manifest: Manifest) -> list[Manifest]:
    """List the packages that are the same in the folders of all messages that need them."""
    return list(manifest["vhdl"]["shared_packages"])


def _own(files: Iterable[str], section: Manifest) -> list[str]:
    """Leave out what other folders have, too."""
    others = {*section["common_files"], *(p["file"] for p in section.get("shared_packages", ()))}
    return [file for file in files if file not in others]


def _common_core(manifest: Manifest, name: str) -> str:
    """Describe to FuseSoC what all types share: `COMMON` for synthesis, `BENCH` for test benches.

    The folder of every type has the same text.
    """
    section = manifest["vhdl"] if name == COMMON else manifest["vhdl"]["bench"]
    what = "Packages" if name == COMMON else "Parts of the test benches"
    vlnv = _common(manifest) if name == COMMON else _bench(manifest)
    return "".join(
        [
            f"CAPI=2:\nname: {vlnv}\n",
            f"description: {what} that all converters of firm-hdl share\n",
            "\nfilesets:\n",
            *_fileset("all", section["common_files"]),
            "\ntargets:\n  default:\n    filesets: [all]\n",
        ]
    )


def _common(manifest: Manifest) -> str:
    kind = "flat" if manifest["vhdl"]["ports"] == "flat" else "common"
    return f"firm-hdl:vhdl:{kind}:{_version(manifest)}"


def _bench(manifest: Manifest) -> str:
    return f"firm-hdl:vhdl:bench:{_version(manifest)}"


def _shared_core(manifest: Manifest, package: Manifest) -> str:
    """Describe to FuseSoC a package that is the same in the folders of several messages."""
    what = f"Records of {package['message']}" if package["message"] else "Streams of one bus width"
    depends = [_common(manifest), *(_shared_vlnv(manifest, name) for name in package["needs"])]
    return "".join(
        [
            f"CAPI=2:\nname: {_shared_vlnv(manifest, package['name'])}\n",
            f"description: {what}, which all converters of firm-hdl share\n",
            "\nfilesets:\n",
            *_fileset("all", [package["file"]], *depends),
            "\ntargets:\n  default:\n    filesets: [all]\n",
        ]
    )


def _shared_vlnv(manifest: Manifest, name: str) -> str:
    """Name the core of a shared package: types may differ from distribution to distribution."""
    [package] = [each for each in _shared(manifest) if each["name"] == name]
    library = manifest["inputs"]["distro"] if package["message"] else "vhdl"
    return f"firm-hdl:{library}:{name}:{_version(manifest)}"


def core(manifest: Manifest) -> str:
    """Describe a type's converters to FuseSoC: target `sim` runs the test bench in GHDL."""
    section = manifest["vhdl"]
    bench, stimuli = section["bench"], section["bench"]["stimuli"]
    text = [
        "CAPI=2:\n",
        f"name: firm-hdl:{manifest['inputs']['distro']}:{section['name']}:{_version(manifest)}\n",
        f"description: Converters of {_remark(manifest)}\n",
        "\nfilesets:\n",
        *_fileset(
            "rtl",
            _own(section["files"], section),
            _common(manifest),
            *(_shared_vlnv(manifest, each["name"]) for each in _shared(manifest)),
        ),
        *_fileset("bench", _own(bench["files"], bench), _bench(manifest)),
    ]
    if stimuli is not None:
        # Beside the simulation, where the bench looks for it.
        text.append(
            f"  stimuli:\n    files:\n      - {stimuli}: {{file_type: user, copyto: {stimuli}}}\n"
        )
    text.append("\ntargets:\n  default:\n    filesets: [rtl]\n")
    for entity in bench["entities"] if stimuli is not None else ():
        target = "sim" if entity == bench["entity"] else "sim_record"
        text.append(
            f"  {target}:\n"
            f"    description: Run {entity} in GHDL\n"
            "    default_tool: ghdl\n"
            "    filesets: [rtl, bench, stimuli]\n"
            f"    toplevel: {entity}\n"
            "    parameters: [seed, stalls]\n"
            "    tools:\n"
            "      ghdl:\n"
            "        run_options: [--ieee-asserts=disable-at-0]\n"
        )
    if stimuli is not None:
        text += [
            "\nparameters:\n",
            *_parameter("seed", 1, "Of the random stalls"),
            *_parameter("stalls", 40, "Percent of the cycles in which a stream stalls, 0 to 99"),
        ]
    return "".join(text)


def _fileset(name: str, files: Iterable[str], *depends: str) -> Iterator[str]:
    yield f"  {name}:\n    file_type: vhdlSource-2008\n"
    if depends:
        yield "    depend:\n"
        yield from (f'      - "{each}"\n' for each in depends)
    yield "    files:\n"
    yield from (f"      - {file}\n" for file in files)


def _parameter(name: str, default: int, description: str) -> Iterator[str]:
    yield f"  {name}:\n    datatype: int\n    default: {default}\n    paramtype: generic\n"
    yield f"    description: {description}\n"


def _vivado_script(manifest: Manifest) -> str:
    """Write the Tcl that reads a design into Vivado, without its benches."""
    section = manifest["vhdl"]
    others = [*section["common_files"], *(each["file"] for each in _shared(manifest))]
    common = "".join(f"  {file}\n" for file in others)
    own = "".join(f"  {file}\n" for file in _own(section["files"], section))
    return f"""\
# Read the converters of {_remark(manifest)} into Vivado:
#
#   source .../vivado.tcl
#
# In the order in which they compile, as VHDL-2008, into the library that is current. Test benches
# are left out.

set firm_hdl_folder [file dirname [file normalize [info script]]]

# The same in the folder of every type that needs them: a project has each of them once.
foreach firm_hdl_file {{
{common}}} {{
  if {{[llength [get_files -quiet "*/$firm_hdl_file"]] == 0}} {{
    read_vhdl -vhdl2008 [file join $firm_hdl_folder $firm_hdl_file]
  }}
}}

foreach firm_hdl_file {{
{own}}} {{
  read_vhdl -vhdl2008 [file join $firm_hdl_folder $firm_hdl_file]
}}
"""


def makefile(manifest: Manifest) -> str:
    """Write the makefile that runs the benches in GHDL."""
    bench = manifest["vhdl"]["bench"]
    return f"""\
# Test benches of {_remark(manifest)} in GHDL.
#
#   make                        run all benches
#   make SEED=7 STALLS=0        with other stalls
#   make lint                   analyse with GHDL's warnings as errors
#   make clean

SEED   ?= 1
STALLS ?= 40
# Its command; if not given, the script finds one.
GHDL   ?=

BENCHES := {" ".join(bench["entities"])}
FILES   := $(shell cat files.txt bench_files.txt)
FOUND    = $(firstword $(foreach name,ghdl ghdl-mcode ghdl-llvm ghdl-gcc,\\
  $(shell command -v $(name))))
STRICT  := --warn-error --warn-unused --warn-body

.PHONY: all lint clean $(BENCHES)

all: $(BENCHES)

# One after the other: they share a folder.
.NOTPARALLEL:

$(BENCHES):
	@BENCH=$@ GHDL='$(GHDL)' sh ./{bench["script"]} -gseed=$(SEED) -gstalls=$(STALLS)

lint:
	@rm -rf work/lint && mkdir -p work/lint
	'$(or $(GHDL),$(FOUND),ghdl)' -a --std=08 --workdir=work/lint $(STRICT) $(FILES)

clean:
	rm -rf work
"""


def _vunit_script(manifest: Manifest) -> str:
    """Write the script that runs the benches by VUnit."""
    section = manifest["vhdl"]
    files = [*section["files"], *section["bench"]["files"], f"tb_{section['name']}_vunit.vhd"]
    listed = "".join(f'    "{file}",\n' for file in files)
    return f'''\
"""Test benches of {_remark(manifest)}, run by VUnit 4 (pip install vunit_hdl)."""

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


def _vunit_bench(manifest: Manifest) -> str:
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
