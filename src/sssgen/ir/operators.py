"""The operators' precedence, shared by the parser and the printers (GLSL ES 3.00, section 5.1; HLSL's is the same)."""

PRECEDENCE = {
    "*": 10, "/": 10, "%": 10, "+": 9, "-": 9, "<<": 8, ">>": 8, "<": 7, ">": 7, "<=": 7, ">=": 7,
    "==": 6, "!=": 6, "&": 5, "^": 4, "|": 3, "&&": 2, "^^": 1, "||": 0,
}  # fmt: skip
"""The higher binds tighter; all are left-associative."""
