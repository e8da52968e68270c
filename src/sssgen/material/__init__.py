"""Materials, the technique library, and how a chain of techniques is put together."""
