"""The NumPy runtime beyond the builtins' vectors: layout, operators, textures, derivatives."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sssgen.targets import numpy_runtime as rt
from sssgen.targets.runtime.numpy_textures import _FACES, Texture
from sssgen.targets.runtime.numpy_values import (
    Record,
    array,
    diagonal,
    divide,
    equals,
    grid,
    index,
    int_divide,
    int_remainder,
    mat,
    mat_mul,
    mat_vec,
    precision,
    resize,
    select,
    shift_left,
    shift_right,
    splat,
    store_index,
    store_swizzle,
    swizzle,
    to_bool,
    to_float,
    to_int,
    to_uint,
    vec,
    vec_mat,
)

INTS = st.integers(-(2**31), 2**31 - 1)


@pytest.fixture(autouse=True)
def no_warnings() -> Iterator[None]:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


def test_constructors() -> None:
    lanes = np.arange(3.0)
    v = vec(1.0, lanes, vec(5.0, 6.0))
    assert v.shape == (4, 3)
    np.testing.assert_array_equal(v[:, 2], [1, 2, 5, 6])
    assert vec(1.0, 2.0).shape == (2, 1)
    assert splat(3, lanes).shape == (3, 3)
    m = mat(2, vec(1.0, 2.0), vec(3.0, lanes))
    assert m.shape == (2, 2, 3)
    np.testing.assert_array_equal(m[1, :, 2], [3, 2])
    np.testing.assert_array_equal(mat(2, 1.0, 2.0, 3.0, 4.0)[..., 0], [[1, 2], [3, 4]])
    np.testing.assert_array_equal(diagonal(2, lanes)[..., 2], [[2, 0], [0, 2]])
    np.testing.assert_array_equal(resize(3, m)[..., 0], [[1, 2, 0], [3, 0, 0], [0, 0, 1]])
    np.testing.assert_array_equal(resize(2, diagonal(3, 4.0))[..., 0], [[4, 0], [0, 4]])


@pytest.mark.parametrize("dtype", ["float16", "float32", "float64"])
def test_precision_is_preserved(dtype: str) -> None:
    x = np.ones(3, dtype)
    with precision(dtype):
        v = vec(x, 0.5, to_float(np.arange(3, dtype=np.int32)))
        for value in (
            v, vec(0.0, 1.0), rt.sin(0.5), rt.min(0.5, 0.25), rt.normalize(v), rt.mix(v, vec(1.0, 2.0, 3.0), 0.5),
            mat_mul(diagonal(3, x), diagonal(3, 2.0)), rt.inverse(diagonal(4, x)), select(True, 1.0, 2.0),
            select(x > 0, 1.0, x), rt.refract(v, v, 0.75), rt.step(0.5, v), rt.smoothstep(0.0, 1.0, v), splat(2, 1.0),
            rt.intBitsToFloat(np.array([0x3F800000], np.int32)), rt.unpackUnorm2x16(7), divide(1.0, 3.0),
            rt.texture(Texture(np.ones((2, 2, 4))), vec(x, x)),
        ):  # fmt: skip
            assert value.dtype == dtype
        assert 2.0 * x.dtype.type(1) == 2.0


def test_matrix_products() -> None:
    generator = np.random.default_rng(1)
    a, b, v = generator.random((3, 3, 5)), generator.random((3, 3, 5)), generator.random((3, 5))
    for lane in range(5):  # with columns first, NumPy's matrix is the transpose
        np.testing.assert_allclose(mat_mul(a, b)[..., lane], (a[..., lane].T @ b[..., lane].T).T)
        np.testing.assert_allclose(mat_vec(a, v)[:, lane], a[..., lane].T @ v[:, lane])
        np.testing.assert_allclose(vec_mat(v, a)[:, lane], v[:, lane] @ a[..., lane].T)
    np.testing.assert_array_equal(mat_mul(a, b[..., :1])[..., 0], mat_mul(a, b)[..., 0])


@pytest.mark.parametrize("size", [2, 3, 4])
def test_inverse_and_determinant(size: int) -> None:
    m = np.random.default_rng(size).random((size, size, 7)) + 2.0 * np.eye(size)[..., None]
    np.testing.assert_allclose(rt.determinant(m), [np.linalg.det(m[..., lane]) for lane in range(7)])
    np.testing.assert_allclose(mat_mul(m, rt.inverse(m)), np.repeat(np.eye(size)[..., None], 7, -1), atol=1e-14)


def test_parts() -> None:
    v = vec(1.0, 2.0, np.array([3.0, 4.0]))
    np.testing.assert_array_equal(swizzle(v, "z"), [3, 4])
    np.testing.assert_array_equal(swizzle(v, "zxx")[:, 1], [4, 1, 1])
    stored = store_swizzle(vec(1.0, 2.0, 3.0), "zx", vec(np.array([8.0, 9.0]), 7.0))
    np.testing.assert_array_equal(stored, [[7, 7], [2, 2], [8, 9]])
    np.testing.assert_array_equal(store_swizzle(v, "y", 5)[:, 0], [1, 5, 3])
    np.testing.assert_array_equal(v[1], [2, 2])
    places = np.array([2, -5], np.int32)
    np.testing.assert_array_equal(index(v, places), [3, 1])
    np.testing.assert_array_equal(index(vec(1.0, 2.0), np.array([0, 9])), [1, 2])
    np.testing.assert_array_equal(index(v, 2), [3, 4])
    elements = array(vec(1.0, 2.0), vec(np.array([3.0, 4.0]), 5.0))
    assert elements.shape == (2, 2, 2)
    np.testing.assert_array_equal(index(elements, np.array([1, 0])), [[3, 1], [5, 2]])
    np.testing.assert_array_equal(store_index(v, places, 9.0), [[1, 1], [2, 2], [9, 4]])
    np.testing.assert_array_equal(store_index(elements, 1, vec(0.0, 0.0))[1], [[0, 0], [0, 0]])


def test_select_and_equality() -> None:
    mask = np.array([True, False])
    np.testing.assert_array_equal(select(mask, vec(1.0, 2.0), vec(3.0, 4.0)), [[1, 3], [2, 4]])
    one, two = Record(a=1.0, b=vec(1.0, 2.0)), Record(a=1.0, b=vec(1.0, np.array([2.0, 3.0])))
    np.testing.assert_array_equal(equals(one, two), [True, False])
    np.testing.assert_array_equal(select(mask, one, two.replace(a=5.0)).a, [1, 5])
    assert one.a == 1.0 and "a=1.0" in repr(one)
    assert equals(2, 2) and not equals(vec(1.0, 2.0), vec(1.0, 3.0))
    assert equals(diagonal(2, 1.0), diagonal(2, 1.0)).shape == (1,)


def test_conversions() -> None:
    np.testing.assert_array_equal(to_int(np.array([1.9, -1.9, np.nan, 1e20])), [1, -1, 0, 2**31 - 1])
    np.testing.assert_array_equal(to_uint(np.array([1.9, -1.9, 1e20])), [1, 0, 2**32 - 1])
    assert to_int(np.uint32(2**32 - 1)) == -1 and to_uint(-1) == 2**32 - 1 and to_uint(-1).dtype == np.uint32
    assert to_int(True) == 1 and to_float(True) == 1.0 and to_int(2.5).dtype == np.int32
    np.testing.assert_array_equal(to_bool(np.array([0.0, -0.5])), [False, True])


@given(INTS, INTS)
def test_integer_division(x: int, y: int) -> None:
    quotient, remainder = int_divide(x, y), int_remainder(x, y)
    assert quotient.dtype == remainder.dtype == np.int32
    if y == 0:
        assert (quotient, remainder) == (x, 0)
    else:
        exact = abs(x) // abs(y) * (1 if (x < 0) == (y < 0) else -1)
        assert quotient == (exact if exact < 2**31 else -(2**31))
        assert remainder == x - exact * y


def test_integer_edges() -> None:
    assert int_divide(-(2**31), -1) == -(2**31) and int_remainder(-(2**31), -1) == 0
    assert int_divide(np.uint32(2**32 - 1), np.uint32(2)) == 2**31 - 1
    assert shift_left(1, 33) == 2 and shift_right(-8, 1) == -4 and shift_right(np.uint32(2**31), 31) == 1
    assert shift_left(np.uint32(1), 31).dtype == np.uint32


def test_open_cases() -> None:
    nan = float("nan")
    assert np.isnan(rt.clamp(nan, 0.0, 1.0)) and rt.min(1.0, nan) == 1.0 and rt.max(1.0, nan) == 1.0
    assert rt.smoothstep(1.0, 0.0, 0.25) == 0.84375
    assert divide(1.0, 0.0) == math.inf and np.isnan(divide(0.0, 0.0))
    assert np.isnan(rt.normalize(vec(0.0, 0.0))).all() and rt.normalize(-3.0) == -1.0
    assert np.isnan(rt.inverse(diagonal(2, 0.0))).any()
    assert rt.refract(vec(1.0, 0.0), vec(0.0, 1.0), 1.5).tolist() == [[0.0], [0.0]]
    assert rt.pow(0.0, -1.0) == math.inf and np.isnan(rt.pow(-1.0, 0.5))


def test_refract_obeys_snell() -> None:
    angle = np.linspace(0.0, 1.5, 50)
    bent = rt.refract(vec(np.sin(angle), -np.cos(angle)), vec(0.0, 1.0), 1.0 / 1.31)
    np.testing.assert_allclose(bent[0], np.sin(angle) / 1.31, atol=1e-15)
    np.testing.assert_allclose(rt.length(bent), 1.0)


# Textures

ROW = np.array([[[0.0], [1.0], [2.0], [3.0]]])


def test_texel_centres_and_filters() -> None:
    at = vec(np.array([0.125, 0.25, 0.375, 0.0, 1.0]), 0.5)
    np.testing.assert_allclose(rt.texture(Texture(ROW), at)[0], [0.0, 0.5, 1.0, 1.5, 1.5])
    np.testing.assert_allclose(rt.texture(Texture(ROW, wrap="clamp"), at)[0], [0.0, 0.5, 1.0, 0.0, 3.0])
    np.testing.assert_allclose(rt.texture(Texture(ROW, filter="nearest"), at)[0], [0.0, 1.0, 1.0, 0.0, 0.0])
    mirrored = rt.texture(Texture(ROW, wrap="mirror", filter="nearest"), vec(np.array([-0.1, 1.1, 2.1]), 0.5))
    np.testing.assert_array_equal(mirrored[0], [0.0, 3.0, 0.0])
    np.testing.assert_array_equal(rt.texture(Texture(ROW), at)[1:, 0], [0, 0, 1])


def test_row_zero_is_at_v_zero_and_3d() -> None:
    image = np.arange(6.0).reshape(3, 2, 1)
    np.testing.assert_allclose(rt.texture(Texture(image), vec(0.25, np.array([1, 3, 5]) / 6))[0], [0, 2, 4])
    volume = Texture(np.arange(24.0).reshape(4, 3, 2, 1))
    np.testing.assert_allclose(rt.texture(volume, vec(0.75, 0.5, np.array([0.125, 0.25])))[0], [3, 6])
    assert rt.textureSize(volume, 0)[:, 0].tolist() == [2, 3, 4]
    place = vec(np.array([1, 2], np.int32), 1, 3)
    np.testing.assert_array_equal(rt.texelFetch(volume, place, 0)[0], [21, 0])


def test_mipmaps() -> None:
    texture = Texture(np.arange(16.0).reshape(4, 4, 1), mipmaps=True)
    assert len(texture.levels) == 3 and rt.textureSize(texture, 1)[:, 0].tolist() == [2, 2]
    centre = vec(0.5, 0.5)
    assert rt.textureLod(texture, vec(0.3, 0.9), 2.0)[0] == 7.5 == rt.textureLod(texture, centre, 99.0)[0]
    np.testing.assert_allclose(rt.textureLod(texture, vec(0.25, 0.25), np.array([1.0, 1.5]))[0], [2.5, 5.0])
    wide = vec(0.5, 0.0)  # half the texture from pixel to pixel: two texels, level 1
    np.testing.assert_allclose(rt.textureGrad(texture, vec(0.25, 0.25), wide, vec(0.0, 0.0))[0], 2.5)
    with pytest.raises(RuntimeError, match="grid"):
        rt.texture(texture, centre)
    with grid(2, 2):
        u, v = np.array([0.0, 0.5, 0.0, 0.5]) + 0.25, np.array([0.0, 0.0, 0.5, 0.5]) + 0.25
        np.testing.assert_allclose(rt.texture(texture, vec(u, v))[0], [2.5, 4.5, 10.5, 12.5])
        np.testing.assert_allclose(rt.texture(texture, vec(u, v), 9.0)[0], 7.5)
    odd = Texture(np.array([[[1.0], [2.0], [6.0]]]), mipmaps=True)
    np.testing.assert_allclose(odd.levels[1][..., 0], [[3.0]])


def test_cube_faces_and_edges() -> None:
    size = 4
    faces = np.arange(6.0)[:, None, None, None] + np.zeros((1, size, size, 1))
    cube = Texture(faces, dim="Cube")
    axes = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float).T
    np.testing.assert_array_equal(rt.texture(cube, axes)[0], range(6))
    assert rt.textureSize(cube, 0)[:, 0].tolist() == [4, 4]
    assert rt.texture(cube, vec(1.0, 0.0, 0.999999))[0] == pytest.approx((0 + 4) / 2, abs=1e-4)
    # A linear function of the direction, sampled at texel centres, is continuous over the edges.
    ramp = np.zeros((6, 32, 32, 3))
    c = (np.arange(32) + 0.5) / 16 - 1
    for face, (s, t, m) in enumerate(_FACES):
        d = s * c[None, :, None] + t * c[:, None, None] + m
        ramp[face] = d / np.linalg.norm(d, axis=-1, keepdims=True)
    directions = np.random.default_rng(3).normal(size=(3, 500))
    directions /= np.linalg.norm(directions, axis=0)
    np.testing.assert_allclose(rt.texture(Texture(ramp, dim="Cube"), directions)[:3], directions, atol=0.03)


def test_bad_textures() -> None:
    for data, filter, wrap, dim in (
        (np.zeros((2, 2)), "linear", "repeat", ""),
        (np.zeros((5, 2, 2, 1)), "linear", "repeat", "Cube"),
        (np.zeros((2, 2, 5)), "linear", "repeat", ""),
        (ROW, "cubic", "repeat", ""),
        (ROW, "linear", "border", ""),
    ):
        with pytest.raises(ValueError, match=r"Texture|texture|cube"):
            Texture(data, filter, wrap, dim)


def test_derivatives() -> None:
    x, y = (a.ravel() for a in np.meshgrid(np.arange(5.0), np.arange(4.0)))
    with pytest.raises(RuntimeError, match="grid"):
        rt.dFdx(x)
    with grid(4, 5):
        np.testing.assert_array_equal(rt.dFdx(3.0 * x + y), np.full(20, 3.0))
        np.testing.assert_array_equal(rt.dFdy(vec(x, 2.0 * y)), [np.zeros(20), np.full(20, 2.0)])
        np.testing.assert_array_equal(rt.fwidth(x - 2.0 * y), np.full(20, 3.0))
        np.testing.assert_array_equal(rt.dFdx(x * x).reshape(4, 5)[0], [1, 1, 5, 5, 7])
        assert rt.dFdx(2.0) == 0.0 and rt.dFdx(vec(1.0, 2.0)).shape == (2, 1)
        with pytest.raises(ValueError, match="lanes"):
            rt.dFdx(x[:7])


# Textures with layers, of integers, that compare


def test_layers_are_chosen_by_the_last_component() -> None:
    layers = Texture(np.stack([np.full((2, 4, 1), value) for value in (1.0, 2.0, 5.0)]), layers=True)
    assert (layers.dim, layers.size(), layers.axes) == ("2D", (4, 2), 2)
    nearest = np.array([-3.0, 0.4, 0.6, 1.4, 9.0])
    np.testing.assert_array_equal(rt.texture(layers, vec(0.3, 0.7, nearest))[0], [1, 1, 2, 2, 5])
    np.testing.assert_array_equal(rt.textureLayer(layers, vec(0.3, 0.7), np.array([0, 1, 2]))[0], [1, 2, 5])
    np.testing.assert_array_equal(rt.textureSize(layers, 0)[:, 0], [4, 2, 3])
    place = np.array([[1, 1, 1], [0, 0, 2], [2, 3, 0]])
    np.testing.assert_array_equal(rt.texelFetch(layers, place, 0)[0], [5, 0, 0])  # outside it is 0
    cubes = Texture(np.arange(12.0).reshape(2, 6, 1, 1, 1) * np.ones((1, 1, 2, 2, 1)), dim="Cube", layers=True)
    directions = np.array([[1.0, 0.0], [0.0, -1.0], [0.0, 0.0], [1.0, 0.0]])
    np.testing.assert_array_equal(rt.textureLod(cubes, directions, 0.0)[0], [6, 3])
    np.testing.assert_array_equal(rt.textureSize(cubes, 0)[:, 0], [2, 2, 2])


def test_texels_of_integers_keep_all_their_bits() -> None:
    numbers = np.array([[[-(2**31)], [2**31 - 1]]])
    ints = Texture(numbers, kind="int")
    actual = rt.texelFetch(ints, np.array([[0, 1], [0, 0]]), 0)
    assert actual.dtype == np.int32
    np.testing.assert_array_equal(actual, [[-(2**31), 2**31 - 1], [0, 0], [0, 0], [1, 1]])
    uints = Texture(np.array([[[2**32 - 1]]]), kind="uint")
    assert rt.texelFetch(uints, np.array([[0], [0]]), 0)[0, 0] == 2**32 - 1


def test_a_comparison_precedes_the_filter() -> None:
    shade = Texture(np.array([[[0.25], [0.75]]]), wrap="clamp", compare=True)
    reference = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    across = np.array([0.5] * 5)  # half way between the texels
    np.testing.assert_array_equal(rt.texture(shade, vec(across, 0.5, reference)), [1, 1, 0.5, 0.5, 0])
    np.testing.assert_array_equal(rt.textureCompare(shade, vec(0.0, 0.5), reference), [1, 1, 0, 0, 0])
    np.testing.assert_array_equal(rt.textureLod(shade, vec(1.0, 0.5, reference), 0.0), [1, 1, 1, 1, 0])
    assert rt.textureGather(Texture(np.ones((1, 1, 1)), compare=True), np.zeros((2, 1)), 7.0).tolist() == [[1.0]] * 4
    shades = Texture(np.array([[[[0.25]]], [[[0.75]]]]), layers=True, compare=True)
    np.testing.assert_array_equal(rt.texture(shades, vec(0.5, 0.5, np.array([0.0, 1.0]), 0.5)), [0, 1])


def test_offsets_are_in_texels_of_each_level() -> None:
    texture = Texture(np.arange(16.0).reshape(4, 4, 1), wrap="clamp", mipmaps=True)
    middle = vec(0.375, 0.375)  # of texel (1, 1) of level 0
    np.testing.assert_allclose(rt.textureLodOffset(texture, middle, 0.0, vec(1, 2))[0], 14.0)
    np.testing.assert_allclose(rt.textureLodOffset(texture, middle, 0.0, vec(-1, 0))[0], 4.0)
    half = vec(0.25, 0.25)  # of texel (0, 0) of level 1, whose texels are 2.5, 4.5, 10.5, 12.5
    np.testing.assert_allclose(rt.textureLodOffset(texture, half, 1.0, vec(1, 0))[0], 4.5)
    np.testing.assert_allclose(rt.textureLodOffset(texture, half, 1.0, vec(0, 1))[0], 10.5)
    np.testing.assert_array_equal(rt.texelFetchOffset(texture, np.array([[1], [1]]), 0, vec(1, -1))[0], 2.0)


def test_a_gather_returns_the_texels_of_the_linear_filter() -> None:
    image = np.zeros((2, 3, 4))
    image[..., 2] = np.arange(6.0).reshape(2, 3)
    texture = Texture(image, wrap="clamp")
    np.testing.assert_array_equal(rt.textureGather(texture, vec(0.4, 0.5), 2)[:, 0], [3, 4, 1, 0])
    np.testing.assert_array_equal(rt.textureGatherOffset(texture, vec(0.4, 0.5), vec(1, 0), 2)[:, 0], [4, 5, 2, 1])
    np.testing.assert_array_equal(rt.textureGather(texture, vec(0.4, 0.5))[:, 0], [0, 0, 0, 0])
    assert rt.textureQueryLevels(texture) == 1


@pytest.mark.parametrize("data", [np.zeros((2, 2, 1)), np.zeros((2, 2, 2, 2, 1))])
def test_layers_are_an_axis_of_their_own(data: np.ndarray) -> None:
    with pytest.raises(ValueError, match="see Texture"):
        Texture(data, dim="2D", layers=True)
