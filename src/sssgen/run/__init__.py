"""Compilers and drivers that this project did not write, and the commands that run emitted text in them."""
