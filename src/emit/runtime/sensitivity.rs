//# if !led
/// The derivatives of the coordinates by each parameter, by the numbers in [`param`], at the
/// position that some parameters have next to that of a state; mostly the state's own. After
/// [`step`] what the text's formulas of inputs make of a parameter counts as well.
//# end
//# if led
/// As [`super::sensitivity`], where inputs have led: they stay what they are.
//# end
///
//# if left_out
/// Where a parameter alone cannot change, because an equation that was left out would cease to hold,
/// its derivatives are `NAN`.
///
//# end
/// # Errors
/// Why there are none: with these parameters there is no such position.
pub fn sensitivity(params: &Params, state: &State) -> Result<[Q; PARAMS], Error> {
    if !params.is_finite() {
        return Err(Error::NotANumber);
    }
//# if inputs
    if state.is_led {
        return following::sensitivity(params, state);
    }
//# end
//# if !led
    let (model, from) = (Model::new(params), state.at());
//# end
//# if led
    let way = Way {
        params: *params,
        ..state.led.model.way.clone()
    };
    let (model, from) = (Model::new(&way), state.led.at());
//# end
    by_params(&model, from)
}

/// What [`sensitivity`] gives, next to a solution.
fn by_params(m: &Model, from: &Solution) -> Result<[Q; PARAMS], Error> {
//# if sides
    let sides = &from.sides;
//# end
    let (mut at, mut by) = (from.clone(), [[0.0; N]; PARAMS]);
    solve_by_params(&tears(&from.q), from.t, m$sides, &mut at, &mut by);
    if !at.is_settled || !at.holds {
//# if pivoting
        at = solve_with_pivoting(&from.q, from.t, m$sides).map_err(Fault::at_start)?;
        let mut elimination = Elimination::new();
        let slopes = $phi_q(&at.q, from.t, &m.params$sides);
        let rights = rights_by_param(&at.q, from.t, &m.params$sides);
        for (by, right) in by.iter_mut().zip(&rights) {
            *by = elimination.solve(&slopes, right).0.map(|x| x + 0.0);
        }
//# end
//# if !pivoting
        return Err(at.fault().at_start());
//# end
    }
    if by.iter().flatten().all(|value| value.is_finite()) {
//# if left_out
        hold_apart_by_param(&mut by, &at.q, from.t, &m.params$sides);
//# end
        Ok(by)
    } else {
        Err(Error::NotANumber)
    }
}

