"""The media that `sssgen import` writes for glTF's volumes, against the definitions of the extensions.

For 200 seeded points of colour, distance and anisotropy a glTF file is written, imported, and the medium is read back
from the scene's TOML. iadpython computes what a slab of it, one world unit thick with a matched boundary, reflects and
transmits of light along the normal. The other side takes the numbers of the glTF file through the equations of the
extensions, without any code of the import, and solves the radiative transfer by the doubling method below.
"""

from __future__ import annotations

import json
import tempfile
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.interchange import format_readers
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.material_writer import write_import

Array = npt.NDArray[np.float64]

POINTS, SEED = 200, 18
STREAMS, DOUBLINGS = 16, 20
PARALLEL = 16
"""Quadrature points of iadpython; with more it loses energy."""


def points(count: int = POINTS, seed: int = SEED) -> list[dict[str, Any]]:
    """The points: alternately of both drafts of scattering."""
    rng = np.random.default_rng(seed)
    return [
        {
            "draft": ("volume_scatter", "scatter")[index % 2],
            "color": rng.uniform(0.02, 0.98, 3).round(4).tolist(),
            "strength": round(float(rng.uniform(0.2, 1.0)), 4),
            "attenuation": rng.uniform(0.05, 0.95, 3).round(4).tolist(),
            "distance": round(float(np.exp(rng.uniform(np.log(0.05), np.log(5.0)))), 4),
            "anisotropy": round(float(rng.uniform(-0.9, 0.9)), 4),
        }
        for index in range(count)
    ]


def asset(point: dict[str, Any]) -> dict[str, Any]:
    """The glTF file of a point."""
    if point["draft"] == "scatter":
        scatter = {"scatterStrengthFactor": point["strength"], "multiscatterColorFactor": point["color"]}
    else:
        scatter = {"multiscatterColor": point["color"]}
    volume = {
        "thicknessFactor": 1.0, "attenuationColor": point["attenuation"], "attenuationDistance": point["distance"],
    }  # fmt: skip
    extensions = {
        "KHR_materials_transmission": {"transmissionFactor": 1.0},
        "KHR_materials_volume": volume,
        f"KHR_materials_{point['draft']}": {**scatter, "scatterAnisotropy": point["anisotropy"]},
    }
    return {"asset": {"version": "2.0"}, "materials": [{"name": "slab", "extensions": extensions}]}


def imported(point: dict[str, Any], folder: Path) -> tuple[Array, Array, float]:
    """The extinction, the albedo and the anisotropy that the import writes for a point."""
    file = folder / "slab.gltf"
    file.write_text(json.dumps(asset(point)), encoding="utf-8")
    report = Report("slab")
    (written,) = write_import(str(folder / "out"), format_readers.read(str(file), report), report, force=True)
    text = (folder / "out" / written.scene).read_text(encoding="utf-8")
    medium, unit = tomllib.loads(text)["medium"], float(text.split("A world unit is ")[1].split(" m.")[0])
    absorption, scattering = (np.array(medium[key]) / unit for key in ("absorption", "scattering"))
    return absorption + scattering, scattering / (absorption + scattering), medium["anisotropy"]


def defined(point: dict[str, Any]) -> tuple[Array, Array, float]:
    """The same by the equations of the extensions."""
    extinction = np.log(1.0 / np.array(point["attenuation"])) / point["distance"]
    scale = point["strength"] if point["draft"] == "scatter" else 1.0
    c = scale * np.array(point["color"])
    s = 4.09712 + 4.20863 * c - np.sqrt(9.59217 + 41.6808 * c + 17.7126 * c**2)
    g = point["anisotropy"]
    albedo = (1.0 - s**2) / (1.0 - g * s**2) if point["draft"] == "scatter" else 1.0 - s**2
    return extinction, albedo, g


def doubled(albedo: float, depth: float, anisotropy: float) -> tuple[float, float]:
    """What a slab reflects and transmits of light along the normal: van de Hulst's doubling, with delta-M scaling.

    The angles are a Radau quadrature over the cosines 0 to 1 that contains the normal; the thinnest layer has single
    scattering only.
    """
    from scipy.special import eval_legendre, roots_jacobi

    inner, weights = roots_jacobi(STREAMS - 1, 1.0, 0.0)
    cosines = 0.5 * (1.0 + np.append(inner, 1.0))
    weights = 0.5 * np.append(weights / (1.0 - inner), 2.0 / STREAMS**2)
    order = np.arange(2 * STREAMS)
    forward = anisotropy ** (2 * STREAMS)
    moments = (anisotropy**order - forward) / (1.0 - forward)
    depth *= 1.0 - albedo * forward
    albedo *= (1.0 - forward) / (1.0 - albedo * forward)
    legendre = eval_legendre(order[:, None], cosines[None])
    signs = (-1.0) ** order
    same = np.einsum("l,li,lj->ij", (2 * order + 1) * moments, legendre, legendre)
    other = np.einsum("l,li,lj->ij", (2 * order + 1) * moments * signs, legendre, legendre)
    thin = depth / 2.0**DOUBLINGS
    scattered = 0.5 * albedo * thin * weights[None] / cosines[:, None]
    unit = np.eye(STREAMS)
    back, through = scattered * other, unit * (1.0 - thin / cosines) + scattered * same
    for _ in range(DOUBLINGS):
        between = through @ np.linalg.inv(unit - back @ back)
        back, through = back + between @ back @ through, between @ through
    beam = np.zeros(STREAMS)
    beam[-1] = 1.0 / (weights[-1] * cosines[-1])
    flux = weights * cosines
    return float(flux @ back @ beam), float(flux @ through @ beam)


def run_slabs(count: int = POINTS) -> dict[str, float]:
    """The largest and the mean difference of reflectance and transmittance, as shares of the incident light."""
    import iadpython

    differences, relative, naive = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for index, point in enumerate(points(count)):
            channel = index % 3
            extinction, albedo, g = (np.atleast_1d(part) for part in imported(point, Path(folder)))
            slab = iadpython.Sample(a=albedo[channel], b=extinction[channel], g=g[0], n=1.0, quad_pts=PARALLEL)
            written = np.array([float(part) for part in slab.rt()[:2]])
            extinction, albedo, g = (np.atleast_1d(part) for part in defined(point))
            expected = np.array(doubled(albedo[channel], extinction[channel], g[0]))
            confused = np.array(doubled(point["color"][channel], extinction[channel], g[0]))
            differences.append(np.abs(written - expected))
            relative.append(np.where(expected > 0.01, np.abs(written / np.maximum(expected, 0.01) - 1.0), 0.0))
            naive.append(np.abs(confused - expected))
    return {
        "points": count,
        "largest difference of reflectance": float(np.max(differences, axis=0)[0]),
        "largest difference of transmittance": float(np.max(differences, axis=0)[1]),
        "largest relative difference, of values above 0.01": float(np.max(relative)),
        "mean difference": float(np.mean(differences)),
        "largest difference if the colour were the albedo": float(np.max(naive)),
    }
