"""The media that `sssgen import` writes for OpenPBR and standard_surface, against the colours that they stand for.

For 200 seeded points of colour, mean free path and anisotropy a MaterialX document is written, imported, and the medium
is read back from the scene's TOML. iadpython then finds the medium whose thick body reflects exactly that colour of
diffuse light, with a matched boundary, and computes what slabs of both media, one metre thick, reflect and transmit.
For 200 more points of the transmission, Beer and Lambert's law is the other side.
"""

from __future__ import annotations

import tempfile
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from sssgen.interchange import format_readers
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.material_writer import write_import

POINTS, SEED = 200, 18
PARALLEL = 16
"""Quadrature points of iadpython; with more it loses energy."""
_SHADERS = {
    "open_pbr_surface": {
        "weight": "subsurface_weight", "radius": "subsurface_radius_scale", "scale": "subsurface_radius",
        "anisotropy": "subsurface_scatter_anisotropy", "transmission": "transmission_weight",
    },
    "standard_surface": {
        "weight": "subsurface", "radius": "subsurface_radius", "scale": "subsurface_scale",
        "anisotropy": "subsurface_anisotropy", "transmission": "transmission",
    },
}  # fmt: skip


def points(count: int = POINTS, seed: int = SEED) -> list[dict[str, Any]]:
    """The points: alternately of both shaders."""
    rng = np.random.default_rng(seed)
    return [
        {
            "shader": [*_SHADERS][index % 2],
            "color": rng.uniform(0.02, 0.98, 3).round(4).tolist(),
            "radius": rng.uniform(0.2, 1.0, 3).round(4).tolist(),
            "scale": round(float(np.exp(rng.uniform(np.log(0.1), np.log(3.0)))), 4),
            "anisotropy": round(float(rng.uniform(-0.9, 0.9)), 4),
        }
        for index in range(count)
    ]


def imported(folder: Path, shader: str, inputs: dict[str, Any]) -> tuple[np.ndarray, np.ndarray, float]:
    """Absorption and scattering per metre, and the anisotropy, that the import writes for a shader's inputs."""
    lines = [
        f'<input name="{name}" type="{"color3" if isinstance(value, list) else "float"}" '
        f'value="{str(value).strip("[]")}"/>'
        for name, value in inputs.items()
    ]
    file = folder / "slab.mtlx"
    content = f'<{shader} name="slab" type="surfaceshader">{"".join(lines)}</{shader}>'
    file.write_text(f'<materialx version="1.39">{content}</materialx>', encoding="utf-8")
    report = Report("slab")
    (written,) = write_import(str(folder / "out"), format_readers.read(str(file), report), report, force=True)
    text = (folder / "out" / written.scene).read_text(encoding="utf-8")
    medium, unit = tomllib.loads(text)["medium"], float(text.split("A world unit is ")[1].split(" m.")[0])
    return np.array(medium["absorption"]) / unit, np.array(medium["scattering"]) / unit, medium["anisotropy"]


def slab(albedo: float, depth: float, anisotropy: float) -> tuple[float, float, float, float]:
    """What a slab reflects and transmits of light along the normal, and of diffuse light."""
    import iadpython

    return tuple(map(float, iadpython.Sample(a=albedo, b=depth, g=anisotropy, n=1.0, quad_pts=PARALLEL).rt()))


def albedo_of(color: float, anisotropy: float) -> float:
    """The albedo of a thick body that reflects this share of diffuse light."""
    from scipy.optimize import brentq

    return float(brentq(lambda albedo: slab(albedo, np.inf, anisotropy)[2] - color, 0.0, 1.0 - 1e-9, xtol=1e-7))


def run_materialx(count: int = POINTS) -> dict[str, float]:
    """The largest and mean differences, as shares of the incident light."""
    shares, colors, normals, beer = [], [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for index, point in enumerate(points(count)):
            channel, names, place = index % 3, _SHADERS[point["shader"]], Path(folder)
            inputs = {
                names["weight"]: 1.0, "subsurface_color": point["color"], names["radius"]: point["radius"],
                names["scale"]: point["scale"], names["anisotropy"]: point["anisotropy"],
            }  # fmt: skip
            absorption, scattering, g = imported(place, point["shader"], inputs)
            extinction = (absorption + scattering)[channel]
            albedo, color = scattering[channel] / extinction, point["color"][channel]
            depth = 1.0 / (point["radius"][channel] * point["scale"])
            written = slab(albedo, extinction, g)
            expected = slab(albedo_of(color, point["anisotropy"]), depth, point["anisotropy"])
            shares.append(np.abs(np.subtract(written, expected)))
            thick = slab(albedo, np.inf, g)
            colors.append(abs(thick[2] - color))
            normals.append(abs(thick[0] - color))
            inputs = {names["transmission"]: 1.0, "transmission_color": point["color"], "transmission_depth": depth}
            absorption, _, _ = imported(place, point["shader"], inputs)
            beer.append(abs(np.exp(-absorption[channel]) - color ** (1.0 / depth)))
    largest = np.max(shares, axis=0)
    return {
        "points": count,
        "largest difference of reflectance, light along the normal": largest[0],
        "largest difference of transmittance, light along the normal": largest[1],
        "largest difference of reflectance, diffuse light": largest[2],
        "largest difference of transmittance, diffuse light": largest[3],
        "mean difference": float(np.mean(shares)),
        "largest difference of a thick body's colour, diffuse light": max(colors),
        "largest difference of a thick body's colour, light along the normal": max(normals),
        "mean difference of a thick body's colour, light along the normal": float(np.mean(normals)),
        "largest difference of the transmittance of clear bodies": max(beer),
    }
