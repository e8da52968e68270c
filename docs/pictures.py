"""Draws the picture at the top of the README: four of the examples, from the GLSL that `sssgen` emits for them.

    python docs/pictures.py [docs/pictures.png]

The textures and meshes are made here; the drawing is that of examples/opengl_program. It needs moderngl and NumPy.
"""

from __future__ import annotations

import struct
import sys
import zlib
from pathlib import Path
from typing import Any

import moderngl
import numpy as np

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT / "src"), str(ROOT / "examples" / "opengl_program")]
sys.dont_write_bytecode = True  # examples/ goes into the wheel as it is

import program as gl  # noqa: E402 - found by the line above

import sssgen  # noqa: E402

SIZE, SAMPLES = 320, 3
"""The width of one picture, and how many samples a pixel has along each side."""


def shader(context: moderngl.Context, material: str) -> gl.Shader:
    """An example's shader, compiled here and now."""
    made = sssgen.compile(material, "glsl-330")
    texts = [made.files[f"{material}.glsl-330.{end}"] for end in ("vert", "frag")]
    return gl.Shader(context, *texts, made.reflection)


# Textures


def grid(width: int, height: int) -> tuple[Any, Any]:
    """u and v at the texels' centres."""
    v, u = np.mgrid[0:height, 0:width]
    return (u + 0.5) / width, (v + 0.5) / height


def noise(width: int, height: int, seed: int, roughness: float = 2.0) -> Any:
    """Cloudy noise that repeats, from 0 to 1: white noise whose spectrum falls with the frequency."""
    frequency = np.hypot(np.fft.fftfreq(height)[:, None] * height, np.fft.fftfreq(width) * width)
    white = np.fft.fft2(np.random.default_rng(seed).standard_normal((height, width)))
    clouds = np.fft.ifft2(white / np.maximum(frequency, 1.0) ** roughness).real
    return np.clip(0.5 + clouds / (5.0 * clouds.std()), 0.0, 1.0)


def texels(*channels: Any) -> Any:
    """Channels from 0 to 1 as RGBA texels; one alone is gray, alpha is 1."""
    colour = channels if len(channels) > 1 else channels * 3
    full = [*np.broadcast_arrays(*colour), np.ones_like(colour[0])][:4]
    return np.round(255.0 * np.stack(full, axis=-1)).astype(np.uint8)


def bumps(height: Any, strength: float) -> Any:
    """A normal map of a height map, y up."""
    across = (np.roll(height, 1, 1) - np.roll(height, -1, 1)) * strength
    along = (np.roll(height, 1, 0) - np.roll(height, -1, 0)) * strength
    length = np.sqrt(across**2 + along**2 + 1.0)
    return texels(0.5 + 0.5 * across / length, 0.5 + 0.5 * along / length, 0.5 + 0.5 / length)


def blend(low: Any, high: Any, weight: Any) -> list[Any]:
    """Two colours mixed, a channel each."""
    return [a + (b - a) * weight for a, b in zip(low, high, strict=True)]


# Meshes


def tube(curve: Any, radius: float, around: int = 48) -> tuple[Any, Any]:
    """The mesh of a closed curve's tube: u along it, v around it."""
    points = np.vstack([curve, curve[:1]])
    ahead = np.roll(curve, -1, 0) - np.roll(curve, 1, 0)
    ahead = np.vstack([ahead, ahead[:1]]) / np.linalg.norm(np.vstack([ahead, ahead[:1]]), axis=1)[:, None]
    side = np.cross(ahead, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side, axis=1)[:, None]
    up = np.cross(side, ahead)
    turn = np.linspace(0.0, 2.0 * np.pi, around + 1)
    normal = np.cos(turn)[:, None] * side[:, None] + np.sin(turn)[:, None] * up[:, None]
    position = points[:, None] + radius * normal
    u, v = np.meshgrid(np.linspace(0.0, 1.0, len(points)), turn / (2.0 * np.pi), indexing="ij")
    tangent = np.broadcast_to(ahead[:, None], normal.shape)
    parts = [position, normal, tangent, np.ones((*u.shape, 1)), u[..., None], v[..., None]]
    a = (np.arange(len(curve))[:, None] * (around + 1) + np.arange(around)).ravel()
    b = a + around + 1
    triangles = np.concatenate([np.stack([a, b, a + 1]), np.stack([a + 1, b, b + 1])], axis=1).T
    return np.concatenate(parts, axis=-1).reshape(-1, 12), triangles


def quad(width: float, height: float) -> tuple[Any, Any]:
    """A rectangle that looks along +z."""
    corners = [
        (x * width / 2, y * height / 2, 0, 0, 0, 1, 1, 0, 0, 1, (x + 1) / 2, (y + 1) / 2)
        for y in (-1, 1)
        for x in (-1, 1)
    ]
    return np.array(corners, float), np.array([(0, 1, 2), (2, 1, 3)])


# The pictures: each sets up its shader, its textures and its light, and draws.


def jelly_cubes(context: moderngl.Context) -> None:
    """The whole scene is in the shader, which covers the screen."""
    context.disable_direct(gl.FRAMEBUFFER_SRGB)  # its output technique encodes
    drawn = shader(context, "jelly_cubes")
    for name, value in {"time": 1.2, "aspect": 1.0, "look_at": (0.72, 0.3, 0.0), "focal_length": 1.9}.items():
        drawn.put(name, value)
    drawn.put("orbit_height", 2.1)
    drawn.put("jelly_color", (0.62, 0.16, 0.05))
    drawn.put("sky_color", (0.35, 0.5, 0.75))
    drawn.put("glow_strength", 1.6)
    drawn.draw([], [])


def paper_lantern(context: moderngl.Context) -> None:
    """A paper ball with ribs; the lamp is inside it."""
    drawn = shader(context, "paper_lantern")
    _, v = grid(1024, 512)
    fibres = noise(1024, 512, 1, 1.2)
    away = np.abs((v * 14.0 + 0.5) % 1.0 - 0.5) / 14.0  # from the nearest rib
    rib = np.clip(1.6 - away / 0.0035, 0.0, 1.0)
    rib = np.maximum(rib, np.clip((np.abs(v - 0.5) - 0.42) * 200.0, 0.0, 1.0))  # the rings at both ends
    drawn.picture("base_color_texture", texels(*blend((0.92, 0.88, 0.8), (0.16, 0.07, 0.03), rib)))
    drawn.picture("thickness_texture", texels(np.maximum(0.25 + 0.5 * (fibres - 0.5), rib)))
    drawn.picture("normal_texture", bumps(0.3 * fibres - 2.0 * away * 14.0, 1.6))
    lights = [((0.0, 0.1, 0.0, 1.0), (0.8, 0.66, 0.5)), ((0.6, 0.8, 0.7, 0.0), (0.05, 0.055, 0.08))]
    gl.view(drawn, (0.0, 0.25, 3.25), (0.0, 0.0, 0.0), 1.0, lights, (0.02, 0.02, 0.03))
    drawn.draw(*gl.sphere(128, 256))


def wax_knot(context: moderngl.Context) -> None:
    """The candle's wax, on a knot whose distance texture is made here."""
    drawn = shader(context, "wax_suzanne")
    s = np.linspace(0.0, 2.0 * np.pi, 384, endpoint=False)
    knot = np.stack([np.sin(s) + 2 * np.sin(2 * s), np.cos(s) - 2 * np.cos(2 * s), -np.sin(3 * s)], axis=1) * 0.36
    radius, size, extent = 0.24, 64, 1.4
    axis = (np.arange(size) + 0.5) / size * 2.0 * extent - extent
    nearest = np.full((size,) * 3, np.inf)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    for point in knot:
        nearest = np.minimum(nearest, (x - point[0]) ** 2 + (y - point[1]) ** 2 + (z - point[2]) ** 2)
    distance = np.sqrt(nearest) - radius
    drawn.picture("distance_map", (0.5 + 0.5 * distance).astype(np.float32)[..., None])
    drawn.put("box_min", [-extent] * 3)
    drawn.put("box_max", [extent] * 3)
    drawn.put("attenuation_distance", 0.2)
    lights = [((-1.2, 1.6, -1.4, 1.0), (5.0, 4.8, 4.4)), ((0.8, 0.9, 0.6, 0.0), (0.10, 0.10, 0.12))]
    gl.view(drawn, (0.0, 0.3, 4.1), (0.0, 0.0, 0.0), 1.0, lights, (0.02, 0.02, 0.025))
    drawn.draw(*tube(knot, radius))


def ice_inlay(context: moderngl.Context) -> None:
    """Leaves in a sheet of ice that leans back, the sun behind it."""
    drawn = shader(context, "ice_inlay")
    u, v = grid(1024, 1024)
    leaves = np.zeros_like(u)
    veins = np.zeros_like(u)
    for x, y, turn, size in (
        (0.33, 0.62, 0.5, 0.26),
        (0.68, 0.42, 2.4, 0.3),
        (0.36, 0.24, -0.5, 0.18),
        (0.74, 0.78, 1.3, 0.16),
    ):
        along = ((u - x) * np.cos(turn) + (v - y) * np.sin(turn)) / size
        across = ((v - y) * np.cos(turn) - (u - x) * np.sin(turn)) / size
        half = 0.36 * np.cos(np.clip(along, -1.0, 1.0) * np.pi / 2) * (1.0 - 0.3 * along)
        inside = np.clip((half - np.abs(across)) * size * 300.0, 0.0, 1.0) * (np.abs(along) < 1.0)
        rows = np.abs((along - 0.8 * np.abs(across)) * 7.0 % 1.0 - 0.5) / 7.0
        line = np.minimum(np.abs(across), rows + 0.006)
        veins = np.where(inside > 0.5, np.clip(1.0 - line / 0.014, 0.0, 1.0), veins)
        leaves = np.maximum(leaves, inside)
    clouds = noise(1024, 1024, 4)
    ice = blend((0.62, 0.78, 0.88), (0.9, 0.96, 1.0), clouds)
    leaf = blend((0.5, 0.16, 0.03), (0.85, 0.55, 0.15), np.clip(veins + 0.5 * noise(1024, 1024, 7) - 0.2, 0.0, 1.0))
    drawn.picture("base_color_texture", texels(*[a + (b - a) * leaves for a, b in zip(ice, leaf, strict=True)]))
    drawn.picture("thickness_texture", texels(np.clip(0.25 + 0.5 * clouds + 0.7 * leaves * (1.0 - veins), 0.0, 1.0)))
    drawn.put("depth", 0.1)
    drawn.put("uv_per_unit", (0.5, 0.5))
    lights = [((-0.9, -0.1, -1.2, 1.0), (3.2, 3.1, 2.9)), ((-0.5, 1.0, 0.9, 0.0), (0.45, 0.47, 0.5))]
    gl.view(drawn, (1.3, 0.6, 2.7), (0.03, -0.03, 0.0), 1.0, lights, (0.04, 0.05, 0.06))
    drawn.draw(*quad(2.0, 2.0))


PICTURES = (jelly_cubes, paper_lantern, wax_knot, ice_inlay)


def draw(context: moderngl.Context, picture: Any) -> Any:
    """One picture, rows from the top, with its samples averaged in linear light."""
    side = SIZE * SAMPLES
    target = gl.off_screen(context, (side, side))
    context.enable(moderngl.DEPTH_TEST)
    context.enable_direct(gl.FRAMEBUFFER_SRGB)
    context.clear(0.012, 0.013, 0.018)
    picture(context)
    rows = np.frombuffer(target.read(components=3, alignment=1), np.uint8).reshape(side, side, 3)[::-1]
    linear = (rows / 255.0) ** 2.2
    mean = linear.reshape(SIZE, SAMPLES, SIZE, SAMPLES, 3).mean(axis=(1, 3))
    return np.round(255.0 * mean ** (1.0 / 2.2)).astype(np.uint8)


def png(rows: Any) -> bytes:
    """Rows of RGB bytes as a PNG file; each row is stored as its difference from the one above."""
    height, width, _ = rows.shape
    above = np.vstack([np.zeros_like(rows[:1]), rows[:-1]])
    lines = np.insert((rows - above).reshape(height, -1), 0, 2, axis=1)
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    parts = ((b"IHDR", head), (b"IDAT", zlib.compress(lines.tobytes(), 9)), (b"IEND", b""))
    chunks = (
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in parts
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def main(path: str = str(ROOT / "docs" / "pictures.png")) -> None:
    """Draws all pictures side by side into a PNG file."""
    backend: Any = {"backend": "egl"} if sys.platform == "linux" else {}
    context = moderngl.create_context(standalone=True, **backend)
    strip = np.concatenate([draw(context, picture) for picture in PICTURES], axis=1)
    Path(path).write_bytes(png(strip))


if __name__ == "__main__":
    main(*sys.argv[1:])
