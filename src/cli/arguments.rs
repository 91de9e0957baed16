//! What can be typed.

use crate::stages::Vectors;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

const AFTER_HELP: &str = "\
Examples:
  mechc check examples/slider_crank.mech
  mechc run examples/slider_crank.mech -o slider_crank.csv
  mechc run examples/slider_crank.mech --set rod_length=200mm --every 0.5ms
  mechc formula '(1.5 * sin(t) + 3 * t^2)^2' --at 0 --at 1.5
  mechc explain E0203

Exit codes:
  0  done (warnings may have been printed)
  1  the input has errors
  2  wrong usage
  3  the analysis could not be completed; the rows up to there are written
  4  a file could not be read or written
  130  interrupted";

/// A compiler for .mech files: planar mechanisms of bodies, joints and drivers.
///
/// It shows that a mechanism is determined, and computes its motion: position, velocity and acceleration.
#[derive(Parser, Debug)]
#[command(name = "mechc", version, after_help = AFTER_HELP, arg_required_else_help = true, args_conflicts_with_subcommands = true)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Print the licences of what this program carries
    #[arg(long, display_order = 100)]
    licenses: bool,
}

#[derive(Subcommand, Debug)]
pub(super) enum Command {
    /// Is it a determined mechanism? Says what was found
    #[command(
        long_about = "Is it a determined mechanism?\n\n\
        Checks the file, counts coordinates and equations, assembles the mechanism at its first time, and prints what \
        was found: bodies, joints, drivers, the NDOF table, and how far the estimates were off.\n\n\
        With --fix, mistakes that leave no doubt of what was meant (`**` for `^`, a parenthesis that is not closed) are \
        mended in the file first, and what is left is told. Standard input goes to standard output, mended, and the report \
        to standard error.",
        after_help = "Examples:\n  mechc check linkage.mech\n  mechc check linkage.mech --fix\n  \
        mechc check - --fix < draft.mech > linkage.mech"
    )]
    Check(CheckArguments),
    /// Lays files out in the one style that `examples/` show
    #[command(
        long_about = "Lays files out in the one style that `examples/` show.\n\n\
        A declaration a line, indented by four spaces; `=`, and what stands behind `:`, in columns where declarations of one kind \
        follow each other; formulas that are too long for a line of 100 columns broken behind an operator. A body that was written on \
        one line stays there if it fits. Comments stay where they stand, blank lines too, but never two. Only spaces, line ends and the \
        comma behind the last item of a list change, so the mechanism stays what it was; parentheses stay as well.\n\n\
        A folder means all .mech files in it and in its folders; hidden ones, `target`, `node_modules` and links are passed over. A file with syntax errors \
        stays as it is, with the errors, and the others are formatted. Files are replaced whole or not at all, and those that are \
        formatted already are not written. Line ends are those of the file's first line; a byte-order mark stays.\n\n\
        With --check nothing is written: what would change is printed as a diff, which `patch` takes, and the exit code is 1.",
        after_help = "Examples:\n  mechc fmt linkage.mech\n  mechc fmt .\n  mechc fmt --check examples tests\n  \
        mechc fmt - < draft.mech > linkage.mech"
    )]
    Fmt(FmtArguments),
    /// The kinematic analysis, as a table
    #[command(
        long_about = "The kinematic analysis, as a table.\n\n\
        Prints a row per output time with, for each body, x, y and phi, then the measures; all of them again with .d \
        (first time derivative) and .dd (second). Units are SI. The times are those of the file's `analysis` \
        unless given here.",
        after_help = "Examples:\n  mechc run linkage.mech\n  mechc run linkage.mech --from 0 --to 2 --every 10ms -o out.csv\n  \
        mechc run linkage.mech --at 0.25 --at '1/3' --format json\n  mechc run linkage.mech --set crank_length=60mm"
    )]
    Run(RunArguments),
    /// Many variants of the mechanism: a row of results for each, or the motion of all
    #[command(
        long_about = "Many variants of the mechanism: a row of results for each, or the motion of all.\n\n\
        --vary says which params vary. `NAME=A..B:N` are N values from A to B, both included (a range of repetition leaves its end out); \
        N = 1 is A, and B may be less than A. `NAME=A,B,C` is a list, `@FILE.csv` a table of variants with a column for each param, units in \
        brackets (`rod [mm],speed [rpm]`). Several of them are combined, each value with each other, the last fastest. `NAME=A..B` without \
        a number of values, with --sample N, are N points within all such ranges, by Sobol's sequence or at random. A point of a drawing \
        varies as `A.x`. A param that decides what is repeated is set, and the others are led; what a variant has no column or result of is empty.\n\n\
        Without more, the table has a row for each variant: its number, its params and results in SI, its `status`, and when it stopped. \
        --result adds results to those of the file. With --rows it has the whole motion of each variant instead: its number, its params, and the columns \
        of `mechc run`, of which --columns chooses.\n\n\
        A variant is assembled with the file's own values, and led over to its params along the branch, as `mechc run --lead --set` does it: the \
        numbers are the same, to the bit, whatever the number of threads. `status` is `ok`; `reassembled` where no way leads there, and the numbers \
        are those of `mechc run --set`; or the code that stopped it, whose page `mechc explain` has. At the end each is counted, with the first of \
        them as a command.\n\n\
        Ctrl-C ends it with whole variants, and tells how to go on. Shares that `--skip K --take N` makes are, put together, the whole. The exit code \
        is 0 if any variant ran to its end, else 3. `mechc explain sweep` has more.",
        after_help = "Examples:\n  mechc sweep linkage.mech --vary rod=100mm..200mm:50 --result 'stroke = max(x(tip)) - min(x(tip))'\n  \
        mechc sweep linkage.mech --vary rod=100mm..200mm:11 --vary speed=60rpm,90rpm -o variants.csv\n  \
        mechc sweep linkage.mech --vary rod=100mm..200mm --vary A.x=0..20mm --sample 100000 -o variants.parquet\n  \
        mechc sweep linkage.mech --vary @variants.csv --rows --columns 'tip.*' -o motion.parquet\n  \
        mechc sweep linkage.mech --vary rod=100mm..200mm:1000 --until 'stroke > 80 mm'"
    )]
    Sweep(SweepArguments),
    /// What small errors of params make of measures and results
    #[command(
        long_about = "What small errors of params make of measures and results.\n\n\
        --tol says how far a param may be off. Of each measure, at the time at which all of them together bring it off the most, and of each \
        result, a table shows what each param contributes, from exact derivatives; its share of the variance; the worst case, all errors at \
        their worst; and the statistical one, the root of the sum of their squares, with the standard deviation σ.\n\n\
        A param with a formula of its own is a dimension of its own where it has a tolerance; else it goes with what it is made of. A result has no \
        derivative, and says so, where two times share its extremum, or where that is at a kink or jump that goes with the param. Derivatives are \
        not all: --verify runs the corners. `mechc explain tolerance` has more.",
        after_help = "Examples:\n  mechc tolerance linkage.mech --tol rod=0.05mm --tol A.x=0.02mm\n  \
        mechc tolerance linkage.mech --tol rod=-0.1mm..0mm --tol crank=0.05mm --normal --verify\n  \
        mechc tolerance linkage.mech --tol rod=0.05mm --result 'stroke = max(x(tip)) - min(x(tip))' -o contributions.csv"
    )]
    Tolerance(ToleranceArguments),
    /// The mechanism as a live page, or as a picture, still or moving
    #[command(
        long_about = "The mechanism as a live page, or as a picture, still or moving.\n\n\
        Without -o, a page is served at an address of this machine, which is printed: nobody who has not its last part is answered. The page \
        follows the file, and those that it uses. While the text is wrong the last picture stays, with the messages. Every param has a \
        slider, which leads the mechanism along its branch, as `mechc run --lead --set` does. An input's slider moves it by hand while time \
        stands still, up to a dead point. A crank can be turned in the picture, and a point that a param is moved. What was found goes \
        back into the file if that is asked for. Ctrl-C ends it.\n\n\
        Bodies are drawn as links, joints and drivers as symbols in the manner of ISO 3952, wheels with teeth that mesh; symbols are as \
        large as the extent of the whole motion asks for. Traces of the file are drawn, and those of `--trace`.\n\n\
        Without --at, OUT.svg moves, over and over, without a script: as a picture of a README or a slide. One run takes 6 s; a motion \
        that does not end as it begins goes to and fro. With --at, it shows the mechanism at that time; with several, all of them, the \
        last one strong and the others pale.\n\n\
        A file called plots.svg, or NAME.plots.svg, holds plots of all measures over time, in the units of the file; --plots does so under \
        any name. A number in the name, as in frames/%04d.svg, asks for a picture of each row, counted from 0, for a film; their folder is \
        made. OUT.dxf holds traces, the lines of cams, the outlines of gears as polylines within 1 µm, and the places of pins, in \
        millimetres, a layer for each declaration: for cutting. --scale draws true to scale, --body one body alone. OUT.html is a page \
        that needs nothing else: the mechanism moves as its reader likes, beside plots of any column, vectors, results and the text.\n\n\
        --vary gives that page a slider for a param, or for two. The mechanism is solved for each value beforehand, and the page holds \
        all of it: how much that is, is told in kB, and of more than 20 MB rows are left out. The slider begins at the file's own value, \
        or at the nearest. Where the mechanism cannot be assembled with a value, or stops, the page says so for that value.\n\n\
        The motion is that of the file's `analysis`, or of --from, --to and --every; with --at alone where there is neither. Where it \
        cannot go on, the picture shows it up to there, with what the message names in red.\n\n\
        What is broken is drawn too, while messages and exit codes are those of `run`. A mechanism that is not determined is shown as its \
        text draws it: what is left free as dashed arrows, redundant joints in rings. One that cannot be assembled is shown with \
        everything closed but the joint that stays open, and a dashed line between the two halves of that; lengths that are too short or too \
        long are red. `mechc explain view` has the page of all this.",
        after_help = "Examples:\n  mechc view linkage.mech\n  mechc view linkage.mech --open\n  mechc view linkage.mech -o linkage.svg\n  mechc view linkage.mech -o start.svg --at 0 --labels\n  \
        mechc view linkage.mech -o strobe.svg --at 0 --at 0.1 --at 0.2 --trace coupler.pen\n  \
        mechc view linkage.mech -o slide.svg --at 0.25 --vectors --size 1280x720 --theme light\n  \
        mechc view linkage.mech -o plots.svg\n  mechc view linkage.mech -o frames/%04d.svg --every 40ms\n  \
        mechc view linkage.mech -o crank.svg --body crank --scale 1:2\n  mechc view camshaft.mech -o cam.dxf --body cam\n  \
        mechc view linkage.mech -o longer.svg --set crank_length=60mm --to 4 --every 10ms\n  \
        mechc view linkage.mech -o rods.html --vary rod_length=120mm..180mm:13"
    )]
    View(ViewArguments),
    /// Φ, Φ_q, ν and γ as Rust, as LaTeX for a report, or as JSON
    #[command(
        long_about = "Φ, Φ_q, ν and γ as Rust, as LaTeX for a report, or as JSON.\n\n\
        As Rust, writes one module without dependencies (but the crate `libm` where a formula asks for it), whose functions \
        give the same bits as the analysis; with --crate, a crate of its own around it, which passes `cargo test` as it is. As LaTeX, a document with every element's equations, to be typeset with pdflatex. As \
        JSON, the whole constraint system for other programs, as `docs/emit-json.md` says.",
        after_help = "Examples:\n  mechc emit linkage.mech -o linkage.rs\n  mechc emit linkage.mech --crate linkage\n  mechc emit linkage.mech -o linkage.tex\n  \
        mechc emit linkage.mech --format json"
    )]
    Emit(EmitArguments),
    /// What the compiler sees, readable: the tree, the model or the equations
    #[command(long_about = "What the compiler sees, readable.\n\n\
        The tree is the file as it would be written; the model has its names resolved and its values in SI; the IR has \
        every coordinate, every row of Φ with the declaration that wrote it, the entries of Φ_q, ν and γ.")]
    Dump(DumpArguments),
    /// A formula of time and its first two derivatives, as text and as numbers
    #[command(
        long_about = "A formula of time and its first two derivatives, as text and as numbers.\n\n\
        Prints the formula C simplified, its time derivatives C' and C'', and their values at the times asked for. \
        Inside, all is SI: `50 mm` becomes 0.05, an angle is in radians. A formula with units of length, time or rate \
        says its dimension.",
        after_help = "Examples:\n  mechc formula '(1.5 * sin(t) + 3 * t^2)^2' --at 0 --at 1.5\n  \
        mechc formula '20 mm * sin(60 rpm * t)' --at '250 ms'\n  \
        mechc formula 'if t < 1 then t^2 else 2 * t - 1'"
    )]
    Formula(FormulaArguments),
    /// A model file of the course's planar engine (ADM), as .mech
    #[command(
        long_about = "A model file of the course's planar engine (ADM), as .mech.\n\n\
        Bodies and constraints keep their names where these can be names. Formulas are translated from MATLAB's notation; \
        a constraint whose formula holds t becomes a driver. What has no place in a kinematic model (forces, masses, \
        drawing data) is named in a note. The settings file (ACF) gives the times of the analysis; without one, `run` needs \
        --from, --to and --every.",
        after_help = "Examples:\n  mechc import pendulum.adm -o pendulum.mech\n  \
        mechc import pendulum.adm --acf kinematics.acf -o pendulum.mech\n  \
        mechc import pendulum.adm | mechc run - --from 0 --to 5 --every 10ms"
    )]
    Import(ImportArguments),
    /// The page of a diagnostic's code, of a word of the language, or of a subject such as `parts`
    #[command(
        long_about = "The page of a diagnostic's code, or of a word of the language.\n\n\
        Every message of mechc begins with a code, as in error[E0203]. Its page says what the code means, shows a small file \
        that raises it, says why that is so, and shows the same file mended. Without a code, all codes are listed.\n\n\
        The page of a word says how it is written, what it means (a joint's equations, a unit's value in SI), shows a mechanism \
        with it, and says what others call it. `functions`, `motions`, `quantities`, `reductions`, `joints`, `units`, `keywords` and \
        `constants` list them; `parts`, `inputs`, `samples`, `files`, `repetition`, `by`, `names` and `view` are pages on more \
        than a word.",
        after_help = "Examples:\n  mechc explain E0203\n  mechc explain step5\n  mechc explain joints | less\n  mechc explain"
    )]
    Explain(ExplainArguments),
    /// The language server, which an editor starts
    #[cfg(feature = "lsp")]
    #[command(long_about = "The language server, which an editor starts.\n\n\
        It speaks the language server protocol over standard input and output: diagnostics while you type, the degrees of freedom, \
        what a name or word is, what fits, new names, mends, formatting. Nobody types this command: an editor's extension or configuration names it.")]
    Lsp(LspArguments),
}

/// Of the language server.
#[cfg(feature = "lsp")]
#[derive(Args, Debug)]
pub(super) struct LspArguments {
    /// Write every message with its time, and what the server did, into FILE
    #[arg(long, value_name = "FILE")]
    pub log: Option<PathBuf>,

    /// What many clients add; it speaks over standard input and output anyway
    #[arg(long, hide = true)]
    pub stdio: bool,
}

/// What all commands that read a .mech file share.
#[derive(Args, Debug)]
pub(super) struct Input {
    /// The .mech file; `-` is standard input
    #[arg(value_name = "FILE")]
    pub file: String,

    /// Which mechanism, where the file holds several
    #[arg(long, value_name = "NAME")]
    pub mechanism: Option<String>,

    /// Set a parameter, with its unit: `--set crank_length=60mm`; a point as `--set 'A=(12mm,0)'` or `--set A.x=12mm`. Repeatable; the last
    /// of one name counts
    #[arg(long, value_name = "NAME=EXPR", allow_hyphen_values = true)]
    pub set: Vec<String>,

    /// What an input of the mechanism is, as a formula of `t`: `--input turn='30 deg + 2 rad/s * t'`. Repeatable, once for each
    #[arg(long = "input", value_name = "NAME=FORMULA", allow_hyphen_values = true)]
    pub signals: Vec<String>,

    /// Samples of inputs: a CSV file with a column `t` and one for each input, units in brackets (`turn [deg]`), joined by natural
    /// cubic splines; `-` is standard input
    #[arg(long, value_name = "FILE.csv")]
    pub samples: Option<PathBuf>,

    #[command(flatten)]
    pub messages: Messages,
}

/// How a command speaks to its user.
#[derive(Args, Debug, Default)]
pub(super) struct Messages {
    /// How diagnostics are written
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub message_format: MessageFormat,

    /// Whether diagnostics are coloured
    #[arg(long, value_enum, default_value_t, value_name = "WHEN")]
    pub color: When,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) enum MessageFormat {
    /// With the lines they speak of
    #[default]
    Human,
    /// One line each
    Short,
    /// One JSON object a line
    Json,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) enum When {
    /// On a terminal, unless `NO_COLOR` is set
    #[default]
    Auto,
    Always,
    Never,
}

#[derive(Args, Debug)]
pub(super) struct CheckArguments {
    #[command(flatten)]
    pub input: Input,

    /// Leave redundant equations out
    #[arg(long)]
    pub allow_redundant: bool,

    /// Write what the text can only have meant into FILE, say what was changed, and check that
    #[arg(long)]
    pub fix: bool,
}

#[derive(Args, Debug)]
pub(super) struct FmtArguments {
    /// The .mech files, or folders of them; `-` is standard input, which goes to standard output
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<String>,

    /// Write nothing; print what would change, and exit with 1 if anything would
    #[arg(long)]
    pub check: bool,

    #[command(flatten)]
    pub messages: Messages,
}

#[derive(Args, Debug)]
pub(super) struct EmitArguments {
    #[command(flatten)]
    pub input: Input,

    /// Where the code goes; `-` is standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: String,

    /// Write a whole crate into this folder, named like it: the module, a page, a test against `mechc run`, a benchmark
    #[arg(long = "crate", value_name = "DIR", conflicts_with = "output")]
    pub folder: Option<String>,

    /// With --crate: a C header and the functions behind it too, for firmware and programs in C or C++
    #[arg(long)]
    pub ffi: bool,

    /// What to write; by the ending of OUT (.tex, .json) if not given, else rust
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub format: Option<EmitFormat>,

    /// What Rust code can do
    #[arg(long, value_enum, value_name = "WHAT", default_value = "solver")]
    pub with: Content,

    /// Leave redundant equations out; the emitted code checks them at every time
    #[arg(long)]
    pub allow_redundant: bool,

    /// Solve for N variants or times at once too, in vector instructions where the target has them
    #[arg(long, value_name = "N", value_parser = lanes)]
    pub lanes: Option<usize>,
}

/// More lanes than this do not stay near the processor.
const MOST_LANES: usize = 256;

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum EmitFormat {
    /// A module without dependencies, for firmware and simulators
    Rust,
    /// A document that typesets Φ, Φ_q, ν and γ, element by element
    Latex,
    /// The whole constraint system as data, formulas as text
    Json,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Content {
    /// Assemble the mechanism and follow its motion, as `mechc run` does
    Solver,
    /// The same, and the derivatives of the coordinates by each parameter
    Sensitivities,
    /// Evaluate its equations only
    Equations,
}

#[derive(Args, Debug)]
pub(super) struct DumpArguments {
    #[command(flatten)]
    pub input: Input,

    /// What to show
    #[arg(long, value_enum, value_name = "STAGE")]
    pub stage: Stage,

    /// Where the text goes; `-` is standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: String,
}

#[derive(Args, Debug)]
pub(super) struct ImportArguments {
    /// The model file; `-` is standard input
    #[arg(value_name = "MODEL.adm")]
    pub model: String,

    /// The settings file with the times of the analysis; `-` is standard input
    #[arg(long, value_name = "FILE")]
    pub acf: Option<String>,

    #[command(flatten)]
    pub messages: Messages,

    /// Where the text goes; `-` is standard output
    #[arg(short, long, value_name = "OUT.mech", default_value = "-")]
    pub output: String,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Stage {
    /// The syntax tree, as it would be written
    Ast,
    /// The checked mechanism
    Model,
    /// The constraint system
    Ir,
}

/// When an analysis begins and ends, over what the file says.
#[derive(Args, Clone, Debug, Default)]
pub(super) struct Interval {
    /// First time, in seconds or with a unit
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub from: Option<String>,

    /// Last time
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub to: Option<String>,

    /// Step from one output time to the next
    #[arg(long, value_name = "H", allow_hyphen_values = true)]
    pub every: Option<String>,
}

#[derive(Args, Debug)]
#[allow(clippy::struct_excessive_bools)] // each is an option of its own
pub(super) struct RunArguments {
    #[command(flatten)]
    pub input: Input,

    /// Where the table goes; `-` is standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: String,

    /// The form of the table; by the ending of OUT if not given, else csv
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub format: Option<Format>,

    /// Where the results go, as a JSON object of names and numbers in SI
    #[arg(long, value_name = "OUT.json")]
    pub results: Option<String>,

    #[command(flatten)]
    pub interval: Interval,

    /// Only this time, followed from the start of the analysis. Repeatable
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub at: Vec<String>,

    /// Only columns of this name, where `*` stands for anything and `?` for one character: `--columns 'rod.*'`; `t` stays. Repeatable
    #[arg(long, value_name = "PATTERN")]
    pub columns: Vec<String>,

    /// A result beside those of the file: `--result 'stroke = max(x(P)) - min(x(P))'`. Repeatable
    #[arg(long, value_name = "NAME=FORMULA")]
    pub result: Vec<String>,

    /// Differentiate every column by an input or parameter too: `--by turn` adds `crank.phi.by.turn` and so on. Repeatable
    #[arg(long, value_name = "NAME")]
    pub by: Vec<String>,

    /// Tabulate what every joint exerts and every driver and constraint supplies: `NAME.fx`, `NAME.fy`, `NAME.torque`, `NAME.effort`
    #[arg(long)]
    pub reactions: bool,

    /// Assemble with the file's own values, and go over to those of `--set` along the branch
    #[arg(long)]
    pub lead: bool,

    /// Bounds the residual of every equation, relative to the mechanism's size
    #[arg(long, value_name = "X", default_value = "1e-12", value_parser = positive)]
    pub tolerance: f64,

    /// Leave redundant equations out, and check them at every time
    #[arg(long)]
    pub allow_redundant: bool,

    /// Go on beyond a bifurcation, along the branch that continues smoothly
    #[arg(long)]
    pub pass_bifurcations: bool,

    /// The vector instructions that rows are solved for with; the widest that the processor has if not given. For tests: the numbers are
    /// the same
    #[arg(long, hide = true, value_name = "NAME", value_parser = vectors)]
    pub vectors: Option<Vectors>,

    /// Print to standard error where the time went
    #[arg(long)]
    pub timings: bool,
}

#[derive(Args, Debug)]
#[allow(clippy::struct_excessive_bools)] // each is an option of its own
pub(super) struct SweepArguments {
    #[command(flatten)]
    pub input: Input,

    /// What varies: `rod=100mm..200mm:50` (50 values, both ends included), `speed=60rpm,90rpm`, `@variants.csv`, or `rod=100mm..200mm` with
    /// --sample. Repeatable; all are combined
    #[arg(long, value_name = "NAME=A..B:N", required = true, allow_hyphen_values = true)]
    pub vary: Vec<String>,

    /// So many points within the ranges that have no number of values
    #[arg(long, value_name = "N")]
    pub sample: Option<u64>,

    /// How the points of a sample are spread; sobol if not given
    #[arg(long, value_enum, value_name = "METHOD")]
    pub method: Option<MethodChoice>,

    /// Which of the samples of its kind it is
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,

    /// Where the table goes; `-` is standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: String,

    /// The form of the table; by the ending of OUT if not given, else csv
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub format: Option<SheetFormat>,

    /// A result beside those of the file: `--result 'stroke = max(x(P)) - min(x(P))'`. Repeatable
    #[arg(long, value_name = "NAME=FORMULA")]
    pub result: Vec<String>,

    /// The whole motion of every variant, rather than its results
    #[arg(long)]
    pub rows: bool,

    /// With --rows: only columns of this name, where `*` stands for anything and `?` for one character; `t` stays. Repeatable
    #[arg(long, value_name = "PATTERN", requires = "rows")]
    pub columns: Vec<String>,

    /// Stop at the first variant with this, a condition over results and params: `--until 'stroke > 80 mm'`
    #[arg(long, value_name = "CONDITION")]
    pub until: Option<String>,

    #[command(flatten)]
    pub interval: Interval,

    /// With --rows: only this time, followed from the start of the analysis. Repeatable
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub at: Vec<String>,

    /// With --rows: differentiate every column by an input or parameter too. Repeatable
    #[arg(long, value_name = "NAME", requires = "rows")]
    pub by: Vec<String>,

    /// With --rows: tabulate what every joint exerts and every driver and constraint supplies
    #[arg(long, requires = "rows")]
    pub reactions: bool,

    /// Pass over the first K variants
    #[arg(long, value_name = "K", default_value = "0", hide_default_value = true)]
    pub skip: u64,

    /// N variants at the most
    #[arg(long, value_name = "N")]
    pub take: Option<u64>,

    /// So many threads; as many as the machine does at once if not given
    #[arg(long, value_name = "N", value_parser = jobs)]
    pub jobs: Option<usize>,

    /// More than 10⁹ variants are meant
    #[arg(long)]
    pub yes: bool,

    #[command(flatten)]
    pub following: Following,

    /// As `run` has it. For tests: the numbers are the same
    #[arg(long, hide = true, value_name = "NAME", value_parser = vectors)]
    pub vectors: Option<Vectors>,
}

/// How variants are followed.
#[derive(Args, Clone, Debug)]
pub(super) struct Following {
    /// Bounds the residual of every equation, relative to the mechanism's size
    #[arg(long, value_name = "X", default_value = "1e-12", value_parser = positive)]
    pub tolerance: f64,

    /// Leave redundant equations out, and check them at every time
    #[arg(long)]
    pub allow_redundant: bool,

    /// Go on beyond a bifurcation, along the branch that continues smoothly
    #[arg(long)]
    pub pass_bifurcations: bool,
}

#[derive(Args, Debug)]
pub(super) struct ToleranceArguments {
    #[command(flatten)]
    pub input: Input,

    /// How far a param may be off: `rod=0.05mm` for ±0.05 mm, `rod=-0.1mm..0mm` for what it may be below and above; `A.x=0.02mm` for a
    /// coordinate of a point. Repeatable
    #[arg(long, value_name = "NAME=AMOUNT", required = true, allow_hyphen_values = true)]
    pub tol: Vec<String>,

    /// Params are spread normally, and what they may be off is 3 σ; if not given, they are anywhere within alike
    #[arg(long)]
    pub normal: bool,

    /// Run the corners too, and say where derivatives are not enough: all corners of up to 12 params, of more the worst ones and 10,000 samples
    #[arg(long)]
    pub verify: bool,

    /// A result beside those of the file: `--result 'stroke = max(x(P)) - min(x(P))'`. Repeatable
    #[arg(long, value_name = "NAME=FORMULA")]
    pub result: Vec<String>,

    /// Where the table goes; `-` is standard output
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    pub output: String,

    /// The form of the table; by the ending of OUT if not given, else table
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub format: Option<ContributionFormat>,

    #[command(flatten)]
    pub interval: Interval,

    /// With --verify: so many threads; as many as the machine does at once if not given
    #[arg(long, value_name = "N", value_parser = jobs, requires = "verify")]
    pub jobs: Option<usize>,

    #[command(flatten)]
    pub following: Following,
}

/// The form of a table of contributions.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum ContributionFormat {
    /// To be read
    Table,
    /// A header, then a line for each contribution and each sum, all numbers in SI
    Csv,
    /// One object, all numbers in SI
    Json,
}

/// The form of a table of variants.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum SheetFormat {
    /// A header, then a line per row
    Csv,
    /// An object a line: {"variant": 0, …}
    Json,
    /// Apache Parquet
    Parquet,
}

/// How a sample is spread.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum MethodChoice {
    /// Evenly, by Sobol's sequence: any first part of it fills the ranges
    Sobol,
    /// Each point for itself
    Random,
}

/// More threads than this are no help on any machine.
const MOST_JOBS: usize = 1024;

fn jobs(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(jobs) if (1..=MOST_JOBS).contains(&jobs) => Ok(jobs),
        _ => Err(format!("a whole number from 1 to {MOST_JOBS} is wanted")),
    }
}

#[derive(Args, Debug)]
#[allow(clippy::struct_excessive_bools)] // each is an option of its own
pub(super) struct ViewArguments {
    #[command(flatten)]
    pub input: Input,

    /// Where the picture goes; without it a page is served that follows the file. Its ending says what is drawn (.svg, .html, .dxf), `%04d` in its name a film's pictures, `plots.svg` plots
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<String>,

    /// Open the page that follows the file in the browser
    #[arg(long, conflicts_with = "output")]
    pub open: bool,

    /// The port of the page that follows the file; one that is free if not given
    #[arg(long, value_name = "PORT", conflicts_with = "output")]
    pub port: Option<u16>,

    /// A slider on the page for a parameter: N values from A to B, each solved beforehand: `--vary rod_length=120mm..180mm:13`. Twice
    /// at most
    #[arg(long, value_name = "NAME=A..B:N", allow_hyphen_values = true)]
    pub vary: Vec<String>,

    /// Plots of all measures over time, whatever OUT.svg is called
    #[arg(long, conflicts_with_all = ["at", "trace", "vectors", "labels", "scale", "body"])]
    pub plots: bool,

    /// The mechanism at this time, in seconds or with a unit. Repeatable
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub at: Vec<String>,

    #[command(flatten)]
    pub interval: Interval,

    /// The path of a point too: `--trace coupler.pen`. Repeatable
    #[arg(long, value_name = "P")]
    pub trace: Vec<String>,

    /// Velocities and accelerations at pins and traced points, as arrows
    #[arg(long)]
    pub vectors: bool,

    /// What joints exert, loads and weights, as arrows to one scale; with `--plots` plots of these, and of what drivers supply
    #[arg(long)]
    pub forces: bool,

    /// The names of bodies and pins
    #[arg(long)]
    pub labels: bool,

    /// Width and height in pixels: `--size 1280x720`; 800 wide at most, and as high as it takes, if not given
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[f64; 2]>,

    /// True to scale, in millimetres of paper: `--scale 1:2` is half as large as the mechanism
    #[arg(long, value_name = "A:B", value_parser = scale, conflicts_with = "size")]
    pub scale: Option<f64>,

    /// One body alone, in its own frame, with all that is fixed to it
    #[arg(long, value_name = "NAME", conflicts_with_all = ["at", "trace", "vectors", "forces"])]
    pub body: Option<String>,

    /// Which colours
    #[arg(long, value_enum, default_value_t, value_name = "THEME")]
    pub theme: ThemeChoice,

    /// Leave redundant equations out, and check them at every time
    #[arg(long)]
    pub allow_redundant: bool,

    /// Go on beyond a bifurcation, along the branch that continues smoothly
    #[arg(long)]
    pub pass_bifurcations: bool,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) enum ThemeChoice {
    /// As the reader's machine is set
    #[default]
    Auto,
    /// Dark on light
    Light,
    /// Light on dark
    Dark,
}

/// Pictures are no smaller and no larger than this (px).
const SIDES: [f64; 2] = [16.0, 16_384.0];

/// Scales are no smaller and no larger than this.
const SCALES: [f64; 2] = [1e-6, 1e6];

fn scale(text: &str) -> Result<f64, String> {
    let parts = text.split_once(':').map(|(on_paper, real)| [on_paper, real].map(|part| part.trim().parse::<f64>()));
    match parts {
        Some([Ok(on_paper), Ok(real)]) if (SCALES[0]..=SCALES[1]).contains(&(on_paper / real)) => Ok(on_paper / real),
        _ => Err("what a length is on paper and what it is are wanted, as in `1:2` or `10:1`".to_owned()),
    }
}

fn size(text: &str) -> Result<[f64; 2], String> {
    let sides =
        text.split_once(['x', '×']).map(|(width, height)| [width, height].map(|side| side.trim().parse::<f64>()));
    match sides {
        Some([Ok(width), Ok(height)]) if [width, height].iter().all(|side| (SIDES[0]..=SIDES[1]).contains(side)) => {
            Ok([width, height])
        }
        _ => Err(format!("width and height in pixels are wanted, from {} to {}, as in `1280x720`", SIDES[0], SIDES[1])),
    }
}

#[derive(Args, Debug)]
pub(super) struct FormulaArguments {
    /// A formula of the time `t`, as a driver takes it; it may hold units and functions of the language
    #[arg(value_name = "EXPR", allow_hyphen_values = true)]
    pub formula: String,

    /// A time to evaluate it at, in seconds or with a unit. Repeatable; sorted, and each printed once
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub at: Vec<String>,

    #[command(flatten)]
    pub messages: Messages,
}

#[derive(Args, Debug)]
pub(super) struct ExplainArguments {
    /// The code, in capitals or not, or the word; without it all codes are listed
    #[arg(value_name = "CODE|NAME")]
    pub name: Option<String>,

    #[command(flatten)]
    pub messages: Messages,
}

#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Format {
    /// A header, then a row per time
    Csv,
    /// {"columns": […], "rows": [[…], …]}
    Json,
    /// Apache Parquet: columns of 64-bit numbers
    Parquet,
}

fn lanes(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(lanes) if (1..=MOST_LANES).contains(&lanes) => Ok(lanes),
        _ => Err(format!("a whole number from 1 to {MOST_LANES} is wanted")),
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("a positive number is wanted".to_owned()),
    }
}

fn vectors(name: &str) -> Result<Vectors, String> {
    let names = Vectors::NAMES.join("`, `");
    Vectors::named(name).ok_or_else(|| format!("one of `{names}` is wanted that this processor has"))
}
