"""The suites, and where their owners publish them; nothing of them is in this repository."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple, Protocol

from qualification.suites import (
    amber_cases,
    deqp_cases,
    piglit_shaders,
    piglit_vectors,
    reference_pages,
    sample_cases,
    text_folders,
    webgl_cases,
)
from qualification.suites.machines import SECONDS


class Case(Protocol):
    """A case of a suite; it can be pickled."""

    @property
    def name(self) -> str: ...


class Suite(NamedTuple):
    """A suite of one repository."""

    repository: str
    commit: str
    """The commit that docs/suites.md was measured with"""
    folders: tuple[str, ...]
    """What is read of it, below the folder of the repository"""
    license: str
    cases: Callable[[Path], Iterator[Case]]
    """The cases of the repository in a folder"""
    runner: str
    """`module:function`, which makes a list of Results of a sequence of cases"""
    about: str = ""
    """What a case is, and when it is right"""


def deqp(*folders: str) -> Callable[[Path], Iterator[deqp_cases.Case]]:
    """A reader of the shader cases in these folders of VK-GL-CTS."""

    def cases(root: Path) -> Iterator[deqp_cases.Case]:
        for folder in folders:
            for path in sorted((root / folder).rglob("*.test")):
                if not path.name.startswith("Coverage"):  # in a format of its own
                    parts = path.relative_to(root).with_suffix("").parts
                    yield from deqp_cases.read(path, "/".join(part for part in parts if part not in _PLACES))

    return cases


def amber(root: Path) -> Iterator[amber_cases.Case]:
    """The GraphicsFuzz cases of VK-GL-CTS."""
    yield from map(amber_cases.read, sorted((root / _AMBER).glob("*.amber")))


_PLACES = ("data", "external", "openglcts", "shaders", "vulkancts")
"""Folders that are not part of a case's name."""
_GL_CTS = "external/openglcts/data/gl_cts/data"
_VULKAN_GLSL = "external/vulkancts/data/vulkan/glsl/es310"
_AMBER = "external/vulkancts/data/vulkan/amber/graphicsfuzz"
_BUILDS = (
    "A case that only has to build is translated, with both of its stages where it has them, and each text is "
    "compiled: WGSL by naga and Tint, HLSL by DXC and glslang, GLSL by the driver and glslang, kernels of Metal "
    "by g++ with a stand-in for its library."
)
_VALUES = (
    "A case with values runs as a function of its inputs: its text is translated, and the results on all inputs "
    "are compared with those that the suite expects, within the suite's own limit of .05 and 5 %. Other cases "
    "build, or must fail."
)
_AMBER_ABOUT = (
    "The GLSL is that of the comments in a file, or spirv-cross makes it of the SPIR-V. Each program draws the "
    "picture of the file's size, with its buffers and textures, and the colors of 8 bits have to be those that "
    "the file expects, or two pictures have equal histograms, within its tolerance. NumPy computes nine blocks of "
    f"4 by 4 pixels, as does a back end that takes more than {SECONDS:g} seconds for the picture. Compute shaders "
    "leave the expected numbers in a buffer. Where spirv-cross is missing, files without GLSL are skipped."
)
_WEBGL_ABOUT = (
    "Pages of `GLSLConformanceTester` list programs: what they render has to be of one color; others build, or "
    "must fail. In other pages of WebGL 2 each pair of shaders that a script names builds. `ogles` has a program "
    "and a reference, which the driver draws: at most 2 % of the 64 by 64 pixels may be more than the suite's own "
    "24 of 255 apart, at edges. A text without a version is GLSL ES 1.00."
)
_SAMPLES_ABOUT = (
    "Each sample draws a quarter of its picture with the values of its JSON file. A translation is right where at "
    "most 2 % of the pixels are more than 1 of 255 apart from what the driver makes of the author's text, or else "
    "where all pixels agree, of nine blocks, that depend neither on rounding nor on what GLSL leaves undefined, "
    "as the interpreter of `--verify` finds. Where WGSL and NumPy are both against the driver, NumPy decides. "
    "Compute shaders leave the same buffers."
)
_FUNCTIONS = (
    "Each function that the pages of GLSL ES 3.00 list, and each that those of 3.10 add, is called in a shader of its "
    "own with uniforms. Functions that glslang does not know are skipped: errors of the pages."
)
_DEQP = "qualification.suites.deqp_runs:run_cases"
_TEXTS = "qualification.suites.text_cases:run_cases"
_VK_GL_CTS = ("KhronosGroup/VK-GL-CTS", "c57d29f97dbd51e6ff57e9eb1a98808e66afa0d3")
_PIGLIT = ("mesa3d/piglit", "5e97a3485e01")
SUITES = {
    name: Suite(*_VK_GL_CTS, (f"data/{name}/shaders",), "Apache-2.0", deqp(f"data/{name}/shaders"), _DEQP, _VALUES)
    for name in ("gles2", "gles3", "gles31")
} | {
    "gl-cts": Suite(*_VK_GL_CTS, (_GL_CTS,), "Apache-2.0", deqp(_GL_CTS), _DEQP, _VALUES),
    "vulkan-glsl": Suite(*_VK_GL_CTS, (_VULKAN_GLSL,), "Apache-2.0", deqp(_VULKAN_GLSL), _DEQP, _VALUES),
    "amber-graphicsfuzz": Suite(
        *_VK_GL_CTS, (_AMBER,), "Apache-2.0", amber, "qualification.suites.amber_runs:run_cases", _AMBER_ABOUT
    ),
    "webgl": Suite(
        "KhronosGroup/WebGL",
        "f15a73f727d8",
        (f"{webgl_cases.TESTS}/conformance", f"{webgl_cases.TESTS}/conformance2"),
        "MIT",
        webgl_cases.cases,
        "qualification.suites.webgl_runs:run_cases",
        _WEBGL_ABOUT,
    ),
    "graphicsfuzz-samples": Suite(
        "google/graphicsfuzz",
        "aa32d4cb5566",
        (sample_cases.FOLDER,),
        "Apache-2.0",
        sample_cases.cases,
        "qualification.suites.sample_cases:run_cases",
        _SAMPLES_ABOUT,
    ),
    "spirv-cross": Suite(
        "KhronosGroup/SPIRV-Cross",
        "6c09849fe88c",
        ("shaders", "shaders-hlsl", "shaders-msl", "shaders-no-opt"),
        "Apache-2.0",
        text_folders.spirv_cross,
        _TEXTS,
        _BUILDS,
    ),
    "glslang": Suite(
        "KhronosGroup/glslang",
        "90afccfbd49d",
        ("Test",),
        "BSD-3-Clause and others",
        text_folders.glslang,
        _TEXTS,
        _BUILDS,
    ),
    "naga-glsl": Suite(
        "gfx-rs/wgpu",
        "64a61ee5c695",
        ("naga/tests/in/glsl",),
        "MIT or Apache-2.0",
        text_folders.naga,
        _TEXTS,
        _BUILDS,
    ),
    "lygia": Suite(
        "patriciogonzalezvivo/lygia",
        "370bb5081ddc",
        (".",),
        "Prosperity-3.0.0 or Patron",
        text_folders.lygia,
        _TEXTS,
        _BUILDS,
    ),
    "reference-pages": Suite(
        "KhronosGroup/OpenGL-Refpages",
        "325d0438",
        tuple(reference_pages.VERSIONS),
        "SGI-B-2.0",
        reference_pages.cases,
        _TEXTS,
        _FUNCTIONS,
    ),
    "piglit": Suite(*_PIGLIT, ("tests",), "MIT and others", piglit_shaders.cases, _TEXTS, _BUILDS),
    "piglit-vectors": Suite(
        *_PIGLIT,
        ("generated_tests",),
        "MIT and others",
        piglit_vectors.cases,
        "qualification.suites.piglit_vectors:run_cases",
    ),
}
"""Name → suite."""
