"""Charts from records: the front and the hypervolume, where everything stands, and files that are always the same."""

from __future__ import annotations

import csv
import html
import io
import itertools
import json
import math
import random
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sssgen.harness.backends.browser_page import find
from sssgen.lab.chart import drawing
from sssgen.lab.chart.drawing import figure
from sssgen.lab.chart.drawing.layout import LONGEST_NOTE, NOTE, Chart, chart, series, styles
from sssgen.lab.chart.drawing.scale import number, scale, tick
from sssgen.lab.chart.drawing.summary import medians
from sssgen.lab.chart.record import checked, front, hypervolume, measures, to_csv, to_json
from sssgen.support.diagnostics import SssgenError

SCENES = {"slab": "A slab <b>&", "ball": "Ball, lit from behind", "cube": "Marble $x^2$ cube"}
OURS = ("march_light", "thinness_uniform", "thinness_hemisphere", "constant_thickness", "thickness_map")
BASELINES = ("depth_map_absorption", "gltf_volume", "cheap_sss_thinness", "distance_field_march")


def point(cost: float, error: float | None, **more: Any) -> dict[str, Any]:
    made = {"scene": "slab", "role": "thickness", "name": "some", "label": "some", "baseline": False, "failed": ""}
    return {**made, "cost": {"value": cost}, "error": {"value": error}, "front": False, **more}


def record(roles: tuple[str, ...] = ("thickness",), scenes: tuple[str, ...] = tuple(SCENES)) -> dict[str, Any]:
    """Techniques with one to four settings each; distance_field_march fails on the ball, one error is 0."""
    points: list[dict[str, Any]] = []
    volumes = []
    for role, scene in itertools.product(roles, scenes):
        here = []
        for name in (*OURS, *BASELINES):
            draw = random.Random(f"{role} {name}")
            cost, error = 10.0 ** draw.uniform(0.8, 2.0), 10.0 ** draw.uniform(-1.5, 0.3)
            error *= 10.0 ** random.Random(f"{scene} {name}").uniform(-0.3, 0.3)
            for taps in (4, 8, 16, 32) if name.startswith(("march", "thin", "distance_field_march")) else (0,):
                failed = "12 of 4096 points are NaN" if (scene, name) == ("ball", "distance_field_march") else ""
                found = 0.0 if (scene, name) == ("slab", "constant_thickness") else error / (1.0 + taps)
                made = point(cost * (1.0 + taps), None if failed else found, failed=failed)
                made |= {"scene": scene, "role": role, "name": name, "baseline": name in BASELINES}
                made |= {"label": f"{name}, {taps} taps" if taps else name, "settings": {"steps": taps}}
                made |= {"parameters": {"scale": 0.1 + taps}, "chain": [name, "beer_lambert"]}
                made |= {"implementation": {"gl": 1e-6}}
                made["cost"] |= {"operations": round(cost), "gpu_ms": None}
                if not failed:
                    made["error"] |= {"low": 0.8 * found, "high": 1.3 * found, "bias": -found / 3.0}
                here.append(made)
        best = {id(one) for one in front(here)}
        for one in here:
            one["front"] = id(one) in best
        corner = (1e4, 10.0)
        ours, baselines = ([one for one in here if one["baseline"] is kind] for kind in (False, True))
        volumes.append({"scene": scene, "role": role, "reference_point": list(corner)})
        volumes[-1] |= {"ours": hypervolume(ours, corner), "baselines": hypervolume(baselines, corner)}
        points += here
    return {
        "format": 1,
        "record": {"commit": "0123456789abcdef", "seed": 0, "samples": 4096, "software": False, "versions": {"a": "1"}},
        "cost": "static",
        "cost_unit": "operations (weighted)",
        "scenes": [{"name": scene, "title": SCENES[scene]} for scene in scenes],
        "points": points,
        "hypervolume": volumes,
    }


NUMBERS = st.sampled_from([0.0, 1e-7, 0.1, 0.25, 1.0, 3.0, 40.0])


@given(st.lists(st.tuples(NUMBERS, NUMBERS, st.booleans()), max_size=12))
def test_front_is_what_nothing_beats(given_points: list[tuple[float, float, bool]]) -> None:
    points = [point(cost, error, failed="NaN" if failed else "") for cost, error, failed in given_points]

    def beaten(one: dict[str, Any]) -> bool:
        x, y = measures(one)
        others = [measures(other) for other in points if not other["failed"]]
        return any(cost <= x and error <= y and (cost, error) != (x, y) for cost, error in others)

    wanted = [id(one) for one in points if not one["failed"] and not beaten(one)]
    found = front(points)
    assert sorted(id(one) for one in found) == sorted(wanted)
    assert [measures(one)[0] for one in found] == sorted(measures(one)[0] for one in found)


def test_hypervolume_in_closed_form() -> None:
    corner = (1000.0, 1.0)
    assert hypervolume([point(100.0, 0.1)], corner) == pytest.approx(1.0)
    assert hypervolume([point(10.0, 0.1)], corner) == pytest.approx(2.0)
    stairs = [point(100.0, 0.001), point(10.0, 0.1), point(200.0, 0.5)]
    assert hypervolume(stairs, corner) == pytest.approx(2.0 * 1.0 + 1.0 * 2.0)
    assert hypervolume([*stairs, point(1.0, 1e-5, failed="NaN")], corner) == pytest.approx(4.0)
    assert hypervolume([point(2000.0, 0.1), point(10.0, 2.0)], corner) == hypervolume([], corner) == 0.0
    assert hypervolume([point(100.0, 0.0)], corner) == pytest.approx(6.0)  # as much as the least error that counts


@given(st.lists(st.tuples(NUMBERS, NUMBERS), max_size=8), NUMBERS, NUMBERS)
def test_one_point_more_is_no_less_hypervolume(some: list[tuple[float, float]], cost: float, error: float) -> None:
    points = [point(*one) for one in some]
    assert hypervolume([*points, point(cost, error)], (50.0, 2.0)) >= hypervolume(points, (50.0, 2.0))


def test_checks() -> None:
    good = record()
    assert checked(good) == good
    odd = json.loads(json.dumps(good))
    odd["points"][0]["error"] |= {"bias": math.nan, "high": math.inf}
    assert checked(odd)["points"][0]["error"]["bias"] is None is checked(odd)["points"][0]["error"]["high"]
    assert math.isnan(odd["points"][0]["error"]["bias"])  # it is a copy

    wrong = json.loads(json.dumps(good))
    wrong |= {"format": 2, "cost": 3}
    wrong["points"][0] |= {"scene": "slap", "role": "colour"}
    wrong["points"][1] |= {"label": "", "error": {"value": None}}
    wrong["points"][2] |= {"cost": {"value": "much"}, "error": {"value": -1.0}}
    wrong["hypervolume"][0]["ours"] = None
    with pytest.raises(SssgenError) as raised:
        checked(wrong)
    said = str(raised.value)
    for part in (
        "its format is 2",
        "'cost' is missing",
        "point 0: its scene 'slap' is unknown: did you mean 'slab'?",
        "point 0: its role 'colour' is none of coordinates,",
        "point 1: 'label' is missing",
        "point 1: error.value is not finite, and 'failed' does not say why",
        "point 2: cost.value is no number",
        "point 2: error.value is below 0",
        "hypervolume 0: 'ours'",
    ):
        assert part in said
    with pytest.raises(SssgenError, match="no JSON object"):
        checked([])


def test_csv_has_every_number() -> None:
    made = record()
    rows = list(csv.DictReader(io.StringIO(to_csv(made))))
    assert len(rows) == len(made["points"])
    for row, one in zip(rows, made["points"], strict=True):
        assert row["label"] == one["label"] and float(row["cost_value"]) == one["cost"]["value"]
        error = one["error"]["value"]
        assert row["error_value"] == ("" if error is None else repr(error)) and row["failed"] == one["failed"]
        assert json.loads(row["settings"]) == one["settings"]


def test_json_does_not_depend_on_the_order_of_entries() -> None:
    made = record()
    turned = {**dict(reversed(made.items())), "points": [dict(reversed(one.items())) for one in made["points"]]}
    assert to_json(made) == to_json(turned) and json.loads(to_json(made)) == made


def test_medians() -> None:
    def on(scene: str, cost: float, error: float | None, name: str = "a") -> dict[str, Any]:
        return point(cost, error, scene=scene, name=name, label=name, failed="" if error is not None else "NaN")

    points = [on("slab", 1.0, 0.1), on("ball", 3.0, 0.3), on("cube", 9.0, None)]
    points += [on("slab", 2.0, None, "b"), on("ball", 2.0, None, "b"), on("cube", 2.0, 0.1, "b")]
    one, other = medians({"points": points}, "thickness")
    assert measures(one) == (3.0, 0.3) and one["front"] and not one["failed"]
    assert other["failed"] == "fails on 2 of 3 scenes" and not other["front"]


@pytest.mark.parametrize(
    ("values", "texts"),
    [
        ([1.0, 1000.0], ["1", "10", "100", "1,000"]),
        ([0.02, 0.2], ["0.02", "0.05", "0.1", "0.2"]),
        ([0.0, 0.1, 1.0], ["0.1", "0.2", "0.5", "1", "<10⁻⁶"]),
        ([1e-5, 1e9], ["10⁻⁴", "1", "10,000", "10⁸"]),
    ],
)
def test_ticks(values: list[float], texts: list[str]) -> None:
    made = scale(values, 0.0, 0.0)
    assert [text for _, text in made.ticks()] == texts
    assert all(-1e-9 <= place <= 1.0 + 1e-9 for place, _ in made.ticks())
    assert made.at(max(values)) == pytest.approx(1.0) and made.at(min(values)) == pytest.approx(0.0)


def test_numbers_for_people() -> None:
    assert [number(value) for value in (None, 0.0, 12.345, 123456.7, 2.5e-6)] == [
        "–",
        "0",
        "12.3",
        "123,457",
        "2.5e-06",
    ]
    assert tick(5.0, -7) == "5·10⁻⁷"


def all_charts() -> list[Chart]:
    made = checked(record(("thickness", "material")))
    return [chart(made, "thickness"), chart(made, "material"), chart(checked(record(scenes=("slab",))), "thickness")]


@pytest.mark.parametrize("which", range(3))
def test_everything_has_its_place(which: int) -> None:
    made = all_charts()[which]
    assert len(made.panels) == (1 if which == 2 else 4)
    for panel in made.panels:
        plot = panel.plot
        assert 0.0 < plot.left < plot.right < made.width and 0.0 < plot.top < plot.bottom < made.height
        assert all(plot.has(dot.x, dot.y) for dot in panel.dots)
        best = [dot for dot in panel.dots if not dot.faint]
        assert best == panel.dots[-len(best) :] and not any(dot.failed for dot in best)
        assert len(panel.labels) >= 0.8 * len(best) > 0
        for label, style in panel.labels:
            assert plot.has(*label.box[:2]) and plot.has(*label.box[2:])
            of_it = [str(dot.point["label"]) for dot in best if dot.style == style]
            assert any(shown.endswith(label.text) for shown in of_it)
            assert not any(label.box.has(dot.x, dot.y) for dot in best)
        for (one, _), (other, _) in itertools.combinations(panel.labels, 2):
            assert not one.box.overlap(other.box)
        for dot in panel.dots:  # nothing lies below the front's line
            assert dot.failed or any(dot.x >= x - 1e-9 and dot.y <= y + 1e-9 for x, y in panel.front)
    names = [style.name for _, style in made.key]
    assert sorted(names) == sorted({series(dot.point) for panel in made.panels for dot in panel.dots})


def test_techniques_look_different() -> None:
    points = [point(1.0, 1.0, name=f"technique {at:02}", baseline=at > 20) for at in range(42)]
    looks = styles(points).values()
    assert len({(style.color, style.marker) for style in looks}) == 42
    assert [style.hollow for style in looks] == [False] * 21 + [True] * 21


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A drawn record of two roles."""
    pytest.importorskip("matplotlib")
    made = tmp_path_factory.mktemp("drawn")
    paths = drawing.write(record(("thickness", "translucency")), made)
    assert sorted(paths) == sorted(map(str, made.iterdir()))
    return made


def test_drawing_again_gives_the_same_files(folder: Path, tmp_path: Path) -> None:
    import matplotlib

    with matplotlib.rc_context({"font.size": 30.0, "lines.linewidth": 9.0, "savefig.facecolor": "red"}):
        drawing.write(json.loads((folder / "chart.json").read_text()), tmp_path)
    names = sorted(path.name for path in folder.iterdir())
    assert names == sorted(path.name for path in tmp_path.iterdir())
    assert names == ["chart.csv", "chart.html", "chart.json"] + [
        f"chart_{role}.{suffix}" for role in ("thickness", "translucency") for suffix in ("png", "svg")
    ]
    for name in names:
        assert (folder / name).read_bytes() == (tmp_path / name).read_bytes(), name


def test_pictures(folder: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    with image.open(folder / "chart_thickness.png") as picture:
        assert picture.width == 1800  # twice what a README shows
        colors = {color for _, color in picture.convert("RGB").getcolors(1 << 24)}
    assert {tuple(bytes.fromhex(color[1:])) for color in figure.COLORS} <= colors
    text = (folder / "chart_thickness.svg").read_text()
    assert text.count("<svg") == 1 and "dc:date" not in text and 'width="648pt"' in text


def test_page_is_whole_and_safe(folder: Path) -> None:
    text = (folder / "chart.html").read_text(encoding="utf-8")
    assert not re.search(r"""(src|href)=["'](?!#)|url\(|@import|https?:""", text)
    assert "A slab <b>&" not in text and "A slab &lt;b&gt;&amp;" in text
    points = 2 * (len(record()["points"]) + len(medians(record(), "thickness")))
    assert text.count("<tr id=") == points == text.count("data-row=")
    assert "12 of 4096 points are NaN" in text and "prefers-color-scheme: dark" in text


DRIVE = """
<script>
const said = {};
const press = (key) => document.activeElement.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
const visible = () => [...document.querySelectorAll("#numbers tbody tr")].filter((row) => !row.hidden);
const panels = [...document.querySelectorAll(".panel")];
panels[1].focus();
press("ArrowRight");
said.first = document.activeElement.getAttribute("aria-label");
said.tip = tip.innerText;
press("End");
said.last = document.activeElement.getAttribute("aria-label");
press("Enter");
said.chosen = document.querySelector("tr.chosen").innerText;
said.hidden = tip.hidden;
const form = document.forms[0];
form.elements.role.value = "thickness";
form.elements.scene.value = form.elements.scene.options[2].value;
form.elements.text.value = "UNIFORM";
form.dispatchEvent(new Event("input"));
said.rows = visible().length;
said.output = form.querySelector("output").textContent;
const heads = [...document.querySelectorAll("thead th")];
const at = heads.findIndex((head) => head.textContent === "error");
const column = () => visible().map((row) => Number(row.cells[at].dataset.key));
heads[at].firstChild.click();
said.up = column();
heads[at].firstChild.click();
said.down = column();
document.title = JSON.stringify(said);
</script>
"""


def test_page_by_keyboard(folder: Path, tmp_path: Path) -> None:
    if not (chromium := find()):
        pytest.skip("there is no Chromium")
    page = tmp_path / "driven.html"
    page.write_text((folder / "chart.html").read_text(encoding="utf-8") + DRIVE, encoding="utf-8")
    command = [chromium, "--headless", "--no-sandbox", "--dump-dom", page.as_uri()]
    dom = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True).stdout
    found = re.search("<title>(.*?)</title>", dom, re.S)
    assert found
    said = json.loads(html.unescape(found[1]))
    assert "A slab <b>&: cost" in said["first"] and said["first"] != said["last"]
    assert "A slab <b>&" in said["tip"] and "cost" in said["tip"]
    assert said["chosen"].split("\t")[2].removesuffix(" (baseline)") in said["last"] and said["hidden"]
    assert said["rows"] == 4 == len(said["up"]) and said["output"].startswith("4 of ")
    assert said["up"] == sorted(said["up"]) == said["down"][::-1] and len(set(said["up"])) == 4


def test_without_points_or_matplotlib(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(SssgenError, match="no points"):
        drawing.write({**record(), "points": []}, tmp_path)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(SssgenError, match=r"sssgen\[chart\]"):
        drawing.write(record(), tmp_path)
    assert not list(tmp_path.iterdir())


def test_long_units_and_devices_go_into_the_notes() -> None:
    made = record(scenes=("slab", "ball"))
    made |= {"cost": "gpu", "cost_unit": "ms at 1920 × 1080, the median of 50 runs of 20 frames each"}
    made["record"] |= {"device": "A GPU with a name that is quite long", "driver": "1.2.3", "software": True}
    found = chart(checked(made), "thickness")
    assert found.x_title == "cost" and made["cost_unit"] in found.notes[1]
    assert "a driver in software" in " ".join(found.notes) and len(found.notes) == 3
    assert all(len(note) <= LONGEST_NOTE for note in found.notes)
    shorter = chart(checked(record(scenes=("slab", "ball"))), "thickness")
    assert shorter.x_title == "cost, operations (weighted)"
    assert found.panels[0].plot.top - shorter.panels[0].plot.top == NOTE * (3 - len(shorter.notes))
