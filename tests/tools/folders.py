"""The folders that tests read."""

from __future__ import annotations

from pathlib import Path

TESTS = Path(__file__).parents[1]
ROOT = TESTS.parent
DOCS = ROOT / "docs"
EXAMPLES = ROOT / "examples"
MESHES = ROOT.parent / "shared" / "data" / "meshes"
SNAPSHOTS = TESTS / "snapshots"
UNITY_SAMPLES = TESTS / "run" / "unity_samples"
