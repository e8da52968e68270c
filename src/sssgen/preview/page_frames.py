"""The frames in which a page and this program send messages: JSON, and one of the page with the bytes of a file.

The server starts before the modules that make pictures are imported, so that this one imports none of them.
"""

from __future__ import annotations

import json
from typing import Any

MOST_BYTES = 64 << 20
"""The largest file that a page may send."""
MOST_TEXT = 1 << 20
"""The largest message besides its file."""


def unpack(frame: bytes) -> tuple[dict[str, Any], bytes]:
    """The message and the file in a binary frame: JSON in one line, then the bytes. Raises ValueError."""
    line, _, data = frame.partition(b"\n")
    return parse(line), data


def parse(text: str | bytes) -> dict[str, Any]:
    """The message in a JSON text. Raises ValueError."""
    if len(text) > MOST_TEXT:
        raise ValueError("too long")
    message = json.loads(text)
    if not isinstance(message, dict):
        raise ValueError("no object")
    return message
