"""Unreal: the Custom node that pastes into the material editor computes what the oracle computes, in centimetres."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from folders import EXAMPLES
from sssgen.ir.types import BY_NAME, FLOAT, VEC2, VEC3, Sampler, Type
from sssgen.run.backends import Backend, Call, Text
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Compiler, Source, errors, unreal_node
from sssgen.run.compilers.unreal_node import CustomNode
from sssgen.targets.runtime.numpy_textures import Texture

LANES = 64
TYPES: dict[str, Type] = {"MaterialFloat": FLOAT, "MaterialFloat2": VEC2, "MaterialFloat3": VEC3}
LENGTHS = ("P", "P_object", "eye_distance", "ray_origin")
MATERIALS = {
    "wax_mouse": {"EmissiveColor", "Metallic", "Roughness"},
    "ice": {"EmissiveColor", "Metallic", "Roughness", "Normal", "OpacityMask"},
    "paper_lantern": {"EmissiveColor", "Metallic", "Roughness", "Normal"},
    "resin_inlay": {"Metallic", "Roughness"},
    "jade_ring": {"EmissiveColor", "Metallic", "Roughness"},
    "examples/bake/wax_map.toml": {"SubsurfaceColor", "Metallic", "Roughness"},
    "jelly_cubes": set(),
}
"""Material → the outputs of its node beside the result. Together they read nearly every input of a chain."""

Array = np.ndarray[Any, Any]


def files(material: str) -> tuple[str, str]:
    """The text for the editor, and the file that it includes."""
    compiled = sssgen.compile(material, "unreal").files
    return next(text for name, text in compiled.items() if name.endswith(".txt")), next(iter(compiled.values()))


def inputs_of_chain() -> dict[str, Array]:
    """Random values in metres, as a scene could have them; directions have length 1."""
    rng = np.random.default_rng(5)
    values: dict[str, Array] = {name: rng.uniform(0.0, 1.0, (2, LANES)) for name in ("uv", "screen_uv")}
    values |= {name: rng.uniform(-0.5, 0.5, (3, LANES)) for name in ("P", "ray_origin")}
    values["P_object"] = np.array([-2.5, 1.2, 4.1])[:, None] + rng.uniform(-0.8, 0.8, (3, LANES))
    for name in ("V", "L", "V_object", "N_object", "L_object", "N", "T", "B"):
        values[name] = rng.normal(size=(3, LANES))
        values[name] /= np.linalg.norm(values[name], axis=0)
    values["T"] = np.cross(values["B"], values["N"], axis=0)
    values["T"] /= np.linalg.norm(values["T"], axis=0)
    values["B"] = np.cross(values["N"], values["T"], axis=0)
    values["ray_direction"] = -values["V"]
    values["eye_distance"] = rng.uniform(0.0, 1.0, LANES)
    values["time"] = rng.uniform(0.0, 9.0, LANES)
    values["light_color"] = rng.uniform(0.5, 2.0, (3, LANES))
    values["light_nearness"] = np.zeros(LANES)
    return {name: value.astype(np.float32) for name, value in values.items()}


def default_of(text: str, node: str, output: int) -> Array:
    """The default of a parameter's node, as the text has it."""
    body = text.partition(f'Name="{node}"')[2].partition("\nEnd Object")[0]
    value = re.search(r"^ +DefaultValue=(.*)$", body, re.MULTILINE)
    assert value is not None, node
    numbers = np.array([float(number) for number in re.findall(r"[-+.\deE]*\d[-+.\deE]*", value[1])], np.float32)
    part = numbers[:3] if output == 0 and len(numbers) > 1 else numbers[output - 1 : output] if output else numbers
    return np.repeat(part[:, None], LANES, axis=1) if len(part) > 1 else np.repeat(part, LANES)


def bound_textures(reflection: Mapping[str, Any]) -> dict[str, Texture]:
    rng = np.random.default_rng(3)
    textures = {}
    for row in reflection["textures"]:
        kind = BY_NAME[row["type"]]
        assert isinstance(kind, Sampler)
        size = (4, 4, 4) if kind.dim == "3D" else (8, 8)
        textures[row["name"]] = Texture(rng.integers(0, 256, (*size, 4)).astype(np.float32) / 256.0)
    return textures


def run_node(
    text: str, included: str, machine: Backend, chain: Mapping[str, Array], textures: Mapping[str, Texture]
) -> dict[str, Array]:
    """Every output of the Custom node by its name, with the parameters' defaults and the chain's inputs."""
    program, node = unreal_node.program(text, included)
    parameters = node.parameters(unreal_node.textures_of(included))
    passed = [(type_, name) for type_, name in parameters if not type_.startswith("inout ")]
    outs = [(type_.removeprefix("inout "), name) for type_, name in parameters if type_.startswith("inout ")]
    values = {pin.name: argument(text, pin, chain) for pin in node.inputs if pin.type}
    names = ", ".join(f"{type_} {name}" for type_, name in passed)
    calls = []
    for number, (type_, name) in enumerate([(node.result, "result"), *outs]):
        declared = "".join(f"{out} {out_name} = ({out})0; " for out, out_name in outs)
        called = ", ".join(["(FMaterialPixelParameters)0", *(name for _, name in [*passed, *outs])])
        program += f"{type_} output_{number}({names}) {{ {declared}{node.result} result = "
        program += f"{unreal_node.FUNCTION}({called}); return {name}; }}\n"
        params = [(kind, name) for kind, name in passed if kind != "SamplerState"]
        types = tuple(TYPES.get(kind) or Sampler(kind.removeprefix("Texture")) for kind, _ in params)
        args = tuple(values.get(name, name) for _, name in params)
        calls.append(Call(f"output_{number}", types, TYPES[type_], args))
    results = machine.run(Text(program), calls, textures)
    return dict(zip(["result", *(name for _, name in outs)], results, strict=True))


def argument(text: str, pin: unreal_node.Input, chain: Mapping[str, Array]) -> Array:
    """The value of a pin: of the engine, with lengths in centimetres, or the default of a parameter."""
    if "Parameter_" in text.partition(f'Name="{pin.node}"')[2].partition("\n   End Object")[0]:
        return default_of(text, pin.node, pin.output)
    value = chain[pin.name]
    if pin.name == "light_color":
        return value * np.float32(np.pi)  # the illuminance in which a white surface has that colour
    return value * np.float32(100.0) if pin.name in LENGTHS else value


def by_the_oracle(material: str, chain: Mapping[str, Array], textures: Mapping[str, Texture]) -> dict[str, Array]:
    """The same outputs by the functions of the NumPy target, in metres."""
    compiled = sssgen.compile(material, "numpy", form="functions")
    functions: dict[str, Any] = {}
    exec(next(iter(compiled.files.values())), functions)
    dark = dict.fromkeys(("irradiance", "irradiance_behind"), np.zeros((3, LANES)))
    known: dict[str, Any] = {**chain, **textures, **dark}
    for row in compiled.reflection["uniforms"]:
        value = np.array(row["default"], np.float64)
        shaped = value.reshape(int(row["type"][-1]), -1) if row["type"].startswith("mat") else value
        known[row["name"]] = float(value[0]) if value.size == 1 else shaped[..., None] * np.ones(LANES)

    def entry(kind: str) -> Any:
        function = functions[f"evaluate_{kind}"]
        return function(*(known[name] for name in inspect.signature(function).parameters))

    if "evaluate_color" in functions:
        return {
            "result": entry("color")[:3] ** 2.2
        }  # encoded by the material's output technique, which Unreal replaces
    surface = known["surface"] = entry("surface")
    expected = {"result": surface.albedo if hasattr(surface, "albedo") else np.ones((3, 1))}
    fields = {"Metallic": "metallic", "Roughness": "roughness", "OpacityMask": "alpha", "AmbientOcclusion": "occlusion"}
    expected |= {name: getattr(surface, field) for name, field in fields.items() if hasattr(surface, field)}
    if hasattr(surface, "normal"):
        expected["Normal"] = surface.normal * np.array([1.0, -1.0, 1.0])[:, None]
        frame = chain["T"] * surface.normal[0] + chain["B"] * surface.normal[1] + chain["N"] * surface.normal[2]
        known["N"] = frame / np.linalg.norm(frame, axis=0)
    through = entry("translucency") if "evaluate_translucency" in functions else np.zeros((3, 1))
    emission = surface.emission if hasattr(surface, "emission") else np.zeros((3, 1))
    return expected | {"EmissiveColor": emission + through * chain["light_color"], "SubsurfaceColor": through}


@pytest.mark.parametrize("material", MATERIALS)
def test_the_node_computes_in_centimetres(material: str, backend: Callable[[str], Backend]) -> None:
    """Inputs and parameters in centimetres, as the text itself has them, give what the oracle gives in metres."""
    text, included = files(material)
    chain = inputs_of_chain()
    textures = bound_textures(sssgen.compile(material, "unreal").reflection)
    actual = run_node(text, included, backend("hlsl"), chain, textures)
    assert actual.keys() == {"result"} | MATERIALS[material]
    if material == "jelly_cubes":  # a picture whose v runs up, on a mesh whose v runs down
        chain["uv"] = np.stack([chain["uv"][0], 1.0 - chain["uv"][1]])
    expected = by_the_oracle(material, chain, textures)
    for name, value in actual.items():
        assert np.ptp(value) > 0.0 or name in ("Metallic", "Roughness"), name
        np.testing.assert_allclose(value, np.broadcast_to(expected[name], value.shape), atol=2e-4, rtol=2e-4)


def test_lengths_are_said() -> None:
    """The head of the file and the reflection; a length in the text is 100 times that of the reflection."""
    text, included = files("wax_mouse")
    head = included.partition("#ifndef")[0]
    assert "Unreal's lengths are in centimetres" in head
    reflection = sssgen.compile("wax_mouse", "unreal").reflection
    assert reflection["conventions"]["lengths"].startswith("centimetres")
    defaults = {row["name"]: row["default"] for row in reflection["uniforms"]}
    node = re.search(r'ParameterName="attenuation_distance"\n +DefaultValue=(.*)', text)
    assert node is not None and float(node[1]) == 100.0 * defaults["attenuation_distance"][0]


def test_what_the_sun_lights_and_what_the_engine_lights() -> None:
    """Transmitted light that depends on the light's direction is the sun's; the other is subsurface colour."""
    sunlit, lit = files("wax_mouse")[1], files("examples/bake/wax_map.toml")[1]
    assert "does not see the lights of the level" in sunlit and "SubsurfaceColor" not in sunlit
    assert "does not see the lights" not in lit and "Two Sided Foliage" in lit and "EmissiveColor" not in lit


def test_the_example_is_lit_by_the_engine() -> None:
    """What comes through the leaf is subsurface colour, on both sides, cut out by its opacity."""
    text, included = files(str(EXAMPLES / "engines" / "unreal" / "leaf.toml"))
    assert "// Switch on Two Sided." in included and "Blend Mode: Masked" in included
    names = {name for _, name in unreal_node.read(text).outputs}
    assert {"SubsurfaceColor", "OpacityMask"} <= names and "EmissiveColor" not in names


def node_of(material: str) -> CustomNode:
    return unreal_node.read(files(material)[0])


def test_the_code_is_one_call_of_the_included_file() -> None:
    for material in MATERIALS:
        node = node_of(material)
        assert re.fullmatch(r"return sssgen_\w+::evaluate_material\(.*\);", node.code)
        assert node.includes == (f"/Project/{Path(material).stem}.ush",)


WRONG = [
    ("LinkedTo=(MaterialGraphNode_1 ", "LinkedTo=(MaterialGraphNode_2 ", "which is not connected to it"),
    ('IncludeFilePaths(0)="/Project/', 'IncludeFilePaths(0)="Project/', "includes no file"),
    ("evaluate_material(uv, ", "evaluate_material(", "too few arguments"),
    ("'MaterialGraphNode_1.", "'MaterialGraphNode_99.", "is connected to no node"),
    ("::evaluate_material", "::evaluate_materials", "no member named"),
]


@pytest.mark.parametrize(("right", "wrong", "message"), WRONG)
def test_a_wrong_text_is_refused(right: str, wrong: str, message: str, compiler: Callable[[str], Compiler]) -> None:
    text, included = files("wax_mouse")
    assert right in text
    source = Source(text.replace(right, wrong), "unreal", "library", name="wax_mouse.unreal.txt", companion=included)
    assert message in errors(compiler("unreal").check(source))[0].text


def test_an_error_has_the_line_of_the_include_file(compiler: Callable[[str], Compiler]) -> None:
    compiled = sssgen.compile("wax_mouse", "unreal", form="functions").files
    (source,) = sources(compiled)
    line = next(number for number, line in enumerate(source.text.splitlines(), 1) if "exp(-min(" in line)
    wrong = source.with_text(source.text.replace("exp(-min(", "exp(-minimum("))
    assert errors(compiler("unreal").check(wrong))[0].line == line
