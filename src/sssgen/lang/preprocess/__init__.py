"""The preprocessor of GLSL."""
