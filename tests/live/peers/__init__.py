"""What runs in environments of peers, and what those have."""
