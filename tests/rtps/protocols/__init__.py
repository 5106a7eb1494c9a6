"""Readers, writers and discovery alone: what they do with each message."""
