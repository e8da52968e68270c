"""Packages that only renders need: imported where they are used, so that a missing one can say how to get it."""

from __future__ import annotations

import importlib
from typing import Any

from sssgen.diagnostics import failure


def need(module: str, package: str = "") -> Any:
    """The module of that name; `package` is what it is installed as. Raises SssgenError where it is missing."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        message = f"the package '{package or module}' is missing: {error}"
        raise failure(message, "pip install 'sssgen[render]'") from None
