//! Names for C and C++.

/// Keywords of C and C++ in lower case, and names that some compilers define.
const KEYWORDS: &[&str] = &[
    "alignas",
    "alignof",
    "and",
    "and_eq",
    "asm",
    "auto",
    "bitand",
    "bitor",
    "bool",
    "break",
    "case",
    "catch",
    "char",
    "char16_t",
    "char32_t",
    "char8_t",
    "class",
    "co_await",
    "co_return",
    "co_yield",
    "compl",
    "concept",
    "const",
    "const_cast",
    "consteval",
    "constexpr",
    "constinit",
    "continue",
    "decltype",
    "default",
    "delete",
    "do",
    "double",
    "dynamic_cast",
    "else",
    "enum",
    "errno",
    "explicit",
    "export",
    "extern",
    "false",
    "far",
    "float",
    "for",
    "friend",
    "goto",
    "if",
    "inline",
    "int",
    "linux",
    "long",
    "mutable",
    "namespace",
    "near",
    "new",
    "noexcept",
    "not",
    "not_eq",
    "nullptr",
    "operator",
    "or",
    "or_eq",
    "private",
    "protected",
    "public",
    "register",
    "reinterpret_cast",
    "requires",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "static_assert",
    "static_cast",
    "struct",
    "switch",
    "template",
    "this",
    "thread_local",
    "throw",
    "true",
    "try",
    "typedef",
    "typeid",
    "typename",
    "typeof",
    "union",
    "unix",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "while",
    "xor",
    "xor_eq",
];

/// Returns the C name of a Rust field: reserved words of C and C++ get a `_`. A Rust name ends with `_` only if Rust reserves it, so names
/// stay distinct.
pub(super) fn field(name: &str) -> String {
    if KEYWORDS.contains(&name) { format!("{name}_") } else { name.to_owned() }
}

/// Formats text as a comment of C: `*/` and `/*` in it get a space, control characters become spaces.
pub(super) fn comment(text: &str) -> String {
    format!("/* {} */", text.replace("*/", "* /").replace("/*", "/ *").replace(char::is_control, " "))
}

#[cfg(test)]
mod tests {
    use super::{comment, field};

    #[test]
    fn c_names_match_the_crate() {
        assert_eq!(["reach", "int", "class", "fn_"].map(field), ["reach", "int_", "class_", "fn_"]);
    }

    #[test]
    fn nothing_ends_a_comment_too_early() {
        assert_eq!(comment("a */ b /* c\n*/*/"), "/* a * / b / * c * / * / */");
    }
}
