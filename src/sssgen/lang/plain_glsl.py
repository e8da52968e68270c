"""Loads plain GLSL (1.00 ES to 4.60): preprocessor, parser, checker, without the extensions for techniques."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from sssgen.ir.nodes import Module
from sssgen.ir.spans import Span
from sssgen.lang import shadertoy
from sssgen.lang.assumption_comments import AssumedInput, with_assumptions
from sssgen.lang.check.context import Language
from sssgen.lang.check.module_checker import check_plain
from sssgen.lang.precision_rules import check_precisions
from sssgen.lang.preprocess.preprocessor import PreprocessedText, preprocess
from sssgen.lang.source_lines import keep_lines
from sssgen.lang.syntax.doc_comments import words_of
from sssgen.lang.syntax.parser import parse_tokens
from sssgen.lang.syntax.separate_textures import join_textures
from sssgen.lang.syntax.tokens import Comment, Token
from sssgen.lang.version_rules import check_version
from sssgen.support.diagnostics import Diagnostic, Reporter, SssgenError, did_you_mean, failure
from sssgen.support.gc_pause import pause_gc
from sssgen.support.text_files import read_code

AUTO = "auto"
"""The entry `shadertoy` for a file that has a mainImage and no main, else none."""
ENTRIES = ("shadertoy", AUTO)
"""The conventions for a file's entry point other than `main()`."""

_GENERATED = re.compile("Made by sssgen for |Paste it below the #version")
"""The lines of a generated file comment. In a text that was translated before, the author's comment is between them."""


class GlslFile(NamedTuple):
    """A loaded file of plain GLSL."""

    module: Module
    version: int
    """The number of `#version`, or 0."""
    texts: dict[str, str]
    """The text of every file that was read."""
    constants: list[str]
    """The macros that became constants."""
    ignored: list[str]
    """The extensions and pragmas, which have no effect."""
    warnings: list[Diagnostic]
    paths: list[str]
    """The paths of the included files."""
    head: list[str]
    """The lines of the comment at the top of the file that documents no declaration, such as a licence."""
    assumed: list[AssumedInput]
    """What comments assume of inputs."""


def load_glsl(
    path: str | os.PathLike[str],
    label: str = "",
    roots: Sequence[str | os.PathLike[str]] = (),
    defines: Mapping[str, str] | None = None,
    entry: str = "",
    assumptions: bool = False,
) -> GlslFile:
    """The checked module of a GLSL file and all it includes.

    `label` is the file's name in messages; `roots` are the folders in which included files are looked for after the
    one that they are included from; `defines` are macros; `entry` is empty, `shadertoy` or `AUTO`; `assumptions`:
    comments with `sssgen: assume` count.
    Raises SssgenError for a missing, unreadable, too large or faulty file.
    """
    name = label or os.fspath(path)
    return load_glsl_text(
        read_code(path, name), name, (os.path.dirname(path) or ".", *roots), defines, entry, assumptions
    )


def load_glsl_text(
    text: str,
    label: str,
    roots: Sequence[str | os.PathLike[str]] = (),
    defines: Mapping[str, str] | None = None,
    entry: str = "",
    assumptions: bool = False,
    language: tuple[int, str] | None = None,
) -> GlslFile:
    """The checked module of a GLSL text; see `load_glsl`, and for `language` `preprocess`."""
    if entry and entry not in ENTRIES:
        raise failure(f"unknown entry '{entry}'", did_you_mean(entry, ENTRIES) or f"entries: {', '.join(ENTRIES)}")
    finder = _Finder(roots)
    with pause_gc():
        loaded = _load(text, label, preprocess(text, label, finder.find, defines, language), entry, assumptions)
    return loaded._replace(paths=finder.paths)


def _load(text: str, label: str, source: PreprocessedText, entry: str, assumptions: bool) -> GlslFile:
    """Parses and checks a preprocessed text."""
    tokens = source.tokens
    assumed: list[AssumedInput] = []
    if assumptions:
        tokens, assumed = with_assumptions(tokens, source.comments, {label: text, **source.texts})
    texts = dict(source.texts)
    texts.setdefault(label, text)
    if entry == "shadertoy" or (entry == AUTO and shadertoy.is_scene(tokens)):
        tokens, added = shadertoy.with_entry(tokens, label)
        texts[shadertoy.FILE] = added
    keep_lines(texts)
    reporter = Reporter(label, text, texts)
    reporter.macros = source.expanded
    check_version(source.tokens, source.version, source.profile, reporter)
    head, rest, is_generated = _head(source, label)
    comments = source.comments | {label: rest} if is_generated else source.comments
    file = join_textures(parse_tokens(tokens, comments, reporter, plain=True), reporter)
    if not is_generated and any("\n".join(head) in external.doc for external in file.externals):
        head = []  # it documents a declaration
    es = source.version if source.profile == "es" else 0
    extensions = frozenset(extension.partition(":")[0].strip() for extension in source.extensions)
    compute = label.endswith((".comp", ".comp.glsl"))
    vertex = _is_vertex(tokens, label)
    precisions: dict[Span, str] = {}
    if es:
        is_compute = compute or any(token.text.startswith("local_size_") for token in tokens)
        precisions = check_precisions(source.tokens, not (vertex or is_compute), reporter)
        reporter.check()
    desktop = source.version if source.profile != "es" else 0
    module = check_plain(file, reporter, Language(es, vertex, compute, extensions, desktop, precisions))
    ignored = [f"#extension {name}" for name in source.extensions] + [f"#pragma {name}" for name in source.pragmas]
    return GlslFile(module, source.version, texts, source.macros, ignored, reporter.warnings, [], head, assumed)


def _head(source: PreprocessedText, label: str) -> tuple[list[str], list[Comment], bool]:
    """The text of the comments at the top of a file, the other comments, and whether the first are generated."""
    comments = source.comments.get(label, [])
    above = source.texts[label].split("\n")[: comments[0].first - 1] if comments else []
    count = 0
    while count < len(comments) and not any(line.strip() for line in above):
        if count and comments[count].first > comments[count - 1].last + 1:
            break
        count += 1
    lines = [line for comment in comments[:count] for line in words_of(comment.text).split("\n")]
    generated = [index for index, line in enumerate(lines) if _GENERATED.match(line)]
    if generated:
        lines = lines[generated[0] + 1 : generated[1] if len(generated) > 1 else None]
    text = "\n".join(lines).strip("\n")
    return (text.split("\n") if text else []), comments[count:], bool(generated)


def preprocess_text(text: str, label: str, roots: Sequence[str | os.PathLike[str]] = ()) -> PreprocessedText:
    """The tokens of a text and of what it includes; see `load_glsl`."""
    return preprocess(text, label, _Finder(roots).find)


def _is_vertex(tokens: Sequence[Token], label: str) -> bool:
    """Whether a file is a vertex shader: by its name, else by variables that only vertex shaders have."""
    suffix = os.path.splitext(label)[1]
    if suffix in (".vert", ".vs", ".frag", ".fs"):
        return suffix in (".vert", ".vs")
    names = {token.text for token in tokens if token.text.startswith("gl_") or token.type == "ATTRIBUTE"}
    return "gl_Position" in names or ("attribute" in names and names.isdisjoint(("gl_FragColor", "gl_FragData")))


class _Finder:
    """Finds included files: next to the including file, then in the given folders."""

    def __init__(self, roots: Sequence[str | os.PathLike[str]]) -> None:
        self.roots = [os.fspath(root) for root in roots]
        self.folders: dict[str, str] = {}
        """The folder of each file that was included, by its name in messages."""
        self.paths: list[str] = []

    def find(self, name: str, place: Span, angled: bool) -> tuple[str, str]:
        own = self.folders.get(place.file, self.roots[0] if self.roots else ".")
        for root in dict.fromkeys((own, *self.roots)):
            path = os.path.join(root, name)
            if os.path.isfile(path):
                label = os.path.normpath(os.path.relpath(path, self.roots[0])) if self.roots else name
                label = label.replace(os.sep, "/")
                self.folders[label] = os.path.dirname(path)
                self.paths.append(path)
                return label, read_code(path, label)
        hint = "it is searched for next to the file and in the folders of -I"
        raise SssgenError([Diagnostic("error", f"cannot find '{name}' to include", place, hint)])
