"""Bakes what techniques sample: distance textures, thickness maps, depth maps, cells and normals."""
