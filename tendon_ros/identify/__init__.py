"""Rollouts along measured motion, residuals, fits with their intervals, and excitation."""
