"""The lines that an editor shows above functions and stages: static cost, and operations that are not proven safe."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from sssgen.analyse.lint.input_assumptions import Assumptions, input_names, rules_of_comments
from sssgen.editor.analysis import Analysis, own_names
from sssgen.editor.documents import GLSL, MATERIAL, TECHNIQUE, Document
from sssgen.editor.problems import Range, range_of
from sssgen.editor.toml_places import tables_of
from sssgen.ir.intrinsics import KINDS
from sssgen.ir.nodes import Module, Span
from sssgen.ir.walk import all_expressions
from sssgen.material.model import Material
from sssgen.passes.cost import cost_of
from sssgen.passes.ranges.sites import Site
from sssgen.passes.reachable import keep_reachable
from sssgen.passes.stage.stage_interface import stage_kind
from sssgen.pipeline.programs import analyse_material, library_sites, plain_module, traced_sites
from sssgen.run.evaluate.probes import subject
from sssgen.targets import registry

PLAIN_TARGET = "glsl-330"
"""Costs of materials are counted with the shell of this target, as `sssgen show` and `sssgen lint` count them."""


MAX_LINES = 3000
"""The longest file that is analysed: these take seconds."""


class Lens(NamedTuple):
    """A text above a place."""

    range: Range
    text: str


def lenses_of(document: Document, analysis: Analysis) -> list[Lens]:
    """The lenses of a document without errors. Raises SssgenError where one appears in the passes."""
    if any(problem.severity == "error" for problem in analysis.diagnostics) or len(document.lines) > MAX_LINES:
        return []
    if document.kind == MATERIAL and analysis.material is not None:
        return _material_lenses(document, analysis.material)
    if document.kind in (TECHNIQUE, GLSL) and analysis.module is not None:
        return _function_lenses(document, analysis, analysis.module)
    return []


def _function_lenses(document: Document, analysis: Analysis, module: Module) -> list[Lens]:
    """Each function with a body. One that the technique calls is analysed for the arguments that it gets there."""
    own = own_names(document)
    functions = {f.span: f for f in module.functions if f.body is not None and f.span.file in own}
    lenses: dict[Span, Lens] = {}
    if analysis.technique is not None:
        chain = subject(document.path)
        sites = library_sites(chain.module, chain.called, chain.chained)
        lenses = _lenses_above(functions, chain.module, sites)
    if functions.keys() - lenses.keys():
        assumptions = Assumptions(
            rules_of_comments(analysis.assumed, input_names(module)), stage_kind(module) == "vertex"
        )
        sites, _ = traced_sites(module, assumed=assumptions.of, unguarded=document.kind == GLSL)
        lenses = _lenses_above(functions, plain_module(module)[0], sites) | lenses
    return [lenses[span] for span in functions if span in lenses]


def _lenses_above(functions: Iterable[Span], module: Module, sites: Sequence[Site]) -> dict[Span, Lens]:
    keys = {function.span: function.key for function in module.functions}
    return {span: Lens(range_of(span), _text(module, keys[span], sites)) for span in functions if span in keys}


def _text(module: Module, key: str, sites: Sequence[Site], slots: frozenset[str] = frozenset()) -> str:
    """The cost of a function with those that it calls, and the proofs of their operations."""
    called = keep_reachable(module, [key]).functions
    places = {expr.span for function in called for expr in all_expressions(function.body or ())}
    own = [site for site in sites if site.node.span in places]
    return f"{cost_of(module, key, slots).text} · {_proof(own)}"


def _proof(sites: Sequence[Site]) -> str:
    """How many of the operations that can fail are not proven safe, and in which ways they may fail."""
    if not sites:
        return "nothing that can fail"
    unproven = [site for site in sites if not site.proven]
    if not unproven:
        return f"proven safe: all {len(sites)}"
    counts = Counter(kind for site in unproven for kind in {guard.kind for guard in site.failures})
    kinds = ", ".join(f"{name}: {counts[kind]}" for kind, name in KINDS.items() if counts[kind])
    return f"not proven safe: {len(unproven)} of {len(sites)} ({kinds})"


def _material_lenses(document: Document, material: Material) -> list[Lens]:
    """The chain above [material], and each stage above its table."""
    program = analyse_material(material, registry.load(PLAIN_TARGET), "shader")
    tables = tables_of(document)
    lenses = []
    for table in tables:
        if table.section == "material":
            costs = [f"{kind}: {cost.text}" for kind, cost in program.costs.items()]
            lenses.append(Lens(_line(document, table.first_line), " · ".join([*costs, _proof(program.sites)])))
    for stage in material.stages:
        line = max(table.first_line for table in tables if table.first_line < stage.span.line)
        span = stage.technique.function.span
        keys = [function.key for function in program.module.functions if function.span == span]
        text = _text(program.module, keys[0], program.sites, program.slots) if keys else "no operation is left of it"
        if line >= 0:
            lenses.append(Lens(_line(document, line), text))
    return lenses


def _line(document: Document, number: int) -> Range:
    return Range(number, 0, number, len(document.line(number)))
