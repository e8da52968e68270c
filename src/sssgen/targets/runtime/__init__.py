"""The parts of `sssgen.targets.numpy_runtime`, which Python printed from a shader imports."""
