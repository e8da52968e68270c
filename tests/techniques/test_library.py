"""All techniques are documented, tested and (with `pytest -m slow`) compiled for every target."""

from __future__ import annotations

import ast
from collections.abc import Callable
from functools import cache
from itertools import permutations
from pathlib import Path

import pytest

from sssgen.ir.baked_textures import is_baked
from sssgen.ir.frame_passes import FRAME_PASSES
from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Matrix, Sampler, Scalar
from sssgen.lang.check.quantities import SCALARS
from sssgen.lang.check.suggested_conversions import suggested_conversions
from sssgen.lang.loader import load_file
from sssgen.material import attributes, library
from sssgen.material.library import Technique
from sssgen.material.material_loading import parse_material
from sssgen.material.model import Material
from sssgen.material.requirements import baked_textures, needed_for, requirements, texel_bytes
from sssgen.material.slots import candidates
from sssgen.pipeline.compiler import FORMS, Compiled
from sssgen.pipeline.compiler import compile as compile_material
from sssgen.run import compilers
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Compiler, errors
from sssgen.support.diagnostics import SssgenError, UnsupportedError
from sssgen.support.paths import source_name
from sssgen.targets import registry

NAMES = sorted(library.index())


# Documented

SECTIONS = {"summary", "role", "formula", "source", "units"}
STRUCTURED = {
    "role",
    "formula",
    "superseded_by",
    "suggested",
    "legend",
    "shape",
    "sets",
    "requires",
    "bake",
    "deviation_bounds",
}
"""Sections that need no sentence."""


@pytest.mark.parametrize("name", NAMES)
def test_the_doc_comment_is_complete(name: str) -> None:
    technique = library.load(name)
    doc = technique.doc
    assert doc.keys() >= SECTIONS, sorted(doc)
    assert doc.keys() & {"limits", "corrects", "baseline"}, "neither limits nor corrects"
    assert all(text and (key in STRUCTURED or text.endswith(".")) for key, text in doc.items()), doc
    folder = Path(technique.path).parent.name
    assert doc["role"] == folder or (folder == "baselines" and technique.baseline)
    assert (folder == "baselines") == bool(technique.attributes.superseded_by)


def test_each_conversion_is_suggested_once() -> None:
    suggested = {
        loaded.attributes.suggested: loaded.name for loaded in library.load_all() if loaded.attributes.suggested
    }
    assert sorted(suggested) == sorted(permutations([name for name in SCALARS if name != "view_thickness"], 2))
    assert suggested_conversions() == suggested


WRONG_ATTRIBUTES = {
    "limts: None.": ("unknown attribute 'limts'", "did you mean 'limits'?"),
    "units: a\nunits: b": ("attribute 'units' is given twice", ""),
    "shape: boxx": ("unknown shape 'boxx'", "did you mean 'box'?"),
    "suggested: thickness": (
        "'thickness' is not a conversion",
        "write, for example, `suggested: thinness to thickness`",
    ),
    "suggested: thickness to thinnes": ("unknown quantity 'thinnes'", "did you mean 'thinness'?"),
    "suggested: thickness to thinness": ("'f' does not convert thickness to thinness", ""),
    "requires: depth-mop": ("unknown requirement 'depth-mop'", "did you mean 'depth-map'?"),
    "requires: sunshine": (
        "unknown requirement 'sunshine'",
        "requirements: bake, depth-map, depth-layers, back-faces, eye-layers, matt-light, inner-light, rest-pose, "
        "rigid, fixed-light",
    ),
    "sets: tint": ("'tint' is not a setting", "write, for example, `sets: albedo by tint`"),
    "sets: albedo by tint": ("'f' does not write 'albedo'", ""),
    "superseded_by: beer_lambert": ("superseded_by is for baselines", "write `baseline: TEXT`, too"),
    "baseline: One.\nsuperseded_by: beer_lamber": (
        "unknown technique 'beer_lamber' in superseded_by",
        "did you mean 'beer_lambert'?",
    ),
    "deviation_bounds: largest 1": ("deviation_bounds without deviation", "write the reason: `deviation: TEXT`"),
    "deviation: Why.\ndeviation_bounds: most 1": ("unknown bound 'most'", "bounds: largest, share, bound_share"),
    "deviation: Why.\ndeviation_bounds: largest": (
        "'largest' is not a bound",
        "write, for example, `largest 0.001, share 0.02`",
    ),
}


@pytest.mark.parametrize("attributes", WRONG_ATTRIBUTES)
def test_attributes_are_checked(attributes: str, tmp_path: Path) -> None:
    lines = "".join(f"/// {line}\n" for line in ["A test.", "role: distance", *attributes.split("\n")])
    (tmp_path / "f.sss").write_text(f"{lines}float f(float x) {{ return x; }}\n", encoding="utf-8")
    with pytest.raises(SssgenError) as caught:
        library.load(str(tmp_path / "f.sss"))
    (result,) = caught.value.diagnostics
    assert (result.message, result.hint) == WRONG_ATTRIBUTES[attributes]


def test_baked_textures_state_their_size_and_pictures_who_draws_them() -> None:
    for technique in library.load_all():
        for uniform in technique.uniforms:
            hints = dict(uniform.hints)
            assert is_baked(uniform) <= ("texel_bytes" in hints), f"{technique.name}: {uniform.name}"
            if isinstance(uniform.type, Sampler) and "repeat_disable" in hints and not is_baked(uniform):
                assert "drawn" in hints or technique.attributes.requires, f"{technique.name}: {uniform.name}"
    assert {name for drawn in FRAME_PASSES for name in needed_for(drawn)} <= set(attributes.REQUIREMENTS)


def test_requirements_follow_from_declarations(tmp_path: Path) -> None:
    def required(text: str) -> tuple[tuple[str, ...], int]:
        stages = parse_material(f'[material]\nname = "one"\n{text}', str(tmp_path / "one.toml")).stages
        return requirements(stages), sum(texel_bytes(texture) for texture in baked_textures(stages))

    light = '[[translucency]]\ntechnique = "{}"\n'
    inside = light.format("interior_sample") + 'bind = {{ light_path = "{}"{} }}\n'
    length = '[[thickness]]\ntechnique = "{}"\n'
    body = ', body_distance = "{}"'
    assert required(light.format("wrap_lighting")) == ((), 0)
    mapped = length.format("thickness_map") + '[[thickness]]\ntechnique = "view_thickness_from_chord"\n'
    assert required(mapped + inside.format("depth_map_path", "")) == (("bake", "depth-map"), 1)
    faces = length.format("back_face_thickness")
    assert required(faces + inside.format("depth_map_path", "")) == (("depth-map", "back-faces"), 0)
    layers = faces + inside.format("depth_layers_path", "")
    assert required(layers) == (("depth-map", "depth-layers", "back-faces"), 0)
    assert required(light.format("fluence_fixed_layers")) == (
        ("bake", "back-faces", "eye-layers", "rigid", "fixed-light"),
        4,
    )
    relit = ("bake", "back-faces", "eye-layers", "inner-light", "rest-pose")
    assert required(light.format("fluence_relit")) == (relit, 8)
    assert required(faces + inside.format("march_light", body.format("sphere"))) == (("back-faces", "rigid"), 0)
    texture = body.format("distance_texture_world")
    marched = length.format("march_view") + 'bind = { body_distance = "distance_texture_world" }\n'
    # two marches read the same volume, which counts once
    assert required(marched + inside.format("march_light", texture)) == (("bake", "rigid"), 2)


UNBOUNDED = {
    "center": "a place", "box_min": "a place", "box_max": "a place", "start": "a place", "end": "a place",
    "look_at": "a place", "eye": "a place", "half_size": "a size along each axis",
    "uv_per_unit": "a scale along each axis, below 0 for mirrored maps",
    "red_speed": "a speed", "green_speed": "a speed", "blue_speed": "a speed", "key_direction": "a direction",
}  # fmt: skip
"""Uniforms without a range → the reason."""


def uniforms() -> dict[str, Uniform]:
    """Every uniform of the library, by FILE:NAME."""
    results = {}
    for path in sorted(Path(library.TECHNIQUES).glob("*/*.sss")):
        for uniform in load_file(path, (library.TECHNIQUES,)).uniforms:
            results[f"{uniform.span.file}:{uniform.name}"] = uniform
    return results


def test_uniforms_are_documented() -> None:
    """Each uniform has a sentence, and a range with a unit, or a reason why not."""
    failures = []
    for name, uniform in uniforms().items():
        hints = dict(uniform.hints)
        if not (uniform.doc and not uniform.doc[0].islower() and uniform.doc.rstrip().endswith(".")):
            failures.append(f"{name}: no sentence: {uniform.doc!r}")
        if isinstance(uniform.type, Sampler):
            if not any(hint.startswith("default_") for hint in hints):
                failures.append(f"{name}: it does not state the value that is read where no texture is bound")
        elif isinstance(uniform.type, Scalar):
            whole = uniform.type.kind == "int"
            if "hint_range" not in hints or ("unit" not in hints and not whole):
                failures.append(f"{name}: no range or no unit")
        elif isinstance(uniform.type, Matrix) or "source_color" in hints or "hint_range" in hints:
            continue
        elif uniform.name not in UNBOUNDED:
            failures.append(f"{name}: neither a colour nor among the uniforms without a range")
    assert not failures, "\n".join(failures)
    named = {name.partition(":")[2] for name in uniforms()}
    assert named >= UNBOUNDED.keys()


def test_aliases_are_unique() -> None:
    """In a technique, a name or alias belongs to a single uniform."""
    for name in NAMES:
        words = [
            word
            for uniform in library.load(name).uniforms
            for word in (uniform.name, *dict(uniform.hints).get("alias", ()))
        ]
        assert len(words) == len(set(words)), (name, words)


def test_a_test_runs_every_technique() -> None:
    """A test of values names each technique; this file does not count, because it only compiles."""
    named: set[str] = set()
    for path in Path(__file__).parent.glob("test_*.py"):
        if path != Path(__file__):
            tree = ast.parse(path.read_text("utf-8"))
            constants = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)]
            named |= {value for value in constants if isinstance(value, str)}
    assert not library.index().keys() - named


# Compiled

TAKERS = {
    "thickness": "absorption_tint",
    "view_thickness": "interior_sample",
    "thinness": "sky_glow",
    "transmittance": "lobe_gdc2011",
}
GIVERS = {
    "thickness": "constant_thickness",
    "view_thickness": "march_view",
    "thinness": "thinness_map",
    "transmittance": "transmittance_map",
}
SLOTS = {
    "light_path": "march_light",
    "body_distance": "torus",
    "scene_distance": "jelly_scene",
    "distance_at": "distance_texture",
}


def stage(section: str, name: str, **slots: str) -> str:
    """A stage of a material file, with functions bound to its slots."""
    bound: dict[str, str] = {}
    waiting = [slot.name for slot in library.load(name).slots]
    while waiting:
        slot = waiting.pop(0)
        bound[slot] = slots.get(slot, SLOTS[slot])
        waiting += [inner.name for inner in library.load(bound[slot].partition(":")[0]).slots]
    table = ", ".join(f'{slot} = "{function}"' for slot, function in bound.items())
    return f'[[{section}]]\ntechnique = "{name}"\n' + (f"bind = {{ {table} }}\n" if bound else "")


def chain(technique: Technique) -> tuple[str, list[str]]:
    """The shading and the stages of a small material that uses the technique."""
    name, role, function = technique.name, technique.role, technique.function
    if role == "distance":
        for path in library.index().values():
            user = library.load_path(path)
            for slot in user.slots:
                if user.role == "thickness" and name in candidates(slot):
                    stages = [stage("thickness", user.name, **{slot.name: name})]
                    return "lit", [*stages, stage("translucency", TAKERS[user.function.quantity])]
        raise AssertionError(f"nothing takes {name}")
    own = stage("thickness" if role == "conversion" else role, name)
    accepted = [param.quantity for param in function.params if param.quantity in GIVERS]
    before = [stage("thickness", GIVERS[quantity]) for quantity in accepted]
    written = function.quantity if function.quantity in TAKERS else ""
    if role == "surface" and accepted:
        written = accepted[0]
    after = [stage("translucency", TAKERS[written])] if written else []
    if role == "lighting" or role == "geometry":
        if name == "standard":
            return "lit", [stage("surface", "base_color"), own]
        scene = [own] if role == "geometry" else []
        if name not in ("camera_still", "camera_orbit"):
            scene.insert(0, stage("geometry", "camera_orbit"))
        if "march" not in name and name != "sky_background":
            scene.append(stage("geometry", "raymarch"))
        light = own if role == "lighting" else stage("lighting", "studio")
        return "unlit", [*scene, light]
    surface = [] if name == "base_color" or "albedo" in {param.name for param in function.params} else ["base_color"]
    return "lit", [*before, *[stage("surface", surface_technique) for surface_technique in surface], own, *after]


@cache
def material(name: str) -> Material:
    """A small material that uses the technique."""
    shading, stages = chain(library.load(name))
    alpha = "blend" if name in ("base_color", "alpha_erosion") else "opaque"
    head = f'[material]\nname = "{name}_alone"\nshading = "{shading}"\nalpha_mode = "{alpha}"\n'
    return parse_material("\n".join([head, *stages]), Path("alone.toml"))


def compiled(name: str, target: str, form: str) -> Compiled:
    return compile_material(material(name), target, form)


# These techniques return a value unchanged, so no emitted line is theirs.
IDENTITIES = {"thinness_from_transmittance", "transmittance_from_thinness"}


@pytest.mark.parametrize("name", sorted({*NAMES} - IDENTITIES))
def test_every_technique_makes_a_material(name: str) -> None:
    """The output has lines of the technique."""
    maps = compiled(name, "glsl-330", "shader").reflection["source_map"]
    places = {place for file in maps.values() for place in file.values()}
    assert any(place.startswith(source_name(library.index()[name])) for place in places), places


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("target", registry.names())
def test_every_technique_compiles(target: str, form: str, compiler: Callable[[str], Compiler]) -> None:
    """Every compiler accepts every technique for every target; all failures are reported together."""
    failures = []
    count, lacking = 0, 0
    taken = registry.load(target).shell
    names = [name for name in NAMES if (role := library.load(name).role) not in library.OF_SHELLS or role in taken]
    for name in names:
        try:
            files = compiled(name, target, form).files
        except UnsupportedError:
            lacking += 1
            continue
        for source in sources(files):
            count += 1
            readers = [compiler(reader) for reader in compilers.readers(source.language)]
            assert readers, source.language
            for reader in readers:
                reported = errors(reader.check(source))
                failures += [f"{source.name} ({source.stage}), {reader.name}: {message}" for message in reported]
    assert count >= len(names) - lacking
    limited = registry.load(target).channels or registry.load(target).lacks
    assert lacking == 0 or (limited and lacking < len(NAMES) / 2)
    assert not failures, "\n".join(failures)
