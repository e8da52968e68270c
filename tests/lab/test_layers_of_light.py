"""The light's way through a concave body, from the layers that the light sees."""

from __future__ import annotations

import pytest

from measured_views import small
from sssgen.lab.measure import candidates
from sssgen.lab.measure.fitting import FitResult
from sssgen.lab.measure.measurement import View, measure_candidate

pytest.importorskip("scipy", reason="scipy is missing: pip install -e '.[chart]'")
pytest.importorskip("flip_evaluator", reason="flip-evaluator is missing: pip install -e '.[chart]'")

pytestmark = pytest.mark.usefixtures("no_cache")


@pytest.mark.parametrize("name", ["torus", "bracket"])
def test_layers_see_the_gap_of_a_concave_body(name: str) -> None:
    """The charts read the map of each light; the error that is left is that of the texels at silhouettes."""
    errors = {}
    for path in ("depth_map_path", "depth_layers_path"):
        option = next(option for option in candidates.thickness() if option.name == path)
        unfitted = FitResult({}, (1.0,) * 3, (0.0,) * 3, 0.0)
        errors[path] = measure_candidate(option, unfitted, [View("own", small(name))])["error"]["value"]
    assert errors["depth_layers_path"] < 0.7 * errors["depth_map_path"], errors
