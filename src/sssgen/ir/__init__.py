"""The intermediate representation: types, nodes, their text form, a verifier, and the intrinsic table.

This package imports nothing else of the project; everything else is written in terms of it.
"""
