"""The targets of other packages: the entry-point group `sssgen.targets`."""

from __future__ import annotations

import contextlib
import functools
import os
import sys
from typing import Any

from sssgen.support.diagnostics import SssgenError, failure


@functools.cache
def entries() -> dict[str, Any]:
    """The entry points by the names of their targets. `importlib.metadata` takes longer to import than a shader takes
    to emit, so it is used only where some installed package mentions the group."""
    if not any(_mentions_targets(root or ".") for root in sys.path):
        return {}
    from importlib.metadata import entry_points

    return {entry.name: entry for entry in entry_points(group="sssgen.targets")}


def load(name: str) -> Any:
    """What an entry point gives: a `Target`, or the path of a descriptor. Raises SssgenError for whatever goes wrong in
    the plug-in."""
    entry = entries()[name]
    try:
        loaded = entry.load()
        loaded = loaded() if callable(loaded) else loaded
        return loaded if hasattr(loaded, "_fields") else os.fspath(loaded)
    except SssgenError:
        raise
    except Exception as error:  # the plug-in's code may fail in any way
        message = f"the plug-in of target '{name}' cannot be loaded: {type(error).__name__}: {error}"
        raise failure(message, f"its entry point is {entry.value}") from None


def _mentions_targets(root: str) -> bool:
    """Whether a package installed in this folder has an entry point of the group."""
    try:
        folders = [entry.path for entry in os.scandir(root) if entry.name.endswith("-info")]
    except OSError:
        return False
    for folder in folders:
        with contextlib.suppress(OSError), open(f"{folder}/entry_points.txt", "rb") as file:
            if b"[sssgen.targets]" in file.read():
                return True
    return False
