"""What heroes take from a package: pictures of surroundings (npm @pmndrs/assets, CC0), which are never committed."""

from __future__ import annotations

import base64
import re
import subprocess
from pathlib import Path

import numpy as np
import numpy.typing as npt

BUILD = Path(__file__).parents[2] / "build" / "heroes"
PICTURES = "@pmndrs/assets@1.7.0"


def surroundings(name: str) -> npt.NDArray[np.float32]:
    """A picture of surroundings, (height, width, 3), in linear RGB; row 0 is above."""
    import OpenEXR

    package = BUILD / "assets" / "node_modules" / "@pmndrs" / "assets"
    if not package.is_dir():
        subprocess.run(
            ["npm", "install", "--prefix", BUILD / "assets", "--no-audit", "--no-fund", PICTURES], check=True
        )
    text = (package / "hdri" / f"{name}.exr.js").read_text("utf-8")
    match = re.search(r"base64,([A-Za-z0-9+/=]+)", text)
    assert match, name
    file = BUILD / "assets" / f"{name}.exr"
    file.write_bytes(base64.b64decode(match[1]))
    with OpenEXR.File(str(file)) as picture:
        channels = picture.channels()
        planes = [channels["RGB"].pixels] if "RGB" in channels else [channels[part].pixels for part in "RGB"]
    return np.dstack(planes).astype(np.float32)
