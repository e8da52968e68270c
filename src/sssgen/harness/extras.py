"""Packages that only some commands need: imported where they are used, so that a missing one can say how to get it."""

from __future__ import annotations

import importlib
from typing import Any

from sssgen.diagnostics import failure


def need(module: str, package: str = "", extra: str = "render") -> Any:
    """The module of that name; `package` is what it is installed as, `extra` the extra of sssgen's that brings it.

    Raises SssgenError where it is missing.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        message = f"the package '{package or module}' is missing: {error}"
        raise failure(message, f"pip install 'sssgen[{extra}]'") from None
