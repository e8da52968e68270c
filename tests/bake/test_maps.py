"""Baked pictures: Voronoi cells against all sites, normals against closed forms, the order of channels."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from oracle import Array, close, technique
from sssgen.bake import cells
from sssgen.bake.cells import Pattern, scale, voronoi
from sssgen.bake.channel_packing import Source, load, pack, parse
from sssgen.bake.normal_map import from_height
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.runtime.numpy_textures import Texture

pytest.importorskip("PIL", reason="Pillow is missing: pip install -e '.[render]'")

from sssgen.scene.pictures.images import png_bytes, read, write_png


def failing(call: Any, *arguments: Any, **named: Any) -> str:
    with pytest.raises(SssgenError) as caught:
        call(*arguments, **named)
    return str(caught.value)


# Cells


def centers(width: int, height: int) -> Array:
    """Where the texels of a picture are sampled, (height, width, 2): u and v, v upwards."""
    row, column = np.mgrid[:height, :width]
    return np.stack([(column + 0.5) / width, 1.0 - (row + 0.5) / height], axis=-1)


def sites(across: int, up: int, jitter: float, seed: int, tileable: bool, beyond: int = 4) -> Array:
    """All sites, also those of some cells outside: (n, 2), in cells."""
    columns, rows = np.arange(-beyond, across + beyond), np.arange(-beyond, up + beyond)
    keys = cells._keys(columns, rows, (across, up) if tileable else None, seed)
    return np.stack(cells._sites(keys, columns, rows, jitter), axis=-1).reshape(-1, 2)


def distances(places: Array, of_sites: Array) -> Array:
    return np.linalg.norm(places[..., None, :] - of_sites, axis=-1)


@pytest.mark.parametrize("tileable", [True, False])
@pytest.mark.parametrize("jitter", [0.0, 0.6, 1.0])
@pytest.mark.parametrize(("across", "up"), [(1, 1), (2, 1), (7, 5), (3, 20)])
def test_the_two_nearest_of_all_sites_are_found(across: int, up: int, jitter: float, tileable: bool) -> None:
    for seed in range(4):
        all_of_them = sites(across, up, jitter, seed, tileable)
        result = np.sort(distances(centers(41, 32) * [across, up], all_of_them), axis=-1)
        first, second = result[..., 0], result[..., 1]
        options: Any = {"size": (41, 32), "cells": (across, up), "jitter": jitter, "seed": seed, "tileable": tileable}
        close(voronoi(Pattern(**options, feature="f1")) * scale("f1", jitter), first, atol=1e-12)
        close(voronoi(Pattern(**options, feature="f2-f1")) * scale("f2-f1", jitter), second - first, atol=1e-12)


def test_far_sites_matter_at_full_jitter() -> None:
    """Somewhere the second nearest site is two cells away, so that 3 x 3 cells would not do."""
    places, there = centers(96, 96) * 16, sites(16, 16, 1.0, 1, True)
    second = there[np.argsort(distances(places, there), axis=-1)[..., 1]]
    assert np.abs(np.floor(second) - np.floor(places)).max() == 2


def test_one_is_the_largest_possible_distance() -> None:
    """With sites at the largest distance; the values of pictures reach nearly 1 and do not exceed it."""
    for jitter in (0.0, 0.3, 1.0):
        reach = 0.5 + 0.5 * jitter  # sites at the far corners of four cells around the origin
        assert scale("f1", jitter) == pytest.approx(np.hypot(reach, reach))
        assert scale("f2-f1", jitter) == pytest.approx(np.hypot(1.0 + 0.5 * jitter, 0.5 * jitter))
        for feature in ("f1", "f2-f1"):
            picture = voronoi(Pattern((300, 300), (60, 60), jitter, feature=feature))
            assert picture.min() >= 0.0
            assert 0.6 < picture.max() <= 1.0
    assert voronoi(Pattern((3, 3), (2, 2), 0.0, feature="f1")).max() == 1.0  # a texel on a corner of four cells


def test_facets_are_the_technique_voronoi_thickness() -> None:
    picture = voronoi(Pattern((64, 48), (9, 9), 0.6, tileable=False, bevel=0.2, variation=0.8))
    values = {"thickness_factor": 1.0, "cell_count": 9.0, "bevel": 0.2, "variation": 0.8}
    close(
        picture, technique("voronoi_thickness")(uv=centers(64, 48).reshape(-1, 2), **values).reshape(48, 64), atol=1e-9
    )


def test_facets_have_level_tops_and_edges_at_0() -> None:
    picture = voronoi(Pattern((256, 256), (6, 6), 0.7, bevel=0.1, variation=0.5))
    tops, counts = np.unique(picture, return_counts=True)
    assert 30 <= (counts > 100).sum() <= 36  # one a cell
    assert tops[counts > 100].min() > 0.5
    assert picture.min() < 0.01
    assert np.unique(voronoi(Pattern((64, 64), (4, 4), variation=0.0))).max() == 1.0


@pytest.mark.parametrize("feature", cells.FEATURES)
def test_tiles_have_no_seam(feature: str) -> None:
    options: Any = {"size": (384, 512), "cells": (3, 4), "seed": 9, "feature": feature, "bevel": 1.0}
    tile = voronoi(Pattern(**options))
    for axis in (0, 1):
        step = np.abs(np.diff(tile, axis=axis)).max()
        assert np.abs(np.take(tile, 0, axis) - np.take(tile, -1, axis)).max() <= step
    lone = voronoi(Pattern(**options, tileable=False))
    assert np.abs(lone[:, 0] - lone[:, -1]).max() > 5.0 * np.abs(np.diff(lone, axis=1)).max()


def test_a_tile_continues_in_its_neighbours() -> None:
    """The sites of the tile, repeated by hand around it, give the picture of the tiles to its right and above."""
    tile = voronoi(Pattern((40, 30), (4, 3), seed=2, feature="f1")) * scale("f1", 1.0)
    once = sites(4, 3, 1.0, 2, False, beyond=0)
    repeated = np.concatenate([once + np.array([4 * i, 3 * j]) for i in range(-3, 4) for j in range(-3, 4)])
    for shift in ((4, 0), (0, 3), (-4, 3)):
        close(tile, distances(centers(40, 30) * [4, 3] + shift, repeated).min(axis=-1), atol=1e-12)


def test_blocks_of_rows_make_no_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = voronoi(Pattern((50, 37), (5, 4)))
    monkeypatch.setattr(cells, "_BLOCK", 200)
    assert np.array_equal(voronoi(Pattern((50, 37), (5, 4))), whole)


def test_cells_depend_on_an_integer_hash() -> None:
    """Sites by the integers of the hash, worked out with Python's."""

    def scrambled(x: int) -> int:
        x = (x ^ (x >> 16)) * 0x7FEB352D % 2**32
        x = (x ^ (x >> 15)) * 0x846CA68B % 2**32
        return x ^ (x >> 16)

    def key(column: int, row: int, seed: int) -> int:
        return scrambled((column + scrambled((row + 1 + scrambled(seed)) % 2**32)) % 2**32)

    columns, rows = np.array([-2, 0, 7]), np.array([-1, 3])
    for seed in (0, 1, 2**32 - 1):
        result = cells._keys(columns, rows, None, seed)
        assert result.tolist() == [[key(int(column), int(row), seed) for column in columns] for row in rows]
    assert not np.array_equal(voronoi(Pattern((32, 32), (4, 4), seed=1)), voronoi(Pattern((32, 32), (4, 4), seed=2)))


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"cells": (0, 4)}, "0 x 4 cells"),
        ({"cells": (4, 65)}, "at most as many as texels"),
        ({"size": (0, 64)}, "0 x 64 texels"),
        ({"size": (64, 16385)}, "1 to 16384"),
        ({"jitter": 1.5}, "jitter is 1.5"),
        ({"jitter": float("nan")}, "jitter is nan"),
        ({"bevel": 0.0}, "bevel is 0.0"),
        ({"bevel": float("inf")}, "bevel is inf"),
        ({"variation": -0.1}, "variation is -0.1"),
        ({"seed": -1}, "seed is -1"),
        ({"feature": "f2"}, "not a feature of cells"),
        ({"feature": "facetted"}, "did you mean 'faceted'"),
    ],
)
def test_invalid_cells_are_refused(changed: dict[str, Any], message: str) -> None:
    assert message in failing(voronoi, Pattern(**{"size": (64, 64), "cells": (4, 4), **changed}))


# Normals


def of_slopes(along_u: Any, along_v: Any) -> Array:
    normal = np.stack(np.broadcast_arrays(-np.asarray(along_u), -np.asarray(along_v), 1.0), axis=-1)
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True)


@pytest.mark.parametrize(("width", "height"), [(16, 16), (20, 8), (5, 31)])
def test_a_plane_has_a_constant_slope(width: int, height: int) -> None:
    """Heights 0.4 u + 0.3 y with u and y in widths of the picture; white is 2 widths high."""
    places = centers(width, height) * [1.0, height / width]
    normal = 2.0 * from_height(places @ [0.4, 0.3], 2.0, tileable=False) - 1.0
    close(normal, np.broadcast_to(of_slopes(0.8, 0.6), normal.shape), atol=1e-12)


def wave(width: int, height: int) -> tuple[Array, Array]:
    """A wave that tiles, and its normals where white is 0.1 widths high."""
    u, v = np.moveaxis(centers(width, height), -1, 0) * 2.0 * np.pi
    heights = 0.5 + 0.2 * np.sin(u) + 0.2 * np.cos(u + 2.0 * v)
    along_u = 0.02 * 2.0 * np.pi * (np.cos(u) - np.sin(u + 2.0 * v))
    along_v = 0.02 * 2.0 * np.pi * -2.0 * np.sin(u + 2.0 * v) * width / height
    return heights, of_slopes(along_u, along_v)


def test_normals_of_a_wave_converge_to_its_own() -> None:
    errors = []
    for size in (32, 64, 128):
        heights, expected = wave(size, 2 * size)
        errors.append(np.abs(2.0 * from_height(heights, 0.1) - 1.0 - expected).max())
    assert errors[0] < 0.01
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.05)


def test_normals_of_a_tile_have_no_seam() -> None:
    """Normals of the tile are those of the middle one of nine, which have the same height in a third of the widths."""
    tile = voronoi(Pattern((40, 24), (5, 3)))
    nine = from_height(np.tile(tile, (3, 3)), 0.05 / 3.0, tileable=False)
    close(from_height(tile, 0.05), nine[24:48, 40:80], atol=1e-12)


def test_green_is_up_or_down() -> None:
    row, column = np.mgrid[:33, :33] - 16.0
    bump = np.exp(-(row**2 + column**2) / 50.0)
    normals = from_height(bump, 0.2)
    assert normals[12, 16, 1] > 0.6  # above the middle, in the picture
    assert normals[20, 16, 1] < 0.4
    assert normals[16, 20, 0] > 0.6  # to its right
    down = from_height(bump, 0.2, green="directx")
    close(down, np.stack([normals[..., 0], 1.0 - normals[..., 1], normals[..., 2]], axis=-1))
    close(from_height(bump, -0.2)[..., :2], 1.0 - normals[..., :2])


def test_the_technique_normal_map_reads_baked_maps() -> None:
    heights, expected = wave(24, 24)
    picture = from_height(heights, 0.1)
    sampled = Texture(picture[::-1], "nearest")  # row 0 of this one is at v = 0
    read_back = technique("normal_map")(
        uv=centers(24, 24).reshape(-1, 2), normal=(0.0, 0.0, 1.0), normal_texture=sampled
    ).reshape(24, 24, 3)
    close(read_back, 2.0 * picture - 1.0, atol=1e-12)
    assert np.abs(read_back - expected).max() < 0.02


def test_flat_stays_flat(tmp_path: Path) -> None:
    flat = from_height(np.full((3, 4), 0.7), 5.0)
    assert np.array_equal(flat, np.broadcast_to([0.5, 0.5, 1.0], (3, 4, 3)))
    for bits, middle, most in ((8, 128, 255), (16, 32768, 65535)):
        write_png(tmp_path / "flat.png", flat, bits)
        stored = read(tmp_path / "flat.png")
        assert (stored * most).round().reshape(-1, 3).tolist() == [[middle, middle, most]] * 12
        assert np.abs(stored - flat).max() < 1.0 / most
    assert len(png_bytes(flat)) < 100


def test_normals_of_a_line_of_texels() -> None:
    for tileable in (True, False):
        normals = from_height(np.linspace(0.0, 1.0, 5)[None], 1.0, tileable)
        assert (normals[..., 1] == 0.5).all()
    assert (normals[..., 0] < 0.5).all()


def test_invalid_heights_are_refused() -> None:
    flat = np.zeros((2, 2))
    assert "not a convention of the green channel" in failing(from_height, flat, 1.0, green="up")
    assert "did you mean 'directx'" in failing(from_height, flat, 1.0, green="DirectX")
    assert "shape (2, 2, 3)" in failing(from_height, np.zeros((2, 2, 3)), 1.0)
    assert "strength is nan" in failing(from_height, flat, float("nan"))
    assert "not finite" in failing(from_height, flat + np.inf, 1.0)


# Packing


@pytest.mark.parametrize(
    ("text", "source"),
    [
        ("ice.png", Source("ice.png")),
        ("maps/ice.png:g", Source("maps/ice.png", "g")),
        ("ice.png:A", Source("ice.png", "a")),
        ("ice.png:2", Source("ice.png", "2")),
        ("1-ice.png", Source("ice.png", inverted=True)),
        ("1-ice.exr:b", Source("ice.exr", "b", True)),
        ("./1-ice.png", Source("./1-ice.png")),
        ("C:\\maps\\ice.png", Source("C:\\maps\\ice.png")),
        ("C:/ice.png:r", Source("C:/ice.png", "r")),
        ("0.25", Source(constant=0.25)),
        ("1", Source(constant=1.0)),
    ],
)
def test_sources_of_the_command_line(text: str, source: Source) -> None:
    assert parse(text) == source


def test_invalid_channel_sources_are_refused() -> None:
    for text in ("2", "-0.5", "nan", "inf"):
        assert "a number from 0 to 1" in failing(parse, text)
    for text in ("", "1-", ":r", "1-:r"):
        assert "names no picture" in failing(parse, text)
    for text in ("ice.png:x", "ice.png:4", "ice.png:rg", "ice.png:"):
        assert "is not a channel" in failing(parse, text)


def test_channels_are_packed_in_order(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    color, gray = np.arange(24).reshape(2, 3, 4) / 255, np.arange(6).reshape(2, 3) / 51
    write_png("color.png", color)
    write_png("gray.png", gray)
    write_png("veiled.png", color[..., :2])
    sources = ["color.png:b", "1-gray.png", "0.5", "color.png:3"]
    packed = pack(load([parse(text) for text in sources]))
    close(packed, np.stack([color[..., 2], 1.0 - gray, np.full((2, 3), 0.5), color[..., 3]], axis=-1))
    close(pack(load([parse("color.png"), None, parse("veiled.png:a")])), color[..., [0, 0, 1]] * [1.0, 0.0, 1.0])
    assert failing(load, [parse("gray.png:g")]).endswith("it has r")
    assert "it has r, a" in failing(load, [parse("veiled.png:2")])
    assert "cannot find the picture" in failing(load, [parse("none.png")])
    np.save("volume.npy", np.zeros((2, 2, 2, 1)))
    assert "3-D texture" in failing(load, [parse("volume.npy")])


def test_how_many_channels_there_are() -> None:
    one, two = np.full((2, 3), 0.1), np.full((2, 3), 0.2)
    assert pack([one]).shape == (2, 3, 1)
    close(pack([one, two])[0, 0], [0.1, 0.2, 0.0])  # a file of two is gray and alpha
    close(pack([None, one, None])[0, 0], [0.0, 0.1, 0.0])
    close(pack([None, None, None, one])[0, 0], [0.0, 0.0, 0.0, 0.1])
    close(pack([one, 0.0, 1.0])[1, 2], [0.1, 0.0, 1.0])


def test_channels_that_do_not_fit() -> None:
    message = failing(pack, [np.zeros((2, 3)), 0.5, np.zeros((4, 3))])
    assert "different sizes" in message
    assert "r is 3 x 2, b is 3 x 4" in message
    assert "no picture" in failing(pack, [0.5, None])
    assert "four at most" in failing(pack, [np.zeros((2, 2))] * 5)
