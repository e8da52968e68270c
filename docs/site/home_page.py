"""The first page of the site: `home.html.j2` with what the README, the presets and the documents' pictures give."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup
from PIL import Image

import demo
from menu import README, ROOT, page_of
from sssgen.material import library
from sssgen.run.web_library import library as web_library

TEMPLATE = "home.html.j2"
ACCURACY = ROOT / "docs" / "accuracy"
_GALLERY = ("candle", "skin_ear", "jelly", "ice_body", "jade_ring", "wax_mouse", "leaves", "resin_inlay")
"""The pictures of docs/gallery that stand in while docs/heroes has none."""
_ENGINE = re.compile(
    r"^\| \[(?P<name>[^\]]+)\]\((?P<page>docs/engines/(?P<file>[\w-]+)\.md)\) \|[^|]*\| (?P<run>.+) \|$", re.M
)
_FINDINGS = re.compile(r"<!-- findings: (?P<command>[^>]+) -->\n```\n(?P<text>.*?)```", re.DOTALL)
_WIDEST = 760


class Picture(NamedTuple):
    """A picture of the page: its file on the site, and what it shows."""

    file: str
    alt: str


class Engine(NamedTuple):
    """An engine of the README's table."""

    name: str
    page: str
    run: str
    picture: str
    """Its file on the site, or ''"""


def write_home(folder: Path) -> None:
    """Writes index.html and its pictures into the site's folder."""
    pictures = folder / "_static" / "home"
    pictures.mkdir(parents=True, exist_ok=True)
    presets = demo.shown_presets()
    first = next(preset for preset in presets if preset.name == demo.FIRST)
    readme = (ROOT / README).read_text(encoding="utf-8")
    findings = _FINDINGS.search(readme)
    assert findings is not None, "the README shows no findings of sssgen lint"
    imports = web_library().import_map().replace('"./library/', '"./playground/library/')
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent), undefined=StrictUndefined, autoescape=True, trim_blocks=True
    )
    text = environment.get_template(TEMPLATE).render(
        import_map=Markup(imports),
        presets=presets,
        first=first,
        targets=demo.TARGETS,
        command=demo.command(first.name, "threejs"),
        techniques=len(library.index()),
        heroes=list(_heroes(pictures)),
        engines=sorted(_engines(readme, pictures), key=lambda engine: not engine.picture),
        chart=_copied(ACCURACY / "front.png", pictures),
        before_after=_copied(ACCURACY / "before_after.png", pictures),
        findings=f"$ {findings['command']}\n{findings['text']}",
    )
    (folder / "index.html").write_text(text, encoding="utf-8", newline="\n")


def _heroes(folder: Path) -> Iterator[Picture]:
    """The pictures of docs/heroes, or some of the gallery."""
    files = sorted(path for path in (ROOT / "docs" / "heroes").glob("*") if path.suffix in (".png", ".webp", ".jpg"))
    for path in files or [ROOT / "docs" / "gallery" / f"{name}.png" for name in _GALLERY]:
        yield Picture(_copied(path, folder), path.stem.replace("_", " "))


def _engines(readme: str, folder: Path) -> Iterator[Engine]:
    for match in _ENGINE.finditer(readme):
        picture = ROOT / "docs" / "engines" / f"{match['file']}.png"
        file = _copied(picture, folder) if picture.is_file() else ""
        yield Engine(match["name"], page_of(match["page"]), match["run"].replace("`", ""), file)


def _copied(picture: Path, folder: Path) -> str:
    """A picture of moderate size in the folder; returns its file on the site."""
    name = f"{picture.parent.name}_{picture.stem}.webp"
    with Image.open(picture) as opened:
        image = opened.convert("RGB")
        if image.width > _WIDEST:
            image = image.resize((_WIDEST, round(image.height * _WIDEST / image.width)), Image.Resampling.LANCZOS)
        image.save(folder / name, quality=88)
    return f"_static/home/{name}"
