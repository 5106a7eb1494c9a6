"""Tools beside the tests, for those who work on the program."""
