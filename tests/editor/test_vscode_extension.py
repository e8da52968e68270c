"""The VS Code extension: its description, its grammar on every technique of the library, its package."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from folders import ROOT
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.out_builtins import OUT_BUILTINS
from sssgen.lang.check.quantities import QUANTITIES
from sssgen.lang.check.uniform_hints import HINTS
from sssgen.lang.syntax.lexer import KEYWORDS, TYPES, scan
from sssgen.lang.syntax.tokens import Token
from sssgen.material.library import TECHNIQUES
from sssgen.version import VERSION
from tools import vscode_grammar

FOLDER = ROOT / "editors" / "vscode"
MODULES = ROOT / "build" / "vscode" / "node_modules"
PACKAGE = json.loads((FOLDER / "package.json").read_text("utf-8"))
MISSING = not MODULES.is_dir() or not shutil.which("node")


def needs_node(test: Callable[..., None]) -> Callable[..., None]:
    """Marks a test that runs packages of npm."""
    return pytest.mark.slow(pytest.mark.skipif(MISSING, reason="npm's packages are missing: make vscode")(test))


def test_the_grammar_is_that_of_the_tables() -> None:
    assert set(vscode_grammar.CONTROL) < set(KEYWORDS)
    assert vscode_grammar.PATH.read_text("utf-8") == vscode_grammar.text(), "run python tools/vscode_grammar.py"


def test_the_description_names_what_is_there() -> None:
    assert (PACKAGE["version"], PACKAGE["main"]) == (VERSION, "./dist/extension.js")
    assert re.fullmatch(r"\^1\.\d+\.0", PACKAGE["engines"]["vscode"])
    assert (FOLDER / "LICENSE").read_text("utf-8") == (ROOT / "LICENSE").read_text("utf-8")
    contributed = PACKAGE["contributes"]
    (language,), (grammar,) = contributed["languages"], contributed["grammars"]
    assert (language["id"], language["extensions"]) == ("sss", [".sss"]) and grammar["language"] == "sss"
    assert grammar["scopeName"] == json.loads((FOLDER / grammar["path"]).read_text("utf-8"))["scopeName"]
    assert json.loads((FOLDER / language["configuration"]).read_text("utf-8"))["comments"]["lineComment"] == "//"
    named = [name for name in PACKAGE["files"] if not name.startswith("dist/")]
    assert all((FOLDER / name).exists() for name in named)


def test_the_code_has_the_commands_and_reads_the_settings() -> None:
    code = (FOLDER / "extension.js").read_text("utf-8")
    registered = set(re.findall(r'registerCommand\("([\w.]+)"', code))
    commands = {command["command"] for command in PACKAGE["contributes"]["commands"]}
    shown = {entry["command"] for entries in PACKAGE["contributes"]["menus"].values() for entry in entries}
    assert registered == commands >= shown
    settings = {f"sssgen.{name}" for name in re.findall(r'getConfiguration\("sssgen"\)\.get\("(\w+)"', code)}
    assert settings == set(PACKAGE["contributes"]["configuration"]["properties"])
    assert set(PACKAGE["capabilities"]["untrustedWorkspaces"]["restrictedConfigurations"]) == settings
    assert set(re.findall(r"\{([\w,]+)\}", code)[0].split(",")) == {
        "sss", "toml", "glsl", "frag", "vert",
    }  # fmt: skip


def techniques() -> list[Path]:
    return sorted(Path(TECHNIQUES).rglob("*.sss"))


def scoped(paths: list[Path]) -> dict[Path, list[list[Any]]]:
    """The tokens of each file by the grammar."""
    command = ["node", ROOT / "tests" / "tools" / "grammar_tokens.mjs", MODULES, vscode_grammar.PATH, *paths]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    return dict(zip(paths, json.loads(done.stdout), strict=True))


def wanted(token: Token, following: str, hint: bool) -> str:
    """The scope that a token of the front end must have."""
    text = token.text
    if text in TYPES:
        return "storage.type.sss"
    if text in (*vscode_grammar.CONTROL, vscode_grammar.ASSUME):
        return "keyword.control.sss"
    if text in KEYWORDS:
        return "constant.language.sss" if text in ("true", "false") else "storage.modifier.sss"
    if hint:
        return "keyword.other.hint.sss"
    if text in (*BUILTINS, *OUT_BUILTINS) and following == "(":
        return "support.function.builtin.sss"
    if text in QUANTITIES and re.match(r"\w", following):
        return "support.type.quantity.sss"
    if token.type in ("INT", "FLOAT"):
        return "constant.numeric.sss"
    if token.type == "STRING":
        return "string.quoted.double.sss"
    return "entity.name.function.sss" if token.type == "NAME" and following == "(" else ""


@needs_node
def test_every_token_of_the_library_has_its_scope() -> None:
    checked = dict.fromkeys(("storage.type", "support.function", "keyword.other.hint", "keyword.control", "comment"), 0)
    for path, lines in scoped(techniques()).items():
        text = path.read_text("utf-8")
        rows = text.split("\n")

        def scope(line: int, column: int, lines: list[list[Any]] = lines) -> str:
            return next(" ".join(scopes) for start, end, scopes in lines[line] if start <= column < end)

        for number, row in enumerate(lines):
            for start, end, scopes in row:
                assert scopes or not rows[number][start:end].strip(), (path.name, number + 1, rows[number][start:end])
        code = re.sub(r"^[ \t]*#.*", "", text, flags=re.MULTILINE)
        tokens, comments = scan(code, path.name)
        in_uniform = False
        for number, token in enumerate(tokens):
            in_uniform = token.text == "uniform" or (in_uniform and token.text != ";")
            following = tokens[number + 1].text if number + 1 < len(tokens) else ""
            before = tokens[number - 1].text if number else ""
            found = scope(token.span.line - 1, token.span.column - 1)
            name = wanted(token, following, in_uniform and token.text in HINTS and before in (":", ","))
            assert (name in found) if name else found, (path.name, token.span, token.text, found)
            for kind in checked:
                checked[kind] += kind in found
        for comment in comments:
            for line in range(comment.first, comment.last + 1):
                column = len(rows[line - 1]) - 1
                documentation = comment.text.startswith("/**")
                if rows[line - 1].strip():
                    found = scope(line - 1, column)
                    assert "comment" in found and ("documentation" in found) == documentation, (path.name, line)
                    checked["comment"] += 1
    assert all(count > 50 for count in checked.values()), checked


@needs_node
def test_a_doc_comment_an_include_and_a_hint(tmp_path: Path) -> None:
    path = tmp_path / "own.sss"
    path.write_text(
        '#include "common/lobe.sss"\n/**\n * A lobe.\n * role: translucency\n */\n'
        'uniform float unit : unit("m"), hint_range(0.0, 1.0) = 0.5; // role: none\n',
        encoding="utf-8",
    )
    lines = scoped([path])[path]
    assert lines[0][0][2] == ["keyword.control.directive.include.sss"]
    assert lines[0][2][2] == ["string.quoted.double.include.sss"]
    attribute = next(token for token in lines[3] if "keyword.other.attribute.sss" in token[2])
    assert " * role: translucency"[attribute[0] : attribute[1]] == "role"
    declared = [token[2][-1] for token in lines[5] if token[2]]
    assert declared.count("keyword.other.hint.sss") == 2
    assert lines[5][-1][2] == ["comment.line.double-slash.sss"]


@needs_node
def test_the_package_has_what_the_description_names(tmp_path: Path) -> None:
    folder = tmp_path / "extension"
    shutil.copytree(FOLDER, folder)
    (tmp_path / "node_modules").symlink_to(MODULES)
    package = tmp_path / "sssgen.vsix"
    subprocess.run(["node", str(folder / "pack.mjs"), str(folder), str(package)], check=True, capture_output=True)
    with zipfile.ZipFile(package) as archive:
        names = {name.removeprefix("extension/").lower() for name in archive.namelist()}
        licences = archive.read("extension/dist/LICENSES.txt").decode()
        code = archive.read("extension/dist/extension.js").decode()
    assert {
        "package.json", "dist/extension.js", "dist/licenses.txt", "syntaxes/sss.tmlanguage.json",
        "language-configuration.json", "readme.md", "license.txt",
    } <= names  # fmt: skip
    assert not [name for name in names if "node_modules" in name or name.endswith(("extension.mjs", "pack.mjs"))]
    assert "vscode-languageclient" in licences and "Microsoft" in licences
    assert 'require("vscode")' in code and 'require("vscode-languageclient' not in code
