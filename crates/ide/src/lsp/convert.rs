//! Conversion between positions in files and types of the protocol.

use super::capabilities::Client;
use super::documents::{Document, Documents};
use crate::{Change, EditorDiagnostic, FilePosition, FileRange, Severity, Snapshot};
use gen_lsp_types as lsp;
use mechc_lang::check::NameKind;
use mechc_text::source::Encoding;
use mechc_text::world::World;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// The snapshot and documents of one moment, with what is needed to convert positions.
#[derive(Clone)]
pub(super) struct ProtocolContext {
    pub snapshot: Snapshot,
    pub documents: Documents,
    pub encoding: Encoding,
    pub client: Client,
    /// Files that are not open, with their lines, once they were read.
    pub closed: Arc<Mutex<BTreeMap<Arc<Path>, Arc<Document>>>>,
}

impl ProtocolContext {
    /// Returns the file of a URI, by identity.
    pub fn path(&self, uri: &lsp::Uri) -> Arc<Path> {
        file_of(&uri.0, &self.documents, &self.snapshot)
    }

    /// Converts a position of the client.
    pub fn position(&self, given: &lsp::TextDocumentPositionParams) -> Option<FilePosition> {
        let path = self.path(&given.text_document.uri);
        let document = self.text(&path)?;
        let offset = document.offset((given.position.line, given.position.character), self.encoding);
        Some(FilePosition { path, offset })
    }

    /// Converts a range of the client in a document, with its ends in order.
    pub fn bytes(&self, given: &lsp::TextDocumentIdentifier, range: &lsp::Range) -> Option<Range<u32>> {
        let document = self.text(&self.path(&given.uri))?;
        let [start, end] = [&range.start, &range.end]
            .map(|position| document.offset((position.line, position.character), self.encoding));
        Some(start.min(end)..start.max(end))
    }

    /// Converts a change to an edit of its file.
    pub fn text_edit(&self, change: &Change) -> Option<lsp::TextEdit> {
        let range = self.location(&change.location)?.range;
        Some(lsp::TextEdit { range, new_text: change.text.clone() })
    }

    /// Converts changes to a workspace edit.
    pub fn edit(&self, changes: &[Change]) -> Option<lsp::WorkspaceEdit> {
        let mut files: HashMap<lsp::Uri, Vec<lsp::TextEdit>> = HashMap::new();
        for change in changes {
            let uri = self.location(&change.location)?.uri;
            files.entry(uri).or_default().push(self.text_edit(change)?);
        }
        Some(lsp::WorkspaceEdit { changes: Some(files), ..lsp::WorkspaceEdit::default() })
    }

    /// Converts a range of a file to one of the client.
    pub fn range(&self, path: &Path, range: &Range<u32>) -> Option<lsp::Range> {
        Some(range_in(&*self.text(path)?, range, self.encoding))
    }

    /// Converts a range of the client in a file.
    pub fn bytes_in(&self, path: &Path, given: &lsp::Range) -> Option<Range<u32>> {
        let document = self.text(path)?;
        let [start, end] = [given.start, given.end].map(|at| document.offset((at.line, at.character), self.encoding));
        Some(start..end.max(start))
    }

    /// Converts a range with its file to a location of the client.
    pub fn location(&self, location: &FileRange) -> Option<lsp::Location> {
        let path: Arc<Path> = self.snapshot.buffers().identity(&location.path).into();
        let range = self.range(&path, &location.range())?;
        Some(lsp::Location { uri: lsp::Uri(self.documents.uri(&path)), range })
    }

    /// Converts a diagnostic of a file.
    pub fn diagnostic(&self, path: &Path, diagnostic: &EditorDiagnostic) -> Option<lsp::Diagnostic> {
        let related = diagnostic.related.iter().filter_map(|related| {
            let message = if related.text.is_empty() { diagnostic.message.clone() } else { related.text.clone() };
            Some(lsp::DiagnosticRelatedInformation { location: self.location(&related.location)?, message })
        });
        let related: Vec<_> = related.collect();
        let lines: Vec<&str> =
            std::iter::once(&diagnostic.message).chain(&diagnostic.details).map(String::as_str).collect();
        Some(lsp::Diagnostic {
            range: self.range(path, &diagnostic.range)?,
            severity: Some(match diagnostic.severity {
                Severity::Error => lsp::DiagnosticSeverity::Error,
                Severity::Warning => lsp::DiagnosticSeverity::Warning,
                Severity::Note => lsp::DiagnosticSeverity::Information,
            }),
            code: Some(diagnostic.code.to_owned().into()),
            code_description: None,
            source: Some("mechc".to_owned()),
            message: lines.join("\n").into(),
            tags: None,
            related_information: (!related.is_empty()).then_some(related),
            data: None,
        })
    }

    /// Returns a file with its lines.
    fn text(&self, path: &Path) -> Option<Arc<Document>> {
        if let Some(open) = self.documents.get(path) {
            return Some(Arc::clone(open));
        }
        let mut closed = self.closed.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(read) = closed.get(path) {
            return Some(Arc::clone(read));
        }
        let bytes = self.snapshot.buffers().read(path).ok()?.bytes;
        let document = Arc::new(Document::new(String::new(), 0, std::str::from_utf8(&bytes).ok()?));
        closed.insert(path.into(), Arc::clone(&document));
        Some(document)
    }
}

/// Returns the identity of the file of a URI: the one under which it was opened, or that on disk.
pub(super) fn file_of(uri: &str, documents: &Documents, snapshot: &Snapshot) -> Arc<Path> {
    let identity = || snapshot.buffers().identity(&super::uri::path_of(uri)).into();
    documents.file(uri).cloned().unwrap_or_else(identity)
}

fn range_in(document: &Document, range: &Range<u32>, encoding: Encoding) -> lsp::Range {
    let position = |offset: u32| {
        let (line, character) = document.position(offset, encoding);
        lsp::Position { line, character }
    };
    lsp::Range { start: position(range.start), end: position(range.end) }
}

/// Wraps Markdown.
pub(super) fn markdown(text: String) -> lsp::MarkupContent {
    lsp::MarkupContent { kind: lsp::MarkupKind::Markdown, value: text }
}

/// Returns the symbol kind with which the client shows a declaration.
pub(super) fn symbol_kind(kind: NameKind) -> lsp::SymbolKind {
    match kind {
        NameKind::Mechanism => lsp::SymbolKind::Module,
        NameKind::Prefix => lsp::SymbolKind::Namespace,
        NameKind::Param => lsp::SymbolKind::Constant,
        NameKind::Function => lsp::SymbolKind::Function,
        NameKind::Argument | NameKind::Measure | NameKind::Trace | NameKind::Result | NameKind::Requirement => {
            lsp::SymbolKind::Variable
        }
        NameKind::Table => lsp::SymbolKind::Array,
        NameKind::Input | NameKind::Driver | NameKind::Load => lsp::SymbolKind::Event,
        NameKind::Ground | NameKind::Body => lsp::SymbolKind::Class,
        NameKind::Part => lsp::SymbolKind::Object,
        NameKind::Point | NameKind::Axis | NameKind::Circle | NameKind::Curve => lsp::SymbolKind::Field,
        NameKind::Joint | NameKind::Constraint => lsp::SymbolKind::Interface,
        NameKind::Broken => lsp::SymbolKind::Null,
    }
}
