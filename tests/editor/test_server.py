"""The language server, run by a real client: each kind of file with an error, mended, hovered, completed, followed."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import AsyncIterator
from pathlib import Path

import pytest
import pytest_asyncio
from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcException
from pytest_lsp import LanguageClient, client_capabilities
from pytest_lsp.client import make_test_lsp_client

from sssgen.material import library
from sssgen.material.material_loading import examples

pytestmark = pytest.mark.slow

FILES = {
    "own.sss": (
        "/**\n * A lobe: 😀.\n * role: translucency\n */\nfloat own(world_direction N)\n"
        "{\n    /* 😀 */ return clamp(N.x, 0.0, 1.0);\n}\n",
        ("N.x", "M.x"),
    ),
    "glass.toml": (Path(examples()["ice"]).read_text("utf-8"), ('technique = "', 'technique = "x')),
    "scene.toml": ('material = "ice"\n\n[geometry]\nkind = "ball"\n', ('"ball"', '"bal"')),
    "plain.glsl": ("float half_of(float x)\n{\n    return 0.5 * x;\n}\n", ("* x", "* y")),
}


@pytest_asyncio.fixture
async def client() -> AsyncIterator[LanguageClient]:
    client = make_test_lsp_client()
    await client.start_io(sys.executable, "-m", "sssgen", "lsp", "--stdio")
    await client.initialize_session(
        lsp.InitializeParams(capabilities=client_capabilities("visual-studio-code"), workspace_folders=[])
    )
    yield client
    await client.shutdown_session()


class Session:
    """A client, and the version of each document that it has open."""

    def __init__(self, client: LanguageClient) -> None:
        self.client = client
        self.versions: dict[str, int] = {}

    async def shown(self, uri: str) -> list[lsp.Diagnostic]:
        """The next problems that the server sends for a document."""
        while True:
            published = await self.client.wait_for_notification(lsp.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
            if published.uri == uri and published.version == self.versions.get(uri):
                return list(published.diagnostics)

    async def open(self, uri: str, text: str) -> list[lsp.Diagnostic]:
        self.versions[uri] = 1
        document = lsp.TextDocumentItem(uri, "sss", 1, text)
        self.client.text_document_did_open(lsp.DidOpenTextDocumentParams(document))
        return await self.shown(uri)

    async def change(self, uri: str, text: str) -> list[lsp.Diagnostic]:
        self.versions[uri] += 1
        self.client.text_document_did_change(
            lsp.DidChangeTextDocumentParams(
                lsp.VersionedTextDocumentIdentifier(self.versions[uri], uri),
                [lsp.TextDocumentContentChangeWholeDocument(text)],
            )
        )
        return await self.shown(uri)


def position(text: str, piece: str) -> lsp.Position:
    """The place of a piece, in UTF-16 units."""
    before = text[: text.index(piece)]
    last = before.rpartition("\n")[2]
    return lsp.Position(before.count("\n"), len(last.encode("utf-16-le")) // 2)


@pytest.mark.asyncio
async def test_a_session_of_an_editor(client: LanguageClient, tmp_path: Path) -> None:
    session = Session(client)
    for name, (right, (old, new)) in FILES.items():
        uri = (tmp_path / name).as_uri()
        wrong = right.replace(old, new, 1)
        (problem, *_) = await session.open(uri, wrong)
        assert problem.severity == lsp.DiagnosticSeverity.Error and problem.source == "sssgen"
        assert problem.range.start.line == position(wrong, new).line
        assert await session.change(uri, right) == []

    uri = (tmp_path / "own.sss").as_uri()
    text = FILES["own.sss"][0]
    document = lsp.TextDocumentIdentifier(uri)
    (problem,) = await session.change(uri, text.replace("clamp", "clmp"))
    assert problem.range.start == position(text, "clamp")  # behind a character of two UTF-16 units
    actions = await client.text_document_code_action_async(
        lsp.CodeActionParams(document, problem.range, lsp.CodeActionContext([problem]))
    )
    assert actions and actions[0].title == "Change 'clmp' to 'clamp'"
    assert await session.change(uri, text) == []
    hover = await client.text_document_hover_async(lsp.HoverParams(document, position(text, "clamp")))
    assert hover is not None and isinstance(hover.contents, lsp.MarkupContent) and "builtin" in hover.contents.value
    assert hover.range is not None and hover.range.start == position(text, "clamp")

    untidy = text.replace("return clamp", "return    clamp")
    assert await session.change(uri, untidy) == []
    options = lsp.FormattingOptions(4, True)
    edits = await client.text_document_formatting_async(lsp.DocumentFormattingParams(document, options))
    assert edits and edits[0].new_text == text

    lenses = await client.text_document_code_lens_async(lsp.CodeLensParams(document))
    assert lenses and lenses[0].command is not None and "operation" in lenses[0].command.title
    assert lenses[0].range.start == position(text, "own(")
    assert await session.change(uri, text.replace("own(", "own((")) != []
    assert len(await client.text_document_code_lens_async(lsp.CodeLensParams(document)) or []) == len(lenses)
    assert await session.change(uri, text) == []
    refused = lsp.RenameParams(document, position(text, "clamp"), "other")
    with pytest.raises(JsonRpcException, match="nothing here can be renamed"):
        await client.text_document_rename_async(refused)
    with pytest.raises(JsonRpcException, match="a quantity of the chain"):
        await client.text_document_prepare_rename_async(lsp.PrepareRenameParams(document, position(text, "N.x")))

    plain = text.replace("/**", "uniform float gain = 1.0;\n/**", 1).replace("clamp(N.x", "clamp(gain * N.x")
    assert await session.change(uri, plain) == []
    place = position(plain, "gain * ")
    prepared = await client.text_document_prepare_rename_async(lsp.PrepareRenameParams(document, place))
    assert isinstance(prepared, lsp.Range) and prepared.start == place
    edit = await client.text_document_rename_async(lsp.RenameParams(document, place, "strength"))
    assert edit is not None and edit.changes is not None
    assert [change.range.start for change in edit.changes[uri]] == [position(plain, "gain = 1.0"), place]

    uri = (tmp_path / "glass.toml").as_uri()
    text = FILES["glass.toml"][0]
    document = lsp.TextDocumentIdentifier(uri)
    name = text.split('technique = "')[1].split('"')[0]
    place = position(text, f'{name}"')
    location = await client.text_document_definition_async(lsp.DefinitionParams(document, place))
    assert isinstance(location, lsp.Location) and location.uri == Path(library.index()[name]).as_uri()
    items = await client.text_document_completion_async(lsp.CompletionParams(document, place))
    assert isinstance(items, list | tuple) and name in [item.label for item in items]


@pytest.mark.asyncio
async def test_bad_documents_do_not_end_the_server(client: LanguageClient, tmp_path: Path) -> None:
    session = Session(client)
    for name, text in (
        ("a.sss", "(" * 20_000),
        ("b.toml", "[material\n\x00"),
        ("c.glsl", "#if\n"),
        ("d.toml", "[[light]]\nx = [["),
    ):
        assert await session.open((tmp_path / name).as_uri(), text)
    untitled = lsp.TextDocumentItem("untitled:Untitled-1", "sss", 1, "float x;")
    client.text_document_did_open(lsp.DidOpenTextDocumentParams(untitled))
    for line in (0, 99):
        place = lsp.Position(line, 500)
        for name in ("a.sss", "b.toml", "gone.toml"):
            document = lsp.TextDocumentIdentifier((tmp_path / name).as_uri())
            await client.text_document_hover_async(lsp.HoverParams(document, place))
            await client.text_document_completion_async(lsp.CompletionParams(document, place))
            await client.text_document_definition_async(lsp.DefinitionParams(document, place))
    right = FILES["plain.glsl"][0]
    document = lsp.TextDocumentIdentifier((tmp_path / "fine.glsl").as_uri())
    assert await session.open(document.uri, right) == []
    asked = asyncio.ensure_future(client.text_document_code_lens_async(lsp.CodeLensParams(document)))
    await asyncio.sleep(0.05)
    assert await session.change(document.uri, right.replace("0.5", "0.25")) == []
    with pytest.raises(JsonRpcException, match="the text has changed"):
        await asked
    (lens,) = await client.text_document_code_lens_async(lsp.CodeLensParams(document)) or []
    assert lens.command is not None and lens.command.title == "1 operation · nothing that can fail"
