"""The JSON schemas: what the readers take is valid, and what they refuse is not."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator

from sssgen.cli.main import main
from sssgen.editor import schemas
from sssgen.editor.documents import MATERIAL, SCENE, kind_of
from sssgen.ir import types
from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler, components
from sssgen.material import library
from sssgen.material.material_loading import examples, parse_material
from sssgen.material.values import WrongValue, read_value
from sssgen.scene import scene_keys
from sssgen.scene.distance_field import PROJECTIONS
from sssgen.scene.scene_loading import parse_scene
from sssgen.support.diagnostics import SssgenError
from sssgen.support.paths import place

FILES = sorted(Path(place("examples")).rglob("*.toml"))


@pytest.fixture(scope="module")
def validators() -> dict[str, Draft7Validator]:
    made = {MATERIAL: schemas.material_schema(), SCENE: schemas.scene_schema()}
    for schema in made.values():
        Draft7Validator.check_schema(schema)
    return {kind: Draft7Validator(schema) for kind, schema in made.items()}


def test_every_example_is_valid(validators: dict[str, Draft7Validator]) -> None:
    counts = dict.fromkeys(validators, 0)
    for path in FILES:
        text = path.read_text("utf-8")
        kind = kind_of(str(path), text)
        if kind in validators:
            errors = [error.message for error in validators[kind].iter_errors(tomllib.loads(text))]
            assert errors == [], path
            counts[kind] += 1
    assert counts[MATERIAL] >= len(examples()) and counts[SCENE] >= len(examples())


CHAIN = '[material]\nname = "m"\n[thickness]\ntechnique = "voronoi_thickness"\n'
WRONG_MATERIALS = [
    CHAIN.replace("name =", "nam ="),
    CHAIN.replace('"m"', '"1m"'),
    CHAIN.replace('"m"', '"m"\nshading = "lot"'),
    CHAIN.replace('"m"', '"m"\ntwo_sided = 1'),
    CHAIN.replace("[thickness]", "[thicknes]"),
    CHAIN.replace("voronoi_thickness", "voronoi"),
    CHAIN.replace("technique", "techniqe"),
    CHAIN.replace("[thickness]", "[surface]"),
    '[material]\nname = "m"\n',
    '[thickness]\ntechnique = "voronoi_thickness"\n',
    CHAIN + "bevl = 0.3\n",
    CHAIN + 'bevel = "0.3"\n',
    CHAIN + "bevel = 7.0\n",
    CHAIN + "bevel = [0.3]\n",
    CHAIN + "bevel = { valu = 0.3 }\n",
    CHAIN + "bevel = { value = 0.3, fixed = 1 }\n",
    CHAIN + "bevel = {}\n",
    CHAIN + 'uv = "uv3"\n',
    CHAIN + "bind = { a = 1 }\n",
    CHAIN + '[translucency]\ntechnique = "lobe_normalized"\nsubsurface_color = "#12"\n',
    CHAIN + '[translucency]\ntechnique = "lobe_normalized"\nsubsurface_color = [1.0, 0.5]\n',
    CHAIN + '[surface]\ntechnique = "base_color"\nbase_color_texture = 3\n',
    CHAIN + '[geometry]\ntechnique = "raymarch"\n',
]


@pytest.mark.parametrize("text", WRONG_MATERIALS)
def test_a_wrong_material_is_not_valid(validators: dict[str, Draft7Validator], text: str) -> None:
    assert validators[MATERIAL].is_valid(tomllib.loads(CHAIN + "bevel = 0.3\n"))
    assert not validators[MATERIAL].is_valid(tomllib.loads(text))
    with pytest.raises(SssgenError):
        parse_material(text, "m.toml")


SCENE_TEXT = 'material = "ice"\n[geometry]\nkind = "ball"\n'
WRONG_SCENES = [
    SCENE_TEXT.replace('"ice"', '"icee"'),
    SCENE_TEXT.replace("material", "materal"),
    "size = [640]\n" + SCENE_TEXT,
    "size = [640, 0]\n" + SCENE_TEXT,
    "samples = 1.5\n" + SCENE_TEXT,
    "samples = 9\n" + SCENE_TEXT,
    "exposure = -1\n" + SCENE_TEXT,
    "background = [0.1, 0.2]\n" + SCENE_TEXT,
    "background = [[0.1, 0.2, 0.3]]\n" + SCENE_TEXT,
    SCENE_TEXT.replace('"ball"', '"bal"'),
    SCENE_TEXT.replace('kind = "ball"', "radius = 1.0"),
    SCENE_TEXT + "size = [1.0, 1.0, 1.0]\n",
    SCENE_TEXT + "radius = 0\n",
    SCENE_TEXT.replace('"ball"', '"union"'),
    SCENE_TEXT.replace('"ball"', '"union"\npart = [{ kind = "bal" }]'),
    SCENE_TEXT.replace('"ball"', '"mesh"'),
    SCENE_TEXT.replace('"ball"', '"distance"\ntechnique = "sphere"\nprojection = "flat"'),
    SCENE_TEXT + "[camera]\nfield_of_view = 180.0\n",
    SCENE_TEXT + "[camera]\npositon = [0.0, 0.0, 1.0]\n",
    SCENE_TEXT + "[[light]]\ncolor = [1.0, 1.0, 1.0]\n",
    SCENE_TEXT + "[[light]]\nposition = [1.0, 1.0, 1.0]\ndirection = [1.0, 1.0, 1.0]\n",
    SCENE_TEXT + "[light]\nposition = [1.0, 1.0, 1.0]\n",
    SCENE_TEXT + "[[light]]\nposition = [1.0, 1.0, 1.0]\n" * 5,
    SCENE_TEXT + '[shell]\ntone_mapping = "acess"\n',
    SCENE_TEXT + '[shell]\ntone = "aces"\n',
    SCENE_TEXT + "[textures]\ncover_texture = 3\n",
    SCENE_TEXT + '[textures]\ncover_texture = { wrap = "clamp" }\n',
    SCENE_TEXT + "[textures]\ncover_texture = { distance_of_geometry = [64, 64] }\n",
    SCENE_TEXT + "title = [1]\n",
]


@pytest.mark.parametrize("text", WRONG_SCENES)
def test_a_wrong_scene_is_not_valid(validators: dict[str, Draft7Validator], text: str) -> None:
    assert validators[SCENE].is_valid(tomllib.loads(SCENE_TEXT))
    assert not validators[SCENE].is_valid(tomllib.loads(text))
    with pytest.raises(SssgenError):
        parse_scene(text, "scene.toml")


@pytest.mark.parametrize(
    "medium",
    ["preset = 'marbel'", "preset = 'marble'\nabsorption = [0.1, 0.1, 0.1]", "unit_mm = 1.0", "anisotropy = 1.0"],
)
def test_a_wrong_medium_is_not_valid(validators: dict[str, Draft7Validator], medium: str) -> None:
    assert validators[SCENE].is_valid({"medium": {"preset": "marble", "unit_mm": 2.0}})
    assert not validators[SCENE].is_valid({"medium": tomllib.loads(medium)})


def takes(uniform: Uniform, raw: object) -> bool:
    try:
        read_value(uniform, raw)
    except WrongValue:
        return False
    return True


def test_each_parameter_takes_what_its_schema_takes() -> None:
    """Numbers at the ends of its range, beyond them, of another kind, too many and too few, colours and tables."""
    count, seen = 0, set()
    for technique in library.load_all():
        keys = schemas._parameters(technique)["properties"]
        for uniform in technique.uniforms:
            if uniform.name not in keys or isinstance(uniform.type, Sampler) or uniform.span in seen:
                continue
            seen.add(uniform.span)
            low, high = schemas.limits(uniform)
            size = components(uniform.type)
            raws: list[Any] = [True, "#ff8000", "red", 0.5, 1, list(uniform.default)]
            for number in (low, high, low - 1.0, high * 1.01 + 1.0, int(low) - 1, int(min(high, 1e12)) + 1):
                if types.kind_of(uniform.type) in ("int", "uint"):
                    number = int(number)  # to JSON Schema, 1.0 is an integer
                raws += [number, [number] * size, [number] * (size + 1), {"value": number}]
            validator = Draft7Validator(keys[uniform.name])
            for raw in raws:
                inner = raw["value"] if isinstance(raw, dict) else raw
                assert validator.is_valid(raw) == takes(uniform, inner), (technique.name, uniform.name, raw)
                count += 1
    assert count > 3_000


def test_the_tables_are_those_of_the_reader() -> None:
    assert scene_keys.SHAPES["distance"]["projection"].choices == tuple(PROJECTIONS)
    for wrong in ("[geometry]\nkind = 'ball'\n", "[camera]\n"):
        with pytest.raises(SssgenError, match="unknown key 'other'"):
            parse_scene(f'material = "ice"\n{wrong}other = 1\n', "scene.toml")


def test_the_command_prints_and_writes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema", "scene"]) == 0
    printed = capsys.readouterr().out
    assert json.loads(printed) == schemas.scene_schema()
    assert main(["schema", "scene", "-o", str(tmp_path / "scene.json")]) == 0
    assert (tmp_path / "scene.json").read_text("utf-8") == printed
