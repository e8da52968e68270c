"""Work items and where they run: this process, local processes, or a cluster."""
