"""Reference solutions: light transport, exact lengths inside bodies, true refraction."""
