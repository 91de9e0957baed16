//! The reader: parses a text declaration by declaration, so that a fault invalidates only its own declaration.
//!
//! The grammar defines declarations; their boundaries come from words and braces ([`SyncPoints`]). The declarations of a large mechanism
//! are parsed on several threads.

#![allow(clippy::redundant_closure_for_method_calls)] // a method of one builder is not general enough for all

use super::ast::{Feature, FeatureKind, File, Item, ItemKind, Mechanism, Name, UsedFile};
use super::build::{Builder, Built, Head, Piece, docs_above, normalized};
use super::depth::STACK;
use super::errors;
use super::grammar::Rule;
use super::reuse::PreviousTree;
use super::sync_points::SyncPoints;
use mechc_parallel::{default_jobs, scoped_chunks};
use mechc_text::diag::{Diagnostic, Diagnostics};
use mechc_text::source::{FileId, Source, Span};
use mechc_text::vocabulary::{SubstituteKind, substitute_name};
use pest::iterators::Pair;
use rustc_hash::FxHashSet;
use std::convert::Infallible;
use std::ops::Range;

/// Maximum number of faults of a text for which suggestions are searched.
const MOST_SUGGESTIONS: usize = 100;
/// Smallest number of tokens that a thread parses at once.
const SHARE: usize = 5_000;
/// Smallest number of such shares that are parsed in parallel.
const FEWEST_SHARES: usize = 8;
/// Maximum number of threads; more are limited by memory.
const MOST_JOBS: usize = 4;

/// Parses a text, with or without faults, with the help of its tree before an edit. Returns the tree, the faults, and where declarations
/// begin that have some.
pub(super) fn read(
    source: &Source,
    file: FileId,
    sync: &SyncPoints<'_>,
    previous: Option<&PreviousTree<'_>>,
) -> (File, Diagnostics, FxHashSet<u32>) {
    let mut reader = Reader { previous, ..Reader::new(source, file, sync, 0) };
    let tree = reader.file();
    (tree, reader.faults, reader.faulty)
}

/// State of the reader between declarations.
struct Reader<'a> {
    source: &'a Source,
    file: FileId,
    sync: &'a SyncPoints<'a>,
    previous: Option<&'a PreviousTree<'a>>,
    /// Index of the next token.
    at: usize,
    faults: Diagnostics,
    /// Keywords that were used as names: their uses are not reported again.
    bad_names: FxHashSet<&'a str>,
    /// True if the missing end of the text has been reported.
    has_reported_end: bool,
    /// Position of the last reported fault, in bytes.
    last_reported: Option<usize>,
    /// True if the declaration that is being parsed has a fault, reported or not.
    is_faulty: bool,
    /// First bytes of the declarations of mechanisms that have a fault.
    faulty: FxHashSet<u32>,
}

/// Declarations without faults that were parsed ahead.
struct Share {
    /// Tokens of its declarations.
    range: Range<usize>,
    items: Vec<Item>,
}

impl<'a> Reader<'a> {
    fn new(source: &'a Source, file: FileId, sync: &'a SyncPoints<'a>, at: usize) -> Reader<'a> {
        Reader {
            source,
            file,
            sync,
            previous: None,
            at,
            faults: Diagnostics::default(),
            bad_names: FxHashSet::default(),
            has_reported_end: false,
            last_reported: None,
            is_faulty: false,
            faulty: FxHashSet::default(),
        }
    }

    fn file(&mut self) -> File {
        let (mut uses, mut mechanisms): (Vec<UsedFile>, Vec<Mechanism>) = (Vec::new(), Vec::new());
        let mut has_reported_outside = false;
        while !self.sync.is_behind_the_last(self.at) {
            if self.sync.begins_use(self.at) {
                if !mechanisms.is_empty() {
                    self.report(Box::new(errors::late_use(self.span(self.sync.range(self.at)))));
                }
                let used = self.used_file();
                uses.push(used);
                continue;
            }
            let is_block = self.sync.word(self.at + 2) == "{" && self.sync.block_behind(self.at) == Some(self.at + 2);
            if self.sync.word(self.at) == "mechanism" || is_block {
                mechanisms.extend(self.mechanism());
                continue;
            }
            // the declarations behind a superfluous brace are reported once
            if !std::mem::replace(&mut has_reported_outside, true) {
                let expected = if mechanisms.is_empty() { Rule::mechanism } else { Rule::mechanism_or_end };
                let fault = self.fault_of(expected);
                self.report(fault);
            }
            match mechanisms.last_mut() {
                Some(last) if self.sync.word(self.at) != "}" => {
                    let end = self.items(&mut last.items, true);
                    last.span = last.span.to(end);
                }
                _ => self.at = (self.at + 1).max(self.sync.sync_token(self.at)),
            }
        }
        File { uses, mechanisms }
    }

    /// Parses `use "FILE.mech" as PREFIX`; one with a fault keeps the parts that can be read.
    fn used_file(&mut self) -> UsedFile {
        let first = self.at;
        let (start, next) = (self.sync.start(first), self.sync.end_of_use(first));
        let make = |builder: &Builder<'_>, pair: Pair<'_, Rule>| builder.use_file(builder.only(pair)?);
        let read = self.piece(first..next).read(Rule::only_use, make).or_else(|_| {
            let last = if self.sync.string_behind(next).is_some() { next + 1 } else { next };
            let piece = self.piece(first..last + 1);
            piece.read(Rule::use_and_next, make).map_err(|refused| piece.fault(refused, self.may_suggest()))
        });
        let fault = match read {
            Ok(used) => {
                self.at = self.sync.index_at(used.span.end as usize);
                return used;
            }
            Err(fault) => fault,
        };
        self.report(fault);
        self.at = next;
        // one that is not closed may hold anything
        let is_closed = |text: &str| text.len() > 1 && text.ends_with('"');
        let path = self.sync.string_behind(first).filter(|token| is_closed(token.text));
        let path = path.map(|token| Name {
            text: token.text.trim_matches('"').to_owned(),
            span: self.span(token.start..token.end()),
        });
        let span = self.span(start..self.sync.end_before(next));
        UsedFile { docs: docs_above(&self.source.text, start), span, path, prefix: None, is_broken: true }
    }

    /// Parses `mechanism NAME { … }`, if it is more than a word.
    fn mechanism(&mut self) -> Option<Mechanism> {
        let (first, start) = (self.at, self.sync.start(self.at));
        let brace = self.sync.block_behind(first);
        let head = self.head(Rule::mechanism_head, brace, |builder, pair| builder.head(pair));
        let mut has_brace = true;
        let name = match head {
            Ok(head) => head.name,
            Err(fault) => {
                // without its opening brace a block mostly lacks the closing one too
                has_brace = brace.is_some();
                let is_head = self.sync.begins_declaration(first + 2) && fault_at(&fault) == self.sync.start(first + 2);
                self.report(fault);
                match brace {
                    Some(brace) => self.at = brace + 1,
                    None if is_head => self.at = first + 2,
                    None => {
                        self.at = self.sync.sync_token(first).max(first + 1);
                        return None;
                    }
                }
                // one without a name has its declarations all the same
                let nameless = Name { text: String::new(), span: self.span(start..start) };
                self.names_of(first, self.at).pop().unwrap_or(nameless)
            }
        };
        let mut items = Vec::new();
        if self.previous.is_none() {
            self.items_in_parallel(&mut items);
        }
        let end = self.items(&mut items, has_brace);
        let span = self.span(start..start).to(end);
        Some(Mechanism { docs: docs_above(&self.source.text, start), name, span, items })
    }

    /// Parses declarations up to the brace that closes the mechanism; returns the span of that brace.
    fn items(&mut self, items: &mut Vec<Item>, must_close: bool) -> Span {
        while !self.ends_the_mechanism() {
            self.item(items);
        }
        if self.sync.word(self.at) == "}" {
            self.at += 1;
            return self.span(self.sync.range(self.at - 1));
        }
        if must_close {
            self.report_end(Rule::item_or_close);
        }
        let end = self.sync.end_before(self.at);
        self.span(end..end)
    }

    /// Parses declarations of a large mechanism on several threads, up to the first one with a fault. They are those that [`Self::items`]
    /// parses: without faults, the reader has no state but its place.
    fn items_in_parallel(&mut self, items: &mut Vec<Item>) {
        let cuts = self.sync.cuts(self.at, SHARE);
        if cuts.len() < FEWEST_SHARES {
            return;
        }
        let read = |shares: Range<usize>| {
            let share = |k: usize| self.share(cuts[k], cuts.get(k + 1).copied().unwrap_or(usize::MAX));
            // each thread has a stack of its own
            stacker::maybe_grow(STACK, STACK, || shares.map_while(share).collect::<Vec<_>>())
        };
        for share in scoped_chunks(default_jobs().min(MOST_JOBS), cuts.len(), read).into_iter().flatten() {
            if share.range.start != self.at {
                break;
            }
            items.extend(share.items);
            self.at = share.range.end;
        }
    }

    /// Parses the declarations of the mechanism between two tokens; `None` if one has a fault.
    fn share(&self, first: usize, end: usize) -> Option<Share> {
        let mut reader = Reader::new(self.source, self.file, self.sync, first);
        let mut items = Vec::new();
        while reader.at < end && !reader.ends_the_mechanism() {
            reader.item(&mut items);
        }
        reader.faults.is_empty().then_some(Share { range: first..reader.at, items })
    }

    /// Parses a declaration of the mechanism, or takes that of the previous tree.
    fn item(&mut self, items: &mut Vec<Item>) {
        let start = self.sync.start(self.at) as u32;
        if let Some((item, next)) = self.previous.and_then(|previous| previous.item(self.sync, self.at)) {
            items.push(item);
            self.at = next;
            return;
        }
        self.is_faulty = false;
        match self.sync.word(self.at) {
            "ground" if self.sync.begins_declaration(self.at) => self.block(items, Rule::ground_head),
            "body" => self.block(items, Rule::body_head),
            _ if self.sync.is_ground_by_another_name(self.at) => self.block(items, Rule::ground_head),
            _ => {
                let item = self.plain_item();
                items.push(item);
            }
        }
        if self.is_faulty {
            self.faulty.insert(start);
        }
    }

    /// Returns whether no declaration of the mechanism follows.
    fn ends_the_mechanism(&self) -> bool {
        match self.sync.word(self.at) {
            "}" => true,
            "" => self.sync.is_behind_the_last(self.at),
            "mechanism" => self.sync.begins_declaration(self.at),
            _ => false,
        }
    }

    /// Parses a body or the ground. Declarations of the mechanism inside its block are added behind it.
    fn block(&mut self, items: &mut Vec<Item>, rule: Rule) {
        let first = self.at;
        let start = self.sync.start(first);
        let brace = self.sync.block_behind(first);
        let head = if rule == Rule::ground_head {
            self.head(rule, brace, |_, _| Ok(None))
        } else {
            self.head(rule, brace, |builder, pair| builder.head(pair).map(Some))
        };
        if let Err(fault) = &head {
            let is_brace_missing = fault_at(fault) == self.sync.start(self.sync.sync_token(first));
            let fault = fault.clone();
            self.report(fault);
            match brace {
                Some(brace) => self.at = brace + 1,
                // features stand where the brace should
                None if is_brace_missing && self.sync.is_feature(self.sync.sync_token(first)) => {
                    self.at = self.sync.sync_token(first);
                }
                None => {
                    self.at = self.sync.sync_token(first).max(first + 1);
                    items.push(self.broken(first));
                    return;
                }
            }
        }
        let behind_head = self.at;
        let mut misplaced = Vec::new();
        let features = self.features(&mut misplaced);
        let span = self.span(start..self.sync.end_before(self.at));
        // a body whose head is at fault is a body all the same, if it has a name
        let of_body = |Head { name, ranges, pose }| (ItemKind::Body { name, pose, features: Vec::new() }, ranges);
        let ground = (ItemKind::Ground { features: Vec::new() }, Vec::new());
        let (mut kind, ranges) = match head {
            Ok(Some(head)) => of_body(head),
            Ok(None) => ground,
            Err(_) if rule == Rule::ground_head || self.sync.word(first + 1) == "ground" => ground,
            // the number of copies is unknown, so their uses cannot be checked
            Err(_) if self.sync.word(first + 2) == "[" => {
                (ItemKind::Broken { names: self.names_of(first, behind_head) }, Vec::new())
            }
            Err(_) => match self.names_of(first, behind_head).pop() {
                Some(name) => of_body(Head { name, ranges: Vec::new(), pose: None }),
                None => (ItemKind::Broken { names: Vec::new() }, Vec::new()),
            },
        };
        if let Some(of_block) = kind.features_mut() {
            *of_block = features;
        }
        items.push(Item { docs: docs_above(&self.source.text, start), span, ranges, kind });
        items.append(&mut misplaced);
    }

    /// Parses features up to the brace that closes their block, or to where it is missing.
    fn features(&mut self, misplaced: &mut Vec<Item>) -> Vec<Feature> {
        let mut features = Vec::new();
        loop {
            match self.sync.word(self.at) {
                "}" => {
                    self.at += 1;
                    return features;
                }
                "" if self.sync.is_behind_the_last(self.at) => {
                    self.report_end(Rule::feature_or_close);
                    return features;
                }
                _ if self.sync.begins_large_declaration(self.at) => {
                    // all open braces are closed, so no brace is missing
                    let is_misplaced = self.sync.braces_from(self.at) <= -2;
                    let fault = self.fault_of(Rule::feature_or_close);
                    if !is_misplaced {
                        self.report(fault);
                        return features;
                    }
                    let word = self.sync.word(self.at);
                    self.faulty.insert(self.sync.start(self.at) as u32);
                    self.report(Box::new(errors::misplaced_in_body(*fault, word)));
                    match word {
                        "ground" => self.block(misplaced, Rule::ground_head),
                        "body" => self.block(misplaced, Rule::body_head),
                        _ => {
                            let item = self.plain_item();
                            misplaced.push(item);
                        }
                    }
                }
                _ => {
                    let feature = self.feature();
                    features.push(feature);
                }
            }
        }
    }

    /// Parses a declaration without a block, or a fault in its place.
    fn plain_item(&mut self) -> Item {
        let first = self.at;
        let read = if self.sync.begins_large_declaration(first) {
            self.declaration([Rule::only_item, Rule::item_and_next], |builder, pair| {
                builder.plain_item(builder.only(pair)?)
            })
        } else {
            let fault = self.fault_of(Rule::item_or_close);
            let is_feature = self.sync.is_feature(first);
            Err(if is_feature { errors::feature_in_mechanism(fault, self.sync.word(first)) } else { fault })
        };
        match read {
            Ok(item) => {
                self.at = self.sync.index_at(item.span.end as usize);
                // a hyphenated name, which has been reported, is no difference
                if self.uses_hyphenated(first) { self.broken(first) } else { item }
            }
            Err(fault) => {
                self.skip(fault);
                self.broken(first)
            }
        }
    }

    fn feature(&mut self) -> Feature {
        let first = self.at;
        let read = if self.sync.is_feature(first) {
            self.declaration([Rule::only_feature, Rule::feature_and_next], |builder, pair| {
                builder.feature(builder.only(pair)?)
            })
        } else {
            Err(self.fault_of(Rule::feature_or_close))
        };
        match read {
            Ok(feature) => {
                self.at = self.sync.index_at(feature.span.end as usize);
                let is_spoilt = self.uses_hyphenated(first);
                if is_spoilt { Feature { kind: FeatureKind::Broken, ..feature } } else { feature }
            }
            Err(fault) => {
                self.skip(fault);
                let span = self.span(self.sync.start(first)..self.sync.end_before(self.at));
                let nameless = Name { text: String::new(), span };
                let name = self.names_of(first, self.at).pop().unwrap_or(nameless);
                Feature {
                    docs: docs_above(&self.source.text, span.start as usize),
                    span,
                    name,
                    kind: FeatureKind::Broken,
                }
            }
        }
    }

    /// Returns whether a token from `first` up to here belongs to a hyphenated name.
    fn uses_hyphenated(&mut self, first: usize) -> bool {
        let is_one = self.sync.uses_hyphenated(first, self.at);
        self.is_faulty |= is_one;
        is_one
    }

    /// Parses the declaration that begins here, up to the next one. A fault is described with the token behind the declaration in view.
    fn declaration<T>(
        &self,
        [alone, with_next]: [Rule; 2],
        make: impl Fn(&Builder<'_>, Pair<'_, Rule>) -> Built<T>,
    ) -> Built<T> {
        let next = self.sync.end_of_plain(self.at);
        let read = self.piece(self.at..next).read(alone, &make).or_else(|_| {
            let piece = self.piece(self.at..next + 1);
            piece.read(with_next, &make).map_err(|refused| piece.fault(refused, self.may_suggest()))
        });
        // a misspelt keyword is the fault of the declaration behind it
        read.or_else(|fault| {
            let next = self.sync.sync_token(self.at);
            if fault_at(&fault) != self.sync.start(next) {
                return Err(fault);
            }
            let piece = self.piece(self.at..next);
            piece.read(alone, &make).map_err(|refused| {
                let local = piece.fault(refused, false);
                if fault_at(&local) < piece.range.end && local.code != fault.code { local } else { fault }
            })
        })
    }

    /// Returns the piece of a range of tokens.
    fn piece(&self, tokens: Range<usize>) -> Piece<'_> {
        Piece::new(self.source, self.file, self.sync.tokens(tokens))
    }

    fn may_suggest(&self) -> bool {
        self.faults.len() < MOST_SUGGESTIONS
    }

    /// Resumes behind a fault: at the next declaration, or where the enclosing block ends.
    fn skip(&mut self, fault: Box<Diagnostic>) {
        let found = self.sync.index_at(fault_at(&fault));
        let next = self.sync.sync_token(self.at);
        self.at = if found > next { self.sync.sync_token(found) } else { next }.max(self.at + 1);
        self.report(fault);
    }

    /// Parses the head of a block, from its keyword to its brace.
    fn head<T>(
        &mut self,
        rule: Rule,
        brace: Option<usize>,
        make: impl FnOnce(&Builder<'_>, Pair<'_, Rule>) -> Built<T>,
    ) -> Built<T> {
        // without a brace, to behind the word in its place
        let last = brace.unwrap_or_else(|| self.sync.sync_token(self.at));
        let piece = self.piece(self.at..last + 1);
        let head = piece.read(rule, make).map_err(|refused| piece.fault(refused, self.may_suggest()))?;
        self.at = last + 1;
        Ok(head)
    }

    /// Returns the diagnostic for the word here, where a rule was expected.
    fn fault_of(&self, rule: Rule) -> Box<Diagnostic> {
        let piece = self.piece(self.at..self.at + 1);
        let refused = piece.read(rule, |builder, _| Err::<Infallible, _>(builder.truncated()));
        match refused {
            Err(refused) => piece.fault(refused, self.may_suggest()),
        }
    }

    fn report_end(&mut self, rule: Rule) {
        if !std::mem::replace(&mut self.has_reported_end, true) {
            let fault = self.fault_of(rule);
            self.report(fault);
        }
    }

    fn report(&mut self, mut fault: Box<Diagnostic>) {
        self.is_faulty = true;
        let at = fault_at(&fault);
        if let Some(("ground", "body")) = self.sync.word_as_name(at) {
            let body = self.sync.start(self.sync.index_at(at) - 1);
            *fault = errors::ground_as_body(*fault, self.span(body..at));
        } else if let Some((word, keyword)) = self.sync.word_as_name(at) {
            let is_free = |name: &str| !self.sync.has_word(name);
            let instead =
                if self.may_suggest() { substitute_name(SubstituteKind::behind(keyword), is_free) } else { None };
            *fault = errors::keyword_as_name(*fault, word, instead);
        }
        // a word that ends one declaration and begins none is met twice
        let is_reported = self.last_reported.replace(at) == Some(at);
        if !is_reported && !self.sync.uses_bad_name(at, &self.bad_names) {
            self.faults.push(*fault);
        }
        self.bad_names.extend(self.sync.word_as_name(at).map(|(word, _)| word));
    }

    /// Returns the tokens from `first` up to here as a broken declaration.
    fn broken(&self, first: usize) -> Item {
        let span = self.span(self.sync.start(first)..self.sync.end_before(self.at));
        let docs = docs_above(&self.source.text, span.start as usize);
        Item { docs, span, ranges: Vec::new(), kind: ItemKind::Broken { names: self.names_of(first, self.at) } }
    }

    fn names_of(&self, first: usize, end: usize) -> Vec<Name> {
        self.sync
            .names_of(first, end)
            .map(|token| Name { text: normalized(token.text), span: self.span(token.start..token.end()) })
            .collect()
    }

    fn span(&self, range: Range<usize>) -> Span {
        Span { file: self.file, start: range.start as u32, end: range.end as u32 }
    }
}

/// Returns the position of a fault, in bytes.
fn fault_at(fault: &Diagnostic) -> usize {
    fault.labels.first().map_or(0, |label| label.span.start as usize)
}
