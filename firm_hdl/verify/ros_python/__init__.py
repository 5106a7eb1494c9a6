"""ROS's own Python modules, in processes of the Python that has them."""

__all__ = []
