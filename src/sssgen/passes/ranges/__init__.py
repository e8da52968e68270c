"""The value-range analysis: which values each expression can have."""
