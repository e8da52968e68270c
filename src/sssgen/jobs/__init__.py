"""Work items, which run in this process, in local processes, or on a cluster."""
