"""Edits of the text of a material: stages are added, replaced and removed; all other lines stay as they are.

The file is cut at the headers of its sections. A stage has the lines from its header, with the comments right above
it, to the next one.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Sequence
from typing import Any, NamedTuple

from sssgen.material.material_text import MaterialSection, stage_lines
from sssgen.material.roles import SECTIONS
from sssgen.support.diagnostics import failure
from sssgen.support.toml_source import Document, Path, parse

_TABLE = re.compile(r"^(\s*)\[(\w+)\](\s*(?:#.*)?)$")
"""The header of a section that is a single stage."""


class StageBlock(NamedTuple):
    """The lines of a section or of a stage; 0-based, the end exclusive."""

    path: Path
    """The section, and the index of the stage where it is one of several"""
    first: int
    header: int
    end: int


class ChainText:
    """A material's text in lines, with the places of its stages. Raises SssgenError for a text that is no TOML."""

    def __init__(self, text: str, file: str) -> None:
        self.document: Document = parse(text, file)
        self.lines = text.splitlines()
        self.file = file
        self.blocks = list(self._blocks())

    def _blocks(self) -> Iterable[StageBlock]:
        paths: list[Path] = []
        for key, content in self.document.data.items():
            paths += [(key, index) for index in range(len(content))] if isinstance(content, list) else [(key,)]
        headers = sorted((self.document.place(*path).value.line - 1, path) for path in paths)
        for header, path in headers:
            if not self.lines[header].lstrip().startswith("["):
                message = f"'{path[0]}' is written without a header, which the menus cannot change"
                raise failure(message, f"write [[{path[0]}]] on a line of its own, its keys below", self.file)
        firsts = [self._with_comments(header) for header, _ in headers]
        for (header, path), first, end in zip(headers, firsts, [*firsts[1:], len(self.lines)], strict=True):
            yield StageBlock(path, first, header, end)

    def _with_comments(self, line: int) -> int:
        """The first line of the comments right above a line."""
        while line > 0 and self.lines[line - 1].lstrip().startswith("#"):
            line -= 1
        return line

    def block(self, path: Path) -> StageBlock:
        """The lines of a stage. Raises SssgenError where it is gone."""
        for block in self.blocks:
            if block.path == path:
                return block
        raise failure(f"the file has no stage {' '.join(map(str, path))} any more", "reload the page", self.file)

    def _last_line(self, block: StageBlock) -> int:
        """The last line of a block that is neither blank nor a comment."""
        lines = [line.strip() for line in self.lines[block.header : block.end]]
        return block.header + max(number for number, line in enumerate(lines) if line and not line.startswith("#"))

    def given_bindings(self) -> dict[str, str]:
        """What the stages bind to slots, so that further stages measure the same body."""
        stages = [stage for section in SECTIONS for stage in _tables(self.document.data.get(section))]
        tables = [stage.get("bind", {}) for stage in stages if isinstance(stage, dict)]
        return {slot: str(to) for table in tables if isinstance(table, dict) for slot, to in table.items()}

    # Edits: each returns the new text

    def with_stage(self, stage: MaterialSection) -> str:
        """A new stage after the last one of its section, or after those that run before it."""
        order = SECTIONS.index(stage.section)
        before = [block for block in self.blocks if block.path[0] in ("material", *SECTIONS[: order + 1])]
        same = [block for block in before if block.path[0] == stage.section]
        place = (same or before)[-1].end if before else len(self.lines)
        return self._text([(place, place, stage_lines(stage))], {stage.section})

    def with_technique(self, path: Path, stage: MaterialSection, keeps: Collection[str]) -> str:
        """Another technique in place of a stage's; of its keys those stay that the technique takes, too."""
        block = self.block(path)
        table = self._stage(path)
        start = self.document.place(*path, "technique")
        name, *bound = stage_lines(stage)[1:]
        changes = [(start.key.line - 1, start.value.end_line, [self._with_value(path, name), *bound])]
        for key in table:
            if key != "technique" and key not in keeps:
                span = self.document.place(*path, key)
                # a table of its own, such as [translucency.bind], ends with the stage
                own = self.lines[span.value.line - 1].lstrip().startswith("[")
                end = self._last_line(block) + 1 if own else self.document.place(*path, key).value.end_line
                changes.append((span.key.line - 1, end, []))
        return self._text(changes)

    def _with_value(self, path: Path, line: str) -> str:
        """The line of a stage's technique with another name, and with its comment."""
        span = self.document.place(*path, "technique").value
        old = self.lines[span.line - 1]
        return old[: span.column - 1] + line.partition("= ")[2] + old[span.end_column - 1 :]

    def without_stage(self, path: Path) -> str:
        """The text without a stage."""
        block = self.block(path)
        return self._text([(block.first, block.end, [])])

    def with_chain(self, stages: Sequence[MaterialSection], settings: Sequence[str] = ()) -> str:
        """The chain of these stages. Stages of the surface with other techniques stay, such as a normal map.

        `settings` are further lines of the section [material].
        """
        names = {stage.technique for stage in stages}
        replaced = [block for block in self.blocks if self._is_replaced(block, names)]
        lines = [line for stage in stages for line in ("", *stage_lines(stage))][1:]
        start = replaced[0].first if replaced else len(self.lines)
        head = self.block(("material",))
        after = self._last_line(head) + 1
        changes: list[tuple[int, int, list[str]]] = [(after, after, list(settings)), (start, start, lines)]
        changes += [(block.first, block.end, []) for block in replaced]
        return self._text(changes, {stage.section for stage in stages})

    def _is_replaced(self, block: StageBlock, names: Collection[str]) -> bool:
        if block.path[0] != "surface":
            return block.path[0] in ("thickness", "translucency")
        technique = str(self._stage(block.path).get("technique"))
        return os.path.splitext(os.path.basename(technique))[0] in names

    def _stage(self, path: Path) -> dict[str, Any]:
        """The keys of a stage."""
        content: Any = self.document.data
        for part in path:
            content = content[part]
        return dict(content)

    def _text(self, changes: Iterable[tuple[int, int, list[str]]], listed: Collection[str] = ()) -> str:
        """The text with some lines exchanged, blank lines around new stages, and sections in `listed` as lists."""
        lines: list[str | None] = list(self.lines)
        for block in self.blocks:
            if block.path[0] in listed and (match := _TABLE.match(self.lines[block.header])):
                lines[block.header] = f"{match[1]}[[{match[2]}]]{match[3]}"
        new: dict[int, list[str]] = {}
        for first, end, content in changes:
            lines[first:end] = [None] * (end - first)
            new[first] = [*new.get(first, []), *content]
        result: list[str] = []
        after_stage = False
        for number, line in enumerate([*lines, None]):
            content = new.get(number, [])
            if any(part.lstrip().startswith("[") for part in content):
                while result and not result[-1].strip():
                    result.pop()
                content, after_stage = [*([""] if result else []), *content, ""], True
            result += content
            if line is not None and (line.strip() or not after_stage):
                result.append(line)
                after_stage = False
        return "\n".join(result).rstrip("\n") + "\n"


def _tables(content: object) -> list[object]:
    """The stages of a section."""
    if isinstance(content, list):
        return content
    return [] if content is None else [content]
