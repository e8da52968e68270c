"""Fixtures for random inputs."""

from __future__ import annotations

import pytest

from sssgen.support import cache


@pytest.fixture(autouse=True)
def _empty_store(monkeypatch: pytest.MonkeyPatch) -> None:
    """No cache on disk: each file is another, and is read once."""
    monkeypatch.setattr(cache, "folder", lambda: "")
