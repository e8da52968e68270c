"""The reference of the techniques: an overview, and a page for each, from its file and the records of charts."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import formula_math
from markup import escaped, fenced, in_search, number, table
from records import points_of
from sssgen.ir.types import VOID, spell
from sssgen.lab.chart.record import measures
from sssgen.material import library
from sssgen.material.library import ROLES, Technique
from sssgen.material.technique_facts import facts_of
from sssgen.pipeline import compiler
from sssgen.run.evaluate import probes
from stability_pictures import PAGE, comparisons_of

OVERVIEW = "docs/reference/techniques.md"
FOLDER = "docs/reference/techniques"
LANGUAGE = "glsl-330"
TITLES = {
    "corrects": "What it corrects",
    "baseline": "What is published",
    "superseded_by": "Use instead",
    "requires": "Requires",
    "units": "Units",
    "calibrated": "Calibration",
    "deviation": "Deviation between devices",
    "uncharted": "Why it is not in the charts",
    "source": "Source",
}
"""The sections of a doc comment with a heading of their own, in the order of the page; the others follow."""
OMITTED = ("suggested", "legend", "shape", "sets", "bake", "deviation_bounds")
"""The sections for programs."""


def overview() -> str:
    """The page that lists all techniques by their roles."""
    lines = [
        "# Techniques",
        "",
        "Made from the files of the library; `sssgen show TECHNIQUE` prints the same. The roles",
    ]
    lines += [
        "are in the order in which a material runs them. A *baseline* is a formula as its source published it.",
        "",
    ]
    for role in ROLES:
        found = sorted(
            (technique for technique in library.load_all() if technique.role == role),
            key=lambda technique: (technique.baseline, technique.name),
        )
        lines += [f"## {role.replace('_', ' ').capitalize()}", ""]
        lines += table(
            ("Technique", "What it computes"),
            [(f"[{technique.name}](techniques/{technique.name}.md)", _summary(technique)) for technique in found],
        )
        names = [f"techniques/{technique.name}" for technique in found]
        lines += ["", "```{toctree}", ":hidden:", "", *names, "```", ""]
    return "\n".join(lines)


def _summary(technique: Technique) -> str:
    return escaped(technique.doc.get("summary", "")) + (" *Baseline.*" if technique.baseline else "")


class Shown(NamedTuple):
    """A picture on a page."""

    file: str
    """Beside the page."""
    caption: str


def page(technique: Technique, picture: Shown | None = None, limits: Sequence[Shown] = (), without: str = "") -> str:
    """The page of a technique, with its picture, or why it has none, and with pictures of its limits."""
    facts = facts_of(technique)
    doc = dict(facts["doc"])
    lines = [*in_search(technique.name), f"# {technique.name}", "", escaped(facts["summary"]), ""]
    if picture is not None:
        lines += _shown(picture)
    elif without:
        lines += [f"*{escaped(without)}*", ""]
    lines += table(("", ""), _at_a_glance(technique, facts))
    if formula := doc.pop("formula", ""):
        lines += ["", "## Formula", "", formula_math.typeset(formula)]
    lines += ["", *_uniforms("Parameters", facts["parameters"]), *_uniforms("Textures", facts["textures"])]
    lines += _slots(facts["slots"])
    below = [*_compared(technique.name), *(line for shown in limits for line in _shown(shown))]
    if text := doc.pop("limits", ""):
        below = [escaped(text), "", *below]
    lines += ["## Limits", "", *below] if below else []
    for key in [*(key for key in TITLES if key in doc), *(key for key in doc if key not in {*TITLES, *OMITTED})]:
        text = f"[{doc[key]}]({doc[key]}.md)" if doc[key] in library.index() else escaped(doc[key])
        lines += [f"## {TITLES.get(key, key.replace('_', ' ').capitalize())}", "", text, ""]
    lines += [*_measured(technique), "## In GLSL", "", *fenced(emitted(technique), "glsl"), ""]
    return "\n".join(lines)


def _shown(picture: Shown) -> list[str]:
    return [f"![{escaped(picture.caption)}]({picture.file})", "", f"*{escaped(picture.caption)}.*", ""]


def _compared(technique: str) -> list[str]:
    """What goes wrong with a published technique, beside what to use instead."""
    up = "../" * (FOLDER.count("/") + 1)
    lines = []
    for one in comparisons_of(technique):
        lines += [f"![{escaped(one.shown)}]({up}{one.file})", ""]
        lines += [f"{one.caption} Left as published, right what to use instead: [measured]({up}{PAGE}).", ""]
    return lines


def _at_a_glance(technique: Technique, facts: Mapping[str, Any]) -> list[tuple[str, str]]:
    function = technique.function
    named = [(param, f"`{param.quantity or spell(param.type)} {param.name}`") for param in function.params]
    takes = [text for param, text in named if param.direction != "out"]
    gives = [f"`{function.quantity or spell(function.result)}`"] if function.result != VOID else []
    gives += [text for param, text in named if param.direction != "in"]
    rows = [
        ("Role", technique.role.replace("_", " ") + (", a baseline as published" if technique.baseline else "")),
        ("Takes", ", ".join(takes) or "nothing"),
        ("Gives", ", ".join(gives)),
        ("File", f"`{facts['file']}`"),
    ]
    section = "thickness" if technique.role == "conversion" else technique.role
    if technique.role != "distance":
        rows.append(("In a material", f'`[[{section}]]` with `technique = "{technique.name}"`'))
    return rows


def _uniforms(title: str, uniforms: Sequence[Mapping[str, Any]]) -> list[str]:
    if not uniforms:
        return []
    rows = []
    for uniform in uniforms:
        low, high, *step = uniform.get("range", ("", ""))
        span = f"{number(low)} to {number(high)}" + (f" by {number(step[0])}" if step else "") if low != "" else ""
        default = ", ".join(number(value) for value in uniform.get("default", ()))
        unit = uniform.get("unit", "")
        notes = [escaped(uniform["doc"])]
        if uniform["aliases"]:
            notes.append(f"Also called {', '.join(f'`{alias}`' for alias in uniform['aliases'])}.")
        if hints := uniform.get("hints"):
            notes.append(f"Hints: {', '.join(f'`{hint}`' for hint in hints)}.")
        cells = (f"`{uniform['name']}`", f"`{uniform['type']}`", " ".join(notes))
        rows.append(
            cells if title == "Textures" else (*cells[:2], default, span, "" if unit == "1" else unit, cells[2])
        )
    heads = (
        ("Name", "Type", "Meaning") if title == "Textures" else ("Name", "Type", "Default", "Range", "Unit", "Meaning")
    )
    return [f"## {title}", "", *table(heads, rows), ""]


def _slots(slots: Sequence[Mapping[str, Any]]) -> list[str]:
    if not slots:
        return []
    rows = []
    for slot in slots:
        functions = ", ".join(f"`{name}`" for name in slot["functions"]) or "none in the library"
        rows.append((f"`{slot['signature']}`", escaped(slot["doc"]), functions))
    return ["## Slots", "", "A material binds a function to each slot: `bind = { SLOT = \"FUNCTION\" }`.", "",
            *table(("Slot", "Meaning", "Functions that fit"), rows), ""]  # fmt: skip


def _measured(technique: Technique) -> list[str]:
    """The errors and costs of the technique by itself, over the scenes of the chart."""
    points = points_of(technique.name)
    if not points:
        return []
    rows = []
    for role, label in dict.fromkeys((point["role"], point["label"]) for point in points):
        same = [point for point in points if (point["role"], point["label"]) == (role, label)]
        errors = [measures(point)[1] for point in same]
        costs = statistics.median(point["cost"]["value"] for point in same)
        figures = (f"{statistics.median(errors):.3f}", f"{max(errors):.3f}", f"{costs:.0f}", str(len(same)))
        rows.append((role.replace("_", " "), escaped(label), *figures))
    accuracy = "../../accuracy/charts.md"
    return [
        "## Error and cost", "",
        f"From the record of the [chart]({accuracy}): the error against the exact reference (0 is none), and the cost "
        "in weighted operations. A translucency gets exact lengths here, so that its error is its own.", "",
        *table(("Quantity", "Setting", "Error, median", "Error, largest", "Cost, median", "Scenes"), rows), "",
    ]  # fmt: skip


def emitted(technique: Technique) -> str:
    """The technique's function as the GLSL target emits it, with the functions that it calls."""
    subject = probes.subject(technique.name)
    probing = {probe.function for probe in subject.probes}
    kept = tuple(function for function in subject.module.functions if function.name not in probing)
    module = subject.module._replace(functions=kept)
    called = [function.key for function in kept if function.name == technique.name]
    files = compiler.transpile(module, LANGUAGE, technique.name, "auto", called, chained=subject.chained).files
    text = next(text for file, text in files.items() if not file.endswith(".json"))
    return text.partition("\n\n")[2].strip("\n")
