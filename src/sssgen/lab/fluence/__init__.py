"""Fluence inside a body: traced for many light directions, factored into few volumes."""
