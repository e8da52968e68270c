"""Scenes with physical data: media, bodies and the points that a view shows."""
