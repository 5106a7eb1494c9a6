"""The parts of a node, alone."""
