//! The parameters as Rust has them: a structure, in which those of a part are a structure of their own, and those of a repeated part an
//! array of such.
//!
//! Copies make an array where their numbers begin with 0 and leave none out, and all have the same parameters; other copies are fields,
//! `leg_2`, of one type as long as they are alike. What is bound is no parameter, and a part without parameters is not there.

use super::names::Case;
use mechc_ir::{ConstraintSystem, Param};
use std::collections::BTreeMap;

/// The parameters of a system, in structures.
pub(super) struct Params {
    /// `Params` itself, and behind it those of its parts.
    pub types: Vec<Type>,
    /// By parameter: how it is reached, `leg[1].shank`.
    pub paths: Vec<String>,
    whole: Group,
}

/// A structure of parameters.
pub(super) struct Type {
    pub name: String,
    /// The part that it is of, the first of copies: `leg[0]`, `front.wheel`; nothing of the mechanism itself.
    pub source: String,
    pub fields: Vec<Field>,
}

pub(super) struct Field {
    pub name: String,
    /// Its name in the text of its part.
    pub source: String,
    pub of: Of,
}

/// Content of a field.
pub(super) enum Of {
    /// A parameter; its number, in the first of copies.
    Number(usize),
    /// A part, by the number of its type.
    Part(usize),
    /// All copies of a part, with how many there are by each index.
    Copies(usize, Vec<usize>),
}

/// Parameters of one part, with those of the parts in it.
#[derive(Default)]
struct Group {
    members: Vec<Member>,
}

enum Member {
    Number { source: String, param: usize },
    Part { source: String, copies: BTreeMap<Vec<i64>, Group> },
}

/// Content of a field, before types are named.
enum Slot<'g> {
    Number {
        source: &'g str,
        param: usize,
    },
    /// A copy, whose part has others that are alike or not.
    Part {
        part: &'g str,
        source: String,
        group: &'g Group,
        are_alike: bool,
    },
    Copies {
        source: &'g str,
        lengths: Vec<usize>,
        groups: Vec<&'g Group>,
    },
}

impl Params {
    pub fn new(system: &ConstraintSystem) -> Params {
        let mut whole = Group::default();
        for (number, param) in system.params().iter().enumerate() {
            whole.add(param, number);
        }
        let mut types = Types::default();
        types.add(["", ""], &whole);
        let mut params = Params { types: types.named(), paths: vec![String::new(); system.params().len()], whole };
        params.find_paths();
        params
    }

    fn find_paths(&mut self) {
        let mut open = vec![(0, &self.whole, String::new())];
        while let Some((of, group, path)) = open.pop() {
            for (field, slot) in self.types[of].fields.iter().zip(group.slots()) {
                let path = format!("{path}{}", field.name);
                match (&field.of, slot) {
                    (_, Slot::Number { param, .. }) => self.paths[param] = path,
                    (Of::Part(of), Slot::Part { group, .. }) => open.push((*of, group, path + ".")),
                    (Of::Copies(of, lengths), Slot::Copies { groups, .. }) => {
                        let groups = groups.into_iter().enumerate();
                        open.extend(groups.map(|(k, group)| (*of, group, format!("{path}{}.", place(k, lengths)))));
                    }
                    _ => {}
                }
            }
        }
    }

    /// A value of `Params` with something for each parameter, by its number, in lines that stand under an indent.
    pub fn value(&self, own: &str, indent: &str, of: &dyn Fn(usize) -> String) -> String {
        self.value_of((0, own), &self.whole, indent, of)
    }

    fn value_of(
        &self,
        (number, name): (usize, &str),
        group: &Group,
        indent: &str,
        of: &dyn Fn(usize) -> String,
    ) -> String {
        let within = format!("{indent}    ");
        let mut text = format!("{name} {{\n");
        for (field, slot) in self.types[number].fields.iter().zip(group.slots()) {
            let value = match (&field.of, slot) {
                (Of::Part(part), Slot::Part { group, .. }) => {
                    self.value_of((*part, &self.types[*part].name), group, &within, of)
                }
                (Of::Copies(part, lengths), Slot::Copies { groups, .. }) => {
                    let depth = within.clone() + &"    ".repeat(lengths.len());
                    let copy = |group: &&Group| self.value_of((*part, &self.types[*part].name), group, &depth, of);
                    array(&groups.iter().map(copy).collect::<Vec<String>>(), lengths, &within)
                }
                (_, Slot::Number { param, .. }) => of(param),
                _ => String::new(),
            };
            text += &format!("{within}{}: {value},\n", field.name);
        }
        text + indent + "}"
    }
}

/// Types in the making.
#[derive(Default)]
struct Types {
    all: Vec<Type>,
    /// Path of the part of each, without the numbers of copies that share it.
    called: Vec<String>,
}

impl Types {
    /// Adds a type, and those of its fields behind it; gives its number. What it is of is called so in types, and so in the text.
    fn add(&mut self, [called, source]: [&str; 2], group: &Group) -> usize {
        let number = self.all.len();
        self.all.push(Type { name: String::new(), source: source.to_owned(), fields: Vec::new() });
        self.called.push(called.to_owned());
        let mut fields: Vec<(String, Of)> = Vec::new();
        let mut before: Option<(&str, usize)> = None;
        for slot in group.slots() {
            fields.push(match slot {
                Slot::Number { source, param } => (source.to_owned(), Of::Number(param)),
                Slot::Part { part, source: own, group, are_alike } => {
                    let known = before.filter(|(known, _)| are_alike && *known == part).map(|(_, of)| of);
                    let telling = if are_alike { part } else { &own };
                    let of = known.unwrap_or_else(|| self.add_part([called, source], [telling, &own], group));
                    before = Some((part, of));
                    (own, Of::Part(of))
                }
                Slot::Copies { source: own, lengths, groups } => {
                    let first = copy_of(own, &vec![0; lengths.len()]);
                    (own.to_owned(), Of::Copies(self.add_part([called, source], [own, &first], groups[0]), lengths))
                }
            });
        }
        let names = Case::Snake.names(fields.iter().map(|(source, _)| source.as_str()));
        let named = fields.into_iter().zip(names).map(|((source, of), name)| Field { name, source, of });
        self.all[number].fields = named.collect();
        number
    }

    /// Adds the type of a part within another.
    fn add_part(&mut self, around: [&str; 2], own: [&str; 2], group: &Group) -> usize {
        let within =
            |k: usize| if around[k].is_empty() { own[k].to_owned() } else { format!("{}.{}", around[k], own[k]) };
        let (called, source) = (within(0), within(1));
        self.add([&called, &source], group)
    }

    /// The types with their names.
    fn named(self) -> Vec<Type> {
        let sources: Vec<String> = self.called.iter().map(|called| format!("{called}.params")).collect();
        let names = Case::Camel.names(sources.iter().map(String::as_str));
        self.all.into_iter().zip(names).map(|(of, name)| Type { name, ..of }).collect()
    }
}

impl Group {
    fn add(&mut self, param: &Param, number: usize) {
        let (parts, own) = param.name.split_at(param.part);
        let mut group = self;
        for part in parts.split_terminator('.') {
            let (name, indices) = part.trim_end_matches(']').split_once('[').unwrap_or((part, ""));
            let indices = indices.split(',').filter_map(|index| index.trim().parse().ok()).collect();
            group = group.part(name).entry(indices).or_default();
        }
        group.members.push(Member::Number { source: own.to_owned(), param: number });
    }

    /// The copies of a part.
    fn part(&mut self, name: &str) -> &mut BTreeMap<Vec<i64>, Group> {
        let is_it = |member: &Member| matches!(member, Member::Part { source, .. } if source == name);
        let at = self.members.iter().position(is_it).unwrap_or_else(|| {
            self.members.push(Member::Part { source: name.to_owned(), copies: BTreeMap::new() });
            self.members.len() - 1
        });
        match &mut self.members[at] {
            Member::Part { copies, .. } => copies,
            Member::Number { .. } => unreachable!("it is a part"),
        }
    }

    /// Returns the content of its fields, one by one.
    fn slots(&self) -> Vec<Slot<'_>> {
        let mut slots = Vec::new();
        for member in &self.members {
            match member {
                Member::Number { source, param } => slots.push(Slot::Number { source, param: *param }),
                Member::Part { source, copies } => {
                    let groups: Vec<&Group> = copies.values().collect();
                    let are_alike = groups.windows(2).all(|pair| pair[0].is_alike(pair[1]));
                    if let Some(lengths) = lengths(copies).filter(|_| are_alike) {
                        slots.push(Slot::Copies { source, lengths, groups });
                    } else {
                        slots.extend(copies.iter().map(|(indices, group)| Slot::Part {
                            part: source,
                            source: copy_of(source, indices),
                            group,
                            are_alike,
                        }));
                    }
                }
            }
        }
        slots
    }

    /// Returns whether another group has the same parameters.
    fn is_alike(&self, other: &Group) -> bool {
        let pairs = self.members.iter().zip(&other.members);
        let mut alike = pairs.map(|pair| match pair {
            (Member::Number { source: a, .. }, Member::Number { source: b, .. }) => a == b,
            (Member::Part { source: a, copies: x }, Member::Part { source: b, copies: y }) => {
                a == b && x.keys().eq(y.keys()) && x.values().zip(y.values()).all(|(x, y)| x.is_alike(y))
            }
            _ => false,
        });
        self.members.len() == other.members.len() && alike.all(|is_alike| is_alike)
    }
}

/// Returns the number of copies by each index, if the indices begin with 0 and have no gaps.
fn lengths(copies: &BTreeMap<Vec<i64>, Group>) -> Option<Vec<usize>> {
    let last = copies.keys().next_back().filter(|indices| !indices.is_empty())?;
    let lengths: Vec<usize> = last.iter().map(|index| usize::try_from(index + 1).ok()).collect::<Option<_>>()?;
    let is_inside = |indices: &Vec<i64>| {
        indices.len() == lengths.len() && indices.iter().zip(last).all(|(index, last)| (0..=*last).contains(index))
    };
    let count = lengths.iter().try_fold(1_usize, |count, length| count.checked_mul(*length));
    (count == Some(copies.len()) && copies.keys().all(is_inside)).then_some(lengths)
}

/// `leg[2]`
fn copy_of(part: &str, indices: &[i64]) -> String {
    let indices: Vec<String> = indices.iter().map(i64::to_string).collect();
    if indices.is_empty() { part.to_owned() } else { format!("{part}[{}]", indices.join(",")) }
}

/// Returns the position of a copy in arrays, the last index fastest: `[1][2]`.
fn place(number: usize, lengths: &[usize]) -> String {
    let (mut rest, mut text) = (number, String::new());
    for length in lengths.iter().rev() {
        text = format!("[{}]{text}", rest % length);
        rest /= length;
    }
    text
}

/// Values as an array of arrays, the last index fastest.
fn array(values: &[String], lengths: &[usize], indent: &str) -> String {
    let (Some((_, rest)), false) = (lengths.split_first(), values.is_empty()) else {
        return values.concat();
    };
    let within = format!("{indent}    ");
    let each = rest.iter().product::<usize>().max(1);
    let items = values.chunks(each).map(|chunk| format!("{within}{},\n", array(chunk, rest, &within)));
    format!("[\n{}{indent}]", items.collect::<String>())
}
