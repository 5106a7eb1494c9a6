"""Libraries that read and write packets of ROS messages, behind one interface.

A library is a :class:`~firm_hdl.verify.references.client.Client`: rosbags, Cyclone DDS, mcap's ROS
packages, ROS's own genpy and Fast CDR, and our converters. Some of them are references: TS3
compares rosbags with them, and `firm_hdl.verify.clients` judges other libraries by them. rosbags is
also the oracle; see :mod:`firm_hdl.cases.oracle`.
"""

__all__ = []
