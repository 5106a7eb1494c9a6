"""Bytes of RTPS: datagrams, submessages, parameter lists, GUIDs and locators, as data."""

__all__ = []
