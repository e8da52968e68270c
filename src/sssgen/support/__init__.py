"""Used by every other package: errors with source positions, files, caches, TOML and JSON with positions."""
