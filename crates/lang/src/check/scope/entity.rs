//! Entities: what the names of a mechanism stand for.

use mechc_text::vocabulary::SubstituteKind;

/// The entity of a name, with its position among those of its kind in the text.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(in crate::check) enum Entity {
    Param(usize),
    Function(usize),
    Table(usize),
    Input(usize),
    Body(usize),
    Joint(usize),
    Equation(usize),
    Load,
    Measure(usize),
    Trace,
    Part(usize),
    /// The ground of a part, in that part.
    Ground,
    Result(usize),
    Requirement,
    /// A declaration that does not follow the grammar, which has been reported.
    Broken,
}

impl Entity {
    /// Returns the noun of the entity's kind.
    pub fn noun(self) -> &'static str {
        match self {
            Entity::Param(_) => "a parameter",
            Entity::Function(_) => "a function",
            Entity::Table(_) => "a table",
            Entity::Input(_) => "an input",
            Entity::Body(_) => "a body",
            Entity::Joint(_) => "a joint",
            Entity::Equation(_) => "a constraint or driver",
            Entity::Load => "a load",
            Entity::Measure(_) => "a measure",
            Entity::Trace => "a trace",
            Entity::Part(_) => "a part",
            Entity::Ground => "the ground of a part",
            Entity::Result(_) => "a result",
            Entity::Requirement => "a requirement",
            Entity::Broken => "a declaration that cannot be read",
        }
    }

    /// Returns whether it is a number in a formula.
    pub fn is_number(self) -> bool {
        matches!(self, Entity::Param(_) | Entity::Input(_) | Entity::Measure(_) | Entity::Result(_))
    }

    /// Returns the kind for which another name is suggested.
    pub fn kind_of_name(self) -> SubstituteKind {
        match self {
            Entity::Param(_)
            | Entity::Input(_)
            | Entity::Measure(_)
            | Entity::Trace
            | Entity::Result(_)
            | Entity::Requirement
            | Entity::Broken => SubstituteKind::Value,
            Entity::Function(_) | Entity::Table(_) => SubstituteKind::Function,
            Entity::Body(_) | Entity::Part(_) | Entity::Ground => SubstituteKind::Body,
            Entity::Joint(_) => SubstituteKind::Joint,
            Entity::Equation(_) | Entity::Load => SubstituteKind::Equation,
        }
    }
}
