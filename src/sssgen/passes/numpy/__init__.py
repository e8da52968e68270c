"""If-conversion for the NumPy target: control flow that differs between lanes becomes masks."""
