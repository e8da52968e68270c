"""Checks a folder: compiles its materials, compares its scenes with golden pictures and its numbers with the oracle.

    with Run(update=False) as run:
        for case in cases("shaders", ["gl"]):
            print(case.name, run(case).outcome.text)

A case is a material, a scene on one back end, or a file `*.eval.json`:

    {"technique": "lobe.sss", "bind": {"body_distance": "shapes.sss:star"}, "inputs": {"N": [[0, 0, 1]], "power": 4.0},
     "tolerance": 1e-5}

`inputs` are numbers by name, or the name of a file for `sssgen eval --inputs`; `samples` is the number of random values
for the other inputs, `seed` their seed; `outputs` are numbers that the oracle must give.
"""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Iterator, Sequence
from time import perf_counter
from typing import Any, Literal, NamedTuple

from sssgen.material.library import ROLES
from sssgen.support import json_source
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.installation import install_hint
from sssgen.support.paths import posix, stem
from sssgen.support.text_files import read_text
from sssgen.testing.compile_outcome import compile_material
from sssgen.testing.outcome import Outcome, beside, missing_part

EVAL = ".eval.json"

_OF_SCENES = {"geometry", "camera", "light", "background", "samples"}
"""Keys of a scene: they tell one whose `material` is misspelt. The keys of a material are its roles."""

Kind = Literal["compile", "render", "eval"]


class Case(NamedTuple):
    """One thing to check."""

    kind: Kind
    path: str
    backends: tuple[str, ...] = ()
    """For a scene exactly one; for numbers any, and none means all that are available."""
    first: bool = True
    """Whether its picture becomes the golden one, which all back ends of the scene share."""

    @property
    def name(self) -> str:
        """The file, and the back ends."""
        on = f" [{', '.join(self.backends)}]" if self.backends else ""
        return f"{posix(self.path)}{on}"


class CaseResult(NamedTuple):
    """A case and its outcome."""

    case: Case
    outcome: Outcome
    seconds: float


def cases(folder: str, backends: Sequence[str] = ()) -> list[Case]:
    """The cases in a folder and its sub-folders; scenes run on `gl` by default.

    Hidden folders, Python environments and `node_modules` are excluded. Raises SssgenError where the folder cannot be
    read, or has no cases.
    """
    result: list[Case] = []
    for path in _files(folder):
        if path.endswith(EVAL):
            result.append(Case("eval", path, tuple(backends)))
        elif path.endswith(".toml") and (kind := _kind(path)):
            names = backends or ("gl",)
            scenes = [Case(kind, path, (name,), name == names[0]) for name in names]
            result += scenes if kind == "render" else [Case(kind, path)]
    if not result:
        hint = f"a material (.toml with [material]), a scene (.toml with `material = …`), or a file *{EVAL}"
        raise failure("there is nothing to check in the folder", hint, posix(folder))
    return result


def _files(folder: str) -> Iterator[str]:
    if not os.path.isdir(folder):
        message = "this is not a folder" if os.path.exists(folder) else "there is no such folder"
        raise failure(message, "name the folder of your materials and scenes", posix(folder))

    def refuse(error: OSError) -> None:
        raise failure(f"cannot read the folder: {error.strerror}", file=posix(error.filename or folder))

    for parent, folders, names in os.walk(folder, onerror=refuse):
        folders[:] = sorted(name for name in folders if not _is_excluded(parent, name))
        yield from (os.path.join(parent, name) for name in sorted(names) if not name.startswith("."))


def _is_excluded(parent: str, name: str) -> bool:
    """Whether a folder is of other tools or of another project: a virtual environment, a repository, a submodule."""
    own = [os.path.join(parent, name, file) for file in ("pyvenv.cfg", ".git")]
    return name.startswith(".") or name in ("node_modules", "__pycache__") or any(map(os.path.exists, own))


def _kind(path: str) -> Kind | None:
    """The kind of case of a .toml file; None for other tools' files. An unreadable file is a case that fails."""
    try:
        text = read_text(path, posix(path))
    except SssgenError:
        return "compile"  # its outcome is the error
    try:
        data: dict[str, Any] = tomllib.loads(text)
    except (ValueError, RecursionError):  # wrong syntax, or thousands of digits
        head = f"\n{text}".partition("\n[")[0]
        return "render" if re.search(r"^\s*material\s*=", head, re.MULTILINE) else "compile"
    if isinstance(data.get("material"), dict):
        return "compile"
    if "material" in data or data.keys() & _OF_SCENES:
        return "render"
    return "compile" if data.keys() & set(ROLES) else None


class Run:
    """Checks cases. Back ends run until it is closed."""

    def __init__(self, update: bool = False, flip: float | None = None) -> None:
        """With `update` golden pictures are written; `flip` is the largest mean of FLIP that passes."""
        self.update = update
        self.flip = flip
        self.started: Any = None  # imported on demand, as materials need no NumPy

    def __enter__(self) -> Run:
        return self

    def __exit__(self, *_: object) -> None:
        if self.started is not None:
            self.started.close()

    def __call__(self, case: Case) -> CaseResult:
        """Checks a case. Raises nothing: an error is the outcome."""
        start = perf_counter()
        try:
            outcome = {"compile": self._compile, "render": self._render, "eval": self._eval}[case.kind](case)
        except SssgenError as error:
            outcome = _failure(error)
        except ImportError as error:
            outcome = missing_part(f"the package '{error.name}'", install_hint("render"))
        except Exception as error:  # the other cases are checked nevertheless
            outcome = Outcome("failed", f"internal error, a bug of sssgen: {type(error).__name__}: {error}")
        return CaseResult(case, outcome, perf_counter() - start)

    def _compile(self, case: Case) -> Outcome:
        return compile_material(case.path)

    def _render(self, case: Case) -> Outcome:
        from sssgen.run.compilers import CompilerMissing
        from sssgen.run.render.scene_render import render
        from sssgen.scene.scene_loading import load
        from sssgen.testing import golden

        (name,), folder = case.backends, os.path.join(os.path.dirname(case.path), golden.FOLDER)
        try:
            backend = self._backends().get(name)
        except CompilerMissing as reason:
            return missing_part(f"the back end {name}", str(reason))
        picture = render(load(case.path), backend).encoded
        if self.update and case.first:
            return golden.update_golden(picture, folder, stem(case.path))
        limit = golden.FLIP if self.flip is None else self.flip
        return golden.compare_golden(picture, folder, stem(case.path), limit, "" if case.first else f".{name}")

    def _eval(self, case: Case) -> Outcome:
        from sssgen.run.backends import SINGLE, CompilerMissing, get
        from sssgen.run.evaluate.deviation import GOAL
        from sssgen.run.evaluate.evaluation import fit_inputs, run
        from sssgen.run.evaluate.input_files import read
        from sssgen.run.evaluate.probes import subject
        from sssgen.run.evaluate.random_inputs import samples
        from sssgen.testing.agreement import against_numbers, against_oracle, check_tolerance

        content, folder = _read(case.path), [os.path.dirname(case.path)]
        tolerance = check_tolerance(content.get("tolerance", GOAL))
        bind = {slot: beside(str(function), folder) for slot, function in content.get("bind", {}).items()}
        chosen = subject(beside(content["technique"], folder), bind)
        inputs: Any = content.get("inputs", {})
        inputs = read(os.path.join(*folder, inputs), chosen) if isinstance(inputs, str) else inputs
        if "samples" in content:
            inputs = samples(chosen, content["samples"], content.get("seed", 0)) | inputs
        fit = fit_inputs(chosen, inputs)
        oracle = run(chosen, fit, get("numpy"))
        outcome = against_numbers(oracle, content.get("outputs", {}), tolerance)
        if outcome.state == "failed":
            return outcome
        outcomes: dict[str, Outcome] = {}
        for name in case.backends or SINGLE:
            try:
                outcomes[name] = against_oracle(chosen, fit, self._backends().get(name), tolerance, oracle)[1]
            except CompilerMissing as reason:
                if case.backends:
                    outcomes[name] = missing_part(f"the back end {name}", str(reason))
            except SssgenError as error:  # the other back ends run nevertheless
                outcomes[name] = Outcome("failed", f"{name} failed", str(error))
        return _summary(outcomes)

    def _backends(self) -> Any:
        if self.started is None:
            from sssgen.testing.backend_pool import BackendPool

            self.started = BackendPool()
        return self.started


def _failure(error: SssgenError) -> Outcome:
    detail = "\n\n".join(diagnostic.render() for diagnostic in error.diagnostics)
    message = " ".join(error.diagnostics[0].message.split())
    return Outcome("failed", message, "" if detail == f"error: {message}" else detail)


def _summary(outcomes: dict[str, Outcome]) -> Outcome:
    """The outcome of several back ends."""
    failed = [outcome for outcome in outcomes.values() if outcome.state == "failed"]
    skipped = [outcome for outcome in outcomes.values() if outcome.state == "skipped"]
    detail = "\n".join(outcome.text for outcome in (failed or outcomes.values()))
    if failed:
        return Outcome("failed", f"{len(failed)} of {len(outcomes)} back ends failed", detail)
    if skipped:
        return Outcome("skipped", skipped[0].message, detail)
    return Outcome("passed", f"as in float64 on {', '.join(outcomes)}", detail)


_SHAPE: dict[str, tuple[type, ...]] = {
    "technique": (str,), "bind": (dict,), "inputs": (dict, str), "samples": (int,), "seed": (int,),
    "tolerance": (int, float), "outputs": (dict,),
}  # fmt: skip


def _read(path: str) -> dict[str, Any]:
    """A file `*.eval.json`. Raises SssgenError."""
    shown = posix(path)
    data = json_source.parse(read_text(path, shown), shown)
    if not isinstance(data, dict) or "technique" not in data:
        raise failure("the technique is missing", '{"technique": "lobe_gdc2011", "inputs": {…}}', shown)
    for key, value in data.items():
        if key not in _SHAPE:
            raise failure(f"unknown key '{key}'", f"keys: {', '.join(_SHAPE)}", shown)
        if not isinstance(value, _SHAPE[key]) or isinstance(value, bool):
            raise failure(f"'{key}' must be {' or '.join(type_.__name__ for type_ in _SHAPE[key])}", file=shown)
    if not (1 <= data.get("samples", 1) <= 1_000_000 and data.get("seed", 0) >= 0):
        raise failure("'samples' must be from 1 to 1000000, 'seed' at least 0", file=shown)
    return data
