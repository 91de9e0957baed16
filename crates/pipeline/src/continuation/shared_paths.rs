//! Groups of parts that one continuation serves: copies of one text whose inputs differ from the nominal ones in a single value, to the
//! same side. Their path passes the nearer targets on its way to the farthest one.

use rustc_hash::FxHashMap;
use std::hash::Hash;

/// The target of a part's continuation.
pub(crate) struct PartTarget<'t, K> {
    /// Parts with equal keys have the same standalone position.
    pub key: &'t K,
    /// Nominal inputs (SI), if they are known.
    pub nominal: Option<&'t [f64]>,
    /// Target inputs (SI).
    pub inputs: &'t [f64],
    /// True if the time changes along the path, too.
    pub has_other_time: bool,
}

/// Targets on one path.
pub(crate) struct SharedPath {
    /// Index of the farthest target.
    pub farthest: usize,
    /// Fractions of the path at which targets lie, rising to 1, each with the indices of the targets there.
    pub stops: Vec<(f64, Vec<usize>)>,
}

/// Groups targets by paths, in the order of the first target of each.
pub(crate) fn shared_paths<K: Hash + Eq>(targets: &[PartTarget<'_, K>]) -> Vec<SharedPath> {
    let mut groups: Vec<Vec<(f64, usize)>> = Vec::new();
    let mut indices: FxHashMap<(&K, usize, bool), usize> = FxHashMap::default();
    for (index, target) in targets.iter().enumerate() {
        match target.only_change() {
            Some((input, change)) => {
                let path = *indices.entry((target.key, input, change > 0.0)).or_insert(groups.len());
                if path == groups.len() {
                    groups.push(Vec::new());
                }
                groups[path].push((change.abs(), index));
            }
            None => groups.push(vec![(1.0, index)]),
        }
    }
    groups.into_iter().map(shared_path).collect()
}

fn shared_path(mut distances: Vec<(f64, usize)>) -> SharedPath {
    distances.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let (length, farthest) = distances.last().copied().unwrap_or((1.0, 0));
    let mut stops: Vec<(f64, Vec<usize>)> = Vec::new();
    for (distance, index) in distances {
        let fraction = distance / length;
        match stops.last_mut() {
            Some((last, members)) if last.total_cmp(&fraction).is_eq() => members.push(index),
            _ => stops.push((fraction, vec![index])),
        }
    }
    SharedPath { farthest, stops }
}

impl<K> PartTarget<'_, K> {
    /// Returns the index of the only input that changes, and by how much.
    fn only_change(&self) -> Option<(usize, f64)> {
        let nominal = self.nominal.filter(|nominal| nominal.len() == self.inputs.len() && !self.has_other_time)?;
        let changes = nominal.iter().zip(self.inputs).map(|(nominal, target)| target - nominal).enumerate();
        let mut changes = changes.filter(|(_, change)| *change != 0.0);
        let only = changes.next().filter(|(_, change)| change.is_finite())?;
        changes.next().is_none().then_some(only)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[allow(clippy::type_complexity)] // spelled out once
    fn check(nominal: &[f64], inputs: &[&[f64]], expected: &[(usize, &[(f64, &[usize])])]) {
        let target = |&inputs| PartTarget { key: &"leg", nominal: Some(nominal), inputs, has_other_time: false };
        let targets: Vec<_> = inputs.iter().map(target).collect();
        let groups = shared_paths(&targets);
        let groups: Vec<_> = groups.iter().map(|path| (path.farthest, path.stops.clone())).collect();
        let owned = |(farthest, stops): &(usize, &[(f64, &[usize])])| {
            (*farthest, stops.iter().map(|(fraction, members)| (*fraction, members.to_vec())).collect::<Vec<_>>())
        };
        assert_eq!(groups, expected.iter().map(owned).collect::<Vec<_>>());
    }

    #[test]
    fn targets_that_differ_in_one_value_share_a_path() {
        let nominal = [1.0, 5.0];
        check(
            &nominal,
            &[&[3.0, 5.0], &[2.0, 5.0], &[0.0, 5.0], &[3.0, 5.0]],
            &[(3, &[(0.5, &[1]), (1.0, &[0, 3])]), (2, &[(1.0, &[2])])],
        );
    }

    #[test]
    fn targets_that_differ_in_two_values_share_no_path() {
        let nominal = [1.0, 5.0];
        check(
            &nominal,
            &[&[3.0, 6.0], &[2.0, 6.0], &[1.0, 5.0]],
            &[(0, &[(1.0, &[0])]), (1, &[(1.0, &[1])]), (2, &[(1.0, &[2])])],
        );
    }

    #[test]
    fn other_texts_and_times_share_no_path() {
        let (nominal, inputs) = ([0.0], [1.0]);
        let target =
            |key, has_other_time| PartTarget { key, nominal: Some(&nominal[..]), inputs: &inputs, has_other_time };
        assert_eq!(shared_paths(&[target(&"leg", false), target(&"arm", false), target(&"leg", true)]).len(), 3);
        assert_eq!(shared_paths(&[target(&"leg", false), target(&"leg", false)]).len(), 1);
    }
}
