"""Stress: techniques on dangerous, boundary and random inputs, on every back end, and the faults of the results.

`stress_run.stress` runs it, `stress_report` formats the results; `dangerous_inputs` has the rows of the table,
`result_checks` the rules.
"""
