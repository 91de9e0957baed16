//! Compiles the generated parser.

fn main() {
    cc::Build::new()
        .std("c11")
        .include("src")
        .flag_if_supported("-Wno-unused")
        .file("src/parser.c")
        .compile("tree-sitter-mech");
    println!("cargo:rerun-if-changed=src/parser.c");
}
