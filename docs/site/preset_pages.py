"""The reference of the presets: a page for each, with its numbers and its material file, from the table of presets."""

from __future__ import annotations

from markup import escaped, fenced, in_search, table
from menu import ROOT
from playground_links import playground_link
from preset_starts import preset_files
from sssgen.cli.facts import preset as facts
from sssgen.presets.preset import presets
from sssgen.support.toml_source import parse

LIST = "docs/presets.md"
"""The page that lists them."""
FOLDER = "docs/reference/presets"
_WIDTH = 90


def pages() -> dict[str, str]:
    """Path → text, for each preset."""
    return {f"{FOLDER}/{name}.md": _page(name) for name in presets()}


def listed() -> str:
    """What the list of presets has beside its own text: a row for each, which leads to its page."""
    rows = [
        (f"[{preset.title}](reference/presets/{name}.md)", f"`{name}`", escaped(preset.doc))
        for name, preset in presets().items()
    ]
    names = [f"reference/presets/{name}" for name in presets()]
    lines = ["", "## All presets", "", *table(("Preset", "Name", "What it is"), rows), ""]
    return "\n".join([*lines, "```{toctree}", ":hidden:", "", *names, "```", ""])


def _page(name: str) -> str:
    preset = presets()[name]
    picture = ROOT / "docs" / "presets" / f"{name}.png"
    text = preset_files()[name].read_text(encoding="utf-8")
    lines = [*in_search(name, preset.title), f"# {preset.title} (preset)", "", escaped(preset.doc), ""]
    if picture.is_file():
        lines += [f"![A mouse of {preset.title.lower()}](../../presets/{name}.png)", ""]
    lines += [
        f"{playground_link(f'preset_{name}', 'Open it in the playground', FOLDER)} · [all presets](../../presets.md)",
        "",
    ]
    lines += ["On your mesh, and as a material of its own:", ""]
    lines += fenced(f"sssgen use {name} mesh.obj -o page --open\nsssgen new my_{name} --from {name}", "sh")
    lines += ["", "## Its numbers", "", *fenced("\n".join(facts.lines(facts.describe(name), _WIDTH)), "text"), ""]
    lines += [
        "## Its material, on a mouse",
        "",
        "The quality is `good`. Its techniques: " + _techniques(text) + ".",
        "",
    ]
    return "\n".join([*lines, *fenced(text.strip(), "toml"), ""])


def _techniques(text: str) -> str:
    """Links to the techniques of a material file, in its order."""
    sections = parse(text, "").data.values()
    names = dict.fromkeys(row["technique"] for rows in sections if isinstance(rows, list) for row in rows)
    return ", ".join(f"[{name}](../techniques/{name}.md)" for name in names)
