"""Client libraries under test: each is compared with the serializer that ROS itself uses."""

from __future__ import annotations

__all__ = []
