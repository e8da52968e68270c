"""llms.txt (https://llmstxt.org) and llms-full.txt: the site for programs that read."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from menu import README, page_of, sections
from sssgen.cli.commands import COMMANDS, GROUPS

SCRIPTS = "docs/scripts.md"
_KEYS = re.compile(r"^\| `sssgen (?P<command>[\w-]+)(?P<words>[^`]*)` \| (?P<keys>.+) \|$", re.MULTILINE)
_TITLE = re.compile(r"^# (.+)$", re.MULTILINE)
_FENCE = re.compile(r"^```.*?^```\n?", re.DOTALL | re.MULTILINE)
LEFT_OUT = ("CHANGELOG.md", "docs/reference/", "docs/accuracy/", "docs/parity", "qualification/")
"""What llms-full.txt is without: history and long tables."""


def write_llms(folder: Path, texts: Mapping[str, str]) -> None:
    """Writes both files for the pages of the site (path → Markdown)."""
    (folder / "llms.txt").write_text(_list(texts), encoding="utf-8", newline="\n")
    pages = [page for section in sections() for page in section.pages if not page.startswith(LEFT_OUT)]
    whole = "\n\n".join(f"<!-- {page} -->\n\n{texts[page].strip()}" for page in pages)
    (folder / "llms-full.txt").write_text(f"{whole}\n", encoding="utf-8", newline="\n")


def _list(texts: Mapping[str, str]) -> str:
    readme = texts[README]
    title, summary, *rest = readme.split("\n\n")
    about = next(part for part in rest if part.startswith("**"))
    lines = [title, "", f"> {summary.strip('*')}", "", about.split("**")[1], ""]
    lines += ["- [All documents in one file](llms-full.txt)", ""]
    lines += ["## Commands", "", "Every command takes `--json`; the keys of its object are listed, `ok` first.", ""]
    reference = page_of("docs/reference/commands.md")
    keys = {match["command"]: match["keys"] for match in _KEYS.finditer(texts[SCRIPTS])}
    for group, heading in GROUPS.items():
        lines += [f"{heading[0].upper()}{heading[1:]}:", ""]
        for name, command in COMMANDS.items():
            if command.group == group:
                lines.append(f"- [`sssgen {name}`]({reference}): {command.help}. JSON: {keys[name]}")
        lines.append("")
    for section in sections():
        lines += [f"## {section.title}", ""]
        lines += [f"- [{_title(texts[page])}]({page_of(page)}){_first_line(texts[page])}" for page in section.pages]
        lines.append("")
    return "\n".join(lines)


def _title(text: str) -> str:
    match = _TITLE.search(text)
    assert match is not None
    return match[1]


def _first_line(text: str) -> str:
    """The first sentence below a page's title, for the list."""
    below = _FENCE.sub("", _TITLE.split(text, maxsplit=1)[-1])
    paragraphs = [" ".join(part.split()) for part in below.split("\n\n")]
    plain = [part for part in paragraphs if part and part[0] not in "#|!<-*[`"]
    if not plain:
        return ""
    sentence = re.split(r"(?<=[.:])\s", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", plain[0]))[0]
    return f": {sentence}"
