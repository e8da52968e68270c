"""What a render shows: scenes in TOML, cameras, and geometry that rays meet on the CPU."""
