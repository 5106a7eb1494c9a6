"""Damaged datagrams through a participant in gateware, among good ones."""
