"""The folders that come with the project: `templates`, `targets`, `examples`.

In a checkout they stand at its top; a wheel carries them inside the package.
"""

from __future__ import annotations

from pathlib import Path

_HERE = Path(__file__).parent


def folder(name: str) -> Path:
    """The folder called `name`, wherever this installation has it."""
    carried = _HERE / "_data" / name
    return carried if carried.is_dir() else _HERE.parents[1] / name
