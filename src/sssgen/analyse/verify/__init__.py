"""`sssgen transpile --verify`: the transpiled functions against the source on random inputs."""
