"""A session of 200 requests of all kinds that the server offers, by pygls' client, once in each encoding of positions.

What comes back must be of the types that the protocol gives it, which lsprotocol holds; where the right answer is known it is compared.
"""

import asyncio
import sys
from pathlib import Path

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcException
from pygls.lsp.client import LanguageClient

REQUESTS = 200
# of the protocol
REQUEST_FAILED = -32803
URI = "file:///work/four_bar.mech"
# letters beyond the first plane stand before what is asked about
TEXT = """mechanism four_bar {
    param 𝛼 = 60 deg  param crank_length = 30 mm
    ground { point A = (0, 0)  point D = (100 mm, 0) }
    body crank at (0, 0, 𝛼) { point A = (0, 0)  point B = (crank_length, 0) }
    body coupler at (15 mm, 26 mm, 30 deg) { point B = (0, 0)  point C = (80 mm, 0) }
    body rocker at (100 mm, 0, 100 deg) { point D = (0, 0)  point C = (60 mm, 0) }
    joint main: revolute(ground.A, crank.A)
    joint pin: revolute(crank.B, coupler.B)
    joint knee: revolute(coupler.C, rocker.C)
    joint pivot: revolute(ground.D, rocker.D)
    driver motor: rotation(main) = 𝛼 + 90 deg/s * t
    analysis from 0 s to 4 s every 0.1 s
}
"""
PLACES = ["crank_length, 0", "𝛼) {", "revolute(crank", "coupler.B", "rotation", "mm, 26", "motor", "analysis", "deg/s"]


class Session:
    """A client with a text, and how both count."""

    def __init__(self, client, encoding):
        self.client, self.encoding, self.text = client, encoding, TEXT
        self.version, self.count = 1, 0

    def width(self, text):
        return len(text.encode("utf-8")) if self.encoding == "utf-8" else len(text.encode("utf-16-le")) // 2

    def position(self, at):
        line_start = self.text.rfind("\n", 0, at) + 1
        return lsp.Position(self.text.count("\n", 0, at), self.width(self.text[line_start:at]))

    def range_of(self, words):
        at = self.text.index(words)
        return lsp.Range(self.position(at), self.position(at + len(words)))

    def document(self):
        return lsp.TextDocumentIdentifier(URI)

    def replace(self, old, new):
        """Edits the text here and there."""
        change = lsp.TextDocumentContentChangePartial(text=new, range=self.range_of(old))
        self.version += 1
        self.text = self.text.replace(old, new, 1)
        document = lsp.VersionedTextDocumentIdentifier(self.version, URI)
        self.client.text_document_did_change(lsp.DidChangeTextDocumentParams(document, [change]))

    async def ask(self, name, params):
        self.count += 1
        return await asyncio.wait_for(getattr(self.client, name + "_async")(params), 20)

    async def diagnostics(self):
        report = await self.ask("text_document_diagnostic", lsp.DocumentDiagnosticParams(self.document()))
        assert report.kind == "full", report
        return report.items

    async def until(self, holds):
        """The diagnostics, once they are what they should be: later stages say theirs later."""
        for _ in range(100):
            found = await self.diagnostics()
            if holds(found):
                return found
            await asyncio.sleep(0.05)
        raise AssertionError(f"the diagnostics are {found}")


def requests(capabilities):
    """What the server says it offers: how each is asked at a position."""
    offers = lambda name: getattr(capabilities, name, None)
    at = lambda make: lambda s, p: make(s.document(), p)
    table = {
        "hover_provider": ("text_document_hover", at(lsp.HoverParams)),
        "completion_provider": ("text_document_completion", at(lsp.CompletionParams)),
        "signature_help_provider": ("text_document_signature_help", at(lsp.SignatureHelpParams)),
        "definition_provider": ("text_document_definition", at(lsp.DefinitionParams)),
        "document_highlight_provider": ("text_document_document_highlight", at(lsp.DocumentHighlightParams)),
        "references_provider": (
            "text_document_references",
            lambda s, p: lsp.ReferenceParams(lsp.ReferenceContext(True), s.document(), p),
        ),
        "rename_provider": ("text_document_rename", lambda s, p: lsp.RenameParams(s.document(), p, "another")),
        "document_symbol_provider": ("text_document_document_symbol", lambda s, p: lsp.DocumentSymbolParams(s.document())),
        "workspace_symbol_provider": ("workspace_symbol", lambda s, p: lsp.WorkspaceSymbolParams("cr")),
        "document_link_provider": ("text_document_document_link", lambda s, p: lsp.DocumentLinkParams(s.document())),
        "folding_range_provider": ("text_document_folding_range", lambda s, p: lsp.FoldingRangeParams(s.document())),
        "selection_range_provider": (
            "text_document_selection_range",
            lambda s, p: lsp.SelectionRangeParams(s.document(), [p]),
        ),
        "code_lens_provider": ("text_document_code_lens", lambda s, p: lsp.CodeLensParams(s.document())),
        "inlay_hint_provider": (
            "text_document_inlay_hint",
            lambda s, p: lsp.InlayHintParams(s.document(), lsp.Range(lsp.Position(0, 0), p)),
        ),
        "semantic_tokens_provider": (
            "text_document_semantic_tokens_full",
            lambda s, p: lsp.SemanticTokensParams(s.document()),
        ),
        "document_formatting_provider": (
            "text_document_formatting",
            lambda s, p: lsp.DocumentFormattingParams(s.document(), lsp.FormattingOptions(4, True)),
        ),
        "document_range_formatting_provider": (
            "text_document_range_formatting",
            lambda s, p: lsp.DocumentRangeFormattingParams(s.document(), lsp.Range(p, p), lsp.FormattingOptions(4, True)),
        ),
        "code_action_provider": (
            "text_document_code_action",
            lambda s, p: lsp.CodeActionParams(s.document(), lsp.Range(p, p), lsp.CodeActionContext([])),
        ),
        "diagnostic_provider": ("text_document_diagnostic", lambda s, p: lsp.DocumentDiagnosticParams(s.document())),
    }
    return [entry for name, entry in table.items() if offers(name)]


async def mistakes(session):
    """What is wrong is told where it is, and gone when it is mended."""
    await session.until(lambda found: not found)
    session.replace("crank.B, coupler", "crank.X, coupler")
    [found] = await session.until(lambda found: len(found) == 1)
    assert (found.code, found.range) == ("E0201", session.range_of("X")), found
    session.replace("crank.X, coupler", "crank.B, coupler")
    # behind the letter beyond the first plane
    session.replace("𝛼 + 90 deg/s", "𝛼 + 90 degs/s")
    [found] = await session.until(lambda found: len(found) == 1)
    assert (found.code, found.range) == ("E0202", session.range_of("degs")), found
    session.replace("degs/s", "deg/s")
    session.replace("driver motor", "// driver motor")
    [found] = await session.until(lambda found: len(found) == 1)
    assert found.code == "E0502", found
    session.replace("// driver motor", "driver motor")
    await session.until(lambda found: not found)


async def answers(session):
    """What is known of names."""
    place = session.position(session.text.index("B, coupler"))
    hover = await session.ask("text_document_hover", lsp.HoverParams(session.document(), place))
    assert "point B" in hover.contents.value, hover
    begin = session.text.index("crank.B, coupler") + len("crank.")
    assert hover.range == lsp.Range(session.position(begin), session.position(begin + 1)), hover
    symbols = await session.ask("text_document_document_symbol", lsp.DocumentSymbolParams(session.document()))
    assert [symbol.name for symbol in symbols] == ["four_bar"], symbols
    inside = {symbol.name: symbol for symbol in symbols[0].children}
    assert inside["𝛼"].selection_range == session.range_of("𝛼"), inside["𝛼"]
    assert [point.name for point in inside["crank"].children] == ["A", "B"], inside["crank"]


async def main(binary, encoding):
    client = LanguageClient("session", "1")
    await client.start_io(binary, "lsp")
    general = lsp.GeneralClientCapabilities(position_encodings=[encoding])
    document = lsp.TextDocumentClientCapabilities(diagnostic=lsp.DiagnosticClientCapabilities())
    workspace = lsp.WorkspaceClientCapabilities(diagnostics=lsp.DiagnosticWorkspaceClientCapabilities(refresh_support=True))
    client.feature("workspace/diagnostic/refresh")(lambda *_: None)
    capabilities = lsp.ClientCapabilities(general=general, text_document=document, workspace=workspace)
    begun = await client.initialize_async(lsp.InitializeParams(capabilities, process_id=None, root_uri=None))
    assert begun.capabilities.position_encoding == encoding, begun.capabilities.position_encoding
    client.initialized(lsp.InitializedParams())
    session = Session(client, encoding)
    client.text_document_did_open(lsp.DidOpenTextDocumentParams(lsp.TextDocumentItem(URI, "mech", 1, TEXT)))
    await mistakes(session)
    await answers(session)
    kinds = requests(begun.capabilities)
    while session.count < REQUESTS:
        name, params = kinds[session.count % len(kinds)]
        place = PLACES[session.count % len(PLACES)]
        try:
            await session.ask(name, params(session, session.position(session.text.index(place))))
        except JsonRpcException as refusal:
            # no word of the language gets another name
            assert name == "text_document_rename" and refusal.code == REQUEST_FAILED, (name, refusal)
    client.text_document_did_close(lsp.DidCloseTextDocumentParams(session.document()))
    await client.shutdown_async(None)
    client.exit(None)
    await client.stop()
    print(f"{session.count} requests of {len(kinds)} kinds in {encoding} are answered as they should be")


for encoding in ["utf-16", "utf-8"]:
    asyncio.run(main(sys.argv[1], encoding))
