"""The kernel measured: speed against others, error against a reference; ``python -m bench``."""
