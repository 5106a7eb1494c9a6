"""TS3: do the converters of a type do as ROS's libraries, with chosen and recorded messages?"""

__all__ = []
