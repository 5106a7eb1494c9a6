"""The front end: from the text of definitions to syntax, and from syntax to the model.

The names that most parts of firm-hdl need are exported here. A `Library` gives the models of
messages, services and actions, in every definition language and from every origin.
"""

from __future__ import annotations

from firm_hdl.frontend.embedded import DEFAULT_DISTRO, DISTROS, Distro
from firm_hdl.frontend.library import Library, load_message
from firm_hdl.frontend.recordings import RecordingOrigin
from firm_hdl.frontend.search import all_names, load_all, open_library
from firm_hdl.frontend.show import show

__all__ = [
    "DEFAULT_DISTRO",
    "DISTROS",
    "Distro",
    "Library",
    "RecordingOrigin",
    "all_names",
    "load_all",
    "load_message",
    "open_library",
    "show",
]
