"""Charts of error against cost, and the choice of a chain."""
