"""Tone mapping: values computed by hand, what the publications state, and the implementation of three.js."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from oracle import Array, close, rng, technique
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.support.paths import folder
from sssgen.targets.runtime.numpy_values import precision

CURVES = ("reinhard", "aces", "agx", "khronos_neutral")
CHUNK = "node_modules/three/src/renderers/shaders/ShaderChunk/tonemapping_pars_fragment.glsl.js"


def mapped(name: str, color: Any, exposure: float = 1.0) -> Array:
    result: Array = technique(name)(color=np.asarray(color, np.float64), exposure=exposure)
    return result


def test_reinhard() -> None:
    close(mapped("reinhard", [0.18, 1.0, 3.0]), [0.18 / 1.18, 0.5, 0.75])


def test_aces_on_greys() -> None:
    """The rows of both matrices add up to 1, so that the curve of a grey is that of a number: here for .18."""
    above = 0.18 * 0.2045786 - 0.000090537
    below = 0.18 * (0.983729 * 0.18 + 0.4329510) + 0.238081
    close(mapped("aces", [0.18] * 3), above / below, rtol=3e-5)
    close(above / below, 0.10559, atol=1e-5)
    close(mapped("aces", [60000.0] * 3), 1.0)


def test_agx_on_greys() -> None:
    """10 stops below middle grey is black and 6.5 above is white; middle grey is half of the display's code."""
    half = mapped("agx", [0.18] * 3) ** (1.0 / 2.2)
    close(half, 0.5, atol=5e-3)
    close(mapped("agx", [0.18 * 2.0**-10.0] * 3), 0.0, atol=1e-4)
    assert (mapped("agx", [0.18 * 2.0**6.5] * 3) > 0.97).all()


def test_khronos_neutral_keeps_base_colours_under_a_white_highlight() -> None:
    """The specification: base + .04 becomes base where no channel exceeds .8; white of 1.04 becomes .88 by hand."""
    base = np.array([[0.5, 0.3, 0.1], [0.76, 0.04, 0.4], [0.2, 0.2, 0.2]])
    close(mapped("khronos_neutral", base + 0.04), base, atol=1e-12)
    close(mapped("khronos_neutral", [1.04, 1.04, 1.04]), 0.88)
    close(mapped("khronos_neutral", [0.06, 0.06, 0.06]), 6.25 * 0.06**2)  # below .08 the offset is smaller
    # (2, .5, .04) above the offset: peak 2, compressed 1 - .0576 / 1.48, whitened by 1 - 1 / (1 + .15 (2 - q))
    q = 1.0 - 0.0576 / 1.48
    share = 1.0 - 1.0 / (0.15 * (2.0 - q) + 1.0)
    close(mapped("khronos_neutral", [2.04, 0.54, 0.08]), np.array([q, 0.25 * q, 0.02 * q]) * (1.0 - share) + q * share)


@pytest.mark.parametrize("name", CURVES)
def test_a_curve_stays_in_range_and_rises(name: str) -> None:
    greys = np.geomspace(1e-5, 1e6, 400)[:, None] * np.ones(3)
    shown = mapped(name, greys)
    assert shown.min() >= 0.0 and shown.max() <= 1.0 and shown[-1].min() > 0.95
    assert (np.diff(shown[:, 0]) > -2e-4).all()  # the polynomial of AgX falls by that much at its ends
    many = mapped(name, 10.0 ** rng().uniform(-4.0, 5.0, (500, 3)))
    assert many.min() >= 0.0 and many.max() <= 1.0


@pytest.mark.parametrize("name", CURVES)
def test_the_exposure_is_a_factor_of_the_light(name: str) -> None:
    color = rng().uniform(0.0, 4.0, (50, 3))
    close(mapped(name, color, 2.5), mapped(name, 2.5 * color), atol=1e-12)


def three(function: str, colors: Array, exposure: float = 1.0) -> Array:
    """The results of a tone mapping function in the sources of three.js, which npm installs."""
    path = folder("build") / "node" / CHUNK
    if not path.is_file():
        pytest.skip("the sources of three.js are missing: run make setup")
    text = path.read_text(encoding="utf-8").partition("`")[2].rpartition("`")[0]
    compiled = transpile(load_glsl_text(text, "three.glsl").module, "numpy", "three")
    names: dict[str, Any] = {}
    exec(compiled.files["three_functions.py"], names)
    with precision(np.float64):
        result: Array = names[function](colors.T.astype(np.float64), np.float64(exposure))
    return result.T


def test_curves_are_those_of_three_js() -> None:
    colors = 10.0 ** rng().uniform(-3.0, 2.0, (2000, 3))
    close(mapped("reinhard", colors), three("ReinhardToneMapping", colors), atol=1e-9)
    close(mapped("khronos_neutral", colors), three("NeutralToneMapping", colors), atol=1e-9)
    close(mapped("aces", colors, 1.0 / 0.6), three("ACESFilmicToneMapping", colors), atol=1e-9)
    # its AgX has the primaries of Rec. 2020, so that greys agree and saturated colours do not
    greys = colors[:, :1] * np.ones(3)
    close(mapped("agx", greys), three("AgXToneMapping", greys), atol=2e-3)


def test_the_matrices_of_agx_are_inverse() -> None:
    text = technique("agx")
    assert text.types.keys() == {"color", "exposure"}
    inset = [[0.842479062253094, 0.0784335999999992, 0.0792237451477643],
             [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
             [0.0423756549057051, 0.0784336, 0.879142973793104]]  # fmt: skip
    # a colour whose stops are all in the middle of the curve: the curve is nearly a line there, and the hue is kept
    red = np.array([0.30, 0.20, 0.20])
    shown = mapped("agx", red) ** (1.0 / 2.2)
    stops = (np.log2(np.array(inset) @ red) + 12.47393) / 16.5
    curve = np.polyval([15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232], stops)
    close(np.array(inset) @ shown, curve, atol=1e-7)
