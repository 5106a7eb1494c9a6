"""ROS's own Python modules, in processes of the Python that has them."""

from __future__ import annotations

__all__ = []
