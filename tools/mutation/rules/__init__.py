"""Mutation rules: each yields the changes of one kind in a module or a grammar."""
