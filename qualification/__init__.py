"""Measurements that prove the project; only its tests and documents need them."""
