"""The media: their file, their units, and the messages for wrong ones."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sssgen.material.scatter_color import albedo_of_color
from sssgen.scene.measured.measured_scene import of_scene
from sssgen.scene.measured.media import Medium, media, preset
from sssgen.scene.scene_loading import parse_scene
from sssgen.support.diagnostics import SssgenError

# The diffuse reflectances from the same table.
REFLECTANCES = {
    "apple": (0.85, 0.84, 0.53),
    "chicken1": (0.31, 0.15, 0.10),
    "chicken2": (0.32, 0.16, 0.10),
    "cream": (0.98, 0.90, 0.73),
    "ketchup": (0.16, 0.01, 0.00),
    "marble": (0.83, 0.79, 0.75),
    "potato": (0.77, 0.62, 0.21),
    "skimmilk": (0.81, 0.81, 0.69),
    "skin1": (0.44, 0.22, 0.13),
    "skin2": (0.63, 0.44, 0.34),
    "spectralon": (1.00, 1.00, 1.00),
    "wholemilk": (0.91, 0.88, 0.76),
}
JENSEN = list(REFLECTANCES)


def diffuse_reflectance(albedo: float, ior: float) -> float:
    """The diffuse reflectance of a half-space: Jensen et al. 2001, equation 8 in its integrated form."""
    inside = -1.440 / ior**2 + 0.710 / ior + 0.668 + 0.0636 * ior
    a = (1.0 + inside) / (1.0 - inside)
    root = np.sqrt(3.0 * (1.0 - albedo))
    return float(0.5 * albedo * (1.0 + np.exp(-4.0 / 3.0 * a * root)) * np.exp(-root))


@pytest.mark.parametrize("name", JENSEN)
def test_coefficients_give_the_published_reflectance(name: str) -> None:
    medium = preset(name)
    actual = [diffuse_reflectance(albedo, medium.ior) for albedo in medium.albedo]
    # published coefficients have about two digits, reflectances two decimal places
    assert np.allclose(actual, REFLECTANCES[name], atol=0.03), (actual, REFLECTANCES[name])


def test_every_medium_has_a_source() -> None:
    for name, result in media().items():
        assert len(result.source) > 20, name
        assert result.measured == (name in JENSEN), name
        assert result.measured or "chosen by us" in result.source.lower() or "No published" in result.source, name


def test_absorption_of_ice_follows_from_its_refractive_index() -> None:
    # the imaginary index that Warren and Brandt give for 610, 550 and 460 nm
    index, wavelength_mm = np.array([6.890e-9, 2.289e-9, 1.325e-10]), np.array([610e-6, 550e-6, 460e-6])
    assert np.allclose(preset("ice").absorption, 4.0 * np.pi * index / wavelength_mm, rtol=1e-3)


def test_coefficients_scale_with_the_world_unit() -> None:
    in_mm, in_cm = preset("marble"), preset("marble", unit_mm=10.0)
    assert np.allclose(np.multiply(in_mm.absorption, 10.0), in_cm.absorption)
    assert np.allclose(np.multiply(in_mm.scattering, 10.0), in_cm.scattering)
    assert in_mm.albedo == pytest.approx(in_cm.albedo)


def test_similar_media_have_the_same_reduced_scattering() -> None:
    isotropic, forward = preset("wholemilk"), preset("wholemilk", anisotropy=0.75)
    assert np.allclose(np.multiply(forward.scattering, 1.0 - 0.75), isotropic.scattering)
    assert forward.absorption == isotropic.absorption
    assert forward.anisotropy == 0.75


def test_a_matched_medium_differs_only_in_its_index() -> None:
    medium = preset("skin1")
    assert medium.ior == 1.3
    assert medium.matched() == Medium("skin1", medium.absorption, medium.scattering, 0.0, 1.0, medium.source)


def test_a_medium_without_interaction_has_albedo_0() -> None:
    assert Medium("air", (0.0,) * 3, (0.0,) * 3).albedo == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: preset("marbel"), "did you mean 'marble'?"),
        (lambda: preset("granite"), "media: apple, "),
        (lambda: preset("marble", unit_mm=0.0), "unit_mm is above 0"),
        (lambda: preset("marble", anisotropy=1.0), "between -1 and 1"),
        (lambda: Medium("x", (-1.0, 0.0, 0.0), (0.0, 0.0, 0.0)), "it is at least 0"),
        (lambda: Medium("x", (0.0, 0.0, 0.0), (0.0, float("nan"), 0.0)), "it is at least 0"),
        (lambda: Medium("x", (0.0,) * 3, (0.0,) * 3, anisotropy=-1.0), "between -1 and 1"),
        (lambda: Medium("x", (0.0,) * 3, (0.0,) * 3, ior=0.5), "from 1 to 10"),
    ],
)
def test_wrong_media_are_refused(make: Callable[[], Medium], message: str) -> None:
    with pytest.raises(SssgenError) as caught:
        make()
    assert message in str(caught.value)


def test_every_error_of_a_file_has_its_place(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        '[soap]\nreduced_scatering = [1.0, 1.0, 1.0]\nabsorption = [-1.0, 0.0, 0.0]\nsource = "mine"\n'
        '[tea]\nreduced_scattering = [1.0, 1.0]\nabsorption = [1.0, 1.0, 1.0]\nmeasured = "yes"\n',
        encoding="utf-8",
    )
    with pytest.raises(SssgenError) as caught:
        media(str(file))
    text = str(caught.value)
    assert "did you mean 'reduced_scattering'?" in text
    assert "mine.toml:3:15" in text and "'absorption' cannot be -1" in text
    assert "'soap' has no 'reduced_scattering'" in text and "'tea' has no 'source'" in text
    assert "'reduced_scattering' takes 3 numbers" in text and "'measured' is true or false" in text


def test_media_of_a_users_file(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    text = '[soap]\nreduced_scattering = [3.0, 2.0, 1.0]\nabsorption = [0, 0.1, 0.2]\nsource = "mine"\n'
    file.write_text(text, encoding="utf-8")
    assert preset("soap", 2.0, file=str(file)) == Medium("soap", (0.0, 0.2, 0.4), (6.0, 4.0, 2.0), 0.0, 1.0, "mine")


def medium_of(lines: str) -> Medium | None:
    text = f'[geometry]\nkind = "ball"\n[[light]]\ndirection = [0.0, 1.0, 0.0]\n[medium]\n{lines}\n'
    return of_scene(parse_scene(text, "look.toml"), "look.toml").medium


def test_a_scene_gives_the_look_of_its_medium() -> None:
    medium = medium_of("color = [0.8, 0.2, 0.1]\ndepth = [0.5, 0.25, 0.1]\nior = 1.4")
    assert medium is not None and medium.ior == 1.4
    assert np.allclose(medium.extinction, (2.0, 4.0, 10.0))
    assert np.allclose(medium.albedo, [albedo_of_color(part) for part in (0.8, 0.2, 0.1)])
    forward = medium_of("color = [0.8, 0.2, 0.1]\ndepth = [0.5, 0.25, 0.1]\nanisotropy = 0.7")
    assert forward is not None and forward.albedo[0] > medium.albedo[0]


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("color = [0.8, 0.2, 0.1]", "the medium has a color and no depth"),
        ("depth = [0.8, 0.2, 0.1]", "the medium has a depth and no color"),
        ("color = [0.8, 0.2, 0.1]\ndepth = [1.0, 1.0, 1.0]\nscattering = [1.0, 1.0, 1.0]", "give the scattering"),
        ('preset = "wax"\ncolor = [0.8, 0.2, 0.1]', "a preset has its own color"),
        ("color = [0.8, 0.2, 1.1]\ndepth = [1.0, 1.0, 1.0]", "'color' cannot be 1.1"),
        ("color = [0.0, 0.0, 0.0]\ndepth = [1.0, 1.0, 1.0]", "this medium does not scatter"),
        ("color = [0.8, 0.2, 0.1]\ndepth = [1.0, 1.0, 1.0]\nunit_mm = 10.0", "leave unit_mm out"),
    ],
)
def test_a_faulty_look_is_an_error_at_its_place(lines: str, message: str) -> None:
    with pytest.raises(SssgenError, match=r"look\.toml:[678]") as caught:
        medium_of(lines)
    assert message in str(caught.value)
