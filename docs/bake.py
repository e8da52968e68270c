"""Bakes both meshes, draws docs/bake/ and writes docs/bake.md: python docs/bake.py [FOLDER OF THE MESHES]

It runs the commands in the scenes of examples/bake, in a copy of that folder. The meshes are not part of the project:
Spot (Keenan Crane, CC0) and Suzanne (Blender's monkey), as spot.obj and suzanne.obj.
"""

from __future__ import annotations

import io
import json
import re
import shlex
import shutil
import sys
from pathlib import Path
from typing import Any

import bake_reference
import numpy as np

from sssgen.cli.main import main as sssgen
from sssgen.scene.mesh import Mesh
from sssgen.scene.pictures import images
from sssgen.scene.pictures.picture_difference import compare
from sssgen.support.extras import need
from sssgen.support.file_writer import write_files
from sssgen.targets.runtime.numpy_textures import Texture

DOCS = Path(__file__).parent
PAGE, FOLDER = DOCS / "bake.md", DOCS / "bake"
WORK = DOCS.parent / "build" / "bake" / "page"
MESHES = DOCS.parent.parent / "shared" / "data" / "meshes"
NAMES = {"spot": "Spot", "suzanne": "Suzanne"}
WAYS = {
    "distance": ("distance texture, marched", "deep"),
    "map": ("thickness map", "light"),
    "depth": ("depth map", "light"),
}
"""The scenes of the techniques: title, and the name of the exact reference."""
FINE = 360
"""The number of points along the height of a slice."""


def main() -> int:
    """Bakes the textures, draws the pictures, and writes the page."""
    meshes = Path(sys.argv[1]) if len(sys.argv) > 1 else MESHES
    missing = [name for name in NAMES if not (meshes / f"{name}.obj").is_file()]
    if missing:
        print(f"{', '.join(f'{name}.obj' for name in missing)} are not in {meshes}: name their folder")
        return 2
    copy(meshes)
    commands = [command for scene in sorted(WORK.glob("*.toml")) for command in commands_of(scene)]
    for command in commands:
        print(f"$ {command}", flush=True)
        if sssgen(in_folder(shlex.split(command)[1:])):
            return 1
    pictures = {"slices.png": slices(), "maps.png": maps(), "cells.png": cells()}
    rows, pictures["renders.png"] = renders()
    ice, pictures["ice.png"] = ice_row()
    write_files(FOLDER, pictures)
    text = (FOLDER / "page.md.in").read_text(encoding="utf-8")
    parts = {"facts": facts(), "renders": rows, "ice": ice, "json": sidecar()}
    for name, part in parts.items():
        assert text.count(f"<!-- {name} -->") == 1, name
        text = text.replace(f"<!-- {name} -->", part)
    PAGE.write_text(text, encoding="utf-8")
    print(f"wrote {PAGE}")
    return 0


def copy(meshes: Path) -> None:
    """Copies the examples and the meshes into the work folder."""
    shutil.rmtree(WORK.parent, ignore_errors=True)
    shutil.copytree(DOCS.parent / "examples" / "bake", WORK)
    shutil.copytree(DOCS.parent / "examples" / "ice", WORK.parent / "ice")
    for name in NAMES:
        shutil.copy(meshes / f"{name}.obj", WORK)
    shutil.copy(FOLDER / "exact_thickness.sss", WORK)


def commands_of(scene: Path) -> list[str]:
    """The commands in a scene's first lines, which bake its textures."""
    return re.findall(r"^# (sssgen bake [^;\n]*)", scene.read_text(encoding="utf-8"), re.MULTILINE)


def in_folder(words: list[str]) -> list[str]:
    """The words of a command, with paths in the work folder."""
    return [str(WORK / word) if re.search(r"\.(obj|npy|png|exr|json)$", word) else word for word in words]


def facts_of(name: str) -> dict[str, Any]:
    """The JSON file of a baked texture."""
    loaded: dict[str, Any] = json.loads((WORK / f"{name}.json").read_text(encoding="utf-8"))
    return loaded


def facts() -> str:
    """The table of the baked textures and their errors."""
    rows = ["| | texels | range | error, as in the JSON file |", "|---|---|---|---|"]
    for name, title in NAMES.items():
        volume, chord, depth = facts_of(f"{name}.npy"), facts_of(f"{name}_thickness.png"), facts_of(f"{name}_depth.exr")
        x, y, z = volume["texels"]
        fine, spread, size = volume["error"], chord["error"], depth["file"]["size"]
        rows += [
            f"| {title}, distance texture | {x} × {y} × {z} | ±{volume['range']:.3g} | {fine['at_texels']:.1e} at "
            f"texels, ≤ {fine['between_texels']:.2g} between (a texel is {volume['voxel'][0]:.2g}) |",
            f"| {title}, thickness map | {chord['texels']} | 0 to {chord['range'][1]:.3g} | mean "
            f"{'standard ' if chord['rays'] else ''}error {spread['mean_standard_error']:.1e}, "
            f"≤ {spread['largest_standard_error']:.1e}; {method(chord)} |",
            f"| {title}, depth map | {size['x']} × {size['y']} | {depth['range'][0]:.3g} to {depth['range'][1]:.3g} | "
            "only the rounding to float32 |",
        ]
    return "\n".join(rows)


def method(chord: Any) -> str:
    """How the lengths of a thickness map were computed."""
    if not chord["rays"]:
        return "an integral over the triangles"
    return f"{chord['rays']} rays per texel, {chord['lost_rays']:.2%} lost in holes"


def sidecar() -> str:
    """The JSON file of Spot's distance texture."""
    return f"```json\n{(WORK / 'spot.npy.json').read_text(encoding='utf-8')}```"


def slices() -> bytes:
    """Slices of each volume, interpolated as in a shader, with the exact distance and the difference."""
    plots = need("matplotlib.pyplot", "matplotlib", "chart")
    plots.switch_backend("agg")
    figure, axes = plots.subplots(len(NAMES), 3, figsize=(11, 7.4), layout="constrained")
    for row, (name, title) in zip(axes, NAMES.items(), strict=True):
        baked_facts = facts_of(f"{name}.npy")
        low, high, voxel = np.array(baked_facts["box_min"]), np.array(baked_facts["box_max"]), baked_facts["voxel"][0]
        texture = Texture(images.read(WORK / f"{name}.npy"), wrap="clamp")
        y, z = np.meshgrid(*(np.linspace(low[at], high[at], FINE) for at in (1, 2)), indexing="ij")
        places = np.stack([np.full(y.size, 0.5 * (low[0] + high[0]) + 0.07), y.ravel(), z.ravel()], axis=1)
        uvw = ((places - low) / (high - low)).T
        baked = ((2.0 * texture.sample(uvw)[0] - 1.0) * baked_facts["range"]).reshape(y.shape)
        exact = Mesh(path=str(WORK / f"{name}.obj")).distance(places).reshape(y.shape)
        window = {"origin": "lower", "extent": (low[2], high[2], low[1], high[1])}
        limit = float(np.abs(exact).max())
        for axis, values, kind in ((row[0], baked, "baked"), (row[1], exact, "exact")):
            picture = axis.imshow(values, cmap="RdBu", vmin=-limit, vmax=limit, **window)
            axis.contour(z, y, values, np.arange(-1.0, 2.0, 0.1), colors="black", linewidths=0.35)
            axis.contour(z, y, values, [0.0], colors="black", linewidths=1.6)
            axis.set_title(f"{title}: {kind} distance")
            figure.colorbar(picture, ax=axis, shrink=0.8)
        apart = np.abs(baked - exact) / voxel
        picture = row[2].imshow(apart, cmap="magma", vmin=0.0, vmax=0.5, **window)
        row[2].contour(z, y, exact, [0.0], colors="white", linewidths=0.8)
        row[2].set_title(f"texels off; median {np.median(apart):.3f}")
        figure.colorbar(picture, ax=row[2], shrink=0.8)
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=80, metadata={"Software": None})
    plots.close(figure)
    return data.getvalue()


def maps() -> bytes:
    """The thickness and depth maps, in false colours."""
    pictures = []
    for name in NAMES:
        chord = images.upright(WORK / f"{name}_thickness.png")[..., 0]
        depth = images.upright(WORK / f"{name}_depth.exr")[..., 0]
        low, nothing = depth.min(), facts_of(f"{name}_depth.exr")["nothing"]
        high = depth[depth < nothing].max()
        pictures += [colored(chord), colored(np.where(depth < nothing, 1.0 - (depth - low) / (high - low), 0.0))]
    return joined([pictures])


def colored(values: Any) -> Any:
    """Values 0..1 in the colours of viridis."""
    colors = need("matplotlib", extra="chart").colormaps["viridis"]
    return colors(np.clip(values, 0.0, 1.0))[..., :3]


def cells() -> bytes:
    """Tileable cells with their normals, repeated twice each way, and the other features."""
    pictures = []
    for feature in ("faceted", "f1", "f2-f1"):
        file = str(WORK / f"tile_{feature}.png")
        options = ["--size", "192", "--cells", "6", "--jitter", "0.8", "--feature", feature]
        sssgen(["bake", "voronoi", "-o", file, *options])
        pictures.append(np.tile(images.upright(file), (2, 2, 3)))
    file = str(WORK / "tile_normal.png")
    sssgen(["bake", "normal", str(WORK / "tile_faceted.png"), "-o", file, "--strength", "0.03"])
    pictures.insert(1, np.tile(images.upright(file), (2, 2, 1)))
    return joined([pictures])


def renders() -> tuple[str, bytes]:
    """A table of the differences from the exact references, and the pictures of each mesh with each technique."""
    rows, pictures = ["| | mean FLIP relative to exact thickness |", "|---|---:|"], []
    for name, title in NAMES.items():
        exact = {}
        for way in dict.fromkeys(reference for _, reference in WAYS.values()):
            base = WORK / f"{name}_{'distance' if way == 'deep' else 'depth'}.toml"
            exact[way] = rendered(bake_reference.write(base, f"{name}_exact_{way}", way == "deep"))
        pictures_of = {way: rendered(WORK / f"{name}_{way}.toml") for way in WAYS}
        pictures.append(
            [exact["deep"], pictures_of["distance"], pictures_of["depth"], exact["light"], pictures_of["map"]]
        )
        for way, (technique, reference) in WAYS.items():
            rows.append(f"| {title}, {technique} | {compare(pictures_of[way], exact[reference]).flip:.3f} |")
    return "\n".join(rows), joined([[picture[:, 50:450] for picture in row] for row in pictures], 0.75)


def ice_row() -> tuple[str, bytes]:
    """Ice with baked cells, next to ice with cells computed in the shader."""
    baked, exact = rendered(WORK / "ice_baked_scene.toml"), rendered(WORK.parent / "ice" / "scene.toml")
    return f"FLIP {compare(baked, exact).flip:.3f}", joined([[baked, exact]], 0.75)


def rendered(scene: Path) -> Any:
    """A scene's picture."""
    file = scene.with_suffix(".rendered.png")
    assert sssgen(["render", str(scene), "-o", str(file)]) == 0
    return images.encoded(file)


def joined(rows: list[list[Any]], scale: float = 1.0) -> bytes:
    """Pictures of one size side by side, in rows."""
    picture = np.concatenate([np.concatenate(row, axis=1) for row in rows], axis=0)
    pillow = need("PIL.Image", "pillow")
    image = pillow.fromarray(np.rint(255.0 * picture).astype(np.uint8))
    if scale != 1.0:
        image = image.resize((round(image.width * scale), round(image.height * scale)), pillow.Resampling.LANCZOS)
    data = io.BytesIO()
    image.save(data, "PNG", optimize=True)
    return data.getvalue()


if __name__ == "__main__":
    sys.exit(main())
