"""Tests with real peers: ROS 2 and Cyclone DDS, in a network of their own."""
