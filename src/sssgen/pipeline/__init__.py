"""From a checked material or plain GLSL to emitted text: the order of the passes, and the caches around it."""
