"""Targets: descriptors, printers, uniform layout, reflection, and the assembly of a shader from its parts."""
