"""What the documents show is so (files, emitted text, output, errors, sessions, links), and their examples run."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from documents import Block, Reader, blocks, programs, read, uncommented
from folders import ROOT
from sssgen.cli.commands import COMMANDS, command_parser
from sssgen.run import compilers
from sssgen.targets import registry

README = ROOT / "README.md"
DOCUMENTS = [README, *(ROOT / f"{name}.md" for name in ("CONTRIBUTING", "CHANGELOG", "SECURITY"))]
DOCUMENTS += sorted((ROOT / "docs").rglob("*.md"))
DOCUMENTS += sorted((ROOT / "examples").rglob("*.md"))


@pytest.fixture(scope="module")
def reader(tmp_path_factory: pytest.TempPathFactory) -> Reader:
    """A reader in a folder next to the examples."""
    folder = tmp_path_factory.mktemp("reader")
    shutil.copytree(ROOT / "examples", folder / "examples")
    environment = {"PYTHONPATH": str(ROOT / "src"), "SSSGEN_CACHE": str(folder / "cache")}
    return Reader(folder, programs(folder / "programs"), environment)


TESTED = [
    block
    for document in DOCUMENTS
    if document.name != "CONTRIBUTING.md" and document.parent.name != "tutorials" and document.is_file()
    for block in blocks(document)
]


@pytest.mark.parametrize("block", TESTED, ids=str)
def test_the_commands_of_a_document_give_its_output(
    block: Block, reader: Reader, compiler: Callable[[str], Any]
) -> None:
    if block.argument == "gl":
        compiler("gl")
    reader.follow(block)


def test_the_readme_is_short_and_has_the_two_commands_of_a_checkout() -> None:
    text = read(README)
    assert len(text.splitlines()) <= 200
    assert "```sh\nmake demo\nmake test\n```" in text
    makefile = read(ROOT / "Makefile")
    assert re.search(r"^demo:", makefile, re.MULTILINE) and re.search(r"^test:", makefile, re.MULTILINE)


def test_the_table_of_targets() -> None:
    table = read(ROOT / "docs" / "targets.md")
    rows = dict(re.findall(r"^\| `([\w-]+)` \|.*\| ([^|]*) \|$", table, re.MULTILINE))
    words = {
        "gl": "OpenGL driver",
        "glslang": "glslang",
        "dxc": "DXC",
        "naga": "naga",
        "tint": "Tint",
        "python": "Python",
        "godot": "Godot 4.6's parser",
        "metal": "g++",
    }
    words |= {"unity": "C preprocessor", "unreal": "DXC", "bevy": "wesl", "tsl": "node"}
    assert list(rows) == [name for name in rows if name in registry.names()]
    for name in registry.names():
        if (ROOT / "targets" / f"{name}.toml").is_file():
            assert all(words[one] in rows[name] for one in compilers.readers(name)), name


def test_every_command_is_in_the_table() -> None:
    text = read(ROOT / "docs" / "command_line.md")
    for name in COMMANDS:
        assert f"`sssgen {name} " in text
        for option in command_parser(name)._option_string_actions:
            assert option in text or option in ("-h", "--help", "-t", "--output"), f"{name} {option}"


def anchors(document: Path) -> set[str]:
    """The headings of a document, as links name them."""
    titles = re.findall(r"^#+ (.*)$", re.sub(r"```.*?```", "", read(document), flags=re.DOTALL), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title).strip().lower().replace(" ", "-") for title in titles}


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_links_lead_somewhere(document: Path) -> None:
    assert document.is_file()
    text = re.sub(r"```.*?```", "", read(document), flags=re.DOTALL)
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"https?://", link):
            continue
        place, _, anchor = link.partition("#")
        target = (document.parent / place).resolve() if place else document
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_documents_keep_their_shape(document: Path) -> None:
    for number, line in enumerate(read(document).splitlines(), 1):
        assert line == line.rstrip() and "\t" not in line, number
    for named in ("/home/", "/root/", "/tmp/", str(ROOT)):
        assert named not in read(document)


def test_most_blocks_are_put_to_the_test() -> None:
    """In the README only those that install something, start a server, or are another system's are not."""
    lines = read(README).splitlines()
    first = [lines[number] for number in uncommented(README)]
    assert all(line.startswith(("make ", "python3 -m ", "py -m ")) for line in first), first


# The examples that the README speaks of


def test_the_opengl_program_draws(reader: Reader, compiler: Callable[[str], Any]) -> None:
    compiler("gl")
    reader.run("sssgen emit paper_lantern --target glsl-330 -o out")
    reader.run("python examples/opengl_program/program.py out/paper_lantern picture.ppm")
    head, _, texels = (reader.folder / "picture.ppm").read_bytes().partition(b"255\n")
    assert head == b"P6 640 640 "
    rows = np.frombuffer(texels, np.uint8).reshape(640, 640, 3).astype(float)
    assert rows[280:360, 280:360].mean() > 60  # the ball
    assert rows[:30, :30].mean() < 20  # beside it
    assert rows[:, :, 0].mean() > rows[:, :, 2].mean()  # warm light


PAGE = """
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';
import { readFileSync } from 'node:fs';
const [modules, page, ...stems] = process.argv.slice(1);
const { create, globals } = await import(pathToFileURL(createRequire(modules + '/').resolve('webgpu')));
Object.assign(globalThis, globals);
const gpu = create(['backend=null']);
const device = await (await gpu.requestAdapter()).requestDevice();
const { Material } = await import(pathToFileURL(page + '/material.js'));
const { camera, identity, sphere } = await import(pathToFileURL(page + '/geometry.js'));
const RENDER = GPUTextureUsage.RENDER_ATTACHMENT;
const made = (format) => device.createTexture({ size: [8, 8], format, usage: RENDER }).createView();
for (const stem of stems) {
  device.pushErrorScope('validation');
  const wgsl = readFileSync(stem + '.wgsl', 'utf8');
  const reflection = JSON.parse(readFileSync(stem + '.wgsl.reflection.json', 'utf8'));
  const material = new Material(device, { wgsl, reflection }, 'rgba8unorm-srgb');
  for (const uniform of reflection.uniforms) material.set(uniform.name, uniform.default);
  const lights = [{ position: [0, 1, 0, 1], color: [1, 1, 1] }];
  const ambient = [0, 0, 0];
  const seen = camera([0, 0, 3], [0, 0, 0], 1);
  material.view({ ...seen, time: 1, ambient, lights, model: identity, inverseModel: identity });
  const encoder = device.createCommandEncoder();
  const body = sphere(device, 4, 8);
  if (reflection.passes.length) {
    const { createPasses } = await import(pathToFileURL(page + '/../sssgen-webgpu.js'));
    material.show(createPasses(device, reflection).draw(encoder, body, { ...seen, size: [8, 8] }, lights));
  }
  const depth = { depthClearValue: 1, depthLoadOp: 'clear', depthStoreOp: 'discard' };
  const pass = encoder.beginRenderPass({
    colorAttachments: [{ view: made('rgba8unorm-srgb'), loadOp: 'clear', storeOp: 'store' }],
    depthStencilAttachment: { view: made('depth24plus'), ...depth },
  });
  material.draw(pass, body);
  pass.end();
  device.queue.submit([encoder.finish()]);
  const error = await device.popErrorScope();
  console.log(stem.split('/').pop(), error ? error.message : 'drawn');
}
const { viewProjection: to, inverseViewProjection: back } = camera([1, 2, 3], [0.5, 0, -1], 1.5);
for (let row = 0; row < 4; row++)
  for (let column = 0; column < 4; column++) {
    let sum = 0;
    for (let k = 0; k < 4; k++) sum += to[4 * k + row] * back[4 * column + k];
    if (Math.abs(sum - (row === column)) > 1e-9) console.log('the inverse is wrong at', row, column, sum);
  }
process.exit(gpu ? 0 : 1);
"""


def test_the_webgpu_page_draws_every_example(tmp_path: Path, compiler: Callable[[str], Any]) -> None:
    """Its modules, in Dawn without a GPU: every binding, offset and attribute is checked against the shader."""
    tint = compiler("tint")
    from sssgen import compile
    from sssgen.material.material_loading import examples

    for name in examples():
        for file, text in compile(name, "wgsl").files.items():
            (tmp_path / file).write_text(text, encoding="utf-8")
    shutil.copytree(ROOT / "examples" / "webgpu_page", tmp_path / "page")
    (tmp_path / "package.json").write_text('{ "type": "module" }', encoding="utf-8")
    stems = [(tmp_path / name).as_posix() for name in examples()]
    command = [*tint._command[:2], "-e", PAGE, str(tint._modules.parent), (tmp_path / "page").as_posix(), *stems]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    drawn = [line for line in done.stdout.splitlines() if line.strip()]
    assert drawn == [f"{name} drawn" for name in examples()], done.stdout + done.stderr


def test_the_examples_hold_nothing_built() -> None:
    """The wheel has the folder unchanged."""
    ends = (".egg-info", ".wgsl", "reflection.json")
    built = [path for path in (ROOT / "examples").rglob("*") if path.name.endswith(ends)]
    assert not built, built
    assert os.path.commonpath([ROOT, *(ROOT / "examples").rglob("*")]) == str(ROOT)
