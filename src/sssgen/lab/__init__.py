"""Measuring techniques: reference, error, cost, charts of them, and the choice of one."""
