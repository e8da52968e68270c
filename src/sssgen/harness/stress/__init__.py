"""Stress: techniques on dangerous, boundary and random inputs, on every back end, and the faults of the results.

`run.stress` does it, `report` tells it; `dangerous` has the table's rows, `judge` the rules.
"""
