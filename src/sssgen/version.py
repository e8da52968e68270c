"""The version, in one place."""

VERSION = "0.1.0"
"""The version of the package; see CHANGELOG.md."""
