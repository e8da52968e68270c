"""Imports inside functions: each module that has them is listed here, with the reason."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from folders import ROOT

EMIT = "`sssgen emit` with a warm cache does not need it, and would take noticeably longer (benchmarks/bench_emit.py)"
EXTRA = "an optional package: what does not need it works without it"
HELP = "the module is imported for its options, too: `--help` works without optional packages"

PREVIEW = "the first picture of `sssgen preview` does not need it, and would come later (benchmarks/bench_preview.py)"

LAZY_IMPORTS = {
    "sssgen.cli.bake": HELP,
    "sssgen.cli.bake_fluence": HELP,
    "sssgen.cli.chart": HELP,
    "sssgen.cli.ci": EXTRA,
    "sssgen.cli.completion": HELP,
    "sssgen.cli.emit": EMIT,
    "sssgen.cli.engine_options": HELP,
    "sssgen.cli.eval": HELP,
    "sssgen.cli.export_gltf": HELP,
    "sssgen.cli.import_materials": HELP,
    "sssgen.cli.list_names": HELP,
    "sssgen.cli.fit": HELP,
    "sssgen.cli.fmt": HELP,
    "sssgen.cli.layout": EMIT,
    "sssgen.cli.lint": HELP,
    "sssgen.cli.lsp": HELP,
    "sssgen.cli.new": EXTRA,
    "sssgen.cli.main": "only an internal error needs it, and `sssgen emit` starts faster",
    "sssgen.cli.output": EMIT,
    "sssgen.cli.pick": HELP,
    "sssgen.cli.preview": HELP,
    "sssgen.cli.render": HELP,
    "sssgen.cli.show": HELP,
    "sssgen.cli.facts.scene": EXTRA,
    "sssgen.cli.sizes": HELP,
    "sssgen.cli.stress": HELP,
    "sssgen.cli.transpile": EXTRA,
    "sssgen.cli.use": HELP,
    "sssgen.preview.page_messages": PREVIEW,
    "sssgen.preview.technique_scene": PREVIEW,
    "sssgen.run.backends.browser_page": EXTRA,
    "sssgen.run.backends.opengl": EXTRA,
    "sssgen.run.backends.dispatch": EXTRA,
    "sssgen.run.backends.webgpu": EXTRA,
    "sssgen.run.compilers.dxc": EXTRA,
    "sssgen.run.compilers.gl_driver": EXTRA,
    "sssgen.run.compilers.naga": EXTRA,
    "sssgen.analyse.lint.lint_findings": EXTRA,
    "sssgen.run.machine_facts": EXTRA,
    "sssgen.scene.mesh_files": EXTRA,
    "sssgen.testing.project_run": EXTRA,
    "sssgen.testing.pytest_plugin": "pytest imports it in every test run, of other projects, too",
    "sssgen.lab.chart.drawing": EXTRA,
    "sssgen.jobs.executor": EXTRA,
    "sssgen.support.value_bytes": EXTRA,
    "sssgen.lang.loader": EMIT,
    "sssgen.lang.syntax.grammar_tables": "only building the tables needs lark",
    "sssgen.material.baked": EMIT,
    "sssgen.material.model": EMIT,
    "sssgen.pipeline.compiler": EMIT,
    "sssgen.pipeline.emitted_cache": EMIT,
    "sssgen.pipeline.trace": "only --trace needs it",
    "sssgen.support.diagnostics": EMIT,
    "sssgen.support.extras": EMIT,
    "sssgen.support.paths": EMIT,
    "sssgen.support.progress": EXTRA,
    "sssgen.support.toml_source": EMIT,
    "sssgen.targets.assemble": EMIT,
    "sssgen.targets.reflection": EMIT,
    "sssgen.targets.descriptor_table": EMIT,
    "sssgen.targets.plugins": EMIT,
    "sssgen.targets.templates": EMIT,
}
"""Module → why it imports inside a function."""


def modules_with_lazy_imports() -> Iterator[str]:
    source = ROOT / "src"
    for path in sorted(source.rglob("*.py")):
        functions = [node for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.FunctionDef)]
        inside = [node for function in functions for node in ast.walk(function)]
        if any(isinstance(node, ast.Import | ast.ImportFrom) for node in inside):
            parts = path.relative_to(source).with_suffix("").parts
            yield ".".join(part for part in parts if part != "__init__")


def test_imports_inside_functions_are_listed() -> None:
    result = set(modules_with_lazy_imports())
    assert result - LAZY_IMPORTS.keys() == set(), "import at the top of the module, or list the reason"
    assert LAZY_IMPORTS.keys() - result == set(), "these have no import inside a function: delete them from the table"
