"""All definitions of a run: a library for our reader, and files in a folder for oracles."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from firm_hdl.errors import DefinitionError, Diagnostic, Source
from firm_hdl.frontend import DISTROS, Library, show
from firm_hdl.frontend.names import KINDS, Kind
from firm_hdl.frontend.search import environment_origins
from firm_hdl.frontend.sources import (
    EmbeddedOrigin,
    FolderOrigin,
    Language,
    Origin,
    Sources,
)
from firm_hdl.model import Dialect, Interface

__all__ = ["DefinitionCase", "Universe", "write_definitions"]


@dataclass(frozen=True, slots=True, kw_only=True)
class DefinitionCase:
    """One definition to judge."""

    dialect: Dialect
    package: str
    kind: Kind  # The kind of interface that is defined, and the name of the folder of the file.
    name: str
    language: Language  # The language of the definition, and the suffix of the file's name.
    text: str  # The whole text, with its own line ends.
    # The name of the file, or of a text that comes with firm-hdl.
    source: str = field(default="", compare=False)

    @property
    def full_name(self) -> str:
        """Name of the type. In ROS 1, it does not contain the kind."""
        middle = f"{self.kind}/" if self.dialect == "ros2" else ""
        return f"{self.package}/{middle}{self.name}"

    @property
    def spelled_name(self) -> str:
        """Name of the type in the form that the command accepts for any dialect and kind."""
        return f"{self.package}/{self.kind}/{self.name}"

    @property
    def file(self) -> str:
        """Name of the file."""
        return f"{self.name}.{self.language}"


class Universe:
    """The definitions of a distribution and of some folders.

    * `paths`, `depends`: as for `open_library`. The folders that the environment names are
      searched, too.
    * `folder`: the folder for the files of `write_definitions`, ``PACKAGE/msg|srv|action/FILE``.
    """

    def __init__(
        self,
        distro: str,
        paths: Sequence[str] = (),
        folder: str = "",
        *,
        depends: Sequence[str] = (),
    ) -> None:
        self._folders = [FolderOrigin(path) for path in paths]
        needed = map(FolderOrigin, depends)
        environment = environment_origins(DISTROS[distro].dialect, os.environ)
        self.origins: list[Origin] = [*self._folders, *needed, *environment, EmbeddedOrigin(distro)]
        self._sources = Sources(self.origins)
        self.library = Library(distro, origins=self.origins)
        self.distro = distro
        self.folder = folder

    @property
    def dialect(self) -> Dialect:
        """The dialect whose rules the definitions follow."""
        return self.library.dialect

    def select(self, types: Iterable[str]) -> list[DefinitionCase]:
        """List the definitions of some types.

        If no type is named, these are all definitions in `paths`. Without `paths`, these are all
        definitions of the universe.

        Raises `DefinitionError` if a type does not exist.
        """
        wanted = list(types)
        if wanted:
            return [self._selected(name) for name in wanted]
        names = Sources(self._folders).names if self._folders else self._sources.names
        return [self._case(*name) for name in sorted(names)]

    def _selected(self, name: str) -> DefinitionCase:
        kinds = KINDS
        match name.split("/"):
            case [package, base]:
                pass
            case [package, "msg" | "srv" | "action" as kind, base]:
                kinds = (kind,)
            case _:
                package = base = ""
        for kind in kinds:
            if (package, kind, base) in self._sources.names:
                return self._case(package, kind, base)
        self.library.source(name)  # Raises an error that says what is wrong with the name.
        message = f"'{name}' has no definition of its own"
        raise DefinitionError([Diagnostic(message=message)])

    def message_case(self, package: str, name: str) -> DefinitionCase | None:
        """Return the definition of a message; `None` if there is none."""
        if (package, "msg", name) not in self._sources.names:
            return None
        return self._case(package, "msg", name)

    @cached_property
    def by_source(self) -> dict[str, DefinitionCase]:
        """Every definition by the name of its source, which may be a file."""
        found = {}
        for name in sorted(self._sources.names):
            # A definition that cannot be read is an error only if it is tested.
            with suppress(DefinitionError):
                case = self._case(*name)
                found[case.source] = case
        return found

    def _case(self, package: str, kind: Kind, name: str) -> DefinitionCase:
        try:
            found = self._sources.find(package, kind, name)
            assert found is not None
            source, language = found.source, found.language
        except DefinitionError as error:
            # The file is not valid text. Oracles have to refuse it, too.
            source = _source_of(error)
            language = "idl" if source.name.endswith(".idl") else kind
        return DefinitionCase(
            source=source.name,
            dialect=self.dialect,
            package=package,
            kind=kind,
            name=name,
            language=language,
            text=source.text,
        )

    def interface(self, case: DefinitionCase) -> Interface:
        """Read a definition as users do.

        Raises `DefinitionError` if the definition, or one that it depends on, is refused.
        """
        return self.library.interface(case.spelled_name)

    def show(self, case: DefinitionCase) -> str:
        """Return a definition as ``firm-hdl show`` prints it."""
        return show(self.library, case.spelled_name)


def write_definitions(universe: Universe) -> None:
    """Put all definitions into the folder of a universe: files as links, other texts as files."""
    folders: dict[tuple[str, str], list[DefinitionCase]] = {}
    for case in universe.by_source.values():
        folders.setdefault((case.package, case.kind), []).append(case)
    for (package, kind), found in folders.items():
        folder = os.path.join(universe.folder, package, kind)
        os.makedirs(os.path.dirname(folder), exist_ok=True)
        origins = {os.path.dirname(case.source) for case in found}
        if len(origins) == 1 and all(os.path.isfile(case.source) for case in found):
            # In the usual case, one link to the folder saves thousands of links to files.
            os.symlink(os.path.abspath(origins.pop()), folder)
            continue
        os.makedirs(folder)
        for case in found:
            file = os.path.join(folder, case.file)
            if os.path.isfile(case.source):
                os.symlink(os.path.abspath(case.source), file)
            else:
                Path(file).write_bytes(case.text.encode())


def _source_of(error: DefinitionError) -> Source:
    span = error.diagnostics[0].span
    if span is None:
        raise error
    return span.source
