"""Mutation score: faults injected one at a time, and which test system notices each.

``python -m tools.mutation`` changes one place of the program in a private copy of the repository,
runs tests there until one fails, and notes which. A mutant that no test notices is a survivor: it
needs a new test, or an explanation in ``survivors.yaml``.
"""
