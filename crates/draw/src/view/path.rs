//! Paths in the syntax of SVG's `d` attribute.

use super::text::decimal;
use crate::scene::{Contour, Path, Segment, Vector};

/// Writes a path as the `d` of an SVG path, whose y axis points down, with its coordinates times `scale`.
#[must_use]
pub fn path_data(path: &Path, scale: f64, decimals: usize) -> String {
    write_path(path, &|[x, y]| [scale * x, -scale * y], scale, decimals)
}

/// Writes a path whose positions `placed` converts to the picture, y reversed; `scale` is that of radii.
pub(super) fn write_path(path: &Path, convert: &dyn Fn(Vector) -> Vector, scale: f64, decimals: usize) -> String {
    let pair = |position: Vector| {
        let [x, y] = convert(position);
        let y = decimal(y, decimals);
        // a minus sign separates numbers, too
        format!("{}{}{y}", decimal(x, decimals), if y.starts_with('-') { "" } else { " " })
    };
    let mut text = String::new();
    match path {
        Path::Circle { at, radius } => {
            let [left, right] = [-radius, *radius].map(|dx| pair([at[0] + dx, at[1]]));
            let radius = decimal(scale * radius, decimals);
            text += &format!("M{left}A{radius} {radius} 0 1 0 {right}A{radius} {radius} 0 1 0 {left}Z");
        }
        Path::Lines(contours) => contours.iter().for_each(|contour| add(&mut text, contour, &pair, scale, decimals)),
    }
    text
}

fn add(text: &mut String, contour: &Contour, pair: &dyn Fn(Vector) -> String, scale: f64, decimals: usize) {
    *text += &format!("M{}", pair(contour.start));
    let mut is_line = false;
    for segment in &contour.segments {
        match *segment {
            Segment::Line(to) => {
                let to = pair(to);
                // the letter of a line is not repeated
                *text += if !is_line {
                    "L"
                } else if to.starts_with('-') {
                    ""
                } else {
                    " "
                };
                *text += &to;
                is_line = true;
            }
            Segment::Arc { to, radius, is_left } => {
                let radius = decimal(scale * radius, decimals);
                *text += &format!("A{radius} {radius} 0 0 {} {}", u8::from(!is_left), pair(to));
                is_line = false;
            }
        }
    }
    if contour.is_closed {
        *text += "Z";
    }
}

#[cfg(test)]
mod tests {
    use super::path_data;
    use crate::scene::Path;

    #[test]
    fn paths_are_written_with_y_down() {
        let triangle = Path::polygon([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]]);
        assert_eq!(path_data(&triangle, 10.0, 2), "M0 0L10 0 10-20Z");
        let arc = Path::arc([0.0; 2], 1.0, 0.0, std::f64::consts::PI);
        assert_eq!(path_data(&arc, 10.0, 2), "M10 0A10 10 0 0 0 0-10A10 10 0 0 0 -10 0");
        let circle = Path::Circle { at: [1.0, 1.0], radius: 0.5 };
        assert_eq!(path_data(&circle, 2.0, 1), "M1-2A1 1 0 1 0 3-2A1 1 0 1 0 1-2Z");
    }
}
