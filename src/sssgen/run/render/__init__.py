"""Draws whole emitted shaders: the values that a shell sets, on each back end."""
