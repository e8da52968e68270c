"""Checks a syntax tree and builds its IR."""
