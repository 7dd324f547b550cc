"""Bags: recordings written, read, recovered, exported and imported; topics ↔ channels."""
