"""Techniques evaluated on arrays of inputs, and their deviation from the float64 oracle."""
