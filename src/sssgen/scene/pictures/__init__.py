"""Picture and volume files as arrays, and the difference of two pictures."""
