"""A participant of DDS in gateware (DDSI-RTPS 2.5): the node is in the graph of ROS 2 by itself.

Its announcements are bytes that :mod:`firm_hdl.rtps` writes when the node is made
(:mod:`.templates`). In the circuit, datagrams go one way:

    datagrams_in --> PacketFifo --> MessageReader --> payload --> gates of the topics
                                        | events
                                        v
    datagrams_out <-- Transmitter <-- Engine <-- packets of publications and services
"""

__all__ = []
