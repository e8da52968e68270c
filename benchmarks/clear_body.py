"""Compares an imported clear body with path tracing: python benchmarks/clear_body.py spot.obj [-o PAIR.png]

The body is a red gummy of glTF: transmission 0.9, roughness 0.2, and a colour of attenuation over its own size. Mitsuba
traces a rough dielectric with an absorbing medium, with the camera, the lamps and the surroundings of the imported
scene. Prints the mean colours of the body, the relative error of blocks of 8 x 8 pixels, and FLIP.
"""

from __future__ import annotations

import argparse
import dataclasses
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from sssgen.cli.main import main as sssgen
from sssgen.interchange.mesh_glb import Buffer, document, glb, primitive
from sssgen.run import backends
from sssgen.run.render.environment_maps import reflection_map
from sssgen.run.render.scene_render import render
from sssgen.run.render.scene_values import environment_of
from sssgen.run.render.several_bodies import tone_mapped
from sssgen.scene import mesh_files
from sssgen.scene.pictures.images import encode_srgb, write_png
from sssgen.scene.pictures.picture_difference import compare
from sssgen.scene.scene import Scene
from sssgen.scene.scene_loading import load

DIFFUSE, ROUGHNESS = 0.1, 0.2
BLOCK = 8
BRIGHTEST = 20.0
"""Brighter samples of the path tracer count as this: they are noise."""


def gummy(mesh: str, path: Path) -> None:
    """A .glb file of a mesh as gummy; the attenuation distance is 0.6 of its largest side."""
    content = mesh_files.read(mesh)
    extensions = {
        "KHR_materials_transmission": {"transmissionFactor": 1.0 - DIFFUSE},
        "KHR_materials_volume": {
            "thicknessFactor": 1.0, "attenuationColor": [0.8, 0.05, 0.04],
            "attenuationDistance": 0.6 * float(np.ptp(content.vertices, axis=0).max()),
        },
        "KHR_materials_ior": {"ior": 1.45},
    }  # fmt: skip
    pbr = {"metallicFactor": 0.0, "roughnessFactor": ROUGHNESS}
    material = {"name": "Gummy", "pbrMetallicRoughness": pbr, "extensions": extensions}
    buffer = Buffer()
    drawn = {**primitive(content._replace(uv=None, uv2=None, color=None), buffer), "material": 0}
    path.write_bytes(glb(document(buffer, [drawn], materials=[material]), bytes(buffer.data)))


def traced(scene: Scene, samples: int) -> Any:
    """The path traced picture, (height, width, 3)."""
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    environment, medium = environment_of(scene), scene.measured["medium"]
    assert environment is not None and scene.geometry is not None
    v, u = np.meshgrid((np.arange(128) + 0.5) / 128, (np.arange(256) + 0.5) / 256, indexing="ij")
    around, polar = 2.0 * np.pi * u, np.pi * v
    ways = np.stack([np.sin(around) * np.sin(polar), np.cos(polar), -np.cos(around) * np.sin(polar)], -1).reshape(-1, 3)
    light = reflection_map(environment).sample(ways.T)[:3].T.reshape(128, 256, 3).astype(np.float32)
    boundary = {
        "type": "roughdielectric", "distribution": "ggx", "alpha": ROUGHNESS**2,
        "int_ior": medium["ior"], "ext_ior": 1.0,
    }  # fmt: skip
    white = {"type": "diffuse", "reflectance": {"type": "rgb", "value": [1.0, 1.0, 1.0]}}
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict({"type": "blendbsdf", "weight": DIFFUSE, "a": boundary, "b": white})
    extinction = np.array(medium["absorption"])
    relative = {"type": "rgb", "value": (extinction / extinction.max()).tolist()}
    properties["interior"] = mi.load_dict(
        {"type": "homogeneous", "albedo": 0.0, "sigma_t": relative, "scale": float(extinction.max())}
    )
    triangles, matrix = scene.geometry.triangles, scene.geometry.to_world()  # type: ignore[attr-defined]
    places = triangles.places @ matrix[:3, :3].T + matrix[:3, 3]
    body = mi.Mesh("body", len(places), len(triangles.corners), has_vertex_normals=True, props=properties)
    parameters = mi.traverse(body)
    parameters["vertex_positions"] = np.ravel(places).astype(np.float32)
    parameters["vertex_normals"] = np.ravel(triangles.normals).astype(np.float32)
    parameters["faces"] = np.ravel(triangles.corners).astype(np.uint32)
    parameters.update()
    camera = scene.camera
    to_world = mi.ScalarTransform4f().look_at(
        origin=list(camera.position), target=list(camera.target), up=[0.0, 1.0, 0.0]
    )
    film = {"type": "hdrfilm", "width": scene.size[0], "height": scene.size[1], "rfilter": {"type": "box"}}
    sensor = {
        "type": "perspective", "fov": camera.field_of_view, "fov_axis": "y", "to_world": to_world, "film": film
    }  # fmt: skip
    lamps = {
        f"lamp {number}": {
            "type": "directional", "direction": [-part for part in lamp.direction or ()],
            "irradiance": {"type": "rgb", "value": [np.pi * part for part in lamp.color]},
        }
        for number, lamp in enumerate(scene.lights)
    }  # fmt: skip
    integrator = {"type": "volpathmis", "max_depth": 24, "rr_depth": 50}
    surroundings = {"type": "envmap", "bitmap": mi.Bitmap(light)}
    parts = {"integrator": integrator, "sensor": sensor, "body": body}
    # apart, so that each has its own number of samples: lamps are rarely met
    pictures = [
        np.array(mi.render(mi.load_dict({"type": "scene", **parts, **lights}), spp=count))[..., :3]
        for lights, count in (({"surroundings": surroundings}, samples), (lamps, 8 * samples))
    ]
    return np.minimum(pictures[0] + pictures[1], BRIGHTEST)


def blocks(picture: Any) -> Any:
    height, width = (side // BLOCK for side in picture.shape[:2])
    return picture[: height * BLOCK, : width * BLOCK].reshape(height, BLOCK, width, BLOCK, -1).mean(axis=(1, 3))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("MESH")
    parser.add_argument("--size", type=int, default=160)
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("-o", "--output", help="a .png file: the imported body, and beside it the path traced one")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        gummy(arguments.MESH, Path(folder, "gummy.glb"))
        if sssgen(["import", f"{folder}/gummy.glb", "-o", f"{folder}/out"]):
            raise SystemExit("the import failed")
        scene = load(f"{folder}/out/gummy/scene.toml")
        scene = dataclasses.replace(scene, size=(arguments.size, arguments.size), samples=4)
        linear = dataclasses.replace(scene, shell={**scene.shell, "tone_mapping": "none"})
        drawn, reference = render(linear, backends.require("gl")), traced(scene, arguments.samples)
    inside = drawn.covered > 0.99
    whole = blocks(drawn.covered[..., None])[..., 0] > 0.9
    first, second = blocks(drawn.linear)[whole], blocks(reference)[whole]
    print(
        "mean colour of the body:",
        drawn.linear[inside].mean(axis=0).round(3),
        "path traced:",
        reference[inside].mean(axis=0).round(3),
    )
    print(f"relative error of blocks: {np.abs(first - second).mean() / second.mean():.3f}")
    shown = [encode_srgb(tone_mapped(picture, scene.shell)) for picture in (drawn.linear, reference)]
    print(f"FLIP: {compare(*shown).flip:.3f}")
    if arguments.output:
        write_png(arguments.output, np.concatenate(shown, axis=1))


if __name__ == "__main__":
    main()
