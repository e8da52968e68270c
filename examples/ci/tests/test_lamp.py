"""The lamp: its shaders compile, its picture is the one that was kept, its light is what the formula says."""

import math

MATERIAL, SCENE = "materials/lamp.toml", "scenes/lamp.toml"


def test_every_compiler_takes_it(sssgen_compile):
    sssgen_compile(MATERIAL)


def test_it_looks_as_it_did(sssgen_golden):
    sssgen_golden(SCENE, "lamp")


def test_it_is_in_the_middle(sssgen_render):
    picture = sssgen_render(SCENE, size=(48, 36))
    assert picture.covered[18, 24] == 1.0
    assert picture.covered[0, 0] == 0.0


def test_half_a_metre_of_wax_leaves_37_percent(sssgen_run):
    through = sssgen_run("beer_lambert", d=[0.0, 0.5, 1.0], attenuation_distance=0.5)["result"]
    assert abs(through - [1.0, math.exp(-1), math.exp(-2)]).max() < 1e-6
