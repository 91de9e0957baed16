//! The arguments of the command line: a file for each command with many options, and one for those with few.

mod emit;
mod run;
mod shared;
mod small;
mod sweep;
mod view;

use clap::{Parser, Subcommand};
pub(super) use emit::{Content, EmitArguments, EmitFormat};
pub(super) use run::{Format, RunArguments};
pub(super) use shared::{Following, Input, Interval, MessageFormat, Messages, When};
#[cfg(feature = "lsp")]
pub(super) use small::LspArguments;
pub(super) use small::{
    CheckArguments, DumpArguments, ExplainArguments, FmtArguments, FormulaArguments, ImportArguments, Stage,
};
pub(super) use sweep::{ContributionFormat, MethodChoice, SheetFormat, SweepArguments, ToleranceArguments};
pub(super) use view::{ThemeChoice, ViewArguments};

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
        made. OUT.dxf holds traces, the lines of cams and the pitch circles of gears as polylines within 1 µm, and the places of pins, in \
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
