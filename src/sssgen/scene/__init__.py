"""What a render shows: scenes in TOML, cameras, geometry that rays meet on the CPU, pictures, and measured scenes."""
