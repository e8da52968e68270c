"""Copies the documents into the folder that Sphinx reads, in the repository's layout, so that links stay valid.

A link to another file of the repository becomes a download of its copy. A link to a folder leads to the folder's
README.md, or to a page that lists its files.
"""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

from menu import README, ROOT, sections
from sssgen.run.backends import Array
from sssgen.scene.pictures.images import write_png

_LINK = re.compile(r"(?P<before>\]\(|<img [^>]*?src=\")(?P<path>[^)\s\"#:]+)(?=[)#\"])")
_FENCE = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)
_SKIPPED = ("__pycache__", ".DS_Store")


class Staging:
    """The folder of the site's sources."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.listed: set[str] = set()
        shutil.rmtree(folder, ignore_errors=True)

    def write(self, page: str, text: str) -> None:
        """A page at its place in the repository, with the files that it refers to."""
        pieces, end = [], 0
        for fence in _FENCE.finditer(text):
            pieces += [self._linked(page, text[end : fence.start()]), fence[0]]
            end = fence.end()
        text = "".join([*pieces, self._linked(page, text[end:])])
        self._put(page, text + _contents() if page == README else text)

    def add_picture(self, place: str, colors: Array) -> None:
        """A picture that is drawn for the site."""
        (self.folder / place).parent.mkdir(parents=True, exist_ok=True)
        write_png(str(self.folder / place), colors)

    def _put(self, page: str, text: str) -> None:
        path = self.folder / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")

    def _linked(self, page: str, text: str) -> str:
        return _LINK.sub(lambda match: match["before"] + self._target(page, match["path"]), text)

    def _target(self, page: str, link: str) -> str:
        """The link on the site for a link of a page; what it leads to is copied."""
        target = (ROOT / page).parent.joinpath(link).resolve()
        if not target.is_relative_to(ROOT) or not target.exists():
            return link  # Sphinx reports it, or it leads to a generated page
        place = target.relative_to(ROOT).as_posix()
        if target.is_dir():
            place = f"{place}/README.md" if (target / "README.md").is_file() else self._listing(target, place)
        elif target.suffix != ".md":
            self._copy(target, place)
        return os.path.relpath(self.folder / place, (self.folder / page).parent).replace(os.sep, "/")

    def _copy(self, file: Path, place: str) -> None:
        (self.folder / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, self.folder / place)

    def _listing(self, directory: Path, place: str) -> str:
        """The page that lists a folder's files."""
        page = f"{place}/files.md"
        if page not in self.listed:
            self.listed.add(page)
            lines = ["---", "orphan: true", "---", f"# {place}", "", "The files of this folder of the repository:", ""]
            for file in sorted(path for path in directory.rglob("*") if path.is_file()):
                name = file.relative_to(directory).as_posix()
                if not any(part in name for part in _SKIPPED):
                    self._copy(file, f"{place}/{name}")
                    lines.append(f"- {{download}}`{name}`")
            self._put(page, "\n".join(lines) + "\n")
        return page


def _contents() -> str:
    """The tables of contents for the end of the overview: they are the menu."""
    parts = []
    for section in sections():
        names = ["self" if page == README else "/" + page.removesuffix(".md") for page in section.pages]
        lines = ["", "```{toctree}", ":hidden:", f":caption: {section.title!r}", "", *names, "```"]
        parts.append("\n".join(lines))
    return "\n".join(parts) + "\n"
