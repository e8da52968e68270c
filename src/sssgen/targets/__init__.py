"""Targets: descriptors, uniform layout, reflection, the assembly of a shader from its parts; printers and runtime."""
