//! Which parts of one text are led along one line: those whose inputs differ from their own in one value only, to the same side. They
//! share one motion, which passes where the nearer ones end.

use rustc_hash::FxHashMap;
use std::hash::Hash;

/// Where a part is led to.
pub(super) struct Target<'t, K> {
    /// Parts of one key are the same alone.
    pub key: &'t K,
    /// Its inputs as the text has them (SI), if they are known.
    pub own: Option<&'t [f64]>,
    /// What they are to be (SI).
    pub inputs: &'t [f64],
    /// Whether it is led to another time too.
    pub is_later: bool,
}

/// Targets on one line.
pub(super) struct Line {
    /// The number of the one that is farthest.
    pub farthest: usize,
    /// How far along the line others are, rising to 1, each with the numbers of those that are there.
    pub stops: Vec<(f64, Vec<usize>)>,
}

/// The lines on which targets lie, in the order of their first ones.
pub(super) fn lines<K: Hash + Eq>(targets: &[Target<'_, K>]) -> Vec<Line> {
    let mut found: Vec<Vec<(f64, usize)>> = Vec::new();
    let mut known: FxHashMap<(&K, usize, bool), usize> = FxHashMap::default();
    for (number, target) in targets.iter().enumerate() {
        match target.only_change() {
            Some((input, change)) => {
                let line = *known.entry((target.key, input, change > 0.0)).or_insert(found.len());
                if line == found.len() {
                    found.push(Vec::new());
                }
                found[line].push((change.abs(), number));
            }
            None => found.push(vec![(1.0, number)]),
        }
    }
    found.into_iter().map(line).collect()
}

fn line(mut targets: Vec<(f64, usize)>) -> Line {
    targets.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let (length, farthest) = targets.last().copied().unwrap_or((1.0, 0));
    let mut stops: Vec<(f64, Vec<usize>)> = Vec::new();
    for (way, number) in targets {
        let part = way / length;
        match stops.last_mut() {
            Some((last, numbers)) if last.total_cmp(&part).is_eq() => numbers.push(number),
            _ => stops.push((part, vec![number])),
        }
    }
    Line { farthest, stops }
}

impl<K> Target<'_, K> {
    /// The number of the only input that is led to another value, and by how much.
    fn only_change(&self) -> Option<(usize, f64)> {
        let own = self.own.filter(|own| own.len() == self.inputs.len() && !self.is_later)?;
        let changes = own.iter().zip(self.inputs).map(|(own, target)| target - own).enumerate();
        let mut changes = changes.filter(|(_, change)| *change != 0.0);
        let only = changes.next().filter(|(_, change)| change.is_finite())?;
        changes.next().is_none().then_some(only)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[allow(clippy::type_complexity)] // spelled out once
    fn check(own: &[f64], inputs: &[&[f64]], wanted: &[(usize, &[(f64, &[usize])])]) {
        let target = |&inputs| Target { key: &"leg", own: Some(own), inputs, is_later: false };
        let targets: Vec<_> = inputs.iter().map(target).collect();
        let found = lines(&targets);
        let found: Vec<_> = found.iter().map(|line| (line.farthest, line.stops.clone())).collect();
        let owned = |(farthest, stops): &(usize, &[(f64, &[usize])])| {
            (*farthest, stops.iter().map(|(part, numbers)| (*part, numbers.to_vec())).collect::<Vec<_>>())
        };
        assert_eq!(found, wanted.iter().map(owned).collect::<Vec<_>>());
    }

    #[test]
    fn what_differs_in_one_value_lies_on_one_line() {
        let own = [1.0, 5.0];
        check(
            &own,
            &[&[3.0, 5.0], &[2.0, 5.0], &[0.0, 5.0], &[3.0, 5.0]],
            &[(3, &[(0.5, &[1]), (1.0, &[0, 3])]), (2, &[(1.0, &[2])])],
        );
    }

    #[test]
    fn what_differs_in_two_values_has_a_line_of_its_own() {
        let own = [1.0, 5.0];
        check(
            &own,
            &[&[3.0, 6.0], &[2.0, 6.0], &[1.0, 5.0]],
            &[(0, &[(1.0, &[0])]), (1, &[(1.0, &[1])]), (2, &[(1.0, &[2])])],
        );
    }

    #[test]
    fn those_of_other_texts_and_times_are_led_alone() {
        let (own, inputs) = ([0.0], [1.0]);
        let target = |key, is_later| Target { key, own: Some(&own[..]), inputs: &inputs, is_later };
        assert_eq!(lines(&[target(&"leg", false), target(&"arm", false), target(&"leg", true)]).len(), 3);
        assert_eq!(lines(&[target(&"leg", false), target(&"leg", false)]).len(), 1);
    }
}
