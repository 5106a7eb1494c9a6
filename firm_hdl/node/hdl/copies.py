"""The files of an accelerator in the folder of a built node."""

from __future__ import annotations

import posixpath
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import Any

from firm_hdl.node.hdl.accelerator import HdlAccelerator

__all__ = ["AcceleratorFiles", "accelerator_files"]

_TYPES = {
    "vhdl": "vhdlSource-2008",
    "verilog": "verilogSource-2005",
    "systemverilog": "systemVerilogSource",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class AcceleratorFiles:
    """Files of a user's, as they are in the folder of a node.

    Attributes
    ----------
    language, entity : str
        Empty if the accelerator is in Amaranth, or if there is none.
    texts : mapping of str to str
        Texts by path in the folder, in compile order.
    headers : mapping of str to str
        Files that those of Verilog include.
    """

    language: str = ""
    entity: str = ""
    texts: Mapping[str, str] = field(default_factory=dict)
    headers: Mapping[str, str] = field(default_factory=dict)

    def facts(self) -> dict[str, Any] | None:
        """Describe the files for the manifest."""
        if not self.language:
            return None
        return {"language": self.language, "entity": self.entity, "files": list(self.texts)}

    def core(self, core: Mapping[str, Any]) -> dict[str, Any]:
        """Add the files to each target of a core of FuseSoC.

        A bench is left out if its simulator does not read the language of the accelerator.
        """
        found: dict[str, Any] = dict(core)
        if not self.language:
            return found
        files: list[Any] = list(self.texts)
        files += [{header: {"is_include_file": True}} for header in self.headers]
        found["filesets"]["accelerator"] = {"files": files, "file_type": _TYPES[self.language]}
        found["targets"].pop("sim_verilog" if self.language == "vhdl" else "sim", None)
        for name, target in found["targets"].items():
            found["targets"][name] = {**target, "filesets": ["accelerator", *target["filesets"]]}
        return found


def accelerator_files(accelerator: Any) -> AcceleratorFiles:
    """Return the files of an accelerator; none of one in Amaranth."""
    if not isinstance(accelerator, HdlAccelerator):
        return AcceleratorFiles()
    language = accelerator.hdl.language
    folder = "vhdl/accelerator" if language == "vhdl" else "accelerator"

    def named(texts: Mapping[str, str]) -> dict[str, str]:
        found: dict[str, str] = {}
        for number, (file, text) in enumerate(texts.items()):
            name = PurePath(file).name
            path = posixpath.join(folder, name)
            found[path if path not in found else f"{folder}/{number}_{name}"] = text
        return found

    return AcceleratorFiles(
        language=language,
        entity=accelerator.hdl.entity,
        texts=named(accelerator.sources),
        headers=named(accelerator.headers),
    )
