//! The file names of a film's frames: a picture of each row, with its number in the name.

use crate::cli::failure::{Failure, unusable};

/// The names of a film's frames: the text before and behind the number, and the minimum number of digits.
pub(super) struct Frames {
    before: String,
    behind: String,
    digits: usize,
}

impl Frames {
    /// Parses a file name with one `%d`, or `%04d`; `None` if there is none.
    ///
    /// # Errors
    /// There is more than one.
    pub fn parse(output: &str) -> Result<Option<Frames>, Failure> {
        match Frames::parse_last(output) {
            Some(frames)
                if frames.before.split(std::path::is_separator).any(|part| Frames::parse_last(part).is_some()) =>
            {
                let message = format!("`{output}` has more than one number in it");
                Err(unusable(message).help("one is counted, as in `frames/%04d.svg`").into())
            }
            frames => Ok(frames),
        }
    }

    fn parse_last(output: &str) -> Option<Frames> {
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
        for (output, expected) in [
            ("frames/%04d.svg", Some("frames/0007.svg")),
            ("f%d.svg", Some("f7.svg")),
            ("100%-%03d.svg", Some("100%-007.svg")),
            ("100%.svg", None),
            ("%4d.svg", None),
            ("%s.svg", None),
            ("%02d/a.svg", None),
            ("a.svg", None),
        ] {
            let frames = Frames::parse(output).expect("one at most");
            assert_eq!(frames.map(|frames| frames.name(7)).as_deref(), expected, "{output}");
        }
        let frames = Frames::parse("%02d.svg").expect("one");
        assert_eq!(frames.map(|frames| frames.name(12_345)).as_deref(), Some("12345.svg"));
        for twice in ["%d_%d.svg", "f%03d/%02d.svg", "%d%d.svg"] {
            assert!(Frames::parse(twice).is_err(), "{twice}");
        }
    }
}
