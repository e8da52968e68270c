"""Rewrites a module until the target can express every node."""
