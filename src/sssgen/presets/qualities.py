"""The qualities of ready materials; a module of its own, as `--help` reads it without optional packages."""

QUALITIES = {
    "fast": "lights alone: no pictures of the body, no bake",
    "good": "the body is drawn from its back and from the lights in each frame",
    "best": "the light inside is baked for the mesh, for all lights and surroundings",
}
