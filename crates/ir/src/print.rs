//! The constraint system as readable text, for `Display` and messages.

use super::{ConditionKind, ConstraintSystem, DeclarationKind, MonitorKind, ReductionKind};
use mechc_expr::{ExprId, Printer, Symbol, number};

impl ConstraintSystem {
    /// Returns the name of a symbol as in result tables: `crank.phi`, `crank.phi.d`.
    #[must_use]
    pub fn symbol_name(&self, symbol: Symbol) -> String {
        match symbol {
            Symbol::Param(k) => self.params[k as usize].name.clone(),
            Symbol::Time => "t".to_owned(),
            Symbol::Signal { index, order } => {
                let name = self.inputs.get(self.signal_position(index)).map_or("t", |input| &input.name);
                if order == 0 { name.to_owned() } else { format!("{name}.{}", "d".repeat(order as usize)) }
            }
            Symbol::Coordinate { index, order } => {
                let name = &self.coordinates[index as usize].name;
                if order == 0 { name.clone() } else { format!("{name}.{}", "d".repeat(order as usize)) }
            }
            Symbol::Named(k) => format!("reduction_{}", k + 1),
            // a shift is zero and only serves to be varied
            Symbol::Shift(_) => "0".to_owned(),
            Symbol::Varied { index, order, variation } => {
                let of = self.symbol_name(Symbol::Coordinate { index, order });
                self.variation_name(&of, variation)
            }
            Symbol::Multiplier(row) => format!("lambda of {}", self.row_name(row as usize)),
            Symbol::VariedMultiplier { row, variation } => {
                self.variation_name(&self.symbol_name(Symbol::Multiplier(row)), variation)
            }
        }
    }

    /// Returns the name of a row by its declaration: `big`, or `big 2` if the declaration wrote several rows.
    #[must_use]
    pub fn row_name(&self, row: usize) -> String {
        let declaration = self.rows[row].declaration;
        let name = &self.declarations[declaration].name;
        if self.declarations[declaration].rows == 1 {
            return name.clone();
        }
        let before = self.rows[..row].iter().rev().take_while(|other| other.declaration == declaration).count();
        format!("{name} {}", before + 1)
    }

    /// Returns the rows of `Φ` that a joint, constraint or driver wrote, with their `ν` and `γ` and the shared subexpressions, one per line;
    /// `None` if no declaration of that name wrote a row.
    #[must_use]
    pub fn equations_of(&self, name: &str) -> Option<String> {
        let declaration = self.declarations.find(|declaration| declaration.name == name)?;
        let rows: Vec<usize> = (0..self.rows.len()).filter(|&row| self.rows[row].declaration == declaration).collect();
        let of = |list: &[ExprId]| rows.iter().map(|&row| list[row]).collect::<Vec<ExprId>>();
        let phi: Vec<ExprId> = rows.iter().map(|&row| self.rows[row].phi).collect();
        let columns = [("Φ", phi), ("ν", of(self.nu())), ("γ", of(self.gamma()))];
        let mut printer = Printer::new(&self.graph, |symbol| self.symbol_name(symbol));
        let roots: Vec<ExprId> = columns.iter().flat_map(|(_, list)| list.iter().copied()).collect();
        let prefix = self.prefix_of_shared();
        let shared = printer.name_shared(&roots, |k| format!("{prefix}{}", k + 1));
        let mut lines: Vec<String> = Vec::new();
        for (letter, list) in &columns {
            for (k, &id) in list.iter().enumerate() {
                let number = if list.len() > 1 { (k + 1).to_string() } else { String::new() };
                lines.push(format!("{letter}{number} = {}", printer.text(id)));
            }
        }
        lines.extend(shared.iter().map(|(name, id)| format!("{name} = {}", printer.definition(*id))));
        (!rows.is_empty()).then(|| lines.join("\n"))
    }
}

/// Prints the coordinates, the rows of `Φ` with their declarations, the entries of `Φ_q`, `ν`, `γ`, the measures and the results.
impl std::fmt::Display for ConstraintSystem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut printer = Printer::new(&self.graph, |symbol| self.symbol_name(symbol)).for_readers();
        let prefix = self.prefix_of_shared();
        let shared = printer.name_shared(&self.printed(), |k| format!("{prefix}{}", k + 1));
        let text = |id: ExprId| printer.text(id);
        let (n, m) = (self.coordinates.len(), self.rows.len());
        writeln!(f, "constraint system of {}: {n} coordinates, {m} equations", self.name)?;
        let params = self.params.iter().map(|p| (p.name.clone(), format!("= {}", number(p.value))));
        section(f, "parameters", params)?;
        section(f, "tables; a name with ' is the derivative by the argument", self.table_lines(&text))?;
        let parts = shared.iter().map(|(name, id)| (name.clone(), format!("= {}", printer.definition(*id))));
        section(f, "parts that stand in several places", parts)?;
        let coordinates = self
            .coordinates
            .iter()
            .map(|c| (c.name.clone(), format!("≈ {} {}", text(c.estimate), c.kind.unit()).trim_end().to_owned()));
        section(f, "coordinates q, with their estimates", coordinates)?;
        self.write_equations(f, &text)?;
        section(f, "measures", self.measure_lines(&text))?;
        section(f, "asked of the whole analysis", self.reduction_lines(&text))?;
        let outcomes = self.results.outcomes.iter();
        let results = outcomes.map(|outcome| (outcome.name.clone(), format!("= {}", text(outcome.value))));
        section(f, "results", results)?;
        section(f, "conditions", self.condition_lines(&text))?;
        section(f, "watched along the way", self.watch_lines(&text))
    }
}

impl ConstraintSystem {
    fn write_equations(&self, f: &mut std::fmt::Formatter<'_>, text: &dyn Fn(ExprId) -> String) -> std::fmt::Result {
        let of_rows = |list: &[ExprId]| -> Vec<(String, String)> {
            list.iter().enumerate().map(|(k, &id)| (self.row_name(k), format!("= {}", text(id)))).collect()
        };
        let phi = self.rows.iter().enumerate().map(|(k, row)| {
            let name = format!("{} [{}]", self.row_name(k), row.unit.display_unit());
            (name, format!("0 = {}", text(row.phi)))
        });
        section(f, "equations Φ = 0, with what each is measured in", phi)?;
        writeln!(f, "\nwritten by")?;
        for declaration in &self.declarations {
            let kind = match declaration.kind {
                DeclarationKind::Joint(joint) => format!("joint, {}", joint.name()),
                other => other.noun().to_owned(),
            };
            writeln!(f, "  {}: {kind}", declaration.name)?;
        }
        let entries = (0..self.rows.len()).flat_map(|k| {
            self.phi_q.row(k).iter().map(move |&(column, id)| {
                let by = &self.coordinates[column as usize].name;
                (format!("{} by {by}", self.row_name(k)), format!("= {}", text(id)))
            })
        });
        section(f, "Jacobian Φ_q, entries that are not 0", entries)?;
        section(f, "velocity, right side ν of Φ_q q̇ = ν", of_rows(self.nu()).into_iter())?;
        section(f, "acceleration, right side γ of Φ_q q̈ = γ", of_rows(self.gamma()).into_iter())?;
        let jerk = self.jerk().map_or(Vec::new(), of_rows);
        section(f, "jerk, right side of Φ_q q⃛ = …", jerk.into_iter())?;
        for (number, variation) in self.variations().iter().enumerate() {
            for (of, rights) in ["q", "q̇", "q̈"].into_iter().zip(&variation.rights) {
                let what = self.variation_name(of, number as u32);
                section(f, &format!("variation, right side of Φ_q {what} = …"), of_rows(rights).into_iter())?;
            }
        }
        Ok(())
    }

    fn table_lines<'s>(&'s self, text: &'s dyn Fn(ExprId) -> String) -> impl Iterator<Item = (String, String)> + 's {
        self.graph.tables().iter().map(|table| {
            let pairs = table.knots.iter().zip(&table.values);
            let rows: Vec<String> = pairs.map(|(x, y)| format!("({}, {})", text(*x), text(*y))).collect();
            let kind = if table.periodic { "periodic spline" } else { "spline" };
            (table.name.clone(), format!("= {kind} [{}]", rows.join(", ")))
        })
    }

    fn measure_lines<'s>(&'s self, text: &'s dyn Fn(ExprId) -> String) -> impl Iterator<Item = (String, String)> + 's {
        self.measures.iter().flat_map(move |measure| {
            let parts = [("", Some(measure.value)), (".d", measure.first), (".dd", measure.second)];
            parts
                .into_iter()
                .filter_map(move |(end, id)| id.map(|id| (format!("{}{end}", measure.name), format!("= {}", text(id)))))
        })
    }

    fn reduction_lines<'s>(
        &'s self,
        text: &'s dyn Fn(ExprId) -> String,
    ) -> impl Iterator<Item = (String, String)> + 's {
        self.results.reductions.iter().enumerate().map(|(k, reduction)| {
            let of = text(reduction.of);
            let reduced = match reduction.kind {
                ReductionKind::Extreme { largest, when } => {
                    let which = if largest { "largest" } else { "least" };
                    if when { format!("the time of the {which} {of}") } else { format!("the {which} {of}") }
                }
                ReductionKind::Mean => format!("the mean of {of}"),
                ReductionKind::Integral => format!("the integral of {of}"),
                ReductionKind::First => format!("the first {of}"),
                ReductionKind::Last => format!("the last {of}"),
                ReductionKind::At(at) => format!("{of} at t = {} s", text(at)),
            };
            let bounds = ["from", "to"].into_iter().zip(reduction.window);
            let bounds = bounds.filter_map(|(word, bound)| bound.map(|bound| format!(" {word} t = {} s", text(bound))));
            let reduced = reduced + &bounds.collect::<String>();
            (self.symbol_name(Symbol::Named(k as u32)), reduced)
        })
    }

    fn condition_lines<'s>(
        &'s self,
        text: &'s dyn Fn(ExprId) -> String,
    ) -> impl Iterator<Item = (String, String)> + 's {
        self.conditions.iter().map(|condition| {
            let why = match condition.kind {
                ConditionKind::Distance => "a distance".to_owned(),
                ConditionKind::Interval => "the interval of a motion".to_owned(),
                ConditionKind::Range(table) => format!("within table `{}`", self.graph.tables()[table.index()].name),
                ConditionKind::Samples(_) => "within the samples".to_owned(),
            };
            (condition.owner.clone(), format!("{} > 0, {why}", text(condition.positive)))
        })
    }

    fn watch_lines<'s>(&'s self, text: &'s dyn Fn(ExprId) -> String) -> impl Iterator<Item = (String, String)> + 's {
        self.watches.iter().map(|watch| {
            let rule = match watch.kind {
                MonitorKind::LineOfCenters => "> 0, along the line of centres",
                MonitorKind::Tangents => "keeps its sign: the tangents",
                MonitorKind::Curvature => "keeps its sign: the relative curvature",
            };
            (self.declarations[watch.declaration].name.clone(), format!("{} {rule}", text(watch.value)))
        })
    }
}

impl ConstraintSystem {
    /// Returns all printed formulas, so that shared subexpressions can be named.
    fn printed(&self) -> Vec<ExprId> {
        let mut roots: Vec<ExprId> = self.rows.iter().map(|row| row.phi).collect();
        roots.extend(self.coordinates.iter().map(|coordinate| coordinate.estimate));
        roots.extend(self.conditions.iter().map(|condition| condition.positive));
        roots.extend(self.results.reductions.iter().map(|reduction| reduction.of));
        roots.extend(self.results.outcomes.iter().map(|outcome| outcome.value));
        roots.extend(self.watches.iter().map(|watch| watch.value));
        roots.extend(self.phi_q.entries().iter().map(|&(_, id)| id));
        roots.extend(self.nu().iter().chain(self.gamma()).chain(self.jerk().into_iter().flatten()));
        roots.extend(self.variations().iter().flat_map(|variation| variation.rights.iter().flatten()));
        roots.extend(self.measures.iter().flat_map(|m| [Some(m.value), m.first, m.second].into_iter().flatten()));
        roots
    }

    /// Returns a prefix for the names of shared subexpressions that no parameter name begins with.
    fn prefix_of_shared(&self) -> &'static str {
        let free = |prefix: &&str| !self.params.iter().any(|param| param.name.starts_with(*prefix));
        ["k", "e", "u", "w"].into_iter().find(free).unwrap_or("shared_")
    }
}

/// Writes a title and lines of two columns; nothing if there are no lines.
fn section(
    f: &mut std::fmt::Formatter<'_>,
    title: &str,
    lines: impl Iterator<Item = (String, String)>,
) -> std::fmt::Result {
    let lines: Vec<(String, String)> = lines.collect();
    if lines.is_empty() {
        return Ok(());
    }
    let width = lines.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    writeln!(f, "\n{title}")?;
    for (name, text) in lines {
        writeln!(f, "  {name:<width$}  {text}")?;
    }
    Ok(())
}
