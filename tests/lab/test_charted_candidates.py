"""Which candidates are charted on a scene: by its boundary and by its lights."""

from __future__ import annotations

from dataclasses import replace

from sssgen.lab.chart import charting as chart
from sssgen.lab.measure import candidates
from sssgen.scene.measured import measured_scene
from sssgen.scene.scene import Light


def test_refraction_is_charted_where_the_body_refracts() -> None:
    scene = measured_scene.load("cube")
    assert scene.medium is not None
    refracting = replace(scene, medium=replace(scene.medium, ior=1.4))
    chain = ("exact_view_thickness", "interior_octaves_refracted")
    bent, plain = (
        candidates.Candidate("translucency", names[-1], names[-1], (), names, False, "march_light")
        for names in (chain, ("wrap_lighting",))
    )
    assert [chart.applies(case, bent) for case in (scene, refracting)] == [False, True]
    assert [chart.applies(case, plain) for case in (scene, refracting)] == [True, True]
    assert all(chart.applies(scene, candidate) for candidate in candidates.coordinates())
    # the light of a bake contains the boundary: one that does not refract is wrong there
    baked, of_boundary = (
        candidates.Candidate("translucency", name, name, (), ("exact_view_thickness", name), False, path)
        for name, path in (("fluence_factored_4", "march_light"), ("fluence_factored_4_refracted", ""))
    )
    assert [chart.applies(case, baked) for case in (scene, refracting)] == [True, False]
    assert [chart.applies(case, of_boundary) for case in (scene, refracting)] == [False, True]
    chain = ("exact_view_thickness", "fluence_relit_once")  # which says that it is for both
    both = candidates.Candidate("translucency", chain[-1], chain[-1], (), chain, False, "")
    assert [chart.applies(case, both) for case in (scene, refracting)] == [True, True]


def test_maps_of_distant_lights_are_charted_where_all_lights_are_distant() -> None:
    scene = measured_scene.load("cube")
    near = replace(scene, lights=(*scene.lights, Light((0.0, 3.0, 0.0), None, (1.0, 1.0, 1.0))))
    chain = ("exact_view_thickness", "interior_octaves")
    mapped, marched = (
        candidates.Candidate("translucency", chain[-1], chain[-1], (), chain, False, path)
        for path in ("depth_map_path", "march_light")
    )
    assert [chart.applies(case, mapped) for case in (scene, near)] == [True, False]
    assert [chart.applies(case, marched) for case in (scene, near)] == [True, True]
