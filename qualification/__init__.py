"""What proves the project: measurements and demonstrations that only its tests and its documents need."""
