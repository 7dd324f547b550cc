"""The command line: one verb a file, found by its name."""
