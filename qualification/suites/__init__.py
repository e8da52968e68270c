"""Shader suites that other people wrote, run on every back end: docs/suites.md."""
