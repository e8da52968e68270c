"""Puts the bundle of the preview's libraries into the wheel and the source distribution, where `make setup` made it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

FILES = ("library.js", "three.LICENSE")


class PreviewBundle(BuildHookInterface):  # type: ignore[type-arg, misc]  # hatchling has no types
    """Without the bundle the build goes on: `sssgen preview` then says what to install."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        folder = "build/preview" if self.target_name == "sdist" else "sssgen/_data/preview"
        if version == "editable":  # it finds the bundle in build/
            return
        files = [name for name in FILES if Path(self.root, "build", "preview", name).is_file()]
        if len(files) < len(FILES):
            self.app.display_warning("without the bundle of `sssgen preview`, which needs npm: make setup")
            return
        for name in FILES:
            build_data["force_include"][str(Path(self.root, "build", "preview", name))] = f"{folder}/{name}"
