//! As many four-bars as are wanted, as text.

/// The four-bar of `tests/cases/four_bar.mech`, so many times, each with a ground of its own.
pub fn four_bars(n: usize) -> String {
    let mut text = "mechanism four_bars {\n    ground {\n".to_owned();
    // in rows of a hundred: no floor is a hundred kilometres long
    let places: Vec<[usize; 2]> = (0..n).map(|k| [5 * (k % 100), 5 * (k / 100)]).collect();
    for (k, [x, y]) in places.iter().enumerate() {
        text += &format!("        point A{k} = ({x}, {y})\n        point B{k} = ({}, {y})\n", x + 4);
    }
    text += "    }\n";
    for (k, [x, y]) in places.iter().map(|place| place.map(|x| x as f64)).enumerate() {
        text += &format!(
            "    body crank{k} at ({x}, {y}, 0.5) {{ point A = (0, 0) point C = (1, 0) }}\n    \
             body coupler{k} at ({}, {}, 0.78) {{ point C = (0, 0) point D = (3.5, 0) }}\n    \
             body rocker{k} at ({}, {}, 1.8) {{ point B = (-1.5, 0) point D = (1.5, 0) }}\n    \
             joint main{k}: revolute(ground.A{k}, crank{k}.A)\n    \
             joint pin{k}: revolute(crank{k}.C, coupler{k}.C)\n    \
             joint knee{k}: revolute(coupler{k}.D, rocker{k}.D)\n    \
             joint pivot{k}: revolute(ground.B{k}, rocker{k}.B)\n    \
             driver motor{k}: rotation(main{k}) = 0.5 + 2 * t\n",
            x + 0.88,
            y + 0.48,
            x + 3.7,
            y + 1.5,
        );
    }
    text + "    analysis from 0 to pi every 0.01\n}\n"
}
