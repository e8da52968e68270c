"""Khronos' validator of glTF files."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

from folders import ROOT
from sssgen.interchange.gltf_container import open_file
from sssgen.run.machine_parts import node_modules

VALIDATOR = node_modules() / "gltf-validator"


def validate(path: Path) -> None:
    """Runs Khronos' validator, where it is installed, and requires that it finds neither errors nor other warnings."""
    open_file(str(path))
    if not VALIDATOR.is_dir():
        if os.environ.get("CI"):
            pytest.fail("gltf-validator is missing: make setup")
        pytest.skip("gltf-validator is missing: make setup")
    script = ROOT / "tests" / "tools" / "gltf_validator.mjs"
    environment = {**os.environ, "NODE_PATH": str(VALIDATOR.parent)}
    done = subprocess.run(
        ["node", str(script), str(path)], capture_output=True, text=True, check=False, env=environment
    )
    assert done.returncode == 0, done.stderr
    issues = json.loads(done.stdout)
    # drafts are not known to it; engines compute tangents themselves
    ignored = {"UNSUPPORTED_EXTENSION", "UNUSED_OBJECT", "MESH_PRIMITIVE_GENERATED_TANGENT_SPACE"}
    serious = [each for each in issues["messages"] if each["severity"] <= 1 and each["code"] not in ignored]
    assert not serious, serious
