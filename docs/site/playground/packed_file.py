"""Files that the page unpacks itself: small on every host, also on one that compresses nothing."""

from __future__ import annotations

import gzip
from pathlib import Path


def write_packed(path: Path, data: bytes) -> None:
    """Writes PATH.gz."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.with_name(f"{path.name}.gz").write_bytes(gzip.compress(data, 9, mtime=0))
