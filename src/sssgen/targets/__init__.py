"""Targets: descriptors, printers, layout, reflection, and putting a shader together."""
