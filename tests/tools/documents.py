"""The tests of the documents' code blocks: a comment before a block states how it is checked.

    <!-- file: PATH -->            the block is that file of the project
    <!-- part of: PATH -->         that file contains the lines of the block, in this order
    <!-- emitted: MATERIAL TARGET FORM FILE -->   the block is that file, emitted by `sssgen.compile`
    <!-- write: PATH -->           the block is written to that file in the reader's folder
    <!-- change: PATH -->          the block is a diff without line numbers for that file in the reader's folder
    <!-- run -->                   its commands succeed there; `<!-- run: gl -->` requires an OpenGL driver
    <!-- output: sssgen … -->      the block is the output of the command
    <!-- findings: sssgen … -->    the block is the output of a command that ends with status 1
    <!-- errors: sssgen … -->      the block is the error output of a command that ends with status 2
    <!-- json: sssgen … -->        the block is a part of the JSON that the command prints: all of its first keys,
                                   of lists the first elements, and of a text that ends with … its beginning
    <!-- python -->                the block is a session of the interpreter

UPDATE_SNAPSHOTS=1 writes the blocks with generated contents: file, emitted, output, findings, errors.
"""

from __future__ import annotations

import doctest
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import sssgen
from folders import ROOT

_BLOCK = re.compile(
    r"<!-- (?P<verb>[a-z ]+?)(?:: (?P<argument>[^\n]*?))? -->\n```(?P<language>\w*)\n(?P<text>(?:(?!```).*\n)*)```\n"
)


class Block(NamedTuple):
    """A code block with its comment."""

    document: Path
    line: int
    verb: str
    argument: str
    text: str

    def __str__(self) -> str:
        return f"{self.document.name}:{self.line} {self.verb} {self.argument}".strip()


def read(document: Path) -> str:
    return document.read_text(encoding="utf-8")


def blocks(document: Path, under: str = "") -> list[Block]:
    """The blocks with a comment, in a whole document or in the part below a heading."""
    text = read(document)
    start, end = 0, len(text)
    if under:
        start = text.index(f"\n## {under}\n")
        end = text.find("\n## ", start + 1) % (len(text) + 1)
    results = []
    for match in _BLOCK.finditer(text, start, end):
        line = text.count("\n", 0, match.start()) + 1
        results.append(Block(document, line, match["verb"], match["argument"] or "", match["text"]))
    return results


def uncommented(document: Path) -> list[int]:
    """The lines of the blocks without such a comment."""
    text = read(document)
    tested = {text.count("\n", 0, match.start()) + 2 for match in _BLOCK.finditer(text)}
    fences = [number for number, line in enumerate(text.splitlines(), 1) if line.startswith("```")][::2]
    return [number for number in fences if number not in tested]


class Reader:
    """Follows a document in its own folder, with the project's commands on the path."""

    def __init__(self, folder: Path, programs: Path, environment: dict[str, str]) -> None:
        self.folder = folder
        path = os.pathsep.join([str(programs), os.environ.get("PATH", "")])
        stored = {name: value for name, value in os.environ.items() if not name.startswith(("SSSGEN", "PYTHON"))}
        self.environment = {**stored, "PATH": path, "PYTHONUTF8": "1", **environment}

    def run(self, command: str, status: int = 0) -> tuple[str, str]:
        """The standard output and the standard error of a command."""
        shell = ["bash", "-euc", command]
        process = subprocess.run(
            shell, cwd=self.folder, env=self.environment, capture_output=True, text=True, encoding="utf-8", check=False
        )
        assert process.returncode == status, f"{command}\n{process.returncode}\n{process.stdout}\n{process.stderr}"
        return process.stdout, process.stderr

    def follow(self, block: Block) -> None:
        """Executes or checks the block. Raises AssertionError if the check fails."""
        if block.verb == "write":
            path = self.folder / block.argument
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text, encoding="utf-8", newline="\n")
        elif block.verb == "change":
            _change(self.folder / block.argument, block)
        elif block.verb == "run":
            self.run(block.text)
        elif block.verb == "python":
            _session(block)
        elif block.verb == "part of":
            _part(block)
        elif block.verb == "json":
            self._json(block)
        else:
            check(block, self.actual_text(block))

    def _json(self, block: Block) -> None:
        shown = json.loads(block.text)
        status = 0 if shown["ok"] else 2 if "diagnostics" in shown else 1
        printed = json.loads(self.run(block.argument, status)[0])
        assert list(shown) == list(printed), f"{block}: the keys are {', '.join(printed)}"
        assert is_part(shown, printed), f"{block} is not current: {json.dumps(printed, indent=2)[:2000]}"

    def actual_text(self, block: Block) -> str:
        """The expected text of the block."""
        if block.verb == "file":
            return read(ROOT / block.argument)
        if block.verb == "emitted":
            material, target, form, file = block.argument.split()
            return sssgen.compile(material, target, form).files[file]
        if block.verb == "output":
            return self.run(block.argument)[0]
        if block.verb == "findings":
            return self.run(block.argument, status=1)[0]
        assert block.verb == "errors", f"{block}: unknown comment"
        return self.run(block.argument, status=2)[1]


def programs(folder: Path, python: str = sys.executable) -> Path:
    """A folder with the programs `sssgen` and `python`, as in an installation."""
    folder.mkdir(parents=True)
    for name, text in {"sssgen": f"{shlex.quote(python)} -m sssgen", "python": shlex.quote(python)}.items():
        path = folder / name
        path.write_text(f'#!/bin/sh\nexec {text} "$@"\n', encoding="utf-8")
        path.chmod(0o755)
    return folder


def check(block: Block, expected: str) -> None:
    """Fails if the block is not that text; UPDATE_SNAPSHOTS=1 writes it."""
    expected = "".join(f"{line.rstrip()}\n" for line in expected.rstrip().splitlines())
    if os.environ.get("UPDATE_SNAPSHOTS") and block.text != expected:
        text = read(block.document)
        head = f"<!-- {block.verb}: {block.argument} -->\n```"
        start = text.index("\n", text.index(head) + len(head)) + 1
        assert text[start:].startswith(f"{block.text}```")
        block.document.write_text(text[:start] + expected + text[start + len(block.text) :], encoding="utf-8")
        return
    assert block.text == expected, f"{block} is not current; UPDATE_SNAPSHOTS=1 updates it"


def is_part(shown: object, printed: object) -> bool:
    """Whether all of a JSON value that a document shows is in a printed one."""
    if isinstance(shown, dict) and isinstance(printed, dict):
        return all(key in printed and is_part(value, printed[key]) for key, value in shown.items())
    if isinstance(shown, list) and isinstance(printed, list):
        pairs = zip(shown, printed, strict=False)
        return len(shown) <= len(printed) and all(is_part(value, other) for value, other in pairs)
    if isinstance(shown, str) and isinstance(printed, str) and shown.endswith("…"):
        return printed.startswith(shown[:-1])
    return shown == printed


def _change(path: Path, block: Block) -> None:
    lines = block.text.splitlines(keepends=True)
    before, after = ("".join(line[1:] for line in lines if line[0] in f" {sign}") for sign in "-+")
    text = read(path)
    assert text.count(before) == 1, f"{block}: the file does not contain the lines to change exactly once"
    path.write_text(text.replace(before, after), encoding="utf-8", newline="\n")


def _session(block: Block) -> None:
    test = doctest.DocTestParser().get_doctest(block.text, {}, str(block), block.document.name, block.line)
    messages: list[str] = []
    doctest.DocTestRunner(verbose=False, optionflags=doctest.ELLIPSIS).run(test, out=messages.append)
    assert not messages, "".join(messages)


def _part(block: Block) -> None:
    lines = iter([line.strip() for line in read(ROOT / block.argument).splitlines()])
    for line in filter(None, map(str.strip, block.text.splitlines())):
        assert line in lines, f"{block}: the file does not contain this line, or not in this order: {line}"
