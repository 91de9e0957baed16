//! Where joints take hold of what they join.

#![allow(clippy::expect_used, clippy::panic)] // a test fails by panicking

use mechc::{Cancel, Choice, Memory, Parsed, Redundant};

/// Where the joints of a mechanism take hold as it is drawn (m), and the directions of its axes and the radii of its circles.
fn features(text: &str) -> (Vec<[f64; 2]>, Vec<[f64; 2]>, Vec<f64>) {
    // the mechanism that is chosen by default, which need not be the first
    let checked = Parsed::new("machine.mech", text).check(&Choice::default(), &Memory::default());
    let (compiled, _) = checked.compile(Redundant::Refused, &Cancel::default());
    let compiled = compiled.expect("it is determined");
    let system = compiled.system();
    let q: Vec<f64> = system.coordinates().iter().map(|of| system.value_at(of.estimate, &[])).collect();
    let value = |place: [mechc_expr::ExprId; 2]| place.map(|id| (1e9 * system.value_at(id, &q)).round() / 1e9);
    let places = system.declarations().iter().filter_map(|of| of.at).map(value).collect();
    let directions = system.axes().iter().map(|axis| value(axis.direction)).collect();
    let radii = system.circles().iter().map(|circle| system.value_at(circle.radius, &[])).collect();
    (places, directions, radii)
}

#[test]
fn joints_take_hold_of_their_second_features() {
    let (places, directions, radii) = features(
        "mechanism machine {
            ground { point O = (0, 0)  point A = (50 mm, 0)  axis rail = O along (3, 4) }
            body wheel { point O = (0, 0)  circle rim = O radius 20 mm }
            body pinion at (50 mm, 0, 90 deg) { point O = (0, 0)  circle rim = O radius 30 mm }
            body slider at (30 mm, 40 mm, 0) { point O = (0, 0)  point P = (5 mm, 0)  axis rail = O along (3, 4) }
            joint first: revolute(ground.O, wheel.O)
            joint second: revolute(ground.A, pinion.O)
            joint mesh: gear(wheel.rim, pinion.rim)
            joint slide: translational(ground.rail, slider.rail)
            driver motor: rotation(first) = 1 rad/s * t
            driver push: displacement(slide) = 50 mm
        }",
    );
    assert_eq!(places, [[0.0, 0.0], [0.05, 0.0], [0.05, 0.0], [0.03, 0.04]]);
    assert_eq!(directions, [[0.6, 0.8], [0.6, 0.8]]);
    assert_eq!(radii, [0.02, 0.03]);
}

#[test]
fn contacts_are_located_where_they_touch() {
    let (places, ..) = features(
        "mechanism machine {
            ground { point O = (0, 0)  axis up = O along (0, 1) }
            body cam { point O = (0, 0)  point C = (5 mm, 0)  circle rim = C radius 20 mm }
            body tappet at (0, 20 mm, 0) { point O = (0, 0)  axis up = O along (0, 1)  axis face = O along (1, 0) }
            joint shaft: revolute(ground.O, cam.O)
            joint guide: translational(ground.up, tappet.up)
            joint touch: flat_follower(cam.rim, tappet.face)
            driver motor: rotation(shaft) = 1 rad/s * t
        }",
    );
    assert_eq!(places[2].map(f64::to_bits), [0.005, 0.02].map(f64::to_bits));
}

#[test]
fn mirrored_features_stay_in_body_frames() {
    let (places, directions, _) = features(
        "mechanism arm {
            ground { point O = (0, 0)  axis up = O along (0, 1) }
            body slider { point O = (0, 0)  axis up = O along (0, 1) }
            joint guide: translational(ground.up, slider.up)
            driver push: displacement(guide) = 10 mm
        }
        mechanism machine {
            part left: arm() on ground at (30 mm, 0, 90 deg) mirrored
            measure height = x(left.slider.O)
        }",
    );
    assert_eq!(places.len(), 1);
    assert_eq!(directions, [[1.0, 0.0], [0.0, -1.0]]);
}
