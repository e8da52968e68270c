"""Stress: techniques on dangerous, boundary and random inputs, on every back end, and what is wrong with the results.

`run.stress` does it, `report` tells it; `dangerous` has the table's rows, `judge` the rules.
"""
