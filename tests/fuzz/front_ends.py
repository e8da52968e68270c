"""Everything that reads a file of the user's, each as a function of a path, and files for it to begin with."""

from __future__ import annotations

import contextlib
import json
import re
from collections.abc import Callable
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image

from amounts import COUNTED
from folders import TESTS
from gltf_files import box, data_uri, inlined, png
from ir_sample import SAMPLE
from sssgen.analyse.verify.inline_includes import expand
from sssgen.bake import bake_light as light
from sssgen.bake.volume_files import encode_volume
from sssgen.interchange import gltf_reader
from sssgen.interchange.mapping_report import Report
from sssgen.ir.nodes import Span
from sssgen.ir.text import print_module
from sssgen.ir.text_reader import TextError, read_module
from sssgen.lang.loader import load_file, load_text
from sssgen.lang.plain_glsl import load_glsl, load_glsl_text
from sssgen.material import baked
from sssgen.material.library import TECHNIQUES, load_path
from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import compile, transpile
from sssgen.run.check import shader_files
from sssgen.run.evaluate import input_files as inputs
from sssgen.run.evaluate import probes
from sssgen.run.evaluate.evaluation import fit_inputs
from sssgen.scene import scene_loading
from sssgen.scene.measured import measured_scene
from sssgen.scene.mesh import Mesh
from sssgen.scene.pictures import images
from sssgen.support import paths as data
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.support.text_files import read_text
from sssgen.targets.texture_import import import_settings
from sssgen.testing import project_run as ci
from watchdog import bounded

NAME = "fuzzed"
"""What the files are called, before their suffix."""

CORPUS = TESTS / "transpile"
"""Plain GLSL of every construct."""


class FrontEnd(NamedTuple):
    """A reader of files."""

    suffix: str
    read: Callable[[Path], object]
    """Raises SssgenError for what it does not take, and nothing else."""
    seeds: Callable[[], list[bytes]]
    """Files that it takes."""
    is_text: bool = True


def _source(path: Path) -> None:
    module = load_file(path, (TECHNIQUES,))
    for target in ("wgsl", "numpy"):  # those two are rewritten the most
        transpile(module, target, "fuzzed")


def _plain(path: Path) -> None:
    module = load_glsl(path, path.name).module
    for target in ("wgsl", "hlsl"):
        transpile(module, target, "fuzzed", keep=True)


def _material(path: Path) -> None:
    compile(load_material(path), "glsl-330")


def _module(path: Path) -> None:
    text = read_text(path, path.name)
    try:
        read_module(text)
    except TextError as error:
        place = Span(path.name, error.line, error.column, error.line, error.column + 1)
        raise SssgenError([Diagnostic("error", error.message, place)]) from None


def _checked(path: Path) -> None:
    shader_files.read([str(path)], [])


def _reflection(path: Path) -> None:
    """Read as a file next to a shader."""
    shader = path.with_name(path.name.removesuffix(".reflection.json"))
    shader.write_text("vec3 f(vec3 x) { return x; }\n", encoding="utf-8")
    shader_files.read([str(shader)], [])


@cache
def _subject() -> probes.Subject:
    return probes.subject("lobe_gdc2011")


def _inputs(path: Path) -> None:
    values = inputs.read(str(path), _subject())
    with contextlib.suppress(SssgenError):  # which names the input, and knows of no file
        fit_inputs(_subject(), values)


def _ci(path: Path) -> None:
    """A table of numbers: what is wrong with it is the case's outcome, which names the file."""
    with ci.Run() as run:
        ran = run(ci.Case("eval", str(path), ("numpy-f32",)))
    assert "a fault of sssgen" not in ran.outcome.text, ran.outcome.text


def _ci_folder(path: Path) -> None:
    ci.cases(str(path.parent))


def _examples(pattern: str, but: str = "") -> list[bytes]:
    result = sorted(data.folder("examples").glob(pattern))
    return [path.read_bytes() for path in result if path.parent.name != but]


def _scenes() -> list[bytes]:
    """The examples' scenes, whose surroundings are elsewhere: they are read in a folder of their own."""
    surroundings = f'"{(data.folder("examples") / "surroundings").as_posix()}/'.encode()
    return [seed.replace(b'"../surroundings/', surroundings) for seed in _examples("*/scene.toml")]


def _sources() -> list[bytes]:
    own = sorted(Path(TECHNIQUES).rglob("*.sss"), key=lambda path: (path.stat().st_size, path.name))
    return [SAMPLE.encode(), *(path.read_bytes() for path in own[::6])]


def _plain_sources() -> list[bytes]:
    """The corpus of plain GLSL, each file with its includes in it."""
    files = [path for path in sorted(CORPUS.iterdir()) if path.is_file() and ".shadertoy." not in path.name]
    return [expand(path.read_text("utf-8"), path).encode() for path in files if path.name != "array_results.glsl"]


def _techniques() -> list[bytes]:
    """Techniques by the name of the file that `survives` writes."""
    own = sorted(Path(TECHNIQUES).glob("[!c]*/*.sss"))
    return [re.sub(rb"\b%b(?=\()" % path.stem.encode(), NAME.encode(), path.read_bytes()) for path in own[::6]]


def _modules() -> list[bytes]:
    return [print_module(load_text(text.decode(), "seed.sss", (TECHNIQUES,))).encode() for text in _sources()[:4]]


def _shaders() -> list[bytes]:
    return [text.encode() for name, text in compile("jelly_cubes", "glsl-330").files.items() if name.endswith(".frag")]


def _reflections() -> list[bytes]:
    """That of a transpiled file, which may have any name; the only one."""
    module = load_glsl_text("vec3 f(vec3 x) { return x; }", "f.glsl").module
    return [list(transpile(module, "glsl-330", "f", keep=True).files.values())[-1].encode()]


def _numbers() -> list[bytes]:
    values = {"V": [0, 0, 1], "N": [[0, 0, 1], [0, 0.6, 0.8]], "L": [0, 0, -1], "through": 0.5, "distortion": 0.2}
    return [json.dumps(values).encode()]


def _tables() -> list[bytes]:
    table = {"technique": "lobe_gdc2011", "samples": 4, "seed": 1, "tolerance": 1e-5, "inputs": {"through": 0.5}}
    return [json.dumps(table).encode()]


def _picture(mode: str, **options: object) -> bytes:
    file = BytesIO()
    Image.new(mode, (5, 3), 1).save(file, "PNG", **options)
    return file.getvalue()


def _pngs() -> list[bytes]:
    return [*(_picture(mode) for mode in ("1", "L", "LA", "P", "RGB", "RGBA", "I;16")), _picture("P", transparency=0)]


def _arrays() -> list[bytes]:
    results = []
    for array in (np.zeros((2, 3)), np.ones((2, 2, 3), np.uint8), np.zeros((2, 2, 2, 4), np.float32)):
        file = BytesIO()
        np.save(file, array)
        results.append(file.getvalue())
    return results


@cache
def _exrs() -> list[bytes]:
    from tempfile import TemporaryDirectory

    with TemporaryDirectory() as folder:
        path = Path(folder, "seed.exr")
        images.write_exr(path, np.linspace(0.0, 1.0, 2 * 3 * 3).reshape(2, 3, 3))
        return [path.read_bytes()]


def _mesh(path: Path) -> None:
    _ = Mesh(path=str(path)).triangles


def _imported(path: Path) -> None:
    gltf_reader.read(str(path), Report(path.name))


def _gltf_files() -> list[bytes]:
    """A cube with a volume and a texture, in one file."""
    volume = {"thicknessFactor": 0.5, "attenuationDistance": 2.0, "attenuationColor": [0.5, 0.25, 1.0]}
    scatter = {"multiscatterColor": [0.9, 0.5, 0.1], "scatterAnisotropy": 0.5}
    extensions = {"transmission": {"transmissionFactor": 1.0}, "volume": volume, "volume_scatter": scatter}
    transform = {"KHR_texture_transform": {"rotation": 0.5, "scale": [2.0, 2.0]}}
    material = {
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": transform}},
        "extensions": {f"KHR_materials_{name}": value for name, value in extensions.items()},
    }
    content, data = box(material, textures=[{"source": 0}], images=[{"uri": data_uri(png((1, 2, 3)))}])
    return [inlined(content, data)]


def _volumes(kind: str) -> Callable[[], list[bytes]]:
    def contents() -> list[bytes]:
        types = (np.uint8, np.uint16, np.float16, np.float32)
        volumes = [np.ones((2, 3, 4), dtype) for dtype in types]
        return [encode_volume(volume, kind) for volume in volumes]

    return contents


def _baked() -> list[bytes]:
    facts = {"format": 1, "kind": "distance", "holds": None, "parameters": {"box_min": [0, 0, 0]}}
    return [json.dumps(facts | {"import": import_settings("3D", "clamp")}).encode()]


def _lights() -> list[bytes]:
    return [b'{"direction": [0.0, 1.0, -2.5]}', b'{"position": [1, 2, 3]}']


def _meshes(kind: str) -> Callable[[], list[bytes]]:
    def contents() -> list[bytes]:
        import trimesh

        exported = trimesh.creation.box().export(file_type=kind)
        return [exported.encode() if isinstance(exported, str) else exported]

    return contents


FRONT_ENDS = {
    "technique": FrontEnd(".sss", lambda path: load_path(str(path)), _techniques),
    "source": FrontEnd(".glsl", _source, _sources),
    "plain glsl": FrontEnd(".glsl", _plain, _plain_sources),
    "material": FrontEnd(".toml", _material, lambda: _examples("*/[!s]*.toml", but="lab")),
    "scene": FrontEnd(".toml", lambda path: scene_loading.load(path), _scenes),
    "measured scene": FrontEnd(".toml", lambda path: measured_scene.load(str(path)), lambda: _examples("lab/*.toml")),
    "ci table": FrontEnd(".eval.json", _ci, _tables),
    "ci folder": FrontEnd(".toml", _ci_folder, lambda: _examples("ci/*/*.toml")),
    "module": FrontEnd(".ir", _module, _modules),
    "checked shader": FrontEnd(".frag", _checked, _shaders),
    "reflection": FrontEnd(".glsl.reflection.json", _reflection, _reflections),
    "inputs": FrontEnd(".json", _inputs, _numbers),
    "png": FrontEnd(".png", images.read, _pngs, False),
    "exr": FrontEnd(".exr", images.read, _exrs, False),
    "npy": FrontEnd(".npy", images.read, _arrays, False),
    "dds": FrontEnd(".dds", images.read, _volumes("dds"), False),
    "ktx2": FrontEnd(".ktx2", images.read, _volumes("ktx2"), False),
    "baked": FrontEnd(".png.json", lambda path: baked.read_bake_file(str(path).removesuffix(".json")), _baked),
    "light": FrontEnd(".json", lambda path: light.read_light(str(path)), _lights),
    "obj": FrontEnd(".obj", _mesh, _meshes("obj"), False),
    "ply": FrontEnd(".ply", _mesh, _meshes("ply"), False),
    "stl": FrontEnd(".stl", _mesh, _meshes("stl"), False),
    "glb": FrontEnd(".glb", _mesh, _meshes("glb"), False),
    "imported gltf": FrontEnd(".gltf", _imported, _gltf_files, False),
    "imported glb": FrontEnd(".glb", _imported, _meshes("glb"), False),
}


WHOLE = re.compile(
    "the file (is too large|is empty|has no function)|no such file"
    "|this is (a folder|not a (file|reflection|valid file name))|cannot read|cannot find the (picture|mesh|light)"
    "|no technique is named|nothing to compile|there is nothing to check|the lists are nested"
    "|a number has thousands|the inputs are no"
    "|this is of another format|'parameters' and|the light has|a light's|this direction"
    "|'.*' is not a picture file's suffix|the format is not 1|the light needs"
    "|'samples' is|unknown key|texture '.*' is given"
)
"""The errors of texts that are about the whole file, or about a JSON value, whose place json does not tell."""


def survives(front_end: FrontEnd, content: bytes, folder: Path) -> bool:
    """Whether a file of this content is taken. Fails where it is refused by anything but errors with their places."""
    path = folder / f"{NAME}{front_end.suffix}"
    path.write_bytes(content)
    return accepts(front_end, path)


def accepts(front_end: FrontEnd, path: Path) -> bool:
    """The same for a path."""
    COUNTED["files"] += 1
    try:
        with bounded(what=f"reading {path.name}"):
            front_end.read(path)
    except SssgenError as error:
        assert error.diagnostics
        for result in error.diagnostics:
            assert result.span.file, f"an error without a file: {result}"
            assert result.span.line or not front_end.is_text or WHOLE.match(result.message), f"without a line: {result}"
            result.render().encode("utf-8", "replace")
        assert len(str(error)) < 200_000
        return False
    return True
