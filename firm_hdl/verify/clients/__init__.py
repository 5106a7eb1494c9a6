"""Client libraries under test: each is compared with the serializer that ROS itself uses."""

__all__ = []
