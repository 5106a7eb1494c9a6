"""The map from lines to tests: it is traced and stored, and selects the tests of a mutant."""
