"""
The experiments of the paper that this package implements, each a function that returns its data.

"Dynamic Modeling of Coupled Tendon-Driven System for Surgical Robot Instrument". A module an
experiment; each result carries the :class:`~tendon_ros.model.paper.statement.Statement` tuple that
holds it against the paper's own numbers.
"""
