"""Cores of FuseSoC: one for a type, one for each package that several types share.

FuseSoC's CAPI2 format is YAML after a first line ``CAPI=2:``.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import yaml

from firm_hdl.export.packaging.facts import (
    Manifest,
    own_files,
    remark,
    shared_packages,
    version,
)

__all__ = ["cores"]

_COMMON = "firm_hdl_common"
"""The core with the packages that all types share."""

_BENCH = "firm_hdl_bench"
"""The core with the parts of test benches that all types share."""

_SHARED = "that all converters of firm-hdl share"


def cores(manifest: Manifest) -> dict[str, str]:
    """Return the texts of all cores by file name."""
    vhdl = manifest["vhdl"]
    documents = {
        _COMMON: _shared(
            _common(manifest), f"Packages {_SHARED}", _vhdl_files(vhdl["common_files"])
        ),
        _BENCH: _shared(
            _bench(manifest),
            f"Parts of the test benches {_SHARED}",
            _vhdl_files(vhdl["bench"]["common_files"]),
        ),
        **{each["name"]: _package(manifest, each) for each in shared_packages(manifest)},
        str(vhdl["name"]): _type(manifest),
    }
    return {f"{name}.core": _text(document) for name, document in documents.items()}


def _text(document: Manifest) -> str:
    return "CAPI=2:\n" + yaml.safe_dump(document, sort_keys=False, width=1000, allow_unicode=True)


def _common(manifest: Manifest) -> str:
    kind = "flat" if manifest["vhdl"]["ports"] == "flat" else "common"
    return f"firm-hdl:vhdl:{kind}:{version(manifest)}"


def _bench(manifest: Manifest) -> str:
    return f"firm-hdl:vhdl:bench:{version(manifest)}"


def _package_name(manifest: Manifest, name: str) -> str:
    """Name the core of a shared package, with the distribution, because types may differ."""
    [package] = [each for each in shared_packages(manifest) if each["name"] == name]
    library = manifest["inputs"]["distro"] if package["message"] else "vhdl"
    return f"firm-hdl:{library}:{name}:{version(manifest)}"


def _shared(name: str, description: str, files: dict[str, Any]) -> dict[str, Any]:
    return {
        "name": name,
        "description": description,
        "filesets": {"all": files},
        "targets": {"default": {"filesets": ["all"]}},
    }


def _package(manifest: Manifest, package: Manifest) -> dict[str, Any]:
    """Describe a package that the folders of several messages have."""
    what = f"Records of {package['message']}" if package["message"] else "Streams of one bus width"
    depends = [_common(manifest), *(_package_name(manifest, name) for name in package["needs"])]
    return _shared(
        _package_name(manifest, package["name"]),
        f"{what}, which all converters of firm-hdl share",
        _vhdl_files([package["file"]], depends),
    )


def _vhdl_files(files: Iterable[str], depends: Iterable[str] = ()) -> dict[str, Any]:
    needed = list(depends)
    return {
        "file_type": "vhdlSource-2008",
        **({"depend": needed} if needed else {}),
        "files": list(files),
    }


def _type(manifest: Manifest) -> dict[str, Any]:
    """Describe a type's converters: target `sim` runs the test bench in GHDL."""
    section = manifest["vhdl"]
    bench, stimuli = section["bench"], section["bench"]["stimuli"]
    needed = [_package_name(manifest, each["name"]) for each in shared_packages(manifest)]
    document: dict[str, Any] = {
        "name": f"firm-hdl:{manifest['inputs']['distro']}:{section['name']}:{version(manifest)}",
        "description": f"Converters of {remark(manifest)}",
        "filesets": {
            "rtl": _vhdl_files(own_files(section["files"], section), [_common(manifest), *needed]),
            "bench": _vhdl_files(own_files(bench["files"], bench), [_bench(manifest)]),
        },
        "targets": {"default": {"filesets": ["rtl"]}},
    }
    if stimuli is not None:
        # FuseSoC copies the packets to the folder of the simulation, where the bench reads them.
        copied = {stimuli: {"file_type": "user", "copyto": stimuli}}
        document["filesets"]["stimuli"] = {"files": [copied]}
        document["targets"] |= {
            "sim" if entity == bench["entity"] else "sim_record": _simulation(entity)
            for entity in bench["entities"]
        }
        document["parameters"] = {
            "seed": _generic(1, "Seed of the random stalls"),
            "stalls": _generic(40, "Percent of the cycles in which a stream stalls, 0 to 99"),
        }
    return document


def _simulation(entity: str) -> dict[str, Any]:
    return {
        "description": f"Run {entity} in GHDL",
        "default_tool": "ghdl",
        "filesets": ["rtl", "bench", "stimuli"],
        "toplevel": entity,
        "parameters": ["seed", "stalls"],
        "tools": {"ghdl": {"run_options": ["--ieee-asserts=disable-at-0"]}},
    }


def _generic(default: int, description: str) -> dict[str, Any]:
    return {
        "datatype": "int",
        "default": default,
        "paramtype": "generic",
        "description": description,
    }
