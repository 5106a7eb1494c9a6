"""The front end's face: a set of definitions that can be asked for types."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable

from firm_hdl.errors import DefinitionError, Diagnostic, Source
from firm_hdl.frontend.embedded import DEFAULT_DISTRO, DISTROS
from firm_hdl.frontend.explain import clip
from firm_hdl.frontend.resolve import Resolver, TypeName
from firm_hdl.frontend.sources import Sources
from firm_hdl.frontend.suggest import did_you_mean, similar_types, unknown_type
from firm_hdl.model import Dialect, Message

__all__ = ["Library", "load_message"]


class Library:
    """All message types of a distribution and of some folders.

    Parameters
    ----------
    distro : str
        ROS distribution: a key of `DISTROS`. It decides the dialect, and which types are there
        without any folder.
    paths : iterable of str or path
        Folders with ROS packages, searched in this order and before the distribution's own types.

    Raises
    ------
    ValueError
        If the distribution is not known.
    DefinitionError
        If a path is not a folder. It has no span.
    """

    def __init__(
        self, distro: str = DEFAULT_DISTRO, paths: Iterable[str | os.PathLike[str]] = ()
    ) -> None:
        if distro not in DISTROS:
            raise ValueError(f"Distribution must be one of {', '.join(DISTROS)}, not {distro!r}")
        self._distro = distro
        self._sources = Sources(distro, paths)
        self._resolver = Resolver(self._sources, self.dialect)

    @property
    def distro(self) -> str:
        """Name of the distribution."""
        return self._distro

    @property
    def dialect(self) -> Dialect:
        """Whose rules the definitions follow."""
        return DISTROS[self._distro].dialect

    def names(self) -> list[str]:
        """List the full names of all types, sorted."""
        types = self._sources.types.items()
        return sorted(
            str(TypeName(package, name, self.dialect)) for package, names in types for name in names
        )

    def message(self, name: str) -> Message:
        """Give the model of a type.

        Parameters
        ----------
        name : str
            ``package/msg/Name`` or ``package/Name``.

        Raises
        ------
        DefinitionError
            With all that is wrong with the definition and with those that it depends on; without
            a span, if `name` means no type.
        """
        parsed = self._parse(name)
        message = self._resolver.resolve(parsed)
        if message is None:
            raise self._unknown(parsed)
        return message

    def source(self, name: str) -> Source:
        """Give the text that defines a type. Its name is parsed as by `message`."""
        parsed = self._parse(name)
        source = self._sources.find(parsed.package, parsed.name)
        if source is None:
            raise self._unknown(parsed)
        return source

    def definition_hash(self, name: str) -> str:
        """Digest a type's text and those of all types that it depends on.

        Returns
        -------
        str
            SHA-256 in hexadecimal. It does not depend on where the files are, nor on how their
            lines end.
        """
        root = self.message(name)
        found = {root.name: root}
        pending = [root]
        while pending:
            for child in pending.pop().children:
                # The builtin types of ROS 1 have neither a text nor a package.
                if child.package and child.name not in found:
                    found[child.name] = child
                    pending.append(child)
        digest = hashlib.sha256()
        for message in [root, *sorted((m for m in found.values() if m is not root), key=str)]:
            text = message.text.replace("\r\n", "\n").replace("\r", "\n")
            for part in (message.name, text):
                # The length in front keeps neighbours apart.
                data = part.encode()
                digest.update(b"%d:" % len(data) + data)
        return digest.hexdigest()

    def _parse(self, name: str) -> TypeName:
        match name.split("/"):
            case [package, base] | [package, "msg", base] if package and base:
                return TypeName(package, base, self.dialect)
        form = "package/msg/Name" if self.dialect == "ros2" else "package/Name"
        message = f"'{clip(name)}' is not the name of a message type, which is '{form}'"
        raise self._error(message, similar_types(self._sources, "", name.rpartition("/")[2]))

    def _unknown(self, name: TypeName) -> DefinitionError:
        message = unknown_type(self._sources, name.package, name.name)
        return self._error(message, similar_types(self._sources, name.package, name.name))

    def _error(self, message: str, similar: list[tuple[str, str]]) -> DefinitionError:
        names = [str(TypeName(package, name, self.dialect)) for package, name in similar]
        return DefinitionError([Diagnostic(message=did_you_mean(message, names))])


def load_message(
    name: str,
    *,
    distro: str = DEFAULT_DISTRO,
    paths: Iterable[str | os.PathLike[str]] = (),
) -> Message:
    """Give the model of one message type.

    Parameters
    ----------
    name : str
        ``package/msg/Name`` or ``package/Name``.
    distro, paths
        As for `Library`, which is the thing to use for more than one type.
    """
    return Library(distro, paths).message(name)
