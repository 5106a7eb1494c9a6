"""Definitions in: text to syntax to model.

Everything that other parts of firm-hdl may use is named here. ``.msg`` files of ROS 1 and ROS 2 are
read; services, actions and IDL are to join them behind the same `Library`.
"""

from __future__ import annotations

from firm_hdl.frontend.embedded import DEFAULT_DISTRO, DISTROS, Distro
from firm_hdl.frontend.library import Library, load_message
from firm_hdl.frontend.show import show

__all__ = ["DEFAULT_DISTRO", "DISTROS", "Distro", "Library", "load_message", "show"]
