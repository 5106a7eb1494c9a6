"""The files of an accelerator in the folder of a built node."""

from __future__ import annotations

import os
import posixpath
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from firm_hdl.node.hdl.accelerator import HdlAccelerator
from firm_hdl.node.hdl.sources import text_of

__all__ = ["AcceleratorFiles", "accelerator_files"]

_INCLUDE = re.compile(r'`include\s+"([^"\n]+)"')

_TYPES = {
    "vhdl": "vhdlSource-2008",
    "verilog": "verilogSource-2005",
    "systemverilog": "systemVerilogSource",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class AcceleratorFiles:
    """Files of a user's, as they are in the folder of a node."""

    # Empty if the accelerator is in Amaranth, or if there is none.
    language: str = ""
    entity: str = ""
    # The entity with plain ports around one with records; empty if there is none.
    wrapper: str = ""
    # Texts by path in the folder, in compile order. Bytes that are not UTF-8 are surrogates.
    texts: Mapping[str, str] = field(default_factory=dict)
    # Texts of files that those of Verilog include.
    headers: Mapping[str, str] = field(default_factory=dict)
    # The folder that an included file is named from, by the path of the file.
    folders: Mapping[str, str] = field(default_factory=dict)

    @property
    def verilog_tool(self) -> str:
        """What runs a bench in Verilog: Icarus Verilog has no structs in packages."""
        return "verilator" if self.wrapper and self.language != "vhdl" else "iverilog"

    def facts(self) -> dict[str, Any] | None:
        """Describe the files for the manifest."""
        if not self.language:
            return None
        ports = {"ports": "records", "wrapper": self.wrapper} if self.wrapper else {}
        files = list(self.texts)
        return {"language": self.language, "entity": self.entity, **ports, "files": files}

    def core(self, core: Mapping[str, Any]) -> dict[str, Any]:
        """Add the files to each target of a core of FuseSoC.

        A bench is left out if its simulator does not read the language of the accelerator.
        """
        found: dict[str, Any] = dict(core)
        if not self.language:
            return found
        files: list[Any] = list(self.texts)
        for header, folder in self.folders.items():
            options: dict[str, Any] = {"is_include_file": True}
            if folder != posixpath.dirname(header):
                options["include_path"] = folder
            files.append({header: options})
        found["filesets"]["accelerator"] = {"files": files, "file_type": _TYPES[self.language]}
        found["targets"].pop("sim_verilog" if self.language == "vhdl" else "sim", None)
        if self.verilog_tool == "verilator":
            found["targets"].pop("sim_verilog", None)
        for name, target in found["targets"].items():
            found["targets"][name] = {**target, "filesets": ["accelerator", *target["filesets"]]}
        return found


def accelerator_files(accelerator: Any) -> AcceleratorFiles:
    """Return the files of an accelerator; none of one in Amaranth.

    Files keep their places towards each other, because those of Verilog include others by them.

    Raises `DefinitionError` if a file of Verilog includes another by an absolute path.
    """
    if not isinstance(accelerator, HdlAccelerator):
        return AcceleratorFiles()
    language = accelerator.hdl.language
    own = accelerator.sources
    sources = {path: own.files[file] for path, file in own.names.items()}
    headers = accelerator.headers
    base = os.path.commonpath([os.path.dirname(path) for path in (*sources, *headers)])
    top = "vhdl/accelerator" if language == "vhdl" else "accelerator"

    def place(path: str) -> str:
        return posixpath.normpath(posixpath.join(top, os.path.relpath(path, base)))

    def texts(files: Mapping[str, bytes]) -> dict[str, str]:
        return {
            place(path): data.decode("utf-8", "surrogateescape") for path, data in files.items()
        }

    included = {
        name
        for data in ({**sources, **headers}.values() if headers else ())
        for name in _INCLUDE.findall(text_of(data))
    }
    folders = dict.fromkeys(os.path.dirname(path) for path in sources)
    found: dict[str, str] = {}
    for header in headers:
        if any(os.path.isabs(name) and os.path.normpath(name) == header for name in included):
            message = f"a file includes '{header}' by an absolute path, which a copy does not have"
            raise own.refused(message)
        nearest = [
            folder
            for folder in folders
            if any(os.path.normpath(os.path.join(folder, name)) == header for name in included)
        ]
        # A name made by a macro is not among the names.
        found[place(header)] = place(nearest[0] if nearest else os.path.dirname(header))
    generated = accelerator.generated
    around = "vhdl" if language == "vhdl" else "systemverilog"
    before, after = (
        {f"{around}/{file}": text for file, text in files.items()}
        for files in (generated.packages, generated.wrapper)
    )
    return AcceleratorFiles(
        language=language,
        entity=accelerator.hdl.entity,
        wrapper=generated.entity,
        texts={**before, **texts(sources), **after},
        headers=texts(headers),
        folders=found,
    )
