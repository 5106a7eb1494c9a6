"""Development tools besides the tests."""
