//! The columns of a row, in the order of its layout.

#![allow(clippy::expect_used, clippy::panic)] // a test fails by panicking

use crate::support::compiled;
use mechc_ir::ConstraintSystem;
use mechc_ir::layout::{RowLayout, columns};

/// An arm with a measure that has no second derivative, as that would need a fourth one of the coordinates.
fn system() -> ConstraintSystem {
    let text = "mechanism m {\n ground { point O = (0, 0) }\n body arm { point O = (0, 0) point tip = (1 m, 0) }\n \
                joint main: revolute(ground.O, arm.O)\n driver motor: rotation(main) = 1 rad/s * t\n \
                measure height = y(arm.tip)\n measure pull = der(der(x(arm.tip)))\n}\n";
    compiled("m", text).system().clone()
}

#[test]
fn columns_match_the_layout() {
    let system = system();
    let (layout, columns) = (RowLayout::new(&system), columns(&system));
    let name = |column: u32| columns[column as usize].name.as_str();
    assert_eq!(columns.len(), layout.printed);
    assert_eq!(
        layout.coordinates[..3].iter().map(|&at| name(at)).collect::<Vec<_>>(),
        ["arm.x", "arm.x.d", "arm.x.dd"]
    );
    assert_eq!(layout.measures.map(name), ["height", "height.d", "height.dd"]);
    let body = system.bodies().find(|body| body.name == "arm").expect("the arm");
    let [places, .., accelerations] = layout.pose(&system, body);
    assert_eq!(places.map(|column| name(column as u32)), ["arm.x", "arm.y", "arm.phi"]);
    assert_eq!(accelerations.map(|column| name(column as u32)), ["arm.x.dd", "arm.y.dd", "arm.phi.dd"]);
}

#[test]
fn measures_have_all_available_columns() {
    let columns = columns(&system());
    let of_pull: Vec<(&str, &str)> = columns
        .iter()
        .filter(|column| column.name.starts_with("pull"))
        .map(|column| (column.name.as_str(), column.unit.text.as_str()))
        .collect();
    assert_eq!(of_pull, [("pull", "m/s^2"), ("pull.d", "m/s^3")]);
}
