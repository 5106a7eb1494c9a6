"""Definitions in: text to syntax to model.

Everything that most parts of firm-hdl need is named here. A `Library` gives the models of messages,
services and actions, whatever they are written in and wherever their definitions come from.
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
