//! Printer of Rust items, blocks and lists of values, formatted as rustfmt does.

use super::text::{LONGEST_LINE, documented, lines};

/// Columns per level of indentation.
const INDENT: usize = 4;

/// Buffer of Rust text.
#[derive(Default)]
pub(super) struct Page {
    text: String,
    /// Current indentation in columns.
    indent: usize,
    /// Indentation in columns that is later added to the whole text.
    margin: usize,
}

/// Head of a function.
pub(super) struct Head<'h> {
    /// Words before the name: `pub fn`.
    pub kind: &'h str,
    pub name: &'h str,
    /// Names and types; a type may be empty, as that of `&self`.
    pub arguments: &'h [(&'h str, &'h str)],
    /// Type of the result, empty if there is no result.
    pub result: &'h str,
}

impl Page {
    /// Returns an empty page whose text will stand in a module.
    pub fn of_module() -> Page {
        Page { margin: INDENT, ..Page::default() }
    }

    /// Returns the printed text.
    pub fn done(self) -> String {
        self.text
    }

    /// Prints an indented line; an empty text gives a blank line.
    pub fn line(&mut self, line: &str) {
        if !line.is_empty() {
            self.text.extend(std::iter::repeat_n(' ', self.indent));
        }
        self.text += line;
        self.text.push('\n');
    }

    pub fn blank(&mut self) {
        self.text.push('\n');
    }

    /// Prints complete lines.
    pub fn text(&mut self, text: &str) {
        text.lines().for_each(|line| self.line(line));
    }

    /// Prints documentation.
    pub fn docs(&mut self, docs: &str) {
        self.text(&documented(docs, ""));
    }

    /// Prints a block in braces behind a head.
    pub fn block(&mut self, head: &str, body: impl FnOnce(&mut Page)) {
        self.line(&format!("{head} {{"));
        self.indented(body);
        self.line("}");
    }

    /// Prints an item as a block, followed by a blank line.
    pub fn item(&mut self, head: &str, body: impl FnOnce(&mut Page)) {
        self.block(head, body);
        self.blank();
    }

    /// Prints indented lines without a head.
    pub fn indented(&mut self, body: impl FnOnce(&mut Page)) {
        self.indent += INDENT;
        body(self);
        self.indent -= INDENT;
        // no blank line precedes a closing brace
        if self.text.ends_with("\n\n") {
            self.text.pop();
        }
    }

    /// Ends a block that is a statement, followed by a blank line.
    pub fn end_statement(&mut self) {
        if self.text.ends_with('\n') {
            self.text.pop();
        }
        self.text += ";\n\n";
    }

    /// Prints a function, followed by a blank line.
    pub fn function(&mut self, head: &Head<'_>, body: impl FnOnce(&mut Page)) {
        let Head { kind, name, arguments, result } = head;
        let argument =
            |(name, of): &(&str, &str)| if of.is_empty() { (*name).to_owned() } else { format!("{name}: {of}") };
        let arguments: Vec<String> = arguments.iter().map(argument).collect();
        let result = if result.is_empty() { String::new() } else { format!(" -> {result}") };
        let line = format!("{kind} {name}({}){result}", arguments.join(", "));
        if self.margin + self.indent + line.len() + 2 <= LONGEST_LINE {
            self.block(&line, body);
        } else {
            self.line(&format!("{kind} {name}("));
            self.indented(|page| arguments.iter().for_each(|argument| page.line(&format!("{argument},"))));
            self.block(&format!("){result}"), body);
        }
        self.blank();
    }

    /// Prints a constant.
    pub fn constant(&mut self, docs: &str, head: &str, value: &str) {
        self.docs(docs);
        self.line(&format!("{head} = {value};"));
        self.blank();
    }

    /// Prints a list of values between the texts `before` and `behind`.
    pub fn list(&mut self, before: &str, values: &[String], behind: &str) {
        self.line(before);
        self.text(&lines(values, ""));
        self.line(behind);
    }
}

#[cfg(test)]
mod tests {
    use super::{Head, Page};

    #[test]
    fn long_lines_break_and_blocks_end_without_blanks() {
        let arguments = [("first", "&mut [f64; 12345678901234]"), ("second", "&mut [f64; 123456789]")];
        let mut page = Page::default();
        page.item("impl Long", |page| {
            let short = Head { kind: "fn", name: "short", arguments: &arguments[..1], result: "" };
            page.function(&short, |page| page.line("first"));
            let head = Head { kind: "pub fn", name: "long_enough", arguments: &arguments, result: "Something" };
            page.function(&head, |page| page.line("second"));
        });
        let wanted = "impl Long {
    fn short(first: &mut [f64; 12345678901234]) {
        first
    }

    pub fn long_enough(
        first: &mut [f64; 12345678901234],
        second: &mut [f64; 123456789],
    ) -> Something {
        second
    }
}

";
        assert_eq!(page.done(), wanted);
    }
}
