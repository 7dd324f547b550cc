"""The instrument as a network, its files, and the one step by which it moves."""
