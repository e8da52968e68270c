"""A technique may declare every name that a shell uses: the shells of all targets compile with it."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection
from pathlib import Path

import pytest

import sssgen
from folders import ROOT
from sssgen.ir.intrinsics import BUILTINS
from sssgen.lang.loader import load_text
from sssgen.material.chain_assembly import TAKEN
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Source
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry

DOC = "/**\n * X.\n * role: {}\n * formula: none\n * source: none\n * units: none\n * limits: none\n */\n"
SURFACE = "void made_surface(uv_position uv, out vec3 albedo, out float alpha, inout tangent_direction normal) {"
LIGHT = "vec3 made_light(world_direction N, world_direction V, world_direction L, float time) {"


def words_of_shells() -> set[str]:
    """The identifiers of the templates and of the descriptors' texts, but for the names of builtins."""
    texts = [
        re.sub(r"\{#.*?#\}", "", path.read_text("utf-8"), flags=re.DOTALL) for path in ROOT.glob("templates/**/*.j2")
    ]
    for target in map(registry.load, registry.names()):
        texts += target.names.shell
        for part in (target, *target.variants.values()):
            places = [
                part.inputs,
                part.light_inputs,
                *part.frame.values(),
                *part.surface.values(),
                *part.absent.values(),
            ]
            texts += [text for place in places for text in place.values()]
    return set(re.findall(r"[A-Za-z_]\w*", " ".join(texts))) | TAKEN - BUILTINS.keys()


def declaration(kind: str, name: str) -> str:
    return {
        "struct": f"struct {name} {{ float a; }};",
        "function": f"float {name}(float x) {{ return x * 0.5; }}",
        "uniform": f"/// U.\nuniform float {name} = 0.5;",
        "const": f"const float {name} = 0.5;",
        "local": "",
    }[kind]


def use(kind: str, name: str) -> str:
    return {
        "struct": f"{{ {name} q = {name}(sum); sum += q.a; }}",
        "function": f"sum += {name}(sum);",
        "uniform": f"sum += {name};",
        "const": f"sum += {name};",
        "local": f"{{ float {name} = sum; sum += {name}; }}",
    }[kind]


def declarable(kind: str, name: str) -> bool:
    """Whether a technique can have the name: the language reserves some, and parameters hide globals."""
    if kind in ("uniform", "const") and re.search(rf"\b{name}\b", f"{SURFACE}{LIGHT} sum"):
        return False
    try:
        load_text(f"{declaration(kind, name)}\nvoid f(float sum) {{ {use(kind, name)} }}", "test.sss")
    except SssgenError:
        return False
    return name not in BUILTINS


def material(folder: Path, kind: str, words: Collection[str]) -> Path:
    """A material of two techniques that declare and use these names."""
    names = sorted(name for name in words if declarable(kind, name))
    assert {"Surface", "surface", "light", "_FORWARD_PLUS", "ENDCG"} <= {*names}
    if kind == "uniform":  # some targets make one property of names that differ in this only
        names = list({name.replace("_", "").lower(): name for name in names}.values())
    head = "\n".join([declaration(kind, name) for name in names]) + "\n"
    body = "float sum = 0.0;\n" + "\n".join([use(kind, name) for name in names]) + "\n"
    surface = "albedo = vec3(sum); alpha = sum; normal = normalize(normal + tangent_direction(vec3(uv, sum))); }\n"
    light = "return vec3(sum) * dot(N, L) * V * time; }\n"
    (folder / "made_surface.sss").write_text(f"{head}{DOC.format('surface')}{SURFACE}\n{body}{surface}", "utf-8")
    (folder / "made_light.sss").write_text(f"{head}{DOC.format('translucency')}{LIGHT}\n{body}{light}", "utf-8")
    path = folder / "made.toml"
    path.write_text(
        '[material]\nname = "made"\nalpha_mode = "mask"\n[[surface]]\ntechnique = "./made_surface.sss"\n'
        '[translucency]\ntechnique = "./made_light.sss"\n',
        "utf-8",
    )
    return path


def compile_everywhere(path: Path, assert_compiles: Callable[[Source], None]) -> None:
    for target in sssgen.all_targets():
        for form in ("shader", "functions"):
            for source in sources(sssgen.compile(str(path), target, form).files):
                assert_compiles(source)


@pytest.mark.slow
def test_structs_with_names_of_the_chain(tmp_path: Path, assert_compiles: Callable[[Source], None]) -> None:
    """The names that no descriptor reserves, as a chain declares them."""
    words = TAKEN | {"_FORWARD_PLUS", "ENDCG", "Varyings", "location", "clip_position"}
    path = material(tmp_path, "struct", words)
    compile_everywhere(path, assert_compiles)
    text = sssgen.compile(str(path), "glsl-330").files["made.glsl-330.frag"]
    assert "struct Surface_2 {" in text and " = Surface_2(sum);" in text


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["struct", "function", "uniform", "const", "local"])
def test_all_names_of_shells(kind: str, tmp_path: Path, assert_compiles: Callable[[Source], None]) -> None:
    words = words_of_shells()
    assert {"Varyings", "clip_position", "to_light", "MAX_LIGHTS"} <= words
    for part in range(12):  # WGSL has at most 255 parameters, and the time of compilers grows faster than the text
        folder = tmp_path / str(part)
        folder.mkdir()
        some = {*sorted(words)[part::12], "Surface", "surface", "light", "_FORWARD_PLUS", "ENDCG"}
        compile_everywhere(material(folder, kind, some), assert_compiles)


def test_a_name_of_a_reserved_beginning_gets_another(tmp_path: Path) -> None:
    """An ending does not help: shells reserve every name that begins with `_AdditionalLights`."""
    name = "_AdditionalLightsBuffer"
    body = f"void made(out vec3 albedo) {{ albedo = vec3({name}(1.0)); }}\n"
    text = f"{declaration('function', name)}\n{DOC.format('surface')}{body}"
    (tmp_path / "made.sss").write_text(text, "utf-8")
    (tmp_path / "made.toml").write_text('[material]\nname = "m"\n[[surface]]\ntechnique = "./made.sss"\n', "utf-8")
    for target in sssgen.all_targets():
        renamed = sssgen.compile(str(tmp_path / "made.toml"), target).reflection["renames"][name]
        assert re.fullmatch(r"[a-z]+_AdditionalLightsBuffer", renamed), target
