"""Bakes textures for techniques: distance textures, thickness maps, depth maps, cells and normals."""
