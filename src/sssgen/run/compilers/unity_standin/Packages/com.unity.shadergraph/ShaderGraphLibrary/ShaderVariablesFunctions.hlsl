// Stand-in (see the README above): nothing that a node's function needs.
