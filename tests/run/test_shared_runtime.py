"""Modules for engines of the web: the materials in a folder share one runtime; a standalone module has it inside."""

from __future__ import annotations

import dataclasses
import json
import re
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import sssgen
from engine_cases import HEAD, mesh_of
from skips import or_skip
from sssgen.cli.main import main
from sssgen.pipeline.compiler import Compiled
from sssgen.run.backends import Array
from sssgen.run.backends.engine_page import Engine, EnginePage
from sssgen.run.backends.web_engines import BABYLON, PLAYCANVAS, THREE
from sssgen.run.render import page_values
from sssgen.support.diagnostics import SssgenError


class Case(NamedTuple):
    engine: Engine
    renderer: str
    runtime: str
    module: str
    """The name of a material's module."""


CASES = [
    Case(BABYLON, "webgl", "sssgen-babylon.js", "{}.babylon.js"),
    Case(PLAYCANVAS, "webgl2", "sssgen-playcanvas.mjs", "{}.mjs"),
    Case(THREE, "webgl", "sssgen-three.js", "{}.js"),
]
NAMES = ("ice", "paper_lantern")


@pytest.fixture(
    scope="module",
    params=[CASES[0], *(pytest.param(case, marks=pytest.mark.slow) for case in CASES[1:])],
    ids=lambda case: case.engine.target,
)
def case(request: pytest.FixtureRequest) -> Case:
    chosen: Case = request.param
    return chosen


@pytest.fixture(scope="module")
def page(case: Case) -> Iterator[EnginePage]:
    opened: EnginePage = or_skip(partial(EnginePage, case.engine), case.renderer)
    yield opened
    opened.page.close()


def emit(case: Case, folder: Path, *arguments: str) -> None:
    assert main(["emit", *arguments, "-t", case.engine.target, "-o", str(folder)]) == 0


def drawn(page: EnginePage, name: str, module: str, folder: Path, *others: str) -> Array:
    """The picture of a module of a folder, with nothing else of the folder but `others`."""
    mesh = mesh_of(name)
    compiled = sssgen.compile(name, page.engine.target)
    files = {file: (folder / file).read_text(encoding="utf-8") for file in (module, *others)}
    (reflection,) = folder.glob(f"{name}.*.reflection.json")
    made = Compiled({**files, reflection.name: reflection.read_text(encoding="utf-8")}, compiled.warnings)
    return page_values.shade(made, dataclasses.replace(mesh.shell), page, mesh.size, mesh.points)


def test_materials_of_a_folder_share_a_runtime(case: Case, page: EnginePage, tmp_path: Path) -> None:
    """Also where they are emitted one after another. Each draws what its standalone module draws."""
    shared, alone = tmp_path / "shared", tmp_path / "alone"
    for name in NAMES:
        emit(case, shared, name)
        emit(case, alone, name, "--standalone")
    assert len(list(shared.glob("sssgen-*"))) == 1 and not list(alone.glob("sssgen-*"))
    for name in NAMES:
        module = case.module.format(name)
        picture = drawn(page, name, module, shared, case.runtime)
        assert picture.std() > 0.02 and (picture == drawn(page, name, module, alone)).all()


def test_the_runtime_is_the_same_for_all_materials(
    case: Case, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    texts = {sssgen.compile(name, case.engine.target).files[case.runtime] for name in (*NAMES, "jelly_cubes")}
    assert len(texts) == 1
    emit(case, tmp_path, *NAMES)
    assert capsys.readouterr().out.count(case.runtime) == 1
    (tmp_path / case.runtime).write_text("// of another version\n", encoding="utf-8")
    emit(case, tmp_path, "ice")
    assert f"wrote {(tmp_path / case.runtime).as_posix()}" in capsys.readouterr().out
    assert (tmp_path / case.runtime).read_text(encoding="utf-8") in texts


def test_a_standalone_module_imports_packages_only(case: Case) -> None:
    files = sssgen.compile("ice", case.engine.target, standalone=True).files
    module = files[case.module.format("ice")]
    assert case.runtime not in files and "'./" not in module.partition("*/")[2].replace("'./ice", "")
    imports = re.findall(r"^import .*;$", module, re.MULTILINE)
    assert imports and len(imports) == len(set(imports))
    exported = re.findall(r"^export \w+ (\w+)", module, re.MULTILINE)
    assert exported == ["parameters", "textures", "IceMaterial", "createMaterial"]


def test_lines_of_a_standalone_module_have_their_sources(case: Case) -> None:
    """The text of the runtime above them moves them."""
    places = []
    for standalone in (False, True):
        compiled = sssgen.compile("ice", case.engine.target, standalone=standalone)
        module = case.module.format("ice")
        lines = compiled.files[module].splitlines()
        places.append({(lines[int(line) - 1], at) for line, at in compiled.reflection["source_map"][module].items()})
    assert places[0] == places[1] and len(places[0]) > 100


def test_a_material_of_another_version_is_refused(case: Case, page: EnginePage, tmp_path: Path) -> None:
    emit(case, tmp_path, "ice")
    module = tmp_path / case.module.format("ice")
    module.write_text(module.read_text(encoding="utf-8").replace("version: 1,", "version: 0,"), encoding="utf-8")
    with pytest.raises(
        SssgenError, match="ice was written by another version of sssgen than its runtime: emit it again"
    ):
        drawn(page, "ice", module.name, tmp_path, case.runtime)


def unlit(folder: Path, declarations: str, body: str, target: str) -> Compiled:
    """An unlit material that shows an expression of its parameters and the normal."""
    technique = f"{declarations}{HEAD.format('lighting')}vec3 made(world_direction N) {{ return {body}; }}\n"
    (folder / "made.sss").write_text(technique, encoding="utf-8")
    text = '[material]\nname = "m"\nshading = "unlit"\n[lighting]\ntechnique = "./made.sss"\n'
    (folder / "m.toml").write_text(text, encoding="utf-8")
    return sssgen.compile(str(folder / "m.toml"), target)


def shown(page: EnginePage, compiled: Compiled, **parameters: float) -> Array:
    """The colours that an unlit material without textures gives a mesh."""
    reflection = {**compiled.reflection, "textures": []}
    # a volume that no bake made would be a warning
    files = {name: re.sub(r'needed: "[^"]*"', "needed: null", text) for name, text in compiled.files.items()}
    bare = Compiled({**files, "m.reflection.json": json.dumps(reflection)}, [])
    mesh = mesh_of("wax_mouse")
    given = {name: np.array([value]) for name, value in parameters.items()}
    shell = dataclasses.replace(mesh.shell, parameters=given, ambient=(0.0, 0.0, 0.0))
    colors: Array = page_values.shade(bare, shell, page, mesh.size, mesh.points)[..., :3][mesh.hit]
    return colors


def test_a_name_of_the_engine_has_a_prefix(case: Case, page: EnginePage, tmp_path: Path) -> None:
    """All engines have a `sheen`. The name before, `sheen_`, still works."""
    uniform = "/// A.\nuniform float sheen = 0.25;\n"
    compiled = unlit(tmp_path, uniform, "vec3(sheen) + 0.0 * vec3(N)", case.engine.target)
    (described,) = compiled.reflection["uniforms"]
    assert described["property"] == "sssSheen"
    former = {
        file: text.replace('"property": "sssSheen"', '"property": "sheen_"') for file, text in compiled.files.items()
    }
    assert np.abs(shown(page, compiled) - 0.25).max() < 1e-6
    for one in (compiled, Compiled(former, [])):
        assert np.abs(shown(page, one, sheen=0.75) - 0.75).max() < 1e-6


def test_check_reads_the_modules_of_a_folder(case: Case, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The runtime is no shader."""
    emit(case, tmp_path, "paper_lantern")
    capsys.readouterr()
    assert main(["check", str(tmp_path), "-v"]) == 0
    assert case.runtime not in capsys.readouterr().out


CLONES = {
    "babylonjs": "new Own(values, scene).clone('own')",
    "playcanvas": "new Own(device, values).clone()",
    "threejs": "new Own(values).clone()",
}


def test_a_class_derived_from_a_material_is_cloned(case: Case, page: EnginePage) -> None:
    """The copy has the class, the parameters and the textures, and draws the same."""
    mesh, compiled = mesh_of("ice"), sssgen.compile("ice", case.engine.target)
    module = case.module.format("ice")
    head, _, body = compiled.files[module].partition("export function createMaterial(")
    own = f"""{head}export function createMaterial({body.partition(") {")[0]}) {{
  class Own extends IceMaterial {{ get answer() {{ return 42; }} }}
  const copy = {CLONES[case.engine.target]};
  const names = [IceMaterial.name, copy.constructor.name].join();
  if (names !== 'IceMaterial,Own' || copy.answer !== 42) throw new Error(names);
  return copy;
}}
"""
    derived = Compiled({**compiled.files, module: own}, [])
    pictures = [page_values.shade(one, mesh.shell, page, mesh.size, mesh.points) for one in (compiled, derived)]
    assert (pictures[0] == pictures[1]).all() and pictures[0].std() > 0.02


KINDS = {"samplerCube": "vec3(N)", "sampler3D": "vec3(0.5)", "sampler2DArray": "vec3(0.5)", "sampler2D": "vec2(0.5)"}
TEXELS = {"white": (1.0, 1.0, 1.0), "black": (0.0, 0.0, 0.0), "gray": (0.5, 0.5, 0.5), "bump": (0.5, 0.5, 1.0)}


@pytest.mark.parametrize("kind", KINDS)
def test_a_texture_that_is_not_set_is_one_texel(case: Case, page: EnginePage, kind: str, tmp_path: Path) -> None:
    uniforms = "".join(f"/// A.\nuniform {kind} {name} : default_{name};\n" for name in TEXELS)
    weights = {"white": 0.1, "black": 0.2, "gray": 0.3, "bump": 0.05}
    total = " + ".join(f"{weight} * texture({name}, {KINDS[kind]}).rgb" for name, weight in weights.items())
    colors = shown(page, unlit(tmp_path, uniforms, f"{total} + 0.0 * vec3(N)", case.engine.target))
    expected = sum(weight * np.array(TEXELS[name]) for name, weight in weights.items())
    assert np.abs(colors - expected).max() < 1e-3
