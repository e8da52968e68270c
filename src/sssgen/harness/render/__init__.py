"""Whole emitted shaders drawn: what a shell gives them, on each back end."""
