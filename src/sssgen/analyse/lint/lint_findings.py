"""The operations of a program that have a domain: whether each is safe, and an input that shows where it is not.

for finding in lint("lobe_gdc2011").findings:
    print(finding.render())
"""

from __future__ import annotations

import itertools
import os
import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from sssgen.analyse.lint.input_assumptions import AssumedFact, Assumptions, input_names, load_rules, rules_of_comments
from sssgen.ir.formats import FLOAT32
from sssgen.ir.intrinsics import Guard, Kind
from sssgen.ir.nodes import Assume, Expr, Function, Global, Index, Literal, Local, Member, Module, Swizzle
from sssgen.ir.spans import Span
from sssgen.ir.types import Matrix, Scalar, Vector, Void
from sssgen.ir.walk import operands, statements, subexpressions
from sssgen.lang.check.termination import endless
from sssgen.lang.plain_glsl import AUTO, load_glsl
from sssgen.lang.source_lines import excerpt, source_line, source_text, whole
from sssgen.material import library
from sssgen.material.material_loading import examples, load_material
from sssgen.passes.guards import remedy
from sssgen.passes.ranges.origins import Origins, Step
from sssgen.passes.ranges.sites import Site, spell_range
from sssgen.passes.reachable import drop_unused, keep_reachable
from sssgen.passes.stage.stage_interface import stage_kind
from sssgen.pipeline.compiler import guarded_sites
from sssgen.pipeline.programs import traced_sites
from sssgen.support.diagnostics import Diagnostic, did_you_mean, failure
from sssgen.support.paths import display_name
from sssgen.support.text_files import refuse_folder
from sssgen.targets import registry

_COMMENT_LINES = 20
"""Lines of a comment that are shown."""
LONGEST = 60
"""Characters of an operand or a definition that are shown."""
PROVEN, MAY_FAIL, NOT_PROVEN = "proven", "may fail", "not proven"
REPORTED: tuple[Kind, ...] = ("nan", "division", "undefined", "range")
"""The kinds that are reported if no others are selected: nearly every sum of numbers without a range may overflow."""


class Finding(NamedTuple):
    """An operation with a domain, and one way in which it may fail."""

    site: Site
    verdict: str
    """`proven`, `may fail` (there is an example) or `not proven`."""
    guard: Guard
    """That of the failure; of an operation that is proven safe, any."""
    example: str = ""
    """The command that shows it."""
    guarded: bool = True
    """Whether the emitted text has a guard there."""
    searched: bool = True
    """Whether an input was searched for."""
    why: Sequence[Step] = ()
    """Where the range of its operand comes from: from the operation to an input."""

    @property
    def kind(self) -> Kind:
        """The kind of the failure."""
        return self.guard.kind

    @property
    def message(self) -> str:
        """The message of the diagnostic."""
        if self.verdict == PROVEN:
            return f"{self.site.operation}: proven safe"
        unseen = "not proven, and no input was found that fails" if self.searched else "not proven"
        noted = f" ({unseen})" if self.verdict == NOT_PROVEN else ""
        return f"{self.site.operation}: {self.guard.problem} [{self.kind}]{noted}"

    @property
    def span(self) -> Span:
        """The place of the operation, with whole brackets."""
        return whole(self.site.node.span)

    @property
    def severity(self) -> str:
        """A warning if no guard covers it, otherwise a note."""
        return "note" if self.verdict == PROVEN or self.guarded else "warning"

    @property
    def remedy(self) -> str:
        """What makes the operation safe; '' if it is."""
        return "" if self.verdict == PROVEN else self.with_operands(remedy(self.site, FLOAT32, self.guard))

    @property
    def found(self) -> str:
        """The ranges of its operands; '' where there are none."""
        return self.with_operands(self.site.range_text)

    def diagnostic(self, hint: str = "") -> Diagnostic:
        """The finding as a diagnostic, with its place."""
        return Diagnostic(self.severity, self.message, self.span, hint, source_line(self.span))

    def render(self) -> str:
        """For a terminal: the place, the ranges found, an example, the remedy."""
        lines = [self.diagnostic().render()]
        if self.found:
            lines.append(f"  found: {self.found}")
        lines += [f"  because: {explanation(step)}" for step in self.shown_steps()]
        if self.example:
            lines.append(f"  example: {self.example}")
        if self.verdict != PROVEN:
            lines.append(f"  {'emitted' if self.guarded else 'write'}: {self.remedy}")
        return "\n".join(lines)

    def shown_steps(self) -> list[Step]:
        """The steps that tell most: the first, the one that widened the range, and the last."""
        why = [step for step in self.why if not isinstance(step.node, Literal)]  # a constant says nothing
        shown = [step for index, step in enumerate(why) if index in (0, len(why) - 1) or step.widens]
        return [
            step
            for step, after in itertools.zip_longest(shown, shown[1:])
            if after is None or step.span != after.span  # of a compound assignment, that it widens
        ]

    def with_operands(self, text: str) -> str:
        """A text with the operands' names in place of their letters, or after the text if an operand is not a name."""
        if self.site.guard.replaces == "result":
            return text
        operand_texts = {}
        for letter, arg in zip("xyz", operands(self.site.node), strict=False):
            operand_text = _text_of(arg)
            if operand_text not in ("", letter, excerpt(self.site.node.span, LONGEST)) and re.search(
                rf"\b{letter}\b", text
            ):
                operand_texts[letter] = operand_text
        if all(re.fullmatch(r"[\w.]+", operand_text) for operand_text in operand_texts.values()):
            return re.sub(r"\b[xyz]\b", lambda match: operand_texts.get(match[0], match[0]), text)
        return f"{text}; {', '.join(f'{letter} is {operand_text}' for letter, operand_text in operand_texts.items())}"

    def as_json(self) -> dict[str, Any]:
        """For editors."""
        site = self.site
        return self.diagnostic(self.remedy).as_json() | {
            "verdict": self.verdict,
            "kind": None if self.verdict == PROVEN else self.kind,
            "operation": site.operation,
            "function": site.function,
            "found": self.found,
            "because": [
                {
                    "text": explanation(step),
                    "file": display_name(step.span.file),
                    "line": step.span.line,
                    "column": step.span.column,
                    "low": step.range.low,
                    "high": step.range.high,
                    "widens": step.widens,
                }
                for step in self.why
            ],
            "example": self.example or None,
            "guarded": self.guarded and self.verdict != PROVEN,
        }


def _text_of(node: Expr) -> str:
    """An expression as its author wrote it; '' where only an argument of a macro is known, of which it is computed."""
    text = excerpt(node.span, LONGEST)
    is_name = re.fullmatch(r"[\w.]+", text) is not None
    if isinstance(node, Local | Global):
        return text if is_name else node.name
    leaves = {part.name for part in subexpressions(node) if isinstance(part, Local | Global)}
    return "" if is_name and text in leaves and not isinstance(node, Swizzle | Index | Member) else text


def explanation(step: Step) -> str:
    """A step on the way from an input to an operation, in words, with its place."""
    code = (excerpt(step.span, LONGEST) if step.node is None else _text_of(step.node)) or "a part of a macro"
    where = f"{'of length ' if step.is_length else 'in '}{spell_range(step.range)}, line {step.span.line}"
    if step.what in ("uniform", "input", "parameter"):
        return f"{step.what} {step.name} is {where}"
    if step.what == "definition" and not re.match(r"(\+\+|--)|[\w.\[\] ]+([-+*/]=|\+\+|--)", code):
        return f"{step.name} = {code} is {where}"
    if step.what == "argument":
        return f"{step.name} is {code}, {where}"
    if step.what == "result":
        return f"{step.name} returns {code}, {where}"
    if step.widens:
        return f"{code} widens the range: {where}"
    return f"{code} is {where}"


class Report(NamedTuple):
    """What is found in one technique, material or file."""

    name: str
    findings: list[Finding]
    """Those of the selected kinds, and the operations that are proven safe, in the order of the source."""
    hidden: Mapping[str, int]
    """How many operations may fail in a way of another kind."""
    assumptions: Sequence[AssumedFact] = ()
    """What was assumed of inputs, beyond their contracts."""
    warnings: Sequence[Diagnostic] = ()
    """Assumptions that match no input."""

    def unproven(self) -> list[Finding]:
        """The findings that are not proven safe."""
        return [finding for finding in self.findings if finding.verdict != PROVEN]


def lint(
    name: str, with_examples: bool = True, kinds: Collection[Kind] = REPORTED, assumed: Sequence[str] = ()
) -> Report:
    """The findings of a technique, a material, an example or a file of functions.

    A material is checked as a whole, as in its emitted shader; a technique for all its inputs; a file of plain
    functions for all arguments and without guards, a whole shader from its main(). `assumed` are presets and TOML files
    with assumptions about inputs of plain GLSL. Raises SssgenError.
    """
    is_known = name.endswith((".toml", ".sss")) or name in examples() or name in library.index()
    if assumed and is_known:
        raise failure(f"'{name}' takes no assumptions", "its uniforms have hints, and its parameters quantities")
    if name.endswith(".toml") or name in examples():
        specimens = _stages(name) if with_examples else []
        return _report(name, guarded_sites(load_material(name)), kinds, specimens)
    if name.endswith(".sss") or name in library.index():
        specimen = _technique(name)
        subject = specimen.subject
        sites, origins = traced_sites(subject.module, subject.called, subject.chained)
        return _report(name, sites, kinds, [specimen] if with_examples else [], origins=origins)
    if name.endswith((".glsl", ".frag", ".vert", ".inc")) or os.path.isfile(name):
        return _plain(name, with_examples, kinds, assumed)
    refuse_folder(name, (".glsl", ".sss", ".toml", ".frag", ".vert"))
    names = [*library.index(), *examples()]
    raise failure(
        f"'{name}' is neither a technique nor a material nor a file",
        did_you_mean(name, names) or "see: sssgen list techniques, sssgen list materials",
    )


def _plain(path: str, with_examples: bool, kinds: Collection[Kind], assumed: Sequence[str]) -> Report:
    """The findings of plain functions, which have no guards."""
    rules = load_rules(assumed)
    loaded = load_glsl(path, path, entry=AUTO, assumptions=True)
    module = loaded.module
    rules += rules_of_comments(loaded.assumed, input_names(module))
    assumptions = Assumptions(rules, stage_kind(module) == "vertex")
    sites, origins = traced_sites(module, assumed=assumptions.of if rules else None, unguarded=True)
    facts = [*assumptions.applied.values(), *_source_assumptions(module)]
    specimens = []
    if with_examples and not endless(module):
        names = {name.split(".")[0] for name, _ in assumptions.applied}
        specimens = [
            _technique(f"{path}:{function.name}")
            for function in module.functions
            if _evaluable(module, function) and not _is_restricted(module, function, names)
        ]
    report = _report(path, sites, kinds, specimens, guarded=False, origins=origins)
    return report._replace(assumptions=facts, warnings=assumptions.warnings(input_names(module)))


def _is_restricted(module: Module, function: Function, names: Collection[str]) -> bool:
    """Whether something is assumed where a function runs, so that an input that is drawn for it may not occur."""
    part = drop_unused(keep_reachable(module, [function.key]), False)
    inputs = {param.name for param in function.params} | {uniform.name for uniform in part.uniforms}
    return not inputs.isdisjoint(names) or any(
        isinstance(stmt, Assume) for each in part.functions for stmt in statements(each.body or ())
    )


def _source_assumptions(module: Module) -> Iterator[AssumedFact]:
    """The assumptions in functions: each comment or `assume()` once, though it may state several conditions."""
    spans = {
        stmt.span: function.name
        for function in module.functions
        for stmt in statements(function.body or ())
        if isinstance(stmt, Assume)
    }
    for span, function in spans.items():
        text = source_text(span)
        if "sssgen" in text:
            below = source_text(span._replace(end_line=span.line + _COMMENT_LINES, end_column=1 << 20))
            text = (below if text.startswith("/*") else text).partition("assume")[2].partition("*/")[0]
        words = " ".join(text.partition("//")[0].split())
        yield AssumedFact(f"{function}(), line {span.line}", words, "source", "")


def _evaluable(module: Module, function: Function) -> bool:
    """Whether inputs can be drawn for a function: numbers, vectors and matrices."""
    types = [param.type for param in function.params] + [uniform.type for uniform in module.uniforms]
    plain = all(isinstance(type_, Scalar | Vector | Matrix) for type_ in types) and not module.variables
    return function.body is not None and plain and isinstance(function.result, Scalar | Vector | Matrix | Void)


def _technique(name: str) -> Any:
    from sssgen.analyse.stress.subject import technique

    return technique(name)


def _stages(name: str) -> list[Any]:
    from sssgen.analyse.stress.subject import named_specimens

    return [*named_specimens(name), _technique(registry.load("glsl-330").lighting)]


def _report(
    name: str, sites: Sequence[Site], kinds: Collection[Kind], specimens: list[Any], guarded: bool = True,
    origins: Origins | None = None,
) -> Report:  # fmt: skip
    findings = []
    hidden: Counter[str] = Counter()
    for site in _merge(sites):
        if site.proven:
            findings.append(Finding(site, PROVEN, site.guard))
            continue
        selected = [guard for guard in site.failures if guard.kind in kinds]
        hidden.update({guard.kind for guard in site.failures if guard.kind not in kinds})
        example = _example(site, specimens) if selected else ""
        for guard in selected:
            verdict = MAY_FAIL if example else NOT_PROVEN
            why = origins.chain(site, guard) if origins is not None else ()
            findings.append(Finding(site, verdict, guard, example, guarded, bool(specimens), why))
    return Report(name, findings, hidden)


def _merge(sites: Sequence[Site]) -> list[Site]:
    """The sites in the order of the source; copies of one, as of a case that others fall into, are one."""
    merged: list[Site] = []
    for site in sorted(sites, key=lambda site: (site.node.span, site.operation)):
        last = merged[-1] if merged else None
        place = site.operation, site.node.span
        if last is not None and (last.operation, last.node.span) == place and last.node == site.node:
            merged[-1] = last.joined(site)
            continue
        merged.append(site)
    return merged


def _example(site: Site, specimens: list[Any]) -> str:
    """A command that shows that an operation fails; '' if none is found."""
    if not specimens:
        return ""
    from sssgen.analyse.stress.guard_witness import sites, witness

    for specimen in specimens:
        if any(
            (own.operation, own.place) == (site.operation, site.place) and not own.proven for own in sites(specimen)
        ):
            shown = witness(specimen, site)
            if shown is not None:
                return shown.command
    return ""
