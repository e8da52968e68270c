"""Says at the end of a run what has been tried; FUZZ_COUNTS names a file that keeps it."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest

from amounts import COUNTED
from sssgen.support import cache


@pytest.fixture(autouse=True)
def _nothing_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """No cache on disk: each file is another, and is read once."""
    monkeypatch.setattr(cache, "folder", lambda: "")


def pytest_terminal_summary(terminalreporter: Any) -> None:
    if COUNTED:
        told = ", ".join(f"{count} × {what}" for what, count in sorted(COUNTED.items()))
        terminalreporter.write_line(f"fuzzed: {told}")
    if name := os.environ.get("FUZZ_COUNTS"):
        Path(name).write_text(json.dumps(COUNTED), encoding="utf-8")
