//! The options of a check.

use super::Library;
use mechc_syntax::ast::Expr;
use mechc_text::diag::Diagnostic;
use mechc_text::source::FileId;
use rustc_hash::FxHashMap;

/// The options of a check, and the files that the text names.
#[derive(Clone, Debug, Default)]
pub struct CheckOptions {
    /// Overrides of parameters.
    pub settings: Vec<ParamOverride>,
    /// The mechanisms of all files that the text uses.
    pub library: Library,
    /// The texts of the files that tables name.
    pub files: TableFiles,
    /// Overrides of inputs.
    pub given: InputOverrides,
    /// For a part that is checked on its own: the values of its bound params (SI).
    pub bound: Vec<(String, f64)>,
    /// The paths of parameters that may change after the check. They become symbols even if their formulas depend on others, and the model
    /// lists them.
    pub open: Vec<String>,
    /// The names by which all columns are differentiated.
    pub by: Vec<String>,
    /// Present if results are differentiated by these names too: for the start and the end of the analysis, true if it is that of the text,
    /// which may depend on parameters.
    pub slopes: Option<[bool; 2]>,
    /// True if requirements are to be judged. Otherwise they are checked, and the model holds none.
    pub judges_requirements: bool,
}

/// The override of a parameter: `--set crank_length=60mm`.
#[derive(Clone, Debug)]
pub struct ParamOverride {
    /// The path of the parameter, or of a coordinate of a point. Without an index it names all copies.
    pub path: String,
    /// The formula, which names nothing of the file.
    pub value: Expr,
}

/// The overrides of inputs.
#[derive(Clone, Debug, Default)]
pub struct InputOverrides {
    /// The names of inputs with their formulas, over params, functions, tables and time.
    pub formulas: Vec<(String, Expr)>,
    /// A file of samples.
    pub samples: Option<FileId>,
}

impl InputOverrides {
    /// Returns whether there are no overrides.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.formulas.is_empty() && self.samples.is_none()
    }
}

/// The texts of the files that tables name, by the naming text and the path as written; or the reason why one cannot be read.
pub type TableFiles = FxHashMap<(FileId, String), Result<FileId, Box<Diagnostic>>>;
