//! Pages of `mechc explain` on topics beyond single words: an explanation, an example, and references.

/// A page with its names.
struct Topic {
    names: &'static [&'static str],
    page: &'static str,
}

const PAGES: [Topic; 11] = [
    Topic { names: &["parts"], page: include_str!("topics/parts.md") },
    Topic { names: &["inputs"], page: include_str!("topics/inputs.md") },
    Topic { names: &["samples"], page: include_str!("topics/samples.md") },
    Topic { names: &["files"], page: include_str!("topics/files.md") },
    Topic { names: &["repetition", "range", "ranges"], page: include_str!("topics/repetition.md") },
    Topic {
        names: &["forces", "loads", "masses", "springs", "reactions", "friction", "dampers"],
        page: include_str!("topics/forces.md"),
    },
    Topic { names: &["by"], page: include_str!("topics/by.md") },
    Topic { names: &["names"], page: include_str!("topics/names.md") },
    Topic { names: &["sweep", "sweeps", "variants"], page: include_str!("topics/sweep.md") },
    Topic { names: &["tolerance", "tolerances"], page: include_str!("topics/tolerance.md") },
    Topic { names: &["view", "vary", "pictures", "vectors"], page: include_str!("topics/view.md") },
];

/// Returns the topics, each by its first name.
pub fn topics() -> impl Iterator<Item = &'static str> {
    PAGES.iter().filter_map(|topic| topic.names.first().copied())
}

/// Returns the page of a name.
#[must_use]
pub fn topic(name: &str) -> Option<&'static str> {
    PAGES.iter().find(|topic| topic.names.contains(&name)).map(|topic| topic.page)
}
