"""Bytes of RTPS: datagrams, submessages, parameter lists, GUIDs and locators, as data."""

__all__: list[str] = []
