"""The error of a chain on a scene, and the fit of its parameters."""
