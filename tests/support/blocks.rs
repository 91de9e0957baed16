//! Fenced blocks of a page.

/// Returns the language and the text of each fenced block.
pub fn blocks(page: &str) -> Vec<(String, String)> {
    let (mut blocks, mut lines) = (Vec::new(), page.lines());
    while let Some(line) = lines.next() {
        if let Some(language) = line.strip_prefix("```") {
            let text = lines.by_ref().take_while(|line| *line != "```").map(|line| line.to_owned() + "\n");
            blocks.push((language.to_owned(), text.collect()));
        }
    }
    blocks
}
