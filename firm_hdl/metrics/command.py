"""The output of the command ``metrics``."""

from __future__ import annotations

from collections.abc import Iterable

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from firm_hdl.identity.command import load_interfaces
from firm_hdl.metrics.analysis import Analyses, Metrics
from firm_hdl.metrics.report import report
from firm_hdl.model import WIRE_OF, Interface
from firm_hdl.wire import Wire

__all__ = ["metrics_text"]


def metrics_text(
    library: Library,
    names: Iterable[str],
    form: str,
    wire: Wire | None,
) -> tuple[str, DefinitionError | None]:
    """Write the figures of types. A service or an action gives the figures of its messages.

    Parameters
    ----------
    library : Library
    names : iterable of str
    form : str
        A key of `FORMATS`.
    wire : "ros1", "cdr" or None
        `None`: the wire format of the library's dialect.

    Returns
    -------
    tuple of str and DefinitionError or None
        The text, and the errors of the types that are not in it.
    """
    analyses = Analyses(wire or WIRE_OF[library.dialect])
    rows: dict[str, Metrics] = {}

    def on_loaded(interface: Interface) -> None:
        for message in interface.messages:
            if message.name not in rows:
                rows[message.name] = analyses.metrics(message)

    wrong = None
    try:
        load_interfaces(library, names, on_loaded=on_loaded)
    except DefinitionError as error:
        wrong = error
    return report(rows.values(), form), wrong
