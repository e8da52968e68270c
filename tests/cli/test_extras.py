"""Without the optional packages every command works, or names the extra of the project that installs what it needs."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from folders import ROOT
from sssgen.cli.commands import COMMANDS
from sssgen.cli.main import WRONG_INPUT
from sssgen.jobs.executor import Item
from sssgen.lab.chart.charting import Settings, results_of
from sssgen.support.diagnostics import SssgenError
from sssgen.support.installation import install_hint

EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]

ALONE = """
import sys
from sssgen.cli.main import main

REQUIRED = {"sssgen", "jinja2", "markupsafe", "lark", "argcomplete"}

class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {*REQUIRED, *sys.stdlib_module_names}:
            return None
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Blocked())
sys.exit(main(sys.argv[1:]))
"""
"""A process with the required packages only."""

MATERIAL = '[material]\nname = "wax"\n[thickness]\ntechnique = "transmittance_map"\n'
NEEDS: dict[str, str | None] = {
    "list techniques": None,
    "list targets": None,
    "list materials": None,
    "show beer_lambert": None,
    "emit wax.toml -t all -o out": None,
    "watch wax.toml": "preview",
    "check mine.frag": None,
    "transpile half.glsl -t wgsl": None,
    "transpile half.glsl --as technique": None,
    "transpile --stages mine.vert mine.frag -t wgsl -o mine": None,
    "transpile half.glsl --verify": "numpy",
    "lint half.glsl --no-examples --all": None,
    "lint half.glsl": "numpy",
    "eval lobe_exp2 --samples 10": "numpy",
    "stress lobe_exp2 --samples 10": "numpy",
    "preview ice": "preview",
    "render ice": "render",
    "render --compare a.png b.png": "render",
    "ci .": None,
    "chart cube": "chart,reference",
    "pick cube --max-error 0.5": "chart,reference",
    "fit cube lobe_exp2": "chart,reference",
    "use wax a.obj -o out": "import",
    "import lamp.gltf -o out": "import",
    "export-gltf soap -o soap.glb": "import",
    "bake sdf a.obj -o a.npy": "bake",
    "bake thickness a.obj -o a.npy": "bake",
    "bake depth a.obj --direction 0,0,1 -o a.npy": "bake",
    "bake voronoi -o a.png": "bake",
    "bake normal a.png -o b.png": "bake",
    "bake pack --red 0.5 -o b.png": "bake",
    "lsp": "lsp",
    "fmt wax.toml": None,
    "schema scene": None,
    "new wood": None,
    "doctor": None,
    "help emit": None,
    "completion bash": None,
}
"""Command → the extra that it needs, or several."""


def test_every_command_is_here() -> None:
    assert {command.split()[0] for command in NEEDS} == set(COMMANDS)


@pytest.mark.parametrize("command", NEEDS)
def test_a_command_without_the_optional_packages(command: str, tmp_path: Path) -> None:
    (tmp_path / "wax.toml").write_text(MATERIAL, encoding="utf-8")
    (tmp_path / "half.glsl").write_text("float halved(float x) { return 1.0 / x; }\n", encoding="utf-8")
    (tmp_path / "mine.frag").write_text("#version 330\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n", encoding="utf-8")
    (tmp_path / "mine.vert").write_text("#version 330\nvoid main() { gl_Position = vec4(1.0); }\n", encoding="utf-8")
    words = [sys.executable, "-c", ALONE, *command.split(), "--json"]
    done = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, check=False, encoding="utf-8")
    result = json.loads(done.stdout)
    extra = NEEDS[command]
    if extra is None:
        assert done.returncode in (0, 1), done
        assert "diagnostics" not in result or result["ok"]
    else:
        assert done.returncode == WRONG_INPUT, done
        (diagnostic,) = result["diagnostics"]
        package = {"watch": "watchfiles", "lsp": "lsprotocol"}.get(command.split()[0], "numpy")
        assert diagnostic["message"].startswith(f"the package '{package}' is missing")
        assert diagnostic["help"] == install_hint(extra)


def named_extras() -> Iterator[tuple[str, str]]:
    """The extras that hints and documents name, each with its place."""
    for path in [*(ROOT / "src").rglob("*.py"), ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]:
        text = path.read_text(encoding="utf-8")
        for listed in re.findall(r"(?:sssgen-shaders|['\"]\.)\[([\w,-]+)\]", text):
            yield from ((name, path.name) for name in listed.split(","))
        if path.suffix == ".py":
            yield from ((name, path.name) for name in extras_of_calls(ast.parse(text)))
    yield from ((extra, name) for name, command in COMMANDS.items() for extra in command.extra.split(","))


def extras_of_calls(tree: ast.Module) -> Iterator[str]:
    """The extras that are passed to `need` and `install_hint`."""
    position = {"need": 2, "install_hint": 0}
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in position:
            arguments = node.args[position[node.func.id] :][:1]
            arguments += [keyword.value for keyword in node.keywords if keyword.arg == "extra"]
            yield from (str(argument.value) for argument in arguments if isinstance(argument, ast.Constant))


def test_every_named_extra_exists() -> None:
    named = list(named_extras())
    assert {"numpy", "render", "chart", "bake", "cluster", "reference"} <= {name for name, _ in named}
    assert [place for place in named if place[0] not in EXTRAS] == []


def test_a_reference_without_mitsuba_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    item = Item("sssgen.lab.reference.transport_mitsuba:mitsuba", (), "reference of cube")
    monkeypatch.setitem(sys.modules, "mitsuba", None)
    with pytest.raises(SssgenError) as caught:
        results_of([item], Settings(processes=0))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.message.startswith("reference of cube: the package 'mitsuba' is missing")
    assert diagnostic.hint == install_hint("reference")


WITHOUT_OTHER_EXTRAS = """
import sys
for name in ("websockets", "wgpu", "compushady", "mitsuba", "matplotlib"):
    sys.modules[name] = None
from sssgen.cli.main import main
sys.exit(main(sys.argv[1:]))
"""
"""A process without the packages that only other extras than `render`, `numpy` and `gl` have."""


def test_a_picture_needs_no_package_of_another_back_end(tmp_path: Path) -> None:
    for package in ("PIL", "OpenEXR", "trimesh", "igl", "embreex"):
        pytest.importorskip(package, reason=f"{package} is missing: pip install -e '.[render]'")
    command = [sys.executable, "-c", WITHOUT_OTHER_EXTRAS, "render", "ice", "--backend", "numpy-f32", "--size", "8x6"]
    done = subprocess.run([*command, "-o", "ice.png"], capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "ice.png").is_file()
