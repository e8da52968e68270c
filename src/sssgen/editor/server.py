"""The language server: the protocol's messages, over pygls (Apache License 2.0), to the functions of this package.

Places are counted in the client's units here (UTF-16 by default) and in characters everywhere else.
"""

from __future__ import annotations

import asyncio
import functools
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcContentModified, JsonRpcException
from pygls.lsp.server import LanguageServer
from pygls.uris import from_fs_path
from pygls.workspace import PositionCodec

from sssgen.editor.analysis import Analysis
from sssgen.editor.completion import TRIGGERS, completions_at
from sssgen.editor.completion_item import Item
from sssgen.editor.definition import definition_at
from sssgen.editor.documents import GLSL, Document
from sssgen.editor.hover import hover_at
from sssgen.editor.layout import lay_out
from sssgen.editor.lenses import Lens, lenses_of
from sssgen.editor.open_documents import OpenDocuments
from sssgen.editor.preparation import prepare
from sssgen.editor.problems import Problem, Range, fixes_of
from sssgen.editor.rename import name_to_rename, rename
from sssgen.support.diagnostics import SssgenError
from sssgen.version import VERSION

QUIET = 0.01
"""Seconds without a change before a text is read: a burst of changes is read once."""
LENSES_QUIET = 0.3
"""Seconds without a change before costs and proofs are computed."""

_SEVERITIES = {"error": lsp.DiagnosticSeverity.Error, "warning": lsp.DiagnosticSeverity.Warning}
_KINDS = {
    "technique": lsp.CompletionItemKind.Module,
    "parameter": lsp.CompletionItemKind.Variable,
    "texture": lsp.CompletionItemKind.File,
    "function": lsp.CompletionItemKind.Function,
    "constant": lsp.CompletionItemKind.Constant,
    "type": lsp.CompletionItemKind.Class,
    "keyword": lsp.CompletionItemKind.Keyword,
    "section": lsp.CompletionItemKind.Struct,
    "value": lsp.CompletionItemKind.Value,
    "file": lsp.CompletionItemKind.File,
}

_Result = TypeVar("_Result")
Place = tuple[Document, Analysis, int, int]


class Server(LanguageServer):
    """The server and the documents that its client has open."""

    def __init__(self) -> None:
        super().__init__("sssgen", VERSION)
        self.documents = OpenDocuments()
        self.lenses: dict[str, tuple[Analysis, list[Lens]]] = {}
        """The last lenses of each open document, and what they were computed of."""
        self.computing = asyncio.Lock()

    @property
    def codec(self) -> PositionCodec:
        return self.workspace.position_codec

    def path_of(self, uri: str) -> str:
        """The path of a document; '' for one that is no file."""
        return str(self.workspace.get_text_document(uri).path) if uri.startswith("file:") else ""

    def range_to_client(self, lines: Sequence[str], part: Range) -> lsp.Range:
        """A range in the client's units."""
        start, end = lsp.Position(part.line, part.column), lsp.Position(part.end_line, part.end_column)
        return lsp.Range(self.position_to_client(lines, start), self.position_to_client(lines, end))

    def position_to_client(self, lines: Sequence[str], place: lsp.Position) -> lsp.Position:
        line = lines[place.line] if place.line < len(lines) else ""
        return lsp.Position(place.line, self.codec.client_num_units(line[: place.character]))

    def location(self, path: str, part: Range) -> lsp.Location:
        """A place in any file, in characters: the client knows no text of it."""
        start, end = lsp.Position(part.line, part.column), lsp.Position(part.end_line, part.end_column)
        return lsp.Location(from_fs_path(path) or "", lsp.Range(start, end))

    def place(self, uri: str, position: lsp.Position) -> Place | None:
        """A document, what it says, and a line and column in it."""
        entry = self.documents.get(path) if (path := self.path_of(uri)) else None
        if entry is None:
            return None
        document, analysis = entry
        own = self.codec.position_from_client_units(document.lines or [""], position)
        return document, analysis, own.line, own.character

    def publish(self, path: str, version: int | None = None) -> None:
        """Reads a document again and sends its problems."""
        problems = self.documents.problems(path)
        entry = self.documents.get(path)
        lines = entry[0].lines if entry else []
        uri = from_fs_path(path) or ""
        diagnostics = [self.diagnostic(lines, problem) for problem in problems]
        self.text_document_publish_diagnostics(lsp.PublishDiagnosticsParams(uri, diagnostics, version))

    def diagnostic(self, lines: Sequence[str], problem: Problem) -> lsp.Diagnostic:
        """A problem as the protocol has it; the hint is part of the message."""
        related = None
        if problem.related_path:
            location = self.location(problem.related_path, problem.related_range)
            related = [lsp.DiagnosticRelatedInformation(location, problem.related_message)]
        return lsp.Diagnostic(
            self.range_to_client(lines, problem.range),
            f"{problem.message}\n{problem.hint}" if problem.hint else problem.message,
            _SEVERITIES.get(problem.severity, lsp.DiagnosticSeverity.Information),
            source="sssgen",
            related_information=related,
        )


async def _on_initialized(server: Server, params: lsp.InitializedParams) -> None:
    """Reads what the first explanation needs, in steps between which requests are answered."""
    for _ in prepare():
        await asyncio.sleep(0)


def _without_errors(handler: Callable[[Server, Any], _Result]) -> Callable[[Server, Any], _Result | None]:
    """A handler that answers nothing where a file that it needs has errors of its own, or has vanished."""

    @functools.wraps(handler)
    def answer(server: Server, params: Any) -> _Result | None:
        try:
            return handler(server, params)
        except (SssgenError, OSError):
            return None

    return answer


def _at_place(handler: Callable[[Server, Any, Place], _Result]) -> Callable[[Server, Any], _Result | None]:
    """A handler that gets the place of the request; one in a document that is not open is answered with nothing."""

    def answer(server: Server, params: Any) -> _Result | None:
        place = server.place(params.text_document.uri, params.position)
        return None if place is None else handler(server, params, place)

    return answer


def _on_open(server: Server, params: lsp.DidOpenTextDocumentParams) -> None:
    path = server.path_of(params.text_document.uri)
    if path:
        server.documents.change(path, params.text_document.text)
        server.publish(path, params.text_document.version)


async def _on_change(server: Server, params: lsp.DidChangeTextDocumentParams) -> None:
    uri, version = params.text_document.uri, params.text_document.version
    path = server.path_of(uri)
    if not path:
        return
    server.documents.change(path, server.workspace.get_text_document(uri).source)
    await asyncio.sleep(QUIET)
    if server.workspace.get_text_document(uri).version not in (version, None):
        return  # a newer change is read in place of this one
    server.publish(path, version)
    dependent = server.documents.depending_on(path)
    for other in dependent:
        await asyncio.sleep(0)
        server.publish(other)
    if dependent:
        _refresh_lenses(server)


def _on_close(server: Server, params: lsp.DidCloseTextDocumentParams) -> None:
    path = server.path_of(params.text_document.uri)
    if path:
        dependent = server.documents.depending_on(path)
        server.documents.close(path)
        server.lenses.pop(path, None)
        server.publish(path)
        for other in dependent:
            server.publish(other)


def _on_file_changes(server: Server, params: lsp.DidChangeWatchedFilesParams) -> None:
    paths = [path for change in params.changes if (path := server.path_of(change.uri))]
    for other in dict.fromkeys(other for path in paths for other in server.documents.depending_on(path)):
        server.publish(other)


def _hover(server: Server, params: lsp.HoverParams, place: Place) -> lsp.Hover | None:
    hover = hover_at(*place)
    if hover is None:
        return None
    word = hover.word
    part = server.range_to_client(place[0].lines, Range(word.line, word.start, word.line, word.end))
    return lsp.Hover(lsp.MarkupContent(lsp.MarkupKind.Markdown, hover.markdown), part)


def _completion(server: Server, params: lsp.CompletionParams, place: Place) -> list[lsp.CompletionItem]:
    return [_item(number, item) for number, item in enumerate(completions_at(*place))]


def _item(number: int, item: Item) -> lsp.CompletionItem:
    return lsp.CompletionItem(
        item.label,
        kind=_KINDS[item.kind],
        detail=item.detail or None,
        documentation=lsp.MarkupContent(lsp.MarkupKind.Markdown, item.doc) if item.doc else None,
        insert_text=item.text or None,
        sort_text=f"{item.rank}{number:05}",
    )


def _definition(server: Server, params: lsp.DefinitionParams, place: Place) -> lsp.Location | None:
    target = definition_at(*place)
    return None if target is None else server.location(target.path, target.range)


def _fixes(server: Server, params: lsp.CodeActionParams) -> list[lsp.CodeAction] | None:
    uri = params.text_document.uri
    place = server.place(uri, params.range.start)
    if place is None:
        return None
    document = place[0]
    actions = []
    for problem in server.documents.problems(document.path):
        if not problem.range.line <= params.range.end.line or problem.range.end_line < params.range.start.line:
            continue
        fixes = fixes_of(document, problem)
        for fix in fixes:
            edit = lsp.TextEdit(server.range_to_client(document.lines, fix.range), fix.text)
            actions.append(
                lsp.CodeAction(
                    fix.title,
                    lsp.CodeActionKind.QuickFix,
                    [server.diagnostic(document.lines, problem)],
                    is_preferred=len(fixes) == 1,
                    edit=lsp.WorkspaceEdit({uri: [edit]}),
                )
            )
    return actions


async def _lenses(server: Server, params: lsp.CodeLensParams) -> list[lsp.CodeLens] | None:
    path = server.path_of(params.text_document.uri)
    entry = server.documents.get(path) if path else None
    if entry is None:
        return None
    text = entry[0].text
    if path not in server.lenses or server.lenses[path][0] is not entry[1]:
        await asyncio.sleep(LENSES_QUIET)
        async with server.computing:
            entry = server.documents.get(path)
            if entry is not None and entry[0].text == text:
                await _renew_lenses(server, path, *entry)
        now = server.documents.get(path)
        if now is None or now[0].text != text:
            raise JsonRpcContentModified("the text has changed")  # the client asks again
    lines = text.split("\n")
    return [
        lsp.CodeLens(server.range_to_client(lines, lens.range), lsp.Command(lens.text, ""))
        for lens in server.lenses.get(path, (None, []))[1]
        if lens.range.line < len(lines)
    ]


async def _renew_lenses(server: Server, path: str, document: Document, analysis: Analysis) -> None:
    """Computes the lenses of a document; while it has errors, the last ones stay.

    Whole shaders take up to half a second, so they are analysed beside the requests; that needs no file.
    """
    try:
        if document.kind == GLSL:
            lenses = await asyncio.to_thread(lenses_of, document, analysis)
        else:
            lenses = lenses_of(document, analysis)
    except (SssgenError, OSError):
        lenses = []
    if lenses or not analysis.diagnostics:
        server.lenses[path] = analysis, lenses


def _refresh_lenses(server: Server) -> None:
    """Has the client ask again for the lenses of documents that have not changed themselves."""
    workspace = server.client_capabilities.workspace
    if workspace and workspace.code_lens and workspace.code_lens.refresh_support:
        server.workspace_code_lens_refresh(None)


def _prepare_rename(server: Server, params: lsp.PrepareRenameParams, place: Place) -> lsp.Range:
    try:
        word = name_to_rename(*place)
    except SssgenError as error:
        raise _refusal(error) from None
    return server.range_to_client(place[0].lines, Range(word.line, word.start, word.line, word.end))


def _rename(server: Server, params: lsp.RenameParams, place: Place) -> lsp.WorkspaceEdit:
    try:
        edits = rename(place, params.new_name, server.documents.refresh, server.documents.paths)
    except SssgenError as error:
        raise _refusal(error) from None
    changes = {}
    for path, own in edits.items():
        lines = server.documents.lines_of(path)
        changes[from_fs_path(path) or ""] = [
            lsp.TextEdit(server.range_to_client(lines, edit.range), edit.text) for edit in own
        ]
    return lsp.WorkspaceEdit(changes)


def _refusal(error: SssgenError) -> JsonRpcException:
    """The answer to a request that cannot be carried out; the client shows its text."""
    first = error.diagnostics[0]
    text = f"{first.message}: {first.hint}" if first.hint else first.message
    return JsonRpcException(text, lsp.LSPErrorCodes.RequestFailed)


def _format(server: Server, params: lsp.DocumentFormattingParams) -> list[lsp.TextEdit] | None:
    place = server.place(params.text_document.uri, lsp.Position(0, 0))
    if place is None:
        return None
    document = place[0]
    text = lay_out(document.text, document.path)
    whole = Range(0, 0, len(document.lines), 0)
    return [lsp.TextEdit(server.range_to_client(document.lines, whole), text)] if text != document.text else []


def make_server() -> Server:
    """A server that answers; `start_io` of it reads from standard input."""
    server = Server()
    server.feature(lsp.INITIALIZED)(_on_initialized)
    server.feature(lsp.TEXT_DOCUMENT_DID_OPEN)(_on_open)
    server.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)(_on_change)
    server.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)(_on_close)
    server.feature(lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES)(_on_file_changes)
    server.feature(lsp.TEXT_DOCUMENT_HOVER)(_without_errors(_at_place(_hover)))
    server.feature(lsp.TEXT_DOCUMENT_COMPLETION, lsp.CompletionOptions(trigger_characters=list(TRIGGERS)))(
        _without_errors(_at_place(_completion))
    )
    server.feature(lsp.TEXT_DOCUMENT_DEFINITION)(_without_errors(_at_place(_definition)))
    server.feature(
        lsp.TEXT_DOCUMENT_CODE_ACTION, lsp.CodeActionOptions(code_action_kinds=[lsp.CodeActionKind.QuickFix])
    )(_without_errors(_fixes))
    server.feature(lsp.TEXT_DOCUMENT_FORMATTING)(_without_errors(_format))
    server.feature(lsp.TEXT_DOCUMENT_CODE_LENS)(_lenses)
    server.feature(lsp.TEXT_DOCUMENT_PREPARE_RENAME)(_at_place(_prepare_rename))
    server.feature(lsp.TEXT_DOCUMENT_RENAME, lsp.RenameOptions(prepare_provider=True))(_at_place(_rename))
    return server
