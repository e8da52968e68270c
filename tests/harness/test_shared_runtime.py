"""Modules for engines of the web: the materials in a folder share one runtime; a standalone module has it inside."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import sssgen
from engine_cases import mesh_of
from skips import or_skip
from sssgen.cli.main import main
from sssgen.harness.backends import Array
from sssgen.harness.backends.engine_page import Engine, EnginePage
from sssgen.harness.backends.three_page import THREE
from sssgen.harness.render import page_values
from sssgen.pipeline.compiler import Compiled
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry


class Case(NamedTuple):
    engine: Engine
    renderer: str
    runtime: str
    module: str
    """The name of a material's module."""


CASES = [
    Case(THREE, "webgl", "sssgen-three.js", "{}.js"),
]
NAMES = ("ice", "paper_lantern")


@pytest.fixture(scope="module", params=CASES, ids=lambda case: case.engine.target)
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


def test_a_former_name_is_another_name(case: Case, page: EnginePage) -> None:
    """`sssAmbient` was `ambient_`, where the engine has an `ambient` of its own."""
    mesh = mesh_of("ice")
    compiled = sssgen.compile("ice", case.engine.target)
    taken = registry.load(case.engine.target).properties.taken
    values = {"metalness": 0.75} if "metalness" in taken else {"ambient": 0.75}
    (name, value), *_ = values.items()
    assert name in taken
    pictures = []
    for prefixed in (f"sss{name.capitalize()}", f"{name}_"):
        files = {
            file: text.replace(f'"property": "sss{name.capitalize()}"', f'"property": "{prefixed}"')
            for file, text in compiled.files.items()
        }
        shell = dataclasses.replace(mesh.shell, parameters={**mesh.shell.parameters, name: np.array([value])})
        pictures.append(page_values.shade(Compiled(files, []), shell, page, mesh.size, mesh.points))
    plain = page_values.shade(compiled, mesh.shell, page, mesh.size, mesh.points)
    assert (pictures[0] == pictures[1]).all() and np.abs(pictures[0] - plain).max() > 0.02


def test_check_reads_the_modules_of_a_folder(case: Case, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The runtime is no shader."""
    emit(case, tmp_path, "paper_lantern")
    capsys.readouterr()
    assert main(["check", str(tmp_path), "-v"]) == 0
    assert case.runtime not in capsys.readouterr().out
