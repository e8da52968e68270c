"""GPU times of emitted programs."""
