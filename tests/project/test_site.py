"""The documents as a site: the menu has every page, and the pages are whole and fetch nothing."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import menu
from folders import ROOT


def test_every_page_is_in_the_menu_once() -> None:
    found = menu.problems(menu.documents())
    assert not found, "\n".join(found)


def test_a_page_that_the_menu_lacks_is_reported_with_what_to_do() -> None:
    pages = menu.documents()
    added, removed = menu.problems([*pages, "docs/new.md"]), menu.problems(pages[1:])
    assert added == ["docs/new.md is not in the menu: add its path to a section of docs/site/menu.toml"]
    assert removed == [f"{pages[0]} is in the menu, but there is no such page: remove it there"]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The whole site."""
    pytest.importorskip("sphinx", reason="`make site` installs it")
    folder = tmp_path_factory.mktemp("site") / "site"
    command = [sys.executable, str(ROOT / "docs" / "site" / "build_site.py"), str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.mark.slow
def test_every_link_of_the_site_leads_somewhere(site: Path) -> None:
    """Sphinx refuses links between documents that lead nowhere; here are those to files, and pictures."""
    targets = 0
    for page in site.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        for link in re.findall(r'<(?:a|img|script|link)\b[^>]*?\b(?:href|src)="([^"#?]+)', text):
            if not re.match(r"[a-z]+:", link):
                targets += 1
                assert (page.parent / link).exists(), f"{page.relative_to(site)}: {link}"
    assert targets > 1000


@pytest.mark.slow
def test_no_page_fetches_anything_from_elsewhere(site: Path) -> None:
    for page in site.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        fetched = re.findall(r'<(?:img|script|link|iframe|source)\b[^>]*?\b(?:href|src)="((?:https?:)?//[^"]*)', text)
        assert not fetched, f"{page.relative_to(site)}: {fetched}"
    for style in site.rglob("*.css"):
        assert not re.search(r"(?:url\(|@import)\s*[\"']?(?:https?:)?//", style.read_text(encoding="utf-8")), style
