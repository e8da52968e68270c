"""Runs the cases of WebGL's conformance tests: pictures are drawn, all other programs are translated and compiled."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np

from qualification.suites.outcomes import FRONT, SKIPPED, Outcome, Result
from qualification.suites.picture_outcomes import Drawn, colors, outcomes
from qualification.suites.pictures import Mesh, PictureProgram
from qualification.suites.text_cases import run_case as run_text
from qualification.suites.webgl_cases import PictureCase, WebglCase
from sssgen.run.backends import Array

_ATTRIBUTE = re.compile(r"\b(?:attribute|in)\s+(?:(?:lowp|mediump|highp)\s+)?\w+\s+(\w+)\s*;")
_SIZE = (32, 32)
_OGLES_SIZE = (64, 64)
EDGES = 0.02
"""The share of the pixels that may differ: where rounding decides which side of an edge a pixel is on"""
_DEPTHS = {"near": 0.0, "far": 1.0, "diff": 1.0}
"""Of the viewport"""
_DEPTH = -2.0
"""Where the models of ogles are in front of the eye"""


def run_cases(cases: Sequence[WebglCase]) -> list[Result]:
    """The results of cases, in their order."""
    return [run_picture(case) if isinstance(case, PictureCase) else run_text(case) for case in cases]


def run_picture(case: PictureCase) -> Result:
    """The result of a case with a picture."""
    skipped = case.skipped or ("the host turns front faces" if case.model == "frontbacksquare" else "")
    if skipped:
        return Result(case.name, "skipped", {FRONT: Outcome(SKIPPED, skipped)})
    size, mesh = _SIZE, quad(case.programs[0][0])
    if case.model:
        size, mesh = _OGLES_SIZE, model(case.model, _OGLES_SIZE[0] // 4)
    uniforms = {name: np.array(values) for name, values in case.uniforms.items()}
    if case.model:
        uniforms |= {"gtf_ModelViewProjectionMatrix": perspective(60.0, 1.0, 30.0)}
        uniforms |= {f"gl_DepthRange.{name}": np.array(value) for name, value in _DEPTHS.items()}
        uniforms |= {f"viewport{side}": np.array(float(_OGLES_SIZE[0])) for side in ("width", "height")}
    programs = [PictureProgram(vertex, fragment, size, mesh, uniforms) for vertex, fragment in case.programs]
    return Result(case.name, "pictures", outcomes(programs, lambda drawn, expected: wrong(case, drawn, expected)))


def wrong(case: PictureCase, drawn: Drawn, expected: Drawn | None) -> str:
    """What is wrong with the pictures of a case; '' where nothing is. The driver draws the reference, where it can."""
    pictures = [colors(picture) for picture in drawn.pictures]
    if case.color:
        apart = np.abs(pictures[0] - np.array(case.color)).max(axis=-1)
    else:
        reference = colors(expected.pictures[0]) if expected is not None else pictures[0]
        apart = np.max([np.abs(picture - reference)[..., :3].max(axis=-1) for picture in pictures], axis=0)
    count = int((apart > case.tolerance).sum())
    share = 0.0 if case.color else EDGES
    return f"{count} of {apart.size} pixels are up to {apart.max()} apart" if count > share * apart.size else ""


def quad(vertex: str) -> Mesh:
    """The quad of GLSLConformanceTester; an attribute of another name than its own is the position, too."""
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]], np.float32)
    positions = np.concatenate([corners, np.array([[0.0, 1.0]] * 4, np.float32)], axis=1)
    names = [name for name in _ATTRIBUTE.findall(vertex) if name != "texCoord0"]
    attributes = {**dict.fromkeys(names, positions), "texCoord0": (corners + 1.0) / 2.0}
    return Mesh(attributes, np.array([[0, 1, 2], [1, 3, 2]]))


def model(name: str, half: int) -> Mesh:
    """A square of ogles, or its grid of twice `half` squares along a side."""
    if name == "square":
        places = [[1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [-1.0, 1.0]]
        corners = [[0.5, 1.0, 0.0], [0.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.5, 0.0, 1.0]]
        return _model(np.array(places), np.array(corners), np.array([[0, 1, 2], [2, 1, 3]]))
    y, x = np.mgrid[-half : half + 1, -half : half + 1] / half
    x, y = x.ravel(), y.ravel()
    shades = np.stack([1.0 - (x + y + 2.0) / 4.0, (x + 1.0) / 2.0, (y + 1.0) / 2.0], axis=-1)
    count = 2 * half + 1
    first = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).reshape(-1, 1)
    triangles = np.concatenate([first + np.array(each) for each in ([0, 1, count + 1], [count + 1, count, 0])])
    return _model(np.stack([x, y], axis=-1), shades, triangles)


def _model(places: Array, shades: Array, triangles: Array) -> Mesh:
    """A model at its place before the eye, with the attributes that the suite's shaders read."""
    depths = np.full((len(places), 1), _DEPTH)
    attributes = {
        "gtf_Vertex": np.concatenate([places, depths, depths * 0.0 + 1.0], axis=1),
        "gtf_Color": np.concatenate([shades, depths * 0.0 + 1.0], axis=1),
        "gtf_Normal": np.concatenate([shades, depths * 0.0 + 1.0], axis=1),
        "gtf_MultiTexCoord0": np.concatenate([(places + 1.0) / 2.0, depths * 0.0, depths * 0.0 + 1.0], axis=1),
    }
    return Mesh({name: values.astype(np.float32) for name, values in attributes.items()}, triangles)


def perspective(angle: float, near: float, far: float) -> Array:
    """The matrix, column by column, of an eye that sees this angle in degrees."""
    scale, depth = 1.0 / math.tan(math.radians(angle) / 2.0), far - near
    columns = np.zeros((4, 4))
    columns[0, 0] = columns[1, 1] = scale
    columns[2, 2:] = -(far + near) / depth, -1.0
    columns[3, 2] = -2.0 * far * near / depth
    return columns
