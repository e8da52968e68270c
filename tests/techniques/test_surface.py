"""Parallax, surface techniques and shared functions, compared with closed forms, finite differences and facts."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from oracle import Array, close, lowbias32, rng, technique, unit, units
from sssgen.targets.runtime.numpy_textures import Texture

X, Y, Z = np.eye(3)
FLAT = {"T": X, "B": Y, "N": Z}
DEGREES = np.array([15.0, 30.0, 45.0, 60.0, 75.0, 85.0])
OFFSETS = {  # the offset of the image in depths, at these angles
    1.5: [0.17517, 0.35355, 0.53452, 0.70711, 0.84169, 0.88833],
    1.33: [0.19839, 0.40570, 0.62773, 0.85796, 1.05650, 1.13051],
}


def slanted(degrees: Any) -> Array:
    """Views at these angles to z, on the side of +x."""
    angle = np.radians(degrees)
    return np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=-1)


# Parallax


@pytest.mark.parametrize("ior", OFFSETS)
def test_refracted_parallax_has_the_offsets_of_the_table(ior: float) -> None:
    ours = technique("parallax_refracted")(uv=(0.3, 0.4), V=slanted(DEGREES), depth=0.1, ior=ior, **FLAT)
    close((0.3 - ours[:, 0]) / 0.1, OFFSETS[ior], atol=5.1e-6)
    close(ours[:, 1], 0.4)
    theirs = technique("subsurface_parallax")(uv=(0.3, 0.4), V=slanted(DEGREES), depth=0.1, eta=1.0 / ior, **FLAT)
    close(theirs, ours, atol=1e-12)
    in_water = {"ior": ior * 1.2, "outside_ior": 1.2}
    close(technique("parallax_refracted")(uv=(0.3, 0.4), V=slanted(DEGREES), depth=0.1, **in_water, **FLAT), ours)


@pytest.mark.parametrize("ior", OFFSETS)
@pytest.mark.parametrize("side", [1.0, -1.0], ids=["front", "back"])
def test_in_an_orthonormal_frame_the_cheap_form_is_the_refracted_one(ior: float, side: float) -> None:
    views = unit(rng().normal((0.0, 0.0, side), 1.0, (200, 3)))
    views = views[views[:, 2] * side > 0.2]  # at grazing angles the refracted form fades
    values = {"uv": (0.3, 0.4), "V": views, "depth": 0.1, "uv_per_unit": (2.0, 0.5)}
    ours = technique("parallax_orthonormal")(relative_ior=ior, T=X, B=Y, **values)
    close(ours, technique("parallax_refracted")(ior=ior, **FLAT, **values), atol=1e-12)


def test_the_offset_of_the_cheap_form_is_at_most_five_depths() -> None:
    views = slanted(np.linspace(0.0, 90.0, 400))
    for ior in (1.0, 1.02, 1.5):
        slide = np.abs(technique("parallax_orthonormal")(uv=(0.0, 0.0), V=views, depth=0.1, relative_ior=ior, T=X, B=Y))
        assert slide.max() <= 0.5 * (1.0 + 1e-12)
        assert np.abs(np.diff(slide[:, 0])).max() < 0.06


FRAMES = {  # the derivatives of the position by u and v, and the normal
    "orthonormal": (X, Y, Z),
    "turned": (np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]), X),
    "scaled": (2.5 * X, 0.3 * Y, Z),
    "mirrored": (-X, Y, Z),
    "sheared": (X, np.array([0.6, 0.9, 0.0]), Z),
    "all of it": (np.array([0.0, -3.0, 0.5]), np.array([0.0, 1.0, 1.4]), X),
}


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("name", ["parallax_straight", "parallax_refracted"])
@pytest.mark.parametrize("stretch", [1.0, 1.8], ids=["unit", "stretched"])
def test_parallax_is_exact_on_a_plane(frame: str, name: str, stretch: float) -> None:
    """The expected coordinates are those of the refracted ray on a parallel plane 0.2 below, in world space."""
    du, dv, n = FRAMES[frame]
    v = units(300)
    v = v[np.abs(v @ n) > 0.21]  # from both sides
    side = np.sign(v @ n)[:, None] * n
    eta = 1.0 if name == "parallax_straight" else 1.0 / 1.31
    cosine = (v * side).sum(axis=1, keepdims=True)
    ray = -eta * v + (eta * cosine - np.sqrt(1.0 - eta**2 * (1.0 - cosine**2))) * side  # Snell's law
    way = ray * 0.2 / -(ray * side).sum(axis=1, keepdims=True)
    along = way + 0.2 * side
    shift = np.linalg.lstsq(np.stack([du, dv], axis=1), along.T, rcond=None)[0].T
    assert np.abs(shift).max() > 0.1
    lengths = np.linalg.norm([du, dv], axis=1)
    values: dict[str, Any] = {"T": unit(du) * stretch, "B": unit(dv) / stretch, "N": n, "depth": 0.2}
    values["uv_per_unit"] = 1.0 / lengths
    if name == "parallax_refracted":
        values["ior"] = 1.31
    result = technique(name)(uv=(0.25, 0.75), V=v, **values)
    close(result, shift + np.array([0.25, 0.75]), atol=1e-12)
    if name == "parallax_refracted" and frame in ("sheared", "scaled", "all of it") and stretch == 1.0:
        above = (v @ n) > 0.0  # the published form, by the transpose, is wrong there
        frame_values = {key: values[key] for key in ("T", "B", "N", "depth")}
        theirs = technique("subsurface_parallax")(uv=(0.25, 0.75), V=v[above], eta=eta, **frame_values)
        assert np.abs(theirs - result[above]).max() > 0.02


@pytest.mark.parametrize("name", ["parallax_straight", "parallax_refracted"])
def test_parallax_without_a_frame_has_no_offset(name: str) -> None:
    for t, b in ((np.zeros(3), Y), (X, np.zeros(3)), (X, X), (np.zeros(3), np.zeros(3))):
        close(technique(name)(uv=(0.3, 0.4), V=slanted(DEGREES), T=t, B=b, N=Z), [[0.3, 0.4]] * 6)


def offsets_in_depths(name: str, degrees: Array, **values: float) -> Array:
    """The offsets of the image, in depths."""
    result: Array = -technique(name)(uv=(0.0, 0.0), V=slanted(degrees), depth=1.0, **values, **FLAT)[:, 0]
    return result


def test_grazing_parallax_fades() -> None:
    """The offset is exact above the cosine `fade`, at most 1.054 / fade, continuous, and 0 along the surface."""
    degrees = np.linspace(0.0, 90.0, 9001)
    for fade in (0.1, 0.2, 0.5):
        slide = offsets_in_depths("parallax_straight", degrees, grazing_fade=fade)
        steep = np.cos(np.radians(degrees)) >= fade
        close(slide[steep], np.tan(np.radians(degrees[steep])), atol=1e-12)
        assert 1.0 / fade < slide.max() * 1.06 and slide.max() <= 1.0541 / fade
        assert np.abs(np.diff(slide)).max() < 0.02 / fade and abs(slide[-1]) < 1e-12
        assert np.isfinite(slide).all() and (slide >= -1e-12).all()


def test_refracted_parallax_is_bounded_and_fades_past_the_critical_angle() -> None:
    degrees = np.linspace(0.0, 90.0, 90001)
    for ior in (1.1, 1.5, 2.4):
        bound = 1.0 / np.sqrt(ior**2 - 1.0)
        assert bound * 0.999 < offsets_in_depths("parallax_refracted", degrees, ior=ior).max() <= bound * (1.0 + 1e-9)
    outwards = offsets_in_depths("parallax_refracted", degrees, ior=1.0, outside_ior=1.5)  # water into air
    critical = np.degrees(np.arcsin(1.0 / 1.5))
    assert not outwards[degrees > critical].any()
    assert np.isfinite(outwards).all() and np.abs(np.diff(outwards)).max() < 0.1
    published = technique("subsurface_parallax")(uv=(0.0, 0.0), V=slanted(60.0), eta=1.5, **FLAT)
    assert np.isnan(published).all()  # 0 / 0 past the critical angle


# Frames


def test_frames_invert_each_other() -> None:
    t, b, n = units(100, 1), units(100, 2), units(100, 3)
    volume = np.abs((t * np.cross(b, n)).sum(axis=1))
    keep = volume > 0.1
    values = {"T": t[keep], "B": b[keep], "N": n[keep]}
    v = 3.0 * units(100)[keep]
    tangent = technique("common/frames.sss:tangent_from_world")(v=v, **values)
    close(np.linalg.solve(np.stack([t, b, n], axis=2)[keep], v[..., None])[..., 0], tangent, atol=1e-12)
    close(technique("common/frames.sss:world_from_tangent")(v=tangent, **values), v, atol=1e-12)


def test_object_space_and_back() -> None:
    matrix = rng().normal(size=(3, 3))
    v = units(10)
    moved = technique("common/frames.sss:object_from_world")(v=v, world_to_object=matrix)
    close(moved, v @ matrix.T)
    back = technique("common/frames.sss:world_from_object")(v=moved, object_to_world=np.linalg.inv(matrix))
    close(back, v, atol=1e-12)


# Hashes and cells


def test_hashes_are_those_of_integers() -> None:
    x = np.array([0, 1, 2, 7, 12345, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF], np.uint32)
    bits = [lowbias32(int(value)) for value in x]
    assert technique("common/hash.sss:hash_bits")(x=x).tolist() == bits
    close(
        technique("common/hash.sss:hash_unit")(x=x),
        np.array([number >> 8 for number in bits]) / 2.0**24,
        rtol=0,
        atol=0,
    )


def cells(p: Array, reach: int = 2) -> tuple[Array, Array, Array]:
    """The distances to the two nearest sites and the hash of the nearest, by brute force over 5 x 5 cells."""
    distances, levels = [], []
    for j in range(-reach, reach + 1):
        for i in range(-reach, reach + 1):
            corner = np.floor(p).astype(int) + np.array([i, j])
            rows = [lowbias32((int(y) & 0xFFFFFFFF) + 1 & 0xFFFFFFFF) for y in corner[:, 1]]
            seeds = [lowbias32((int(x) + row) & 0xFFFFFFFF) for x, row in zip(corner[:, 0], rows, strict=True)]
            site = [[(lowbias32((s + k) & 0xFFFFFFFF) >> 8) / 2**24 for k in (1, 2)] for s in seeds]
            distances.append(np.linalg.norm(corner + 0.5 + 0.6 * (np.array(site) - 0.5) - p, axis=1))
            levels.append([(lowbias32((s + 3) & 0xFFFFFFFF) >> 8) / 2**24 for s in seeds])
    order = np.argsort(distances, axis=0)
    first, second = np.take_along_axis(np.array(distances), order[:2], axis=0)
    return first, second, np.take_along_axis(np.array(levels), order[:1], axis=0)[0]


def test_voronoi_thickness() -> None:
    """A search of 3 x 3 cells is sufficient, also for negative coordinates."""
    uv = rng().uniform(-3.0, 3.0, (1500, 2))
    first, second, level = cells(uv * 5.0)
    x = np.clip((second - first) / 0.4, 0.0, 1.0)
    values = {"cell_count": 5.0, "bevel": 0.4, "variation": 0.7, "thickness_factor": 0.25}
    result = technique("voronoi_thickness")(uv=uv, **values)
    close(result, 0.25 * (1.0 - 0.7 * level) * x * x * (3.0 - 2.0 * x), atol=1e-9)
    line = np.stack([np.linspace(0.0, 2.0, 200001), np.full(200001, 0.37)], axis=1)
    steps = np.diff(technique("voronoi_thickness")(uv=line, **values))
    # continuous at cell borders: F2 - F1 changes by at most 2 per cell, times the slope of smoothstep
    assert 5e-5 < np.abs(steps).max() < 1e-5 * 5.0 * 2.0 * (1.5 / 0.4) * 0.25


def test_voronoi_normal_is_the_slope_of_voronoi_thickness() -> None:
    uv = rng().uniform(-1.0, 1.0, (600, 2))
    cell = {"cell_count": 6.0, "bevel": 0.5, "variation": 0.5}
    e = 1e-6

    def slope(axis: int, step: float) -> Array:
        height = technique("voronoi_thickness")
        shift = step * np.eye(2)[axis]
        result: Array = (
            height(uv=uv + shift, thickness_factor=0.03, **cell) - height(uv=uv - shift, thickness_factor=0.03, **cell)
        ) / (2 * step)
        return result

    per_unit = np.array([2.0, 0.5])
    slopes = np.stack([slope(0, e), slope(1, e)], axis=1)
    creased = np.abs(slopes - np.stack([slope(0, 50 * e), slope(1, 50 * e)], axis=1)).max(axis=1) > 1e-3
    assert creased.mean() < 0.2 and np.abs(slopes).max() > 0.2
    normal = technique("voronoi_normal")(uv=uv, normal=Z, relief=0.03, uv_per_unit=per_unit, **cell)
    expected = unit(np.concatenate([-slopes * per_unit, np.ones((600, 1))], axis=1))
    close(normal[~creased], expected[~creased], atol=2e-4)


# Normals


def test_slopes_become_normals_and_add() -> None:
    slopes, more = rng().normal(size=(50, 2)), rng(1).normal(size=(50, 2))
    ones = np.ones((50, 1))
    normal = technique("common/normals.sss:normal_of_slope")(slope=slopes)
    close(normal, unit(np.concatenate([-slopes, ones], axis=1)))
    detail = technique("common/normals.sss:normal_of_slope")(slope=more)
    both = technique("common/normals.sss:blend_normals")
    close(both(base=normal, detail=Z), normal)
    close(both(base=Z, detail=detail), detail)
    # whiteout blending: x and y are added, z is multiplied
    whiteout = np.stack([*(normal + detail)[:, :2].T, normal[:, 2] * detail[:, 2]], axis=1)
    close(both(base=normal, detail=detail), unit(whiteout))


def test_normal_map() -> None:
    normals = unit(np.array([[[0.3, -0.2, 0.8], [0.0, 0.0, 1.0]]]))
    picture = Texture(normals * 0.5 + 0.5, "nearest")
    uv = np.array([[0.25, 0.5], [0.75, 0.5]])
    read = technique("normal_map")
    close(read(uv=uv, normal=Z, normal_texture=picture), normals[0])
    close(read(uv=uv, normal=Z, normal_texture=picture, normal_scale=2.0), unit(normals[0] * [2.0, 2.0, 1.0]))
    base = unit([0.1, 0.2, 0.9])
    blended = unit([*(base + normals[0, 0])[:2], base[2] * normals[0, 0, 2]])
    close(read(uv=uv, normal=base, normal_texture=picture), [blended, base])


def heights(size: int = 64) -> tuple[Texture, float, float]:
    """A ramp along u and a parabola along v, for which central differences of any length are exact."""
    steps = (np.arange(size) + 0.5) / size
    return Texture((0.3 * steps[None] + 0.4 * steps[:, None])[..., None], wrap="clamp"), 0.3, 0.4


def test_normal_from_height() -> None:
    """Bright texels are high, so the normal points away from brighter texels."""
    picture, along_u, along_v = heights()
    uv = rng().uniform(0.1, 0.9, (50, 2))
    values = {"height_texture": picture, "relief": 0.5, "uv_per_unit": (2.0, 3.0), "texel_size": 0.01}
    expected = unit([-0.5 * 2.0 * along_u, -0.5 * 3.0 * along_v, 1.0])
    close(technique("normal_from_height")(uv=uv, normal=Z, **values), np.broadcast_to(expected, (50, 3)), atol=1e-12)
    base = unit([0.2, 0.0, 1.0])
    blended = unit([base[0] + expected[0], expected[1], base[2] * expected[2]])
    close(technique("normal_from_height")(uv=uv, normal=base, **values)[0], blended, atol=1e-12)


# Surfaces


def test_alpha_erosion() -> None:
    """At 0 nothing is eroded, at 1 everything, dark texels first; the bevel is the slope of the remaining part."""
    picture, along_u, along_v = heights()
    uv = rng().uniform(0.1, 0.9, (400, 2))
    mask = uv @ [along_u, along_v]
    erode = technique("alpha_erosion")
    common = {"uv": uv, "erosion_texture": picture, "edge": 0.2, "uv_per_unit": (2.0, 3.0), "texel_size": 0.001}
    for amount in (0.0, 0.3, 0.5, 1.0):
        left = np.clip((mask - (-0.2 * (1.0 - amount) + amount)) / 0.2, 0.0, 1.0)
        alpha, normal = erode(alpha=0.8, normal=Z, erosion=amount, edge_height=0.04, **common)
        close(alpha, 0.8 * left, atol=1e-12)
        slope = 0.04 / 0.2 * np.array([2.0 * along_u, 3.0 * along_v])
        on_edge = (left > 0.02) & (left < 0.98)
        off_edge = (np.abs(mask - (1.2 * amount - 0.2)) > 0.01) & (np.abs(mask - 1.2 * amount) > 0.01) & ~on_edge
        close(normal[on_edge], np.broadcast_to(unit([*-slope, 1.0]), (on_edge.sum(), 3)), atol=1e-9)
        close(normal[off_edge], np.broadcast_to(Z, (off_edge.sum(), 3)))
        assert amount not in (0.3, 0.5) or on_edge.sum() > 20
    black = np.zeros((1, 1, 1))
    assert erode(uv=(0.5, 0.5), alpha=1.0, normal=Z, erosion=0.0, erosion_texture=black)[0] == 1.0
    assert erode(uv=(0.5, 0.5), alpha=1.0, normal=Z, erosion=1.0, erosion_texture=black + 1.0)[0] == 0.0


def test_packed_scroll() -> None:
    """Each channel moves independently, and a long session loses no precision."""
    picture = rng().uniform(size=(8, 16, 3))
    y, x = np.divmod(np.arange(128), 16)
    uv = np.stack([(x + 0.5) / 16, (y + 0.5) / 8], axis=1)
    texels = {"red": (1, 0), "green": (-2, 3), "blue": (0, -5)}  # texels per second
    speeds = {f"{name}_speed": np.array(move) / [16, 8] for name, move in texels.items()}
    colors = {"vein_color": np.array([0.3, 0.8, 1.0]), "spark_color": np.array([0.6, 0.2, 0.1])}
    scroll = technique("packed_scroll")
    start = np.array([0.1, 0.0, 0.2])
    for time in (0.0, 1.0, 3.0):
        r, g, b = (
            np.roll(picture[..., i], (-int(time) * dy, -int(time) * dx), axis=(0, 1)).reshape(-1, 1)
            for i, (dx, dy) in enumerate(texels.values())
        )
        expected = start + colors["vein_color"] * r * g + colors["spark_color"] * b
        for later in (0.0, 16.0 * 1000):  # the motion repeats after 16 seconds
            result = scroll(uv=uv, time=time + later, emission=start, packed_texture=picture, **speeds, **colors)
            close(result, expected, atol=1e-9)


def test_ice_mask() -> None:
    """A covered point is dark, a bare point fully bright; a tenth counts as bare."""
    covered = np.array([0.0, 0.5, 0.9, 0.95, 0.98, 1.0])
    uv = np.stack([(np.arange(6) + 0.5) / 6, np.full(6, 0.5)], axis=1)
    x = np.clip((1.0 - covered) / 0.1, 0.0, 1.0)
    mask = technique("ice_mask")
    values = {"uv": uv, "through": 0.8, "cover_texture": Texture(covered[None, :, None], "nearest")}
    close(mask(**values), 0.8 * x * x * (3.0 - 2.0 * x), atol=1e-12)
    close(mask(cover=0.5, **values), 0.8)


def test_base_color_and_constants() -> None:
    picture = rng().uniform(size=(2, 2, 4))
    uv = np.array([[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]])
    tint = np.array([0.5, 1.0, 0.25, 0.8])
    albedo, alpha = technique("base_color")(uv=uv, base_color_texture=picture, tint=tint)
    close(np.concatenate([albedo, alpha[:, None]], axis=1), picture.reshape(-1, 4) * tint)
    metallic, roughness = technique("pbr_constants")(metalness=0.3, surface_roughness=0.7)
    assert (metallic, roughness) == (0.3, 0.7)


UV = np.array([[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]])
"""The centres of a 2 x 2 picture's texels, row by row."""


def test_maps_of_the_surface_multiply_their_factors() -> None:
    picture = rng().uniform(size=(2, 2, 4))
    texels = picture.reshape(-1, 4)
    factors = {"uv": UV, "metalness": 0.8, "surface_roughness": 0.6}
    metallic, roughness = technique("metallic_roughness_map")(metallic_roughness_texture=picture, **factors)
    close(metallic, 0.8 * texels[:, 2])
    close(roughness, 0.6 * texels[:, 1])
    half = {"occlusion": 0.5, "occlusion_strength": 0.25}
    expected = 0.5 * (1.0 - 0.25 * (1.0 - texels[:, 0]))
    close(technique("occlusion_map")(uv=UV, occlusion_texture=picture, **half), expected)
    packed = technique("occlusion_roughness_metallic_map")(packed_surface_texture=picture, **factors, **half)
    for result, value in zip(packed, (expected, metallic, roughness), strict=True):
        close(result, value)


def test_colours_of_vertices_are_factors() -> None:
    colors = rng().uniform(size=(8, 4))
    colors[0, 3] = 3.0
    albedo, alpha = technique("vertex_tint")(vertex_color=colors, albedo=(0.5, 1.0, 0.25), alpha=0.6)
    close(albedo, colors[:, :3] * [0.5, 1.0, 0.25])
    close(alpha, 0.6 * np.minimum(colors[:, 3], 1.0))


def test_specular_and_clearcoat() -> None:
    picture = rng().uniform(size=(2, 2, 4))
    texels = picture.reshape(-1, 4)
    # glass of the index 1.5 reflects ((1.5 - 1) / (1.5 + 1))^2
    close(technique("specular_level")(dielectric_specular=0.5), (0.5 / 2.5) ** 2)
    reflected = technique("specular_map")(uv=UV, specular_texture=picture, specular_strength=0.75)
    close(reflected, 0.06 * texels[:, 3])
    factors = {"coat_weight": 0.8, "coat_roughness": 0.3}
    assert technique("clearcoat_constants")(**factors) == (0.8, 0.3)
    weight, roughness = technique("clearcoat_map")(uv=UV, clearcoat_texture=picture, **factors)
    close(weight, 0.8 * texels[:, 0])
    close(roughness, 0.3 * texels[:, 1])


def test_sheen_is_the_same_everywhere() -> None:
    color, roughness = technique("sheen_constants")(sheen_tint=(0.9, 0.4, 0.1), sheen_spread=0.35)
    close(color, (0.9, 0.4, 0.1))
    assert roughness == 0.35


def test_emission_is_added() -> None:
    picture = rng().uniform(size=(2, 2, 3))
    values = {"emission_color": (1.0, 0.5, 0.25), "emission_strength": 20.0, "emission": (0.1, 0.2, 0.3)}
    expected = [0.1, 0.2, 0.3] + 20.0 * np.array([1.0, 0.5, 0.25]) * picture.reshape(-1, 3)
    close(technique("emission_map")(uv=UV, emission_texture=picture, **values), expected)


def test_a_map_with_y_down_has_the_normals_of_the_same_map_with_y_up() -> None:
    up = rng().uniform((0.3, 0.3, 0.7), (0.7, 0.7, 1.0), size=(2, 2, 3))
    down = up * [1.0, -1.0, 1.0] + [0.0, 1.0, 0.0]
    values = {"uv": UV, "normal": Z, "normal_scale": 1.5}
    close(
        technique("normal_map_directx")(normal_texture_y_down=down, **values),
        technique("normal_map")(normal_texture=up, **values),
        atol=1e-12,
    )


def test_transformed_texture_coordinates() -> None:
    values = {"uv_tiling": (2.0, 3.0), "uv_offset": (0.1, -0.2), "uv_rotation": 30.0}
    moved = technique("uv_transform")(uv=UV, **values)
    # complex numbers turn counter-clockwise about 0
    turned = (2.0 * UV[:, 0] + 3.0j * UV[:, 1]) * np.exp(1j * np.pi / 6.0) + (0.1 - 0.2j)
    close(moved, np.stack([turned.real, turned.imag], axis=1), atol=1e-12)


def test_jelly_surface() -> None:
    """The floor is a faint checker and transmits no light; the cubes have one colour and transmit by their thinness."""
    p = np.array([[3.1, 0.0, 2.6], [3.6, 0.0, 2.6], [-2.1, 0.0, 0.1], [0.0, 0.98, 0.0], [1.45, 0.5, 0.7]])
    albedo, thinness = technique("jelly_surface")(P=p, th=0.4, jelly_color=(1.0, 0.5, 0.0))
    close(albedo[:3], [[0.9] * 3, [1.0] * 3, [0.9] * 3])
    close(albedo[3:], [[1.0, 0.5, 0.0]] * 2)
    close(thinness, [0.0, 0.0, 0.0, 0.4, 0.4])
    floor = rng().uniform(-9.0, -2.0, (100, 3)) * [1.0, 0.0, 1.0]
    odd = (np.floor(2.0 * floor[:, 0]) + np.floor(2.0 * floor[:, 2])) % 2.0
    close(technique("jelly_surface")(P=floor, th=0.4)[0], np.stack([1.0 - 0.1 * odd] * 3, axis=1))
