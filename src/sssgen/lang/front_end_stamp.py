"""The state of the front end's own sources: a cached result is valid only for the state that made it."""

from __future__ import annotations

import os

from sssgen.support import cache
from sssgen.support.paths import PACKAGE

_stamp = ""


def front_end_stamp() -> str:
    """Tells one state of the project's own sources from another, so that no stale result is used."""
    global _stamp
    if not _stamp:
        here = os.path.join(PACKAGE, "lang")
        _stamp = repr([cache.stamp(folder) for folder in (here, os.path.join(PACKAGE, "ir"))])
    return _stamp
