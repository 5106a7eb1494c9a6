"""Tests of the participant: bytes, endpoints in a simulated network, sockets."""
