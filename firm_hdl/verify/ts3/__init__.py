"""TS3: do the converters of a type agree with ROS's libraries on chosen and recorded messages?"""

__all__ = []
