"""Writes what the page and the path tracer of a hero read: meshes, bakes, emitted shaders, pictures, hero.json."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import pickle
import runpy
from pathlib import Path

import numpy as np
from scipy.ndimage import map_coordinates

from hero_stage.assets import BUILD, surroundings
from hero_stage.hero import Body, Hero
from hero_stage.mesh import Mesh
from sssgen.cli.main import main as sssgen
from sssgen.material.material_text import toml_value
from sssgen.run.web_library import library

PAGE = Path(__file__).parent
RANK = 16
PROCESSES = 2


@dataclasses.dataclass(frozen=True)
class Model:
    """What a hero's model.py makes."""

    meshes: dict[str, Mesh]
    coarse: dict[str, Mesh]
    """The same, of fewer triangles, for bakes"""
    volumes: dict[str, np.ndarray]
    """(z, y, x, 3): factors, over the box of the mesh of the same name"""
    pictures: dict[str, np.ndarray]
    """(height, width, 3), linear RGB, row 0 above"""


@dataclasses.dataclass(frozen=True)
class Prepared:
    """The files of a hero in its folder of the build."""

    hero: Hero
    folder: Path
    model: Model
    sky: np.ndarray
    """(height, width, 3): radiance, row 0 above; the middle is the direction of x, as three has it"""


def prepare(hero: Hero, cells: int | None = None) -> Prepared:
    """Makes all files that are missing or older than what they are made of. Raises SystemExit for a bake that fails."""
    folder = BUILD / hero.name
    folder.mkdir(parents=True, exist_ok=True)
    model = modelled(hero, folder, cells or hero.cells)
    sky = _sky(hero)
    texels = np.dstack([sky, np.ones_like(sky[..., :1])])[::-1]
    (folder / "sky.bin").write_bytes(np.ascontiguousarray(texels, np.float32).tobytes())
    responses = [bake(hero, body, model.coarse[body.mesh], folder) for body in hero.bodies]
    materials = sorted({body.material for body in hero.bodies})
    for material in materials:
        command = ["emit", str(hero.folder / material), "--target", "threejs", "-o", str(folder), "--json"]
        if sssgen(command):
            raise SystemExit(f"{hero.name}: {material} was not emitted")
    volumes = {}
    for body, response in zip(hero.bodies, responses, strict=True):
        if body.inclusions:
            facts = json.loads((folder / f"{response}.json").read_text("utf-8"))
            mesh, volume = model.meshes[body.mesh], model.volumes[body.inclusions]
            volumes[body.inclusions] = _over_box(volume, mesh, facts["box_min"], facts["box_max"])
    for name, volume in volumes.items():
        (folder / f"{name}.volume").write_bytes(np.rint(255.0 * np.clip(volume, 0, 1)).astype(np.uint8).tobytes())
    for name, picture in model.pictures.items():
        _write_picture(picture, folder / f"{name}.png")
    web = library()
    for file, source in web.files.items():
        target = folder / "library" / file
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(source.read_bytes())
    page = (PAGE / "index.html").read_text("utf-8").replace("IMPORT_MAP", web.import_map())
    (folder / "index.html").write_text(page, "utf-8")
    (folder / "stage.js").write_text((PAGE / "stage.js").read_text("utf-8"), "utf-8")
    stage = dataclasses.asdict(hero) | {
        "sky": [sky.shape[1], sky.shape[0]],
        "volumes": {name: [*volume.shape[2::-1], volume.shape[3]] for name, volume in volumes.items()},
    }
    for body, response in zip(stage["bodies"], responses, strict=True):
        body["response"] = response
    (folder / "hero.json").write_text(json.dumps(stage, indent=1, default=dict), "utf-8")
    return Prepared(hero, folder, model, sky)


def bake_name(hero: Hero, body: Body, coarse: Mesh) -> str:
    """The name of the bake of a body: of its mesh, its medium and the photons."""
    key = (
        json.dumps([dict(body.medium), body.voxels, hero.photons], sort_keys=True).encode()
        + np.round(coarse.vertices, 4).tobytes()
    )
    return f"{body.mesh}_{hashlib.sha256(key).hexdigest()[:8]}"


def modelled(hero: Hero, folder: Path, cells: int) -> Model:
    """The model, kept until its model.py changes."""
    source = hero.folder / "model.py"
    key = hashlib.sha256(f"{source.read_text('utf-8')}{cells}".encode()).hexdigest()
    kept = folder / "model.pickle"
    if kept.is_file():
        known, model = pickle.loads(kept.read_bytes())
        if known == key:
            return model
    module = runpy.run_path(str(source))
    meshes = module["meshes"](cells)
    coarse = module["meshes"](hero.bake_cells) if hero.bake_cells else meshes
    model = Model(
        meshes, coarse, module["volumes"](meshes) if "volumes" in module else {},
        module["pictures"]() if "pictures" in module else {},
    )  # fmt: skip
    for name, mesh in meshes.items():
        mesh.write_glb(folder / f"{name}.glb")
        model.coarse[name].write_glb(folder / f"{name}_coarse.glb")
    kept.write_bytes(pickle.dumps((key, model)))
    return model


def _over_box(volume: np.ndarray, mesh: Mesh, low: list[float], high: list[float]) -> np.ndarray:
    """A volume over the box of a mesh as one over another box, whose texels are cells."""
    start, end = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    axes = [
        (a + (np.arange(count) + 0.5) / count * (b - a) - first) / (last - first) * (count - 1)
        for a, b, first, last, count in zip(low, high, start, end, volume.shape[2::-1], strict=True)
    ]
    places = np.meshgrid(*axes[::-1], indexing="ij")
    return np.stack([map_coordinates(volume[..., part], places, order=1, mode="nearest") for part in range(3)], axis=-1)


def _sky(hero: Hero) -> np.ndarray:
    """The picture of the surroundings as it lights the hero."""
    around = hero.surroundings
    picture = np.minimum(surroundings(around.picture) * around.intensity, around.brightest)
    return np.roll(picture, round(around.turn / 360.0 * picture.shape[1]), axis=1)


def bake(hero: Hero, body: Body, coarse: Mesh, folder: Path) -> str | None:
    """The file of the response of a body to all lights, made where it is missing; None where nothing scatters, or
    without voxels."""
    if not any(body.medium.get("scattering", ())) or not body.voxels:
        return None
    output = folder / f"{bake_name(hero, body, coarse)}.bin"
    if output.is_file():
        return output.name
    keys = "".join(f"{key} = {toml_value(value)}\n" for key, value in body.medium.items())
    scene = folder / "bake.toml"
    scene.write_text(
        f'material = "ice"\n[geometry]\nkind = "mesh"\nfile = "{body.mesh}_coarse.glb"\n'
        f"[[light]]\ndirection = [0.0, 1.0, 0.0]\n[medium]\n{keys}", "utf-8"
    )  # fmt: skip
    command = ["bake", "fluence", str(scene), "--relit", str(RANK), "--voxels", str(body.voxels)]
    command += ["--photons", str(hero.photons), "--processes", str(PROCESSES), "-o", str(output)]
    if sssgen(command):
        raise SystemExit(f"{body.mesh} was not baked")
    return output.name


def _write_picture(picture: np.ndarray, path: Path) -> None:
    from PIL import Image

    from sssgen.scene.pictures.images import encode_srgb

    encoded = encode_srgb(np.clip(picture, 0.0, 1.0))
    Image.fromarray(np.rint(255.0 * encoded).astype(np.uint8)).save(path)
