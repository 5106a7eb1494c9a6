"""Libraries that read and write packets of ROS messages, behind one interface.

A library is a :class:`~firm_hdl.verify.references.client.Client`: rosbags, Cyclone DDS, mcap's ROS
packages, ROS's own genpy and Fast CDR, and our converters. They are references of TS3 and of each
other; `firm_hdl.verify.clients` has them under test. rosbags is also the oracle, see `oracle`.
"""

__all__ = []
