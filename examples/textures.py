"""Makes the textures of the example scenes: python examples/textures.py [FOLDER]

Each picture is computed from formulas and seeded noise, so the same NumPy gives the same picture, and written as a PNG
of 8 bits to NAME/textures below FOLDER, which is this file's folder where it is not given. Colours are sRGB, all else
is linear. It needs NumPy and Pillow.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

SIZE = 512
"""Texels along each side."""


# What pictures are made of. Arrays are (height, width), row 0 at v = 0, until they are written.


def grid() -> tuple[Any, Any]:
    """u and v at the texels' centres."""
    v, u = np.mgrid[0:SIZE, 0:SIZE]
    return (u + 0.5) / SIZE, (v + 0.5) / SIZE


def noise(seed: int, roughness: float = 2.0, stretch: float = 1.0) -> Any:
    """Cloudy noise 0 to 1 that tiles: white noise whose spectrum falls with the frequency.

    The larger `roughness`, the softer; `stretch` above 1 draws it out along u.
    """
    waves = np.fft.fftfreq(SIZE) * SIZE
    frequency = np.hypot(waves[:, None], waves * stretch)
    white = np.fft.fft2(np.random.default_rng(seed).standard_normal((SIZE, SIZE)))
    clouds = np.fft.ifft2(white / np.maximum(frequency, 1.0) ** roughness).real
    return np.clip(0.5 + clouds / (5.0 * clouds.std()), 0.0, 1.0)


def smooth(low: float, high: float, x: Any) -> Any:
    """0 below `low`, 1 above `high`, soft between them; `low` may be the larger."""
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def color(text: str) -> Any:
    """#rrggbb as numbers 0 to 1."""
    return np.array([int(text[at : at + 2], 16) for at in (1, 3, 5)]) / 255.0


def blend(low: Any, high: Any, weight: Any) -> Any:
    """Two colours, or pictures, mixed by a weight a texel: (height, width, 3)."""
    return low + (high - low) * weight[..., None]


def bumps(height: Any, strength: float) -> Any:
    """The normal map of a height map, y up."""
    across = (np.roll(height, 1, 1) - np.roll(height, -1, 1)) * strength
    up = (np.roll(height, 1, 0) - np.roll(height, -1, 0)) * strength
    normal = np.stack([across, up, np.ones_like(height)], axis=-1)
    return 0.5 + 0.5 * normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def around(seed: int) -> tuple[Any, Any]:
    """Distances to the nearest and to the second nearest of scattered points, in uv; they tile."""
    middles = (np.arange(SIZE) + 0.5) / SIZE
    nearest = np.full((SIZE, SIZE), 4.0)
    second = nearest
    for x, y in np.random.default_rng(seed).random((28, 2)):
        across, up = (np.abs((middles - at + 0.5) % 1.0 - 0.5) for at in (x, y))
        square = up[:, None] ** 2 + across**2
        second = np.minimum(second, np.maximum(nearest, square))
        nearest = np.minimum(nearest, square)
    return np.sqrt(nearest), np.sqrt(second)


# The examples


def paper_lantern() -> dict[str, Any]:
    """Washi on hoops of wood: v is the latitude, as lantern.sss has it; caps at both ends, a red tassel below."""
    _, v = grid()
    latitude = 180.0 * (v - 0.5)
    fibres = 0.6 * noise(1, 1.3, stretch=0.35) + 0.4 * noise(2, 1.6)
    flecks = smooth(0.72, 0.9, noise(3, 1.5, stretch=0.5))
    to_hoop = np.abs(latitude / 9.0 - np.round(latitude / 9.0)) * 9.0
    hoop = smooth(1.25, 0.65, to_hoop)
    cap = smooth(50.0, 51.0, np.abs(latitude))
    wood = np.maximum(hoop, cap)
    grain = noise(4, 1.4, stretch=0.1)
    paper = blend(color("#d8c8a8"), color("#f7efdf"), fibres)
    paper = blend(paper, color("#b48a5a"), 0.35 * flecks)
    timber = blend(color("#2a140a"), color("#5b3018"), grain)
    base = blend(blend(paper, timber, wood), color("#a3141c"), smooth(-80.0, -83.0, latitude))
    thickness = np.clip(0.22 + 0.5 * (fibres - 0.5) + 0.25 * flecks + 0.12 * smooth(4.0, 0.0, to_hoop), 0.04, 1.0)
    thickness = np.maximum(thickness, wood)
    height = 0.35 * fibres + 0.15 * flecks + 0.4 * hoop
    return {"base_color": base, "thickness": thickness, "normal": bumps(height, 0.9)}


def ice() -> dict[str, Any]:
    """A sheet of ice: snow that has drifted against its foot, light in its veins, an outline and holes of melting."""
    u, v = grid()
    clouds, fine = noise(11), noise(12, 1.5)
    drift = 0.24 + 0.1 * np.sin(2.0 * np.pi * (u + 0.1)) + 0.05 * np.sin(6.0 * np.pi * u + 1.0) + 0.09 * (clouds - 0.5)
    snow = smooth(0.03, -0.03, v - drift + 0.1 * (fine - 0.5))
    frost = 0.5 * smooth(0.55, 0.95, noise(13, 1.7))
    bare = blend(color("#5f97b8"), color("#cce4f0"), np.clip(0.7 * clouds + frost, 0.0, 1.0))
    powder = blend(color("#eef2f6"), color("#ffffff"), fine)
    base = blend(bare, powder, snow)
    cover = np.clip(snow + 0.3 * frost, 0.0, 1.0)
    nearest, second = around(14)
    veins = smooth(0.035, 0.0, second - nearest) * (0.35 + 0.65 * noise(15))
    other, beyond = around(16)
    cracks = smooth(0.06, 0.0, beyond - other)
    sparks = smooth(0.02, 0.0, around(17)[0]) * 0.6
    packed = np.stack([veins, 0.25 + 0.75 * cracks, sparks], axis=-1)
    # what is left: the middle of the sheet, less some holes
    x, y = 2.0 * u - 1.0, 2.0 * v - 1.0
    rough, rougher = noise(18, 2.0) - 0.5, noise(19, 2.1) - 0.5
    corners = (0.86, 0.1), (0.84, 1.3), (0.8, 2.2), (0.85, 3.2), (0.87, 4.1), (0.9, 4.9), (0.8, 5.7)
    sides = [x * np.cos(turn) + y * np.sin(turn) - away for away, turn in corners]
    rim = -np.max(np.stack(sides), axis=0) + 0.16 * rough
    left = np.clip(0.5 + 1.6 * rim, 0.0, 1.0)
    for at_x, at_y, radius in ((0.36, 0.3, 0.17), (0.1, 0.52, 0.09), (0.52, -0.06, 0.07), (-0.5, 0.02, 0.06)):
        away = np.hypot(x - at_x, 1.2 * (y - at_y)) - radius + 0.28 * rougher
        left = np.minimum(left, np.clip(0.5 + 1.6 * away, 0.0, 1.0))
    return {"base_color": base, "cover": cover, "packed": packed, "erosion": left}


LEAVES = (
    # x, y, turn, length, hue from russet to gold
    (0.38, 0.62, 0.75, 0.27, 0.25), (0.66, 0.55, 2.5, 0.22, 0.9), (0.45, 0.3, -0.45, 0.23, 0.6),
    (0.7, 0.28, 1.2, 0.13, 0.1), (0.24, 0.4, 1.9, 0.12, 0.8), (0.58, 0.79, 0.1, 0.12, 0.5),
)  # fmt: skip


def leaves() -> tuple[Any, Any, Any]:
    """Where leaves are (0 to 1), where their veins are, and their hue."""
    u, v = grid()
    inside, veins, hue = np.zeros_like(u), np.zeros_like(u), np.zeros_like(u)
    for x, y, turn, length, own in LEAVES:
        along = ((u - x) * np.cos(turn) + (v - y) * np.sin(turn)) / length
        across = ((v - y) * np.cos(turn) - (u - x) * np.sin(turn)) / length
        across = across - 0.12 * (1.0 - along**2)  # bent
        teeth = 1.0 + 0.05 * (np.abs((along * 9.0) % 1.0 - 0.5) * 2.0)
        half = 0.42 * teeth * np.cos(np.clip(along, -1.0, 1.0) * np.pi / 2) * (1.0 - 0.35 * along)
        blade = smooth(-0.004, 0.004, (half - np.abs(across)) * length) * (np.abs(along) < 1.0)
        stalk = smooth(0.03, 0.015, np.abs(across)) * smooth(-1.35, -1.3, along) * (along < 0.0)
        leaf = np.maximum(blade, stalk)
        rows = np.abs((along - 0.9 * np.abs(across)) * 6.0 % 1.0 - 0.5) / 6.0
        line = np.minimum(np.abs(across), rows + 0.008)
        veins = np.where(leaf > 0.5, smooth(0.03, 0.005, line), veins)
        hue = np.where(leaf > 0.02, own, hue)
        inside = np.maximum(inside, leaf)
    return inside, veins, hue


def ice_inlay() -> dict[str, Any]:
    """Autumn leaves in clouded ice with bubbles; thickness is what stands in the sun's way."""
    inside, veins, hue = leaves()
    clouds, mottle = noise(21), noise(22, 1.5)
    bubbles = smooth(0.011, 0.005, around(23)[0])
    frozen = blend(color("#6c9bb4"), color("#d8eaf2"), np.clip(clouds + 0.25 * bubbles, 0.0, 1.0))
    leaf = blend(color("#c0390b"), color("#f2b21f"), np.clip(hue + 0.6 * (mottle - 0.5), 0.0, 1.0))
    base = blend(frozen, blend(leaf, color("#f6d98a"), 0.6 * veins), inside)
    shade = inside * (0.85 - 0.3 * veins)
    thickness = np.clip(0.16 + 0.5 * clouds - 0.12 * bubbles + shade, 0.0, 1.0)
    return {"base_color": base, "thickness": thickness}


def resin_inlay() -> dict[str, Any]:
    """Marquetry: a compass rose of brass and mother-of-pearl in walnut."""
    u, v = grid()
    x, y = 2.0 * u - 1.0, 2.0 * v - 1.0
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    texel = 2.0 / SIZE

    def ring(middle: float, width: float) -> Any:
        return smooth(texel, -texel, np.abs(radius - middle) - 0.5 * width)

    grain = noise(31, 1.6, stretch=7.0)
    rings = 0.5 + 0.5 * np.sin(20.0 * (y + 0.15 * x * x) + 7.0 * grain)
    walnut = blend(color("#2b170d"), color("#6e4424"), np.clip(0.6 * grain + 0.4 * rings, 0.0, 1.0))
    brass = blend(color("#b98a33"), color("#f0cf7c"), noise(32, 1.4, stretch=4.0))
    pearl = blend(color("#9fc4c9"), color("#f3e6ea"), noise(33, 1.8))
    ebony = blend(color("#0d1214"), color("#233238"), noise(34, 1.6, stretch=5.0))
    picture = walnut

    def lay(what: Any, where: Any) -> None:
        nonlocal picture
        picture = blend(picture, what, where)

    def points(count: int, start: float, length: float, foot: float) -> tuple[Any, Any]:
        """The light and the dark halves of a star's points: from the tip to `foot` beside the middle."""
        step = 2.0 * np.pi / count
        turned = (angle - start + 0.5 * step) % step - 0.5 * step
        along, side = radius * np.cos(turned), radius * np.sin(turned)
        depth = 0.5 * step
        # the edge runs from the tip (length, 0) to the foot (foot cos depth, foot sin depth)
        fx, fy = foot * np.cos(depth), foot * np.sin(depth)
        norm = np.hypot(length - fx, fy)
        inward = ((length - along) * fy - np.abs(side) * (length - fx)) / norm
        point = smooth(-texel, texel, inward)
        return point * smooth(-texel, texel, side), point * smooth(texel, -texel, side)

    lay(ebony, smooth(texel, -texel, radius - 0.8))
    lay(brass, ring(0.8, 0.025))
    lay(brass, ring(0.69, 0.012))
    ticks = np.abs((angle / (2.0 * np.pi) * 48.0) % 1.0 - 0.5)
    lay(pearl, smooth(0.2, 0.12, ticks) * smooth(texel, -texel, np.abs(radius - 0.745) - 0.025))
    for count, start, length, foot, light, dark in (
        (8, np.pi / 8, 0.42, 0.16, walnut * 1.6, walnut * 0.9),
        (4, np.pi / 4, 0.58, 0.17, brass, brass * 0.55),
        (4, 0.0, 0.78, 0.15, pearl, blend(color("#31606b"), color("#5c919a"), noise(33, 1.8))),
    ):
        bright, shaded = points(count, start, length, foot)
        lay(np.clip(light, 0.0, 1.0), bright)
        lay(dark, shaded)
    lay(brass, smooth(texel, -texel, radius - 0.07))
    lay(ebony, ring(0.05, 0.012))
    edge = np.maximum(np.abs(x), np.abs(y))
    lay(brass, smooth(texel, -texel, np.abs(edge - 0.86) - 0.01))
    return {"base_color": picture}


def surroundings() -> dict[str, Any]:
    """What scenes mirror: a dark studio with lamps behind cloth, and a bright room with windows; and a wood to show."""
    way = directions()
    # the floor is brown, the ceiling is lighter and blue
    studio = blend(color("#28231f"), color("#46505c"), smooth(-0.5, 0.9, way[..., 1]))
    room = blend(color("#6c6b6a"), color("#aeb4bb"), smooth(-0.7, 0.7, way[..., 1]))
    lamps = (
        ((-0.55, 0.62, 0.56), 0.55, 0.42, color("#ffffff")),
        ((0.95, 0.12, 0.3), 0.13, 0.6, color("#d8e4ff")),
        ((0.1, 0.5, -0.86), 0.8, 0.16, color("#fff0dc")),
    )
    windows = (
        ((-0.9, 0.35, 0.25), 0.5, 0.55, color("#ffffff")),
        ((0.55, 0.3, -0.78), 0.75, 0.45, color("#fffaf2")),
        ((0.5, 0.75, 0.45), 0.5, 0.3, color("#f4f8ff")),
    )
    return {
        "studio": with_lamps(studio, way, lamps),
        "room": with_lamps(room, way, windows),
        "wood": wood(directions(128)),
    }


def wood(way: Any) -> Any:
    """A wood in summer: the sky shines through gaps between the leaves, and trunks stand before it."""
    random = np.random.default_rng(3)
    picture = blend(color("#161c0c"), color("#55702c"), smooth(-0.5, 0.55, way[..., 1]))
    azimuth = np.arctan2(way[..., 2], way[..., 0])
    for trunk in random.uniform(-np.pi, np.pi, 26):
        away = np.abs(np.angle(np.exp(1j * (azimuth - trunk))))
        picture = blend(picture, color("#12120b"), 0.75 * smooth(0.09, 0.0, away) * smooth(0.9, 0.2, way[..., 1]))
    for _ in range(170):
        facing = random.normal(size=3) * [1.0, 0.35, 1.0] + [0.0, 0.3, 0.0]
        gap = smooth(1.0 - 0.012 * random.uniform(0.2, 1.0), 1.0, way @ (facing / np.linalg.norm(facing)))
        picture = blend(picture, color("#c8dc8c" if random.random() < 0.6 else "#f2f6dc"), 0.6 * gap)
    return picture


def directions(rows: int = 64) -> Any:
    """The unit direction of each texel of a picture of all directions: up at the top, +x in the middle."""
    v, u = np.mgrid[0:rows, 0 : 2 * rows] + 0.5
    polar, azimuth = np.pi * (1.0 - v / rows), np.pi * (u / rows - 1.0)
    return np.stack([np.sin(polar) * np.cos(azimuth), np.cos(polar), np.sin(polar) * np.sin(azimuth)], axis=-1)


def with_lamps(picture: Any, way: Any, lamps: Any) -> Any:
    """A picture of all directions with upright rectangles: the direction of each, its half sizes and its colour."""
    for facing, width, height, light in lamps:
        ahead = np.array(facing) / np.linalg.norm(facing)
        right = np.cross([0.0, 1.0, 0.0], ahead) / np.hypot(ahead[0], ahead[2])
        far = np.maximum(way @ ahead, 1e-3)
        x, y = np.abs(way @ right) / far, np.abs(way @ np.cross(ahead, right)) / far
        lamp = smooth(width + 0.04, width - 0.04, x) * smooth(height + 0.04, height - 0.04, y)
        picture = blend(picture, light, lamp)
    return picture


EXAMPLES = (paper_lantern, ice, ice_inlay, resin_inlay, surroundings)


def write(path: Path, picture: Any) -> None:
    """A picture, (height, width) or (height, width, 3), as a PNG: row 0 goes to the bottom."""
    stored = np.rint(255.0 * np.clip(picture, 0.0, 1.0)).astype(np.uint8)[::-1]
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(np.ascontiguousarray(stored)).save(path, optimize=True)


def main(folder: str = str(Path(__file__).parent)) -> None:
    """Writes every texture of every example."""
    for example in EXAMPLES:
        for name, picture in example().items():
            write(Path(folder) / example.__name__ / "textures" / f"{name}.png", picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
