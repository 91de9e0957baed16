//! A film: a picture of each row, each with its number in its name.

/// The names of a film's pictures: what stands before and behind the number, which has so many digits at least.
pub(super) struct Frames {
    before: String,
    behind: String,
    digits: usize,
}

impl Frames {
    /// Of a file's name with one `%d`, or `%04d`, in it.
    pub fn of(output: &str) -> Option<Frames> {
        let (before, rest) = output.rsplit_once('%')?;
        let (digits, behind) = rest.split_once('d')?;
        let has_digits = digits.is_empty() || (digits.starts_with('0') && digits.bytes().all(|c| c.is_ascii_digit()));
        let digits = if digits.is_empty() { 1 } else { digits.parse().ok()? };
        let is_in_name = !behind.contains(std::path::is_separator);
        (has_digits && is_in_name && digits <= 20).then(|| Frames {
            before: before.to_owned(),
            behind: behind.to_owned(),
            digits,
        })
    }

    pub fn name(&self, row: usize) -> String {
        format!("{}{row:0digits$}{}", self.before, self.behind, digits = self.digits)
    }
}

#[cfg(test)]
mod tests {
    use super::Frames;

    #[test]
    fn names_of_frames_have_a_number() {
        for (output, wanted) in [
            ("frames/%04d.svg", Some("frames/0007.svg")),
            ("f%d.svg", Some("f7.svg")),
            ("100%-%03d.svg", Some("100%-007.svg")),
            ("100%.svg", None),
            ("%4d.svg", None),
            ("%s.svg", None),
            ("%02d/a.svg", None),
            ("a.svg", None),
        ] {
            assert_eq!(Frames::of(output).map(|frames| frames.name(7)).as_deref(), wanted, "{output}");
        }
        assert_eq!(Frames::of("%02d.svg").map(|frames| frames.name(12_345)).as_deref(), Some("12345.svg"));
    }
}
