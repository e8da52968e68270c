"""Measures techniques: references, errors, costs, charts, and the choice of a chain."""
