"""Passes for whole shaders: inputs, outputs and variables of the module."""
