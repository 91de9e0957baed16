//! Parameters as Rust structures: one for the mechanism, with a nested structure for each part and an array for each repeated part.
//!
//! Copies form an array if their numbers are consecutive from 0 and all have the same parameters; other copies are fields,
//! `leg_2`, of one type as long as they are alike. Bound params are no parameters, and parts without parameters are left out.

use super::names::Case;
use mechc_ir::{ConstraintSystem, Param};
use std::collections::BTreeMap;

/// Parameters of a system, in structures.
pub(super) struct Params {
    /// `Params` itself, followed by the structures of its parts.
    pub types: Vec<Type>,
    /// Path of each parameter: `leg[1].shank`.
    pub paths: Vec<String>,
    whole: Group,
}

/// A structure of parameters.
pub(super) struct Type {
    pub name: String,
    /// Path of its part, for copies of the first: `leg[0]`, `front.wheel`; empty for the mechanism itself.
    pub source: String,
    pub fields: Vec<Field>,
}

pub(super) struct Field {
    pub name: String,
    /// Name in the source of the part.
    pub source: String,
    pub kind: FieldType,
}

/// Content of a field.
pub(super) enum FieldType {
    /// Index of a parameter, for copies in the first one.
    Number(usize),
    /// A part, by the index of its type.
    Part(usize),
    /// All copies of a part: the index of their type, and the number of copies along each index.
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
    /// A copy; `are_alike` if all copies of its part have the same parameters.
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
                match (&field.kind, slot) {
                    (_, Slot::Number { param, .. }) => self.paths[param] = path,
                    (FieldType::Part(of), Slot::Part { group, .. }) => open.push((*of, group, path + ".")),
                    (FieldType::Copies(of, lengths), Slot::Copies { groups, .. }) => {
                        let groups = groups.into_iter().enumerate();
                        open.extend(groups.map(|(k, group)| (*of, group, format!("{path}{}.", place(k, lengths)))));
                    }
                    _ => {}
                }
            }
        }
    }

    /// Returns a struct expression of type `name`, with `of(k)` as the value of parameter `k`, in indented lines.
    pub fn value(&self, name: &str, indent: &str, of: &dyn Fn(usize) -> String) -> String {
        self.value_of((0, name), &self.whole, indent, of)
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
            let value = match (&field.kind, slot) {
                (FieldType::Part(part), Slot::Part { group, .. }) => {
                    self.value_of((*part, &self.types[*part].name), group, &within, of)
                }
                (FieldType::Copies(part, lengths), Slot::Copies { groups, .. }) => {
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

/// Builder of types.
#[derive(Default)]
struct Types {
    all: Vec<Type>,
    /// Path of each type's part, without the numbers of copies that share it.
    called: Vec<String>,
}

impl Types {
    /// Adds a type, and those of its fields behind it; gives its number. What it is of is called so in types, and so in the text.
    fn add(&mut self, [called, source]: [&str; 2], group: &Group) -> usize {
        let number = self.all.len();
        self.all.push(Type { name: String::new(), source: source.to_owned(), fields: Vec::new() });
        self.called.push(called.to_owned());
        let mut fields: Vec<(String, FieldType)> = Vec::new();
        let mut before: Option<(&str, usize)> = None;
        for slot in group.slots() {
            fields.push(match slot {
                Slot::Number { source, param } => (source.to_owned(), FieldType::Number(param)),
                Slot::Part { part, source: field, group, are_alike } => {
                    let alike = before.filter(|(previous, _)| are_alike && *previous == part).map(|(_, of)| of);
                    let name = if are_alike { part } else { &field };
                    let of = alike.unwrap_or_else(|| self.add_part([called, source], [name, &field], group));
                    before = Some((part, of));
                    (field, FieldType::Part(of))
                }
                Slot::Copies { source: field, lengths, groups } => {
                    let first = copy_of(field, &vec![0; lengths.len()]);
                    (
                        field.to_owned(),
                        FieldType::Copies(self.add_part([called, source], [field, &first], groups[0]), lengths),
                    )
                }
            });
        }
        let names = Case::Snake.names(fields.iter().map(|(source, _)| source.as_str()));
        let named = fields.into_iter().zip(names).map(|((source, kind), name)| Field { name, source, kind });
        self.all[number].fields = named.collect();
        number
    }

    /// Adds the type of a part within another.
    fn add_part(&mut self, around: [&str; 2], inner: [&str; 2], group: &Group) -> usize {
        let within =
            |k: usize| if around[k].is_empty() { inner[k].to_owned() } else { format!("{}.{}", around[k], inner[k]) };
        let (called, source) = (within(0), within(1));
        self.add([&called, &source], group)
    }

    /// Names the types and returns them.
    fn named(self) -> Vec<Type> {
        let sources: Vec<String> = self.called.iter().map(|called| format!("{called}.params")).collect();
        let names = Case::Camel.names(sources.iter().map(String::as_str));
        self.all.into_iter().zip(names).map(|(of, name)| Type { name, ..of }).collect()
    }
}

impl Group {
    fn add(&mut self, param: &Param, number: usize) {
        let (parts, field) = param.name.split_at(param.part);
        let mut group = self;
        for part in parts.split_terminator('.') {
            let (name, indices) = part.trim_end_matches(']').split_once('[').unwrap_or((part, ""));
            let indices = indices.split(',').filter_map(|index| index.trim().parse().ok()).collect();
            group = group.part(name).entry(indices).or_default();
        }
        group.members.push(Member::Number { source: field.to_owned(), param: number });
    }

    /// Returns the copies of a part, and adds the part if necessary.
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

/// Returns values as an array of arrays, the last index fastest.
fn array(values: &[String], lengths: &[usize], indent: &str) -> String {
    let (Some((_, rest)), false) = (lengths.split_first(), values.is_empty()) else {
        return values.concat();
    };
    let within = format!("{indent}    ");
    let each = rest.iter().product::<usize>().max(1);
    let items = values.chunks(each).map(|chunk| format!("{within}{},\n", array(chunk, rest, &within)));
    format!("[\n{}{indent}]", items.collect::<String>())
}
