"""Charts from records: the front and the hypervolume, the layout, and reproducible files."""

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
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from processes import HANG
from slow_cases import some_slow
from sssgen.lab.chart import drawing
from sssgen.lab.chart.drawing import figure
from sssgen.lab.chart.drawing.panels import COLORS, Chart, charts_of, label_texts, medians, number, styles
from sssgen.lab.chart.record import LEAST, check_record, front, hypervolume, measures, to_csv, to_json
from sssgen.run.machine_parts import chromium
from sssgen.support.diagnostics import SssgenError

SCENES = {"slab": "A slab <b>&", "ball": "Ball, lit from behind", "cube": "Marble $x^2$ cube"}
OURS = ("march_light", "thinness_uniform", "thinness_hemisphere", "constant_thickness", "thickness_map")
BASELINES = ("depth_map_absorption", "gltf_volume", "cheap_sss_thinness", "distance_field_march")


def point(cost: float, error: float | None, **more: Any) -> dict[str, Any]:
    result = {"scene": "slab", "role": "thickness", "name": "some", "label": "some", "baseline": False, "failed": ""}
    return {**result, "cost": {"value": cost}, "error": {"value": error}, "front": False, **more}


def record(roles: tuple[str, ...] = ("thickness",), scenes: tuple[str, ...] = tuple(SCENES)) -> dict[str, Any]:
    """Techniques with one to four settings each; distance_field_march fails on the ball, one error is 0."""
    points: list[dict[str, Any]] = []
    volumes = []
    for role, scene in itertools.product(roles, scenes):
        scene_points = []
        for name in (*OURS, *BASELINES):
            draw = random.Random(f"{role} {name}")
            cost, error = 10.0 ** draw.uniform(0.8, 2.0), 10.0 ** draw.uniform(-1.5, 0.3)
            error *= 10.0 ** random.Random(f"{scene} {name}").uniform(-0.3, 0.3)
            for taps in (4, 8, 16, 32) if name.startswith(("march", "thin", "distance_field_march")) else (0,):
                failed = "12 of 4096 points are NaN" if (scene, name) == ("ball", "distance_field_march") else ""
                result = 0.0 if (scene, name) == ("slab", "constant_thickness") else error / (1.0 + taps)
                built = point(cost * (1.0 + taps), None if failed else result, failed=failed)
                built |= {"scene": scene, "role": role, "name": name, "baseline": name in BASELINES}
                built |= {"label": f"{name}, {taps} taps" if taps else name, "settings": {"steps": taps}}
                built |= {"parameters": {"scale": 0.1 + taps}, "chain": [name, "beer_lambert"]}
                built |= {"implementation": {"gl": 1e-6}}
                built["cost"] |= {"operations": round(cost), "gpu_ms": None}
                if not failed:
                    built["error"] |= {"low": 0.8 * result, "high": 1.3 * result, "bias": -result / 3.0}
                scene_points.append(built)
        best = {id(entry) for entry in front(scene_points)}
        for entry in scene_points:
            entry["front"] = id(entry) in best
        corner = (1e4, 10.0)
        ours, baselines = ([entry for entry in scene_points if entry["baseline"] is kind] for kind in (False, True))
        volumes.append({"scene": scene, "role": role, "reference_point": list(corner)})
        volumes[-1] |= {"ours": hypervolume(ours, corner), "baselines": hypervolume(baselines, corner)}
        points += scene_points
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
def test_the_front_has_the_points_that_no_point_dominates(values: list[tuple[float, float, bool]]) -> None:
    points = [point(cost, error, failed="NaN" if failed else "") for cost, error, failed in values]

    def rounded(entry: dict[str, Any]) -> tuple[float, float]:
        cost, error = measures(entry)
        return cost, max(error, LEAST)

    def dominated(entry: dict[str, Any]) -> bool:
        x, y = rounded(entry)
        remaining = [rounded(other) for other in points if not other["failed"]]
        return any(cost <= x and error <= y and (cost, error) != (x, y) for cost, error in remaining)

    expected = [id(entry) for entry in points if not entry["failed"] and not dominated(entry)]
    result = front(points)
    assert sorted(id(entry) for entry in result) == sorted(expected)
    assert [measures(entry)[0] for entry in result] == sorted(measures(entry)[0] for entry in result)


def test_hypervolume_in_closed_form() -> None:
    corner = (1000.0, 1.0)
    assert hypervolume([point(100.0, 0.1)], corner) == pytest.approx(1.0)
    assert hypervolume([point(10.0, 0.1)], corner) == pytest.approx(2.0)
    stairs = [point(100.0, 0.001), point(10.0, 0.1), point(200.0, 0.5)]
    assert hypervolume(stairs, corner) == pytest.approx(2.0 * 1.0 + 1.0 * 2.0)
    assert hypervolume([*stairs, point(1.0, 1e-5, failed="NaN")], corner) == pytest.approx(4.0)
    assert hypervolume([point(2000.0, 0.1), point(10.0, 2.0)], corner) == hypervolume([], corner) == 0.0
    assert hypervolume([point(100.0, 0.0)], corner) == pytest.approx(6.0)  # an error of 0 counts as the least error


@given(st.lists(st.tuples(NUMBERS, NUMBERS), max_size=8), NUMBERS, NUMBERS)
def test_another_point_never_reduces_the_hypervolume(
    measured: list[tuple[float, float]], cost: float, error: float
) -> None:
    points = [point(*values) for values in measured]
    assert hypervolume([*points, point(cost, error)], (50.0, 2.0)) >= hypervolume(points, (50.0, 2.0))


def test_checks() -> None:
    good = record()
    assert check_record(good) == good
    odd = json.loads(json.dumps(good))
    odd["points"][0]["error"] |= {"bias": math.nan, "high": math.inf}
    assert check_record(odd)["points"][0]["error"]["bias"] is None is check_record(odd)["points"][0]["error"]["high"]
    assert math.isnan(odd["points"][0]["error"]["bias"])  # the record itself is unchanged

    wrong = json.loads(json.dumps(good))
    wrong |= {"format": 2, "cost": 3}
    wrong["points"][0] |= {"scene": "slap", "role": "colour"}
    wrong["points"][1] |= {"label": "", "error": {"value": None}}
    wrong["points"][2] |= {"cost": {"value": "much"}, "error": {"value": -1.0}}
    wrong["hypervolume"][0]["ours"] = None
    with pytest.raises(SssgenError) as raised:
        check_record(wrong)
    message = str(raised.value)
    for part in (
        "its format is 2",
        "'cost' is missing",
        "point 0: its scene 'slap' is unknown: did you mean 'slab'?",
        "point 0: its role 'colour' is none of coordinates,",
        "point 1: 'label' is missing",
        "point 1: error.value is not finite, and 'failed' does not say why",
        "point 2: cost.value is not a number",
        "point 2: error.value is below 0",
        "hypervolume 0: 'ours'",
    ):
        assert part in message
    with pytest.raises(SssgenError, match="not a JSON object"):
        check_record([])


def test_csv_has_every_number() -> None:
    result = record()
    rows = list(csv.DictReader(io.StringIO(to_csv(result))))
    assert len(rows) == len(result["points"])
    for row, entry in zip(rows, result["points"], strict=True):
        assert row["label"] == entry["label"] and float(row["cost_value"]) == entry["cost"]["value"]
        error = entry["error"]["value"]
        assert row["error_value"] == ("" if error is None else repr(error)) and row["failed"] == entry["failed"]
        assert json.loads(row["settings"]) == entry["settings"]


def test_json_does_not_depend_on_the_order_of_entries() -> None:
    result = record()
    turned = {**dict(reversed(result.items())), "points": [dict(reversed(entry.items())) for entry in result["points"]]}
    assert to_json(result) == to_json(turned) and json.loads(to_json(result)) == result


def test_medians() -> None:
    def on(scene: str, cost: float, error: float | None, name: str = "a") -> dict[str, Any]:
        return point(cost, error, scene=scene, name=name, label=name, failed="" if error is not None else "NaN")

    points = [on("slab", 1.0, 0.1), on("ball", 3.0, 0.3), on("cube", 9.0, None)]
    points += [on("slab", 2.0, None, "b"), on("ball", 2.0, None, "b"), on("cube", 2.0, 0.1, "b")]
    median, failing = medians({"points": points}, "thickness")
    assert measures(median) == (3.0, 0.3) and median["front"] and not median["failed"]
    assert failing["failed"] == "fails on 2 of 3 scenes" and not failing["front"]


def test_numbers_are_formatted() -> None:
    values = (None, 0.0, 12.345, 123456.7, 2.5e-6)
    assert [number(value) for value in values] == ["–", "0", "12.3", "123,457", "2.5e-06"]


def gpu_record() -> dict[str, Any]:
    """A record with long notes and units."""
    result = record(scenes=("slab", "ball"))
    result |= {"cost": "gpu", "cost_unit": "ms at 1920 × 1080, the median of 50 runs of 20 frames each"}
    result["record"] |= {"device": "A GPU with a name that is quite long", "driver": "1.2.3" * 12, "software": True}
    return result


WHOLE = Path(__file__).parents[2] / "build" / "accuracy" / "chart.json"
"""The record that `make accuracy` measures."""
CHARTS = {
    "two roles": lambda: charts_of(check_record(record(("thickness", "material")))),
    "one scene": lambda: charts_of(check_record(record(scenes=("slab",)))),
    "long notes": lambda: charts_of(check_record(gpu_record())),
    "docs": lambda: charts_of(check_record(json.loads(WHOLE.read_text(encoding="utf-8")))),
}


LONG = [pytest.mark.slow, pytest.mark.skipif(not WHOLE.is_file(), reason=f"{WHOLE} is missing: make accuracy")]
DRAWN = [pytest.param(name, marks=LONG if name == "docs" else []) for name in CHARTS]


@cache
def drawn(name: str) -> list[tuple[Chart, Any]]:
    """The charts of a record and their figures."""
    pytest.importorskip("textalloc")
    with figure.settings():
        return [(chart, figure.figure_of(chart)) for chart in CHARTS[name]()]


@pytest.mark.parametrize("name", some_slow(CHARTS, "two roles"))
def test_texts_do_not_overlap(name: str) -> None:
    """No text of a chart covers another text or a marker, or crosses the edge of the picture; few are omitted."""
    for chart, picture in drawn(name):
        with figure.settings():
            picture.draw_without_rendering()
            texts = [text for text in visible_texts(picture) if text.get_text()]
            boxes = [text.get_window_extent() for text in texts]
            edge = picture.bbox
            for text, box in zip(texts, boxes, strict=True):
                inside = edge.x0 <= box.x0 and box.x1 <= edge.x1 and edge.y0 <= box.y0 and box.y1 <= edge.y1
                assert inside, text.get_text()
            for (text, box), (other, other_box) in itertools.combinations(zip(texts, boxes, strict=True), 2):
                assert not box.shrunk(0.98, 0.9).overlaps(other_box), (text.get_text(), other.get_text())
            assert len(picture.axes) == len(chart.panels)
            for axes, panel in zip(picture.axes, chart.panels, strict=True):
                markers = axes.transData.transform([measures(point) for point in panel.points])
                labels = axes.texts[1:]
                for label in labels:
                    box = label.get_window_extent()
                    assert not any(box.contains(x, y) for x, y in markers), label.get_text()
                front_points = [point for point in panel.points if point["front"]]
                written = [label.get_text().replace("\n", " ") for label in labels]
                assert set(written) <= set(label_texts(front_points))
                assert len(labels) >= 0.8 * len(front_points) > 0


def visible_texts(picture: Any) -> list[Any]:
    """All texts of a figure, without ticks outside the limits."""
    texts = [picture._suptitle, *picture.legends[0].get_texts(), picture.legends[0].get_title()]
    for axes in picture.axes:
        texts += [axes.title, axes._left_title, axes.xaxis.label, axes.yaxis.label, *axes.texts]
        for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
            texts += [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
    return texts


@pytest.mark.parametrize("name", DRAWN)
def test_axes_show_every_point(name: str) -> None:
    for chart, picture in drawn(name):
        for axes, panel in zip(picture.axes, chart.panels, strict=True):
            (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
            finite = [measures(point) for point in panel.points if not point["failed"]]
            assert all(left < cost < right and low < error < high for cost, error in finite)
            assert panel.points == sorted(panel.points, key=measures)
            assert axes.get_xscale() == "log" and axes.get_yscale() in ("log", "symlog")
        names = [text.get_text() for text in picture.legends[0].get_texts()]
        assert names == list(chart.styles)


def test_rows_of_the_charts_are_consecutive() -> None:
    panels = [panel for chart in CHARTS["two roles"]() for panel in chart.panels]
    assert [panel.first_row for panel in panels] == [
        sum(len(before.points) for before in panels[:index]) for index in range(len(panels))
    ]
    assert [panel.title for panel in panels[:2]] == ["All 3 scenes", SCENES["slab"]]


def test_techniques_look_different() -> None:
    points = [point(1.0, 1.0, name=f"technique {at:02}", baseline=at > 20) for at in range(42)]
    looks = styles(points).values()
    assert len({(style.color, style.marker) for style in looks}) == 42
    assert [style.baseline for style in looks] == [False] * 21 + [True] * 21


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A drawn record of two roles."""
    pytest.importorskip("textalloc")
    result = tmp_path_factory.mktemp("drawn")
    paths = drawing.write(record(("thickness", "translucency")), result)
    assert sorted(paths) == sorted(map(str, result.iterdir()))
    return result


def test_the_same_record_gives_the_same_files(folder: Path, tmp_path: Path) -> None:
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
        assert picture.width == 2000  # twice the size in a README
        colors = {color for _, color in picture.convert("RGB").getcolors(1 << 24)}
    assert {tuple(bytes.fromhex(color[1:])) for color in COLORS} <= colors
    text = (folder / "chart_thickness.svg").read_text()
    assert text.count("<svg") == 1 and "dc:date" not in text and 'width="720pt"' in text


def test_page_is_complete_and_safe(folder: Path) -> None:
    text = (folder / "chart.html").read_text(encoding="utf-8")
    namespaces = re.compile(r' xmlns(:xlink)?="[^"]*"')
    assert not re.search(r"""(src|href)=["'](?!#)|url\((?!#)|@import|https?:""", namespaces.sub("", text))
    assert "A slab <b>&" not in text and "A slab &lt;b&gt;&amp;" in text
    points = 2 * (len(record()["points"]) + len(medians(record(), "thickness")))
    assert text.count("<tr id=") == points == len(re.findall('<a xlink:href="#row[0-9]+"><title>', text))
    assert "12 of 4096 points are NaN" in text
    ids = re.findall(r'\bid="([^"]+)"', text)
    assert len(set(ids)) == len(ids)


DRIVE = """
<script>
const said = {};
const visible = () => [...document.querySelectorAll("#numbers tbody tr")].filter((row) => !row.hidden);
const link = document.querySelector("#thickness a");
said.title = link.querySelector("title").textContent;
link.focus();
said.focused = document.activeElement === link;
const form = document.forms[0];
form.elements.role.value = "thickness";
form.elements.scene.value = form.elements.scene.options[2].value;
form.elements.technique.value = "UNIFORM";
form.dispatchEvent(new Event("input"));
said.rows = visible().length;
said.output = form.querySelector("output").textContent;
const heads = [...document.querySelectorAll("thead th")];
const index = heads.findIndex((head) => head.textContent === "error");
const column = () => visible().map((row) => Number(row.cells[index].dataset.key));
heads[index].firstChild.click();
said.up = column();
heads[index].firstChild.click();
said.down = column();
location.hash = link.getAttribute("xlink:href");
dispatchEvent(new HashChangeEvent("hashchange"));
said.target = document.querySelector("tr:target").innerText;
said.shown = visible().length;
document.title = JSON.stringify(said);
</script>
"""


def test_page_in_a_browser(folder: Path, tmp_path: Path) -> None:
    if not (program := chromium()):
        pytest.skip("there is no Chromium")
    page = tmp_path / "driven.html"
    page.write_text((folder / "chart.html").read_text(encoding="utf-8") + DRIVE, encoding="utf-8")
    command = [program, "--headless", "--no-sandbox", "--dump-dom", page.as_uri()]
    dom = subprocess.run(command, capture_output=True, text=True, timeout=HANG, check=True).stdout
    result = re.search("<title>({.*?)</title>", dom, re.S)
    assert result
    report = json.loads(html.unescape(result[1]))
    assert report["title"].startswith("All 3 scenes\n") and "cost " in report["title"] and report["focused"]
    assert report["target"].split("\t")[2].removesuffix(" (baseline)") in report["title"]
    assert report["rows"] == 4 == len(report["up"]) and report["output"].startswith("4 of ") and report["shown"] > 4
    assert report["up"] == sorted(report["up"]) == report["down"][::-1] and len(set(report["up"])) == 4


def test_without_points_or_matplotlib(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(SssgenError, match="no points"):
        drawing.write({**record(), "points": []}, tmp_path)
    monkeypatch.setitem(sys.modules, "textalloc", None)
    with pytest.raises(SssgenError, match=r"\[chart\]"):
        drawing.write(record(), tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_long_device_and_unit_are_shown() -> None:
    result = gpu_record()
    (chart,) = charts_of(check_record(result))
    assert chart.cost_unit == result["cost_unit"] and result["record"]["driver"] in chart.note
    assert "a software driver" in chart.note


@pytest.mark.slow
def test_charts_say_the_boundary_and_the_lights() -> None:
    result = record()
    assert "boundary" not in charts_of(check_record(result))[0].note
    smooth, rough, clear = result["scenes"]
    smooth |= {"medium": {"name": "marble", "ior": 1.0, "roughness": 0.0}, "lights": ["from afar"]}
    rough |= {"medium": {"name": "jade", "ior": 1.4, "roughness": 0.3}, "lights": ["point", "even surroundings"]}
    texts = ["boundary matched; light from afar", "boundary index 1.4, roughness 0.3; light point, even surroundings"]
    (chart,) = charts_of(check_record(result))
    line, _, rest = chart.note.partition("\n")
    assert line == f"{smooth['name']}: {texts[0]} · {rough['name']}: {texts[1]}"
    assert "boundary" not in rest and clear["name"] not in line
    clear |= {"medium": smooth["medium"], "lights": smooth["lights"]}
    (chart,) = charts_of(check_record(result))
    assert chart.note.startswith(f"{smooth['name']}, {clear['name']}: {texts[0]} · ")
    rough["medium"]["roughness"] = 0.0
    page = str(drawing.chart_files(result)["chart.html"])
    assert f"{html.escape(smooth['title'])}: marble · {texts[0]}</li>" in page
    assert "jade · boundary index 1.4, smooth; light point, even surroundings</li>" in page
