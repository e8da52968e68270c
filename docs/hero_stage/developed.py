"""From linear light to a picture: exposure, the glare of a lens, a film curve of the techniques, sRGB.

Both pictures of a hero are developed alike.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter

from hero_stage.assets import BUILD
from hero_stage.hero import Camera
from sssgen.cli.main import main as sssgen
from sssgen.scene.pictures.images import encode_srgb
from sssgen.support.paths import PACKAGE

_SPREADS = (0.004, 0.016, 0.06)
"""The widths of the glare, relative to the height of the picture."""


def develop(linear: np.ndarray, camera: Camera) -> Image.Image:
    """The picture, 8 bits with a dither that hides the steps of slow gradients."""
    height = len(linear)
    spread = sum(gaussian_filter(linear, (width * height, width * height, 0.0)) for width in _SPREADS) / len(_SPREADS)
    light = np.maximum((1.0 - camera.glare) * linear + camera.glare * spread, 0.0)
    shown = _curve(camera.curve)(light.reshape(-1, 3).T.astype(np.float64), camera.exposure).T.reshape(light.shape)
    grey = (shown @ [0.2126, 0.7152, 0.0722])[..., None]
    encoded = encode_srgb(np.clip(grey + camera.saturation * (shown - grey), 0.0, 1.0))
    dither = np.random.default_rng(0).triangular(-1.0, 0.0, 1.0, (*encoded.shape[:2], 1))
    return Image.fromarray(np.clip(np.rint(255.0 * encoded + 0.5 * dither), 0, 255).astype(np.uint8))


@cache
def _curve(name: str) -> Any:
    """A tone mapping technique as a function of colours (3, n) and the exposure."""
    file, functions = BUILD / f"{name}.py", {}
    if sssgen(["transpile", f"{PACKAGE}/techniques/tone_mapping/{name}.sss", "--target", "numpy", "-o", str(file)]):
        raise SystemExit(f"the curve {name} was not translated")
    exec(file.read_text("utf-8"), functions)
    return functions[name]
