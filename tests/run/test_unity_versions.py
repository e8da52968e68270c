"""The shader for URP under each version of Unity: its keywords, its passes, and the lights that come through.

The versions are those at which names change. The stand-in headers have the names of each version and no others. Unity's
own packages are read where SSSGEN_UNITY_INCLUDES names them.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from folders import EXAMPLES
from lamp_scene import RIBS
from sssgen.run.backends import Array, Backend
from sssgen.run.compilers import shaderlab
from sssgen.run.compilers import unity_compiler as unity
from sssgen.run.compilers.compiler_interface import Compiler, Source
from sssgen.scene.scene_loading import parse_scene
from unity_engine import drawing

CLUSTERS = {
    202120: "_CLUSTERED_RENDERING",
    202220: "_FORWARD_PLUS",
    60000000: "_FORWARD_PLUS",
    60000100: "_CLUSTER_LIGHT_LOOP",
}
"""The keyword of lists of lights per part of the screen, by UNITY_VERSION."""
NEWEST = 60000500
ENDS = [202120, *(pytest.param(version, marks=pytest.mark.slow) for version in (202220, 60000000)), 60000100]
"""The oldest and the newest names; those between in the slow tests."""
MATERIALS = (
    "leaf",
    *(pytest.param(name, marks=pytest.mark.slow) for name in ("ice", "jelly_cubes", "marble_idol", "paper_lantern")),
)
LEAF = """
[material]
name = "leaf"
shading = "lit"
two_sided = true
[[surface]]
technique = "base_color"
[[surface]]
technique = "normal_map"
[translucency]
technique = "wrap_lighting"
"""
SUNS_AND_LAMP = """
[[light]]
direction = [0.1, 0.2, -1.0]
color = [0.2, 0.1, 0.1]
[[light]]
direction = [-0.3, -0.2, -1.0]
color = [0.1, 0.3, 0.1]
[[light]]
position = [0.2, 0.1, -0.2]
color = [0.1, 0.1, 0.3]
"""


@pytest.fixture(scope="module", params=MATERIALS)
def text(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> str:
    return shader(request.param, tmp_path_factory.mktemp("unity"))


def shader(material: str, folder: Path) -> str:
    if material == "leaf":
        (folder / "leaf.toml").write_text(LEAF, encoding="utf-8")
    path = str(folder / "leaf.toml") if material == "leaf" else material
    return sssgen.compile(path, "unity-urp").files[f"{material}.unity-urp.shader"]


@pytest.fixture
def of_version(compiler: Callable[[str], Compiler]) -> Callable[[int], unity.Unity]:
    """The stand-in headers as those of a version."""
    compiler("unity")
    return lambda version: unity.Unity(unity.STANDIN, False, unity.preprocessor(), (), version)


@pytest.mark.parametrize("version", ENDS)
def test_every_version_takes_every_pass(text: str, version: int, of_version: Callable[[int], unity.Unity]) -> None:
    assert not of_version(version).check(Source(text, "unity-urp", name="x.shader"))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("own", "versions"),
    [
        ("URP_FP_DIRECTIONAL_LIGHTS_COUNT", {202220, 60000000, 60000100}),
        ("_AdditionalLightsDirectionalCount", {202120}),
        ("GetMeshRenderingLayer()", {202220, 60000000, 60000100}),
        ("GetMeshRenderingLightLayer()", {202120}),
        ("SampleProbeVolumePixel(", {60000000, 60000100}),
        ("unity_RendererBounds_Min", {202220, 60000000, 60000100}),
        ("UnityMetaFragment(", set(CLUSTERS)),
    ],
)
def test_a_version_reads_its_own_names(
    own: str, versions: set[int], of_version: Callable[[int], unity.Unity], tmp_path: Path
) -> None:
    """A mistake in the text of one version is found there, and nowhere else: every branch is compiled."""
    correct = shader("leaf", tmp_path)
    assert own in correct
    wrong = Source(correct.replace(own, own.replace("(", "Missing(") if "(" in own else "missing"), "unity-urp")
    assert {version for version in CLUSTERS if of_version(version).check(wrong)} == versions


def test_each_version_declares_its_keywords_once(tmp_path: Path) -> None:
    emitted = shader("leaf", tmp_path)
    for version, keyword in CLUSTERS.items():
        forward = shaderlab.parse(emitted, "x", version).programs[0]
        declared = [
            word for pragma, words in forward.pragmas if pragma.startswith("multi_compile") for word in words.split()
        ]
        assert {word for word in declared if word in CLUSTERS.values()} == {keyword}
        assert declared.count("_SHADOWS_SOFT") == 1
        assert ("_SHADOWS_SOFT_HIGH" in declared) == (version >= 202310)
        assert ("PROBE_VOLUMES_L1" in declared) == (version >= 60000000)
        assert {"_LIGHT_LAYERS", "_LIGHT_COOKIES", "_REFLECTION_PROBE_BLENDING"} <= set(declared)


def test_the_passes(tmp_path: Path) -> None:
    passes = [program.name for program in shaderlab.parse(shader("leaf", tmp_path), "x", NEWEST).programs]
    assert passes == ["ForwardLit", "ShadowCaster", "DepthOnly", "DepthNormals", "Meta"]


def test_conditions_around_pragmas() -> None:
    code = """Shader "A" { SubShader { Pass {
        HLSLPROGRAM
        #if UNITY_VERSION >= 300 // newest
        #pragma first
        #elif UNITY_VERSION >= 200
        #pragma second 2
        #else
        #pragma third
        #endif
        #if defined(OTHER)
        #pragma fourth
        #else
        #pragma fifth
        #endif
        ENDHLSL
    } } }"""
    for version, expected in ((100, ("third", "")), (200, ("second", "2")), (300, ("first", ""))):
        pragmas = shaderlab.parse(code, "x", version).programs[0].pragmas
        assert pragmas == (expected, ("fourth", ""), ("fifth", ""))


def test_the_version_of_a_folder(tmp_path: Path) -> None:
    package = tmp_path / "Packages" / "com.unity.render-pipelines.universal" / "package.json"
    package.parent.mkdir(parents=True)
    assert unity.version_of(tmp_path) == unity.OLDEST
    for written, version in (("6000.1", 60000100), ("2022.3", 202230), ("?", unity.OLDEST)):
        package.write_text(f'{{"unity": "{written}"}}', encoding="utf-8")
        assert unity.version_of(tmp_path) == version


# --- the file for Shader Graph


@pytest.mark.parametrize(
    ("right", "wrong", "job"),
    [
        ("#elif defined(UNIVERSAL_LIGHTING_INCLUDED)", "#elif 1 // UNIVERSAL_LIGHTING_INCLUDED", "HDRP"),
        pytest.param("GetMeshRenderingLayer()", "missing()", "functions", marks=pytest.mark.slow),
        pytest.param("URP_FP_DIRECTIONAL_LIGHTS_COUNT", "missing", "functions", marks=pytest.mark.slow),
    ],
)
def test_a_graph_is_compiled_for_each_pipeline(
    right: str, wrong: str, job: str, of_version: Callable[[int], unity.Unity], tmp_path: Path
) -> None:
    """HDRP's graphs have no lights, so a text that reads them fails there only."""
    (tmp_path / "leaf.toml").write_text(LEAF, encoding="utf-8")
    compiled = sssgen.compile(str(tmp_path / "leaf.toml"), "unity-shadergraph")
    text = compiled.files["leaf.unity-shadergraph.hlsl"]
    assert right in text
    found = of_version(NEWEST).check(
        Source(text.replace(right, wrong), "unity-shadergraph", "library", name="leaf.hlsl")
    )
    assert found
    assert all(f"{job}:" in message.text for message in found)


# --- drawn with the stand-in headers


@pytest.fixture
def light_through(backend: Callable[[str], Backend], monkeypatch: pytest.MonkeyPatch) -> Callable[..., Array]:
    """The light that comes through a lantern, for `(version, keywords, values)`: values of the engine that change."""
    text = f'material = "paper_lantern"\nsamples = 1\n[geometry]\nkind = "ball"\n{SUNS_AND_LAMP}{RIBS}'
    return partial(drawing(backend("unity-urp"), monkeypatch), parse_scene(text, EXAMPLES / "scene.toml"))


@pytest.mark.parametrize("version", ENDS)
def test_every_light_counts_once(light_through: Callable[..., Array], version: int) -> None:
    """With lists of lights per part of the screen, directional lights are apart; the picture is the same."""
    plain = light_through(version)
    count: dict[str, Any] = (
        {"_AdditionalLightsDirectionalCount": 1} if version < 202220 else {"_FPParams0": [0, 0, 0, 1]}
    )
    listed = light_through(version, (f"{CLUSTERS[version]}=1",), **count)
    np.testing.assert_allclose(listed, plain, atol=1e-5)
    assert plain.max(axis=(0, 1)).min() > 0.05


@pytest.mark.parametrize("version", [pytest.param(202120, marks=pytest.mark.slow), NEWEST])
def test_cookies_color_every_light(light_through: Callable[..., Array], version: int) -> None:
    plain, keywords = light_through(version), ("_ADDITIONAL_LIGHTS=1", "_LIGHT_COOKIES=1")
    cookie = np.array([0.5, 0.25, 0.125])
    np.testing.assert_allclose(light_through(version, keywords, standin_cookie=list(cookie)), cookie * plain, atol=1e-5)


@pytest.mark.parametrize("version", [pytest.param(202120, marks=pytest.mark.slow), NEWEST])
def test_lights_of_other_layers_do_not_come_through(light_through: Callable[..., Array], version: int) -> None:
    keywords = ("_ADDITIONAL_LIGHTS=1", "_LIGHT_LAYERS=1")
    layer = float(np.array([2], np.uint32).view(np.float32)[0])

    def lit(main: int, additional: int) -> Array:
        masks: dict[str, Any] = {"_MainLightLayerMask": main, "_AdditionalLightsLayerMask": additional}
        return light_through(version, keywords, unity_RenderingLayer=layer, **masks)

    both, one, others, none = lit(3, 2), lit(3, 1), lit(4, 2), lit(1, 4)
    np.testing.assert_allclose(both, light_through(version), atol=1e-5)
    np.testing.assert_allclose(one + others, both, atol=1e-4)
    assert one.max() > 0.05 < others.max()
    assert none.max() == 0.0


# --- Unity's own packages

FOLDERS = [folder for folder in os.environ.get("SSSGEN_UNITY_INCLUDES", "").split(os.pathsep) if folder]


@pytest.mark.skipif(not FOLDERS, reason="SSSGEN_UNITY_INCLUDES names no folder of Unity's headers")
@pytest.mark.parametrize("folder", FOLDERS or [""])
def test_unitys_own_headers_of_each_version(text: str, folder: str, compiler: Callable[[str], Compiler]) -> None:
    compiler("unity")
    root = Path(folder).resolve()
    assert not unity.Unity(root, True, unity.preprocessor()).check(Source(text, "unity-urp", name="x.shader"))


@pytest.mark.slow
def test_several_folders_are_checked_together(
    monkeypatch: pytest.MonkeyPatch, compiler: Callable[[str], Compiler], tmp_path: Path
) -> None:
    """The second folder's version finds a mistake that the first does not read."""
    compiler("unity")
    newer = tmp_path / "newer"
    newer.mkdir()
    for part in ("CGIncludes", "Packages"):
        (newer / part).symlink_to(unity.STANDIN / part, target_is_directory=True)
    monkeypatch.setenv("SSSGEN_UNITY_INCLUDES", os.pathsep.join([str(unity.STANDIN), str(newer)]))
    monkeypatch.setattr(unity, "version_of", lambda root: unity.OLDEST if root == unity.STANDIN.resolve() else NEWEST)
    both = unity.find()
    wrong = shader("leaf", tmp_path).replace("GetMeshRenderingLayer()", "Missing()")
    messages = both.check(Source(wrong, "unity-urp", name="x.shader"))
    assert messages
    assert all(str(newer) in message.text and "Missing" in message.text for message in messages)
