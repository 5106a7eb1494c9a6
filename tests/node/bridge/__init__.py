"""Tests of the bridge, its boards and its graphs."""
