"""`Library`: a set of definitions that gives the models of types."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable
from dataclasses import replace

from firm_hdl.errors import DefinitionError, Diagnostic, Source
from firm_hdl.frontend.embedded import DEFAULT_DISTRO, DISTROS
from firm_hdl.frontend.explain import clip
from firm_hdl.frontend.interfaces import Unit
from firm_hdl.frontend.names import (
    ACTION_SERVICES,
    ACTION_WRAPPERS,
    EVENT,
    KINDS,
    PARTS,
    Kind,
    TypeName,
    owners,
)
from firm_hdl.frontend.resolve import Resolver
from firm_hdl.frontend.sources import EmbeddedOrigin, FolderOrigin, Origin, Sources
from firm_hdl.frontend.spelling import spelled
from firm_hdl.frontend.suggest import did_you_mean, similar_types, unknown_type
from firm_hdl.model import Action, Dialect, Interface, Message, Service, closure

__all__ = ["Library", "load_message"]


class Library:
    """All messages, services and actions of a distribution and of some folders.

    Parameters
    ----------
    distro : str
        ROS distribution: a key of `DISTROS`. It decides the dialect and the embedded types.
    paths : iterable of str or path
        Folders with ROS packages, searched in this order and before anything else. As in ROS, the
        first copy of a package hides all others, also that of the distribution.
    origins : iterable of Origin or None
        Origins to search after the folders. By default, the distribution's own types.
    implied : iterable of Origin
        Origins to search last, whose types are not listed.

    Attributes
    ----------
    unusable : dict of str to str
        Types of recorded topics that cannot be used, with sentences that say why.

    Raises
    ------
    ValueError
        If the distribution is not known.
    DefinitionError
        If a path is not a folder. It has no span.
    """

    def __init__(
        self,
        distro: str = DEFAULT_DISTRO,
        paths: Iterable[str | os.PathLike[str]] = (),
        *,
        origins: Iterable[Origin] | None = None,
        implied: Iterable[Origin] = (),
    ) -> None:
        if distro not in DISTROS:
            raise ValueError(f"Distribution must be one of {', '.join(DISTROS)}, not {distro!r}")
        self._distro = distro
        others = [EmbeddedOrigin(distro)] if origins is None else origins
        self._sources = Sources([*_folders(paths), *others], implied)
        self.unusable: dict[str, str] = {}
        distribution = DISTROS[distro]
        self._resolver = Resolver(
            self._sources,
            self.dialect,
            has_events=distribution.has_events,
            wchar_bytes=distribution.wchar_bytes,
        )
        self._interfaces: dict[TypeName, Service | Action] = {}

    @property
    def distro(self) -> str:
        """Name of the distribution."""
        return self._distro

    @property
    def dialect(self) -> Dialect:
        """Dialect of the definitions."""
        return DISTROS[self._distro].dialect

    def names(self) -> list[str]:
        """List the full names of all message types that have a definition of their own, sorted."""
        found = (TypeName(p, k, n, self.dialect) for p, k, n in self._sources.names if k == "msg")
        return sorted(map(str, found))

    def interfaces(self) -> list[str]:
        """List the full names of all messages, services and actions with a definition, sorted.

        If two types of ROS 1 have the same name, the second is listed with its kind:
        ``package/srv/Name``.
        """
        return list(self.kinds())

    def kinds(self) -> dict[str, Kind]:
        """Return the kind of every type that `interfaces` lists, by its name and in that order."""
        names: dict[str, Kind] = {}
        order = {kind: index for index, kind in enumerate(KINDS)}
        for package, kind, name in sorted(self._sources.names, key=lambda n: order[n[1]]):
            short = str(TypeName(package, kind, name, self.dialect))
            names[short if short not in names else f"{package}/{kind}/{name}"] = kind
        return dict(sorted(names.items()))

    def problems(self) -> list[Diagnostic]:
        """List why types cannot be used although they are listed: two files have them."""
        return self._sources.problems

    def message(self, name: str) -> Message:
        """Give the model of a message.

        Parameters
        ----------
        name : str
            ``package/msg/Name`` or ``package/Name``, or another spelling of these that
            :func:`.spelled` knows. Messages of services and actions have names, too:
            ``package/srv/Name_Request``, and in ROS 1 ``package/NameRequest``.

        Raises
        ------
        DefinitionError
            With all errors of the definition and of its dependencies; without a span if no message
            has this name.
        """
        candidates = self._parse(name)
        for candidate in self._by_origin(candidates):
            message = self._resolver.resolve(candidate)
            if message is not None:
                return message
        for candidate in candidates:
            unit = self._resolver.unit(candidate)
            if unit is not None:
                what = "a service" if candidate.kind == "srv" else "an action"
                text = f"'{candidate}' is {what}, not a message"
                parts = [str(candidate)[: -len(candidate.name)] + part for part in unit.messages]
                raise DefinitionError.of(did_you_mean(text, parts))
        raise self._unknown(candidates)

    def interface(self, name: str) -> Interface:
        """Give the model of a message, a service or an action.

        Parameters
        ----------
        name : str
            ``package/kind/Name``, or ``package/Name``; also any name that `message` takes. In
            ROS 1, ``package/Name`` is the first of message, service and action of that name.

        Raises
        ------
        DefinitionError
            As by `message`; also if ``package/Name`` of ROS 2 can be several types.
        """
        candidates = self._unambiguous(name)
        for candidate in self._by_origin(candidates):
            unit = self._resolver.unit(candidate)
            if unit is not None and not unit.is_message:
                return self._assembled(candidate, unit)
            message = self._resolver.resolve(candidate)
            if message is not None:
                return message
        raise self._unknown(candidates)

    def source(self, name: str) -> Source:
        """Give the text that defines a type, which may be a service or an action."""
        return self._unit(name).source

    def is_idl(self, name: str) -> bool:
        """Tell whether a type is defined in OMG IDL."""
        return self._unit(name).language == "idl"

    def definition_hash(self, name: str | Interface) -> str:
        """Hash the texts of a type and of all types that it depends on.

        Parameters
        ----------
        name : str or Message or Service or Action
            As for `interface`, or what that returned.

        Returns
        -------
        str
            SHA-256 in hexadecimal. It does not depend on where the files are, nor on how their
            lines end.
        """
        roots = (self.interface(name) if isinstance(name, str) else name).messages
        digest = hashlib.sha256()
        given = {root.name for root in roots}
        # The builtin types of ROS 1 have neither a text nor a package.
        others = [each for each in closure(roots) if each.package and each.name not in given]
        for message in [*roots, *sorted(others, key=str)]:
            text = message.text.replace("\r\n", "\n").replace("\r", "\n")
            parts = [message.name, text]
            if "#include" in text:
                # A file without types is not hashed: hash the effect of its constants and typedefs.
                parts += [f"{item.type} {item.name} {item.default!r}" for item in message.fields]
                parts += [f"{c.type} {c.name} {c.value!r}" for c in message.constants]
            for part in parts:
                # With its length in front, a text cannot run into the next one.
                data = part.encode()
                digest.update(b"%d:" % len(data) + data)
        return digest.hexdigest()

    def _unit(self, name: str) -> Unit:
        candidates = self._unambiguous(name)
        for candidate in self._by_origin(candidates):
            unit = self._resolver.unit(candidate) or self._resolver.unit_of(candidate)
            if unit is not None:
                return unit
        raise self._unknown(candidates)

    def _assembled(self, name: TypeName, unit: Unit) -> Service | Action:
        if name not in self._interfaces:
            messages = self._messages_of(unit)
            self._interfaces[name] = (
                _service(unit, name.name, messages)
                if name.kind == "srv"
                else _action(unit, messages)
            )
        return self._interfaces[name]

    def _messages_of(self, unit: Unit) -> dict[str, Message]:
        """Resolve all messages of a service or an action, by their names without the package."""
        messages: dict[str, Message] = {}
        diagnostics = list(unit.diagnostics)
        for part in unit.messages:
            try:
                message = self._resolver.resolve(replace(unit.name, name=part))
            except DefinitionError as error:
                diagnostics += error.diagnostics
            else:
                assert message is not None
                messages[part] = message
        if diagnostics:
            raise DefinitionError(_in_order(unit, diagnostics))
        return messages

    def _parse(self, name: str) -> list[TypeName]:
        """List the types that a name can mean, the likeliest first."""
        if not isinstance(name, str):
            raise TypeError(f"Name of a type must be a string, not {name!r}")
        kinds: tuple[Kind, ...] = KINDS
        match spelled(name).split("/"):
            case [package, base] if package and base:
                return [TypeName(package, kind, base, self.dialect) for kind in kinds]
            case [package, "msg" | "srv" | "action" as kind, base] if package and base:
                return [TypeName(package, kind, base, self.dialect)]
            case [*parts, base]:
                package = parts[0] if parts else ""
        form = "package/msg/Name" if self.dialect == "ros2" else "package/Name"
        message = f"'{clip(name)}' is not the name of a type, which is '{form}'"
        similar = similar_types(self._sources, package, base)
        if not package and base in self._sources.types:
            message = f"'{clip(name)}' is a package, and not the name of a type, which is '{form}'"
            similar = [(base, *each) for each in self._sources.types[base]]
        raise DefinitionError.of(did_you_mean(message, self._spell(similar)))

    def _unambiguous(self, name: str) -> list[TypeName]:
        """List the types that a name can mean; in ROS 2, only one of them has a definition."""
        candidates = self._parse(name)
        defined = [n for n in candidates if (n.package, n.kind, n.name) in self._sources.names]
        if self.dialect == "ros2" and len(defined) > 1:
            choice = " or ".join(f"'{each}'" for each in defined)
            raise DefinitionError.of(f"'{clip(name)}' can be {choice}; name one of them")
        return candidates

    def _by_origin(self, names: list[TypeName]) -> list[TypeName]:
        """Sort names by the origin that defines them; drop those that no origin defines.

        For example, `TestGoal` may be a message of the distribution, and also a part of an action
        in a user's folder.
        """
        found: dict[TypeName, None] = {}
        asked = {other: name for name in names for other in (name, *owners(name))}
        for defined in self._sources.by_origin(asked):
            found[asked[defined]] = None
        return list(found)

    def _unknown(self, names: list[TypeName]) -> DefinitionError:
        for each in names:
            # There may be a reason: a recording has no definition, or a file's name is not legal.
            unit = self._resolver.unit(each)
            if unit is not None and unit.diagnostics:
                return DefinitionError(unit.diagnostics)
        name = names[0]
        message = unknown_type(self._sources, names)
        similar = similar_types(self._sources, name.package, name.name)
        if message.endswith("is not found") and not similar:
            message += "; --path names a folder that has it (in a node: 'paths')"
        return DefinitionError.of(did_you_mean(message, self._spell(similar)))

    def _spell(self, types: list[tuple[str, Kind, str]]) -> list[str]:
        return [str(TypeName(package, kind, name, self.dialect)) for package, kind, name in types]


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
        As for `Library`. To load more than one type, use a `Library`.
    """
    return Library(distro, paths).message(name)


def _folders(paths: Iterable[str | os.PathLike[str]]) -> list[FolderOrigin]:
    folders: list[FolderOrigin] = []
    wrong: list[Diagnostic] = []
    if isinstance(paths, str | os.PathLike):
        raise TypeError(f"paths= must be a list of folders, such as [{str(paths)!r}], not one")
    for path in paths:
        try:
            folders.append(FolderOrigin(path))
        except DefinitionError as error:
            wrong += error.diagnostics
    if wrong:
        raise DefinitionError(wrong)
    return folders


def _in_order(unit: Unit, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Sort by position in the file; diagnostics of other files come last."""

    def place(diagnostic: Diagnostic) -> tuple[bool, int]:
        span = diagnostic.span
        if span is None or span.source != unit.source:
            return True, 0
        return False, span.start

    return sorted(dict.fromkeys(diagnostics), key=place)


def _service(unit: Unit, base: str, messages: dict[str, Message]) -> Service:
    dialect = unit.name.dialect
    request, response = (messages[base + suffix] for suffix in PARTS[dialect, "srv"])
    package = str(unit.name)[: -len(unit.name.name)]
    is_whole = base == unit.name.name
    return Service(
        name=package + base,
        dialect=dialect,
        request=request,
        response=response,
        event=messages.get(base + EVENT),
        comment=request.comment if is_whole else "",
        text=unit.source.text if is_whole else "",
    )


def _action(unit: Unit, messages: dict[str, Message]) -> Action:
    base, dialect = unit.name.name, unit.name.dialect
    goal, result, feedback = (messages[base + suffix] for suffix in PARTS[dialect, "action"])
    services = ACTION_SERVICES if dialect == "ros2" else ()
    return Action(
        name=str(unit.name),
        dialect=dialect,
        goal=goal,
        result=result,
        feedback=feedback,
        services=tuple(_service(unit, base + suffix, messages) for suffix in services),
        wrappers=tuple(messages[base + suffix] for suffix in ACTION_WRAPPERS[dialect]),
        comment=goal.comment,
        text=unit.source.text,
    )
