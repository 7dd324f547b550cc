"""Simulate, estimate and diagnose tendon-driven surgical instruments."""

__version__ = '0.1.0'
