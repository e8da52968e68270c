"""The playground's Python in Node.js's Pyodide: its texts and errors equal those of this Python."""

from __future__ import annotations

import gzip
import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import python_bundle
import starts
from sssgen.lang.plain_glsl import load_glsl
from sssgen.material.material_loading import examples, load_material, parse_material
from sssgen.pipeline.compiler import all_targets, compile, transpile
from sssgen.preview.emitted_head import TARGET, emitted_head
from sssgen.preview.flat_head import plain_head
from sssgen.run.machine_parts import node, node_modules
from sssgen.support.diagnostics import SssgenError

HERE = Path(__file__).parent
SECONDS = 280.0
Answers = Callable[[list[dict[str, Any]]], dict[str, Any]]

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not node(), reason="Node.js is missing"),
    pytest.mark.skipif(not (node_modules() / "pyodide").is_dir(), reason="npm's pyodide is missing"),
]


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> Answers:
    """Answers requests in Pyodide, with the page's bundle."""
    folder = tmp_path_factory.mktemp("playground")
    python_bundle.write_bundle(folder, starts.all_starts(), "skin_ear")
    for name in ("app.zip", "stdlib.zip"):
        (folder / name).write_bytes(gzip.decompress((folder / f"{name}.gz").read_bytes()))

    def ask(requests: list[dict[str, Any]]) -> dict[str, Any]:
        (folder / "requests.json").write_text(json.dumps(requests), encoding="utf-8")
        files = [folder, folder / "stdlib.zip", folder / "app.zip", folder / "requests.json", folder / "answers.json"]
        command = [node(), str(HERE / "answers.mjs"), *map(str, files)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS)
        assert not done.returncode, done.stderr[-3000:]
        result: dict[str, Any] = json.loads((folder / "answers.json").read_text(encoding="utf-8"))
        return result

    return ask


def request(name: str, target: str, files: dict[str, str] | None = None, **others: Any) -> dict[str, Any]:
    asked = {"example": name, "main": f"{name}.toml", "files": files or {}, "target": target, "form": "shader"}
    return {**asked, "part": "text", "values": {}, "in_scene": [], **others}


def test_all_texts_equal_those_of_this_python(answers: Answers) -> None:
    pairs = [(name, target) for name in examples() for target in all_targets()]
    found = answers([request(name, target) for name, target in pairs])
    texts = refused = 0
    for (name, target), answer in zip(pairs, found["answers"], strict=True):
        try:
            files = compile(name, target).files
        except SssgenError as error:
            assert answer["errors"] == str(error), (name, target)
            refused += 1
            continue
        assert answer["texts"] == files, (name, target)
        texts += 1
    print(f"{len(pairs)} pairs of example and target: {texts} with equal texts, {refused} with the same error")
    assert texts > 200
    assert not {"numpy", "lark"} & set(found["modules"])


def test_edits_give_the_texts_and_errors_of_the_edited_files(answers: Answers) -> None:
    toml = Path(examples()["skin_ear"]).read_text(encoding="utf-8")
    ear = Path(examples()["skin_ear"]).with_name("ear.sss").read_text(encoding="utf-8")
    edits = [
        toml.replace("surface_roughness = 0.42", "surface_roughness = { value = 0.25, fixed = true }"),
        toml.replace('"base_color"', '"base_colour"'),
        toml.replace("[material]", "[material"),
        toml.replace("surface_roughness = 0.42", "surface_roughness = 7.5"),
    ]
    asked = [request("skin_ear", "wgsl", {"skin_ear.toml": text, "ear.sss": ear}) for text in edits]
    asked.append(request("skin_ear", "wgsl", {"skin_ear.toml": toml, "ear.sss": ear.replace(";", "", 1)}))
    asked.append(request("skin_ear", "wgsl"))
    asked.append(request("skin_ear", "wgsl", part="picture", values={"surface_roughness": [0.3]}, in_scene=["x"]))
    found = answers(asked)["answers"]
    for text, answer in zip(edits, found, strict=False):
        try:
            expected = compile(parse_material(text, examples()["skin_ear"]), "wgsl")
            assert (answer["texts"], answer["errors"]) == (expected.files, "")
        except SssgenError as error:
            assert answer["errors"] == str(error)
            assert answer["diagnostics"] == [one.as_json() for one in error.diagnostics]
            assert "-->" in answer["errors"] and "^" in answer["errors"]
    assert [bool(answer["errors"]) for answer in found] == [False, True, True, True, True, False, False]
    assert "ear.sss" in found[4]["errors"] and "^" in found[4]["errors"]
    assert found[5]["texts"] == compile(load_material("skin_ear"), "wgsl").files  # the edits are taken back
    material = load_material("skin_ear")
    head = emitted_head(material, compile(material, TARGET), {"surface_roughness": [0.3]}, ["x"])
    assert found[6]["head"] == {**head, "texture_files": {}}


def test_plain_glsl_equals_transpile(answers: Answers) -> None:
    path = starts.OWN / "plain_glsl" / "plain_glsl.glsl"
    text = path.read_text(encoding="utf-8")
    targets = list(all_targets())
    asked = [request("plain_glsl", name, {path.name: text}, main=path.name) for name in targets]
    wrong = {path.name: text.replace("sum +=", "sum =+ * ")}
    asked.append(request("plain_glsl", "wgsl", {path.name: text}, main=path.name, part="picture"))
    asked.append(request("plain_glsl", "wgsl", wrong, main=path.name))
    found = answers(asked)["answers"]
    loaded = load_glsl(path, path.name, entry="shadertoy")
    for target, answer in zip(targets, found, strict=False):
        try:
            expected = transpile(loaded.module, target, "plain_glsl", keep=True, head=loaded.head).files
        except SssgenError as error:
            assert answer["errors"] == str(error), target
        else:
            assert answer["texts"] == expected, target
    assert found[-2]["head"] == json.loads(json.dumps(plain_head(str(path), "auto")))
    assert "plain_glsl.glsl:12:16" in found[-1]["errors"] and "^" in found[-1]["errors"]
