"""The code distinguishes techniques by their attributes, not by their names."""

from __future__ import annotations

import re

from folders import ROOT
from sssgen.material import library

EXAMPLE, SHAPE, HINT = "an example in a text for users", "a shape of a body", "a hint of uniforms"
CHOSEN_FOR_IMPORTS = {
    "back_face_thickness", "back_face_thickness_soft", "base_color", "base_color_alone", "clearcoat_constants",
    "clearcoat_map",
    "constant_thickness", "depth_map_path", "diffuse_transmission_map", "emission_map", "interior_octaves",
    "eye_layers_thickness", "lamps_through_body", "light_layers_path_soft", "metallic_roughness_map",
    "normal_map", "normal_map_directx", "occlusion_map", "pbr_constants", "seen_through", "seen_through_body",
    "sheen_constants", "specular_level",
    "specular_map", "thickness_map", "uv_transform", "vertex_tint",
}  # fmt: skip
PERMITTED = {
    "cli/ci.py": (EXAMPLE, {"lobe_gdc2011"}),
    "cli/starter.toml": (
        "the material to start from, which the user edits",
        {"base_color", "beer_lambert", "constant_thickness", "lobe_normalized", "parallax_refracted", "pbr_constants"},
    ),
    "run/evaluate/evaluation.py": (EXAMPLE, {"lobe_gdc2011"}),
    "analyse/lint/lint_findings.py": (EXAMPLE, {"lobe_gdc2011"}),
    "scene/distance_field.py": ("the default of a scene's distance function", {"sphere"}),
    "scene/scene_keys.py": ("kinds of geometry", {"box", "capsule", "torus"}),
    "scene/scene_reader.py": (
        "kinds of geometry; an example",
        {"box", "capsule", "sphere", "torus"},
    ),
    "analyse/stress/rows_field.py": (SHAPE, {"box", "sphere", "torus"}),
    "testing/project_run.py": (EXAMPLE, {"lobe_gdc2011"}),
    "interchange/gltf_materials.py": ("a field of the neutral record", {"base_color"}),
    "interchange/gltf_textures.py": ("what the report names", {"uv_transform"}),
    "interchange/materialx_surfaces.py": ("a field of the neutral record", {"base_color"}),
    "interchange/unity_surfaces.py": ("a field of the neutral record", {"base_color"}),
    "interchange/scene_text.py": ("the shell of a scene", {"khronos_neutral", "prefiltered_environment"}),
    "interchange/technique_choice.py": (
        "the choice of techniques for a foreign material",
        CHOSEN_FOR_IMPORTS,
    ),
    "presets/boundary_light.py": (
        "what a refracting surface changes of stages",
        {"base_color", "interior_octaves", "interior_octaves_refracted"},
    ),
    "presets/kept_material.py": ("a field of the neutral record", {"base_color"}),
    "presets/preset_stages.py": (
        "the stages of ready materials",
        {
            "back_face_thickness",
            "base_color",
            "beer_lambert",
            "constant_thickness",
            "lamps_through_body",
            "lobe_normalized",
            "seen_through",
            "seen_through_body",
            "wrap_lighting",
        },
    ),
    "lab/chart/charting.py": ("names of scenes", {"capsule", "torus"}),
    "lab/gpu/timed_programs.py": (EXAMPLE, {"lobe_exp2"}),
    "lab/measure/technique_chain.py": ("a hint of uniforms; the body in a slot", {"box", "normal_map"}),
    "lab/reference/transport_mitsuba.py": ("Mitsuba's names", {"box", "sphere"}),
    "lang/check/uniform_hints.py": (HINT, {"normal_map"}),
    "material/attributes.py": (SHAPE, {"box", "sphere", "torus"}),
    "material/baked.py": (HINT, {"normal_map"}),
    "material/slots.py": (EXAMPLE, {"box"}),
    "targets/graphs/unreal_nodes.py": (HINT, {"normal_map"}),
    "targets/parameter_variables.py": (HINT, {"normal_map"}),
    "targets/texture_import.py": ("settings of a texture import", {"normal_map", "srgb"}),
}
"""File → the reason, and the quoted words that are also names of techniques."""
DATA = ("lab/measure/published.toml",)
"""Files that list techniques as data: the chains of the published sources."""


def test_the_code_names_no_technique() -> None:
    quoted = re.compile(rf"[\"']({'|'.join(library.index())})(?::\w+)?[\"']")
    package = ROOT / "src" / "sssgen"
    names = {}
    for path in sorted(package.rglob("*")):
        file = path.relative_to(package).as_posix()
        if path.suffix in (".py", ".toml", ".json") and file not in DATA:
            names[file] = set(quoted.findall(path.read_text(encoding="utf-8")))
    with_names = {file: matches for file, matches in names.items() if matches}
    assert with_names == {file: permitted for file, (_, permitted) in PERMITTED.items()}
