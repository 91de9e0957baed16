//! Line breaking: a group stays on one line if it fits, and otherwise breaks at its own gaps before those of inner groups.
//!
//! One pass from the end measures what must fit behind each gap, one from the beginning decides. Both touch each node a bounded
//! number of times, however deep the groups nest (after D. C. Oppen, "Prettyprinting", 1980, and P. Wadler, "A prettier printer", 2003).

/// Style in which the gaps of a group break if it does not fit.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Style {
    /// Only gaps behind which the next piece does not fit are broken.
    Filled,
    /// All gaps are broken.
    Stacked,
    /// All gaps are broken, and the closing bracket stands on a line of its own.
    Listed,
}

/// A piece of a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Node {
    /// Width of a text in columns.
    Text(usize),
    /// Fixed number of spaces.
    Space(usize),
    /// Number of spaces, or the end of a line.
    Gap(usize),
    /// The end of a line.
    Line,
    Open(Style),
    Close,
}

/// Columns of a level of indentation.
pub(super) const INDENT: usize = 4;

/// Columns of a line.
pub(super) const WIDTH: usize = 100;

/// Columns beyond which nothing is indented further.
pub(super) const DEEPEST_INDENT: usize = 48;

/// Result of the layout.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct Laid {
    /// Indentation of the lines that begin with each node that is a gap or line, if it begins one.
    pub lines: Vec<Option<usize>>,
    /// True for nodes that open a broken group.
    pub is_broken: Vec<bool>,
    /// The column behind the last node.
    pub column: usize,
    /// True if there is more than one line.
    pub has_lines: bool,
    /// Number of examined nodes.
    pub steps: usize,
}

/// Measures that the decisions need.
struct Measures {
    /// Columns before each node, all in one line; and behind the last.
    columns: Vec<usize>,
    /// Lines before each node, and behind the last.
    lines: Vec<usize>,
    /// Node at which a line can end next, outside of groups that begin later, for each gap and each node that closes a group.
    next_end: Vec<usize>,
    /// Closing node of each group, by its opening node.
    closes: Vec<usize>,
    steps: usize,
}

impl Measures {
    fn of(nodes: &[Node]) -> Measures {
        let (mut columns, mut lines) = (vec![0], vec![0]);
        for (k, node) in nodes.iter().enumerate() {
            let wide = if let Node::Text(width) | Node::Space(width) | Node::Gap(width) = node { *width } else { 0 };
            columns.push(columns[k] + wide);
            lines.push(lines[k] + usize::from(*node == Node::Line));
        }
        let (next_end, closes) = (vec![nodes.len(); nodes.len()], vec![nodes.len(); nodes.len()]);
        let mut measures = Measures { columns, lines, next_end, closes, steps: 2 * nodes.len() };
        measures.measure_ends(nodes);
        measures
    }

    fn measure_ends(&mut self, nodes: &[Node]) {
        // places where a line can end, nearest last, each in fewer groups than those before it
        let mut ends: Vec<(usize, usize)> = Vec::new();
        // the nodes that close the groups around a node
        let mut around: Vec<usize> = Vec::new();
        for (k, node) in nodes.iter().enumerate().rev() {
            match node {
                Node::Close | Node::Gap(_) => {
                    let depth = around.len();
                    while ends.last().is_some_and(|&(of_end, _)| of_end > depth) {
                        ends.pop();
                        self.steps += 1;
                    }
                    self.next_end[k] = ends.last().map_or(nodes.len(), |&(_, at)| at);
                    if *node == Node::Close {
                        around.push(k);
                    } else {
                        ends.push((depth, k));
                    }
                }
                Node::Line => ends.push((0, k)),
                Node::Open(_) => self.closes[k] = around.pop().unwrap_or(nodes.len()),
                Node::Text(_) | Node::Space(_) => {}
            }
        }
    }

    /// Returns the columns from before one node to before another, if no line ends between.
    fn width(&self, from: usize, to: usize) -> Option<usize> {
        (self.lines[from] == self.lines[to]).then(|| self.columns[to] - self.columns[from])
    }

    /// Returns the columns of a group with all that cannot be on another line, if no line ends in it.
    fn width_of_group(&self, open: usize) -> Option<usize> {
        let close = self.closes[open];
        let behind = self.next_end.get(close).copied().unwrap_or(close);
        // a line that ends there ends behind all that is measured
        Some(self.width(open, close)? + self.width(close, behind)?)
    }
}

/// A group that is open.
struct Group {
    style: Style,
    is_flat: bool,
    /// Indentation of the line in which it begins.
    base: usize,
    /// Indentation of the lines that it breaks into.
    indent: usize,
    has_lines: bool,
}

impl Group {
    /// Returns the indentation of a line that begins with a node.
    fn begin_line(&mut self, with: Option<&Node>) -> usize {
        self.has_lines = true;
        let is_end_of_list = self.style == Style::Listed && with == Some(&Node::Close);
        if is_end_of_list { self.base } else { self.indent }
    }

    /// Returns the current indentation.
    fn now(&self) -> usize {
        if self.has_lines { self.indent } else { self.base }
    }

    fn within(base: usize, style: Style, is_flat: bool) -> Group {
        let indent = (base + INDENT).min(DEEPEST_INDENT.max(base));
        Group { style, is_flat, base, indent, has_lines: false }
    }
}

/// Lays nodes out in a line with an indentation, which may be continued.
pub(super) fn lay_out(nodes: &[Node], indent: usize) -> Laid {
    let measures = Measures::of(nodes);
    let mut laid = Laid {
        lines: vec![None; nodes.len()],
        is_broken: vec![false; nodes.len()],
        column: indent,
        has_lines: false,
        steps: measures.steps + nodes.len(),
    };
    let is_flat = measures.width(0, nodes.len()).is_some_and(|width| indent + width <= WIDTH);
    let mut groups = vec![Group::within(indent, Style::Filled, is_flat)];
    for (k, node) in nodes.iter().enumerate() {
        let Some(group) = groups.last_mut() else { break };
        match *node {
            Node::Text(width) | Node::Space(width) => laid.column += width,
            Node::Gap(width) => {
                let next = measures.next_end[k];
                let fits = measures.width(k, next).is_some_and(|wide| laid.column + wide <= WIDTH);
                if group.is_flat || group.style == Style::Filled && fits {
                    laid.column += width;
                } else {
                    laid.begin_line(k, group.begin_line(nodes.get(k + 1)));
                }
            }
            Node::Line => laid.begin_line(k, group.begin_line(nodes.get(k + 1))),
            Node::Open(style) => {
                let fits = measures.width_of_group(k).is_some_and(|wide| laid.column + wide <= WIDTH);
                laid.is_broken[k] = !(group.is_flat || fits);
                let opened = Group::within(group.now(), style, !laid.is_broken[k]);
                groups.push(opened);
            }
            Node::Close => drop(groups.pop()),
        }
    }
    laid
}

impl Laid {
    fn begin_line(&mut self, node: usize, indent: usize) {
        self.lines[node] = Some(indent);
        self.column = indent;
        self.has_lines = true;
    }
}

#[cfg(test)]
mod tests {
    use super::{INDENT, Node, Style, WIDTH, lay_out};

    /// Lays out nodes and returns the length of each line.
    fn shown(nodes: &[Node]) -> Vec<usize> {
        let laid = lay_out(nodes, 0);
        let mut widths = vec![0];
        for (k, node) in nodes.iter().enumerate() {
            if let Some(indent) = laid.lines[k] {
                widths.push(indent);
            } else if let (Node::Text(width) | Node::Space(width) | Node::Gap(width), Some(last)) =
                (node, widths.last_mut())
            {
                *last += width;
            }
        }
        widths
    }

    #[test]
    fn fitting_groups_stay_on_one_line() {
        let half = WIDTH / 2;
        assert_eq!(shown(&[Node::Text(half - 1), Node::Gap(1), Node::Text(half)]), [WIDTH]);
        assert_eq!(shown(&[Node::Text(half), Node::Gap(1), Node::Text(half)]), [half, INDENT + half]);
    }

    #[test]
    fn outer_groups_break_before_inner_ones() {
        use Node::{Close, Gap, Open, Text};
        let inner = [Open(Style::Filled), Text(30), Gap(1), Text(30), Close];
        let mut nodes = vec![Text(30), Gap(1)];
        nodes.extend(inner);
        nodes.extend([Gap(1), Text(30)]);
        assert_eq!(shown(&nodes), [92, INDENT + 30]);
        nodes[0] = Text(50);
        assert_eq!(shown(&nodes), [50, INDENT + 92]);
    }

    #[test]
    fn a_list_that_does_not_fit_has_a_line_for_each_item() {
        use Node::{Close, Gap, Open, Text};
        let item = [Text(40), Text(1), Gap(1)];
        let nodes = [&[Text(9), Open(Style::Listed), Gap(0)], &item[..], &item, &[Text(40), Gap(0), Close, Text(1)]];
        assert_eq!(shown(&nodes.concat()), [9, INDENT + 41, INDENT + 41, INDENT + 40, 1]);
    }

    #[test]
    fn steps_grow_with_the_nodes_and_not_with_their_nesting() {
        let nested = |depth: usize| {
            let mut nodes = Vec::new();
            for _ in 0..depth {
                nodes.extend([Node::Text(30), Node::Open(Style::Filled), Node::Text(30), Node::Gap(1)]);
            }
            nodes.push(Node::Text(1));
            nodes.extend(vec![Node::Close; depth]);
            lay_out(&nodes, 0).steps as f64 / nodes.len() as f64
        };
        let (few, many) = (nested(100), nested(100_000));
        assert!(many <= few * 1.1 && many < 5.0, "{few} and {many} steps a node");
    }
}
