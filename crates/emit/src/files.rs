//! Files of a crate, and how they can be told from those that somebody wrote.

/// A file of a crate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CrateFile {
    /// Where it goes in the crate, with `/`.
    pub path: String,
    /// What is in it; one of the first lines has [`MARK`].
    pub text: String,
}

/// What every file of a crate holds near its beginning, and by which it can be told from one that somebody wrote.
pub const MARK: &str = "ritten by mechc ";

/// What not every crate has, as folders and the endings of files in them: there an earlier one may have left its own.
pub const NOT_IN_ALL: [(&str, &str); 2] = [("include", ".h"), ("src", "unsafe_c.rs")];
