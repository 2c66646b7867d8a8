//! Derivatives of the flexible aircraft in slow motion: static ones, and those with the elevator's rate.

use super::LAGGED;
use crate::error::Error;
use crate::validate::reference::{Reference, RigidFlexible};
use crate::validate::study::{AVL, CORRECTED, Study, Variant, control_index};
use albatross::Model;
use albatross::analysis::Trimmed;
use albatross::numerics::{Mat, solve};
use albatross::report::{Cell, Column, Format, Table};
use albatross::strip::Flow;
use albatross::strip::kernels::JONES;

/// A longitudinal variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cause {
    Incidence,
    PitchRate,
    Elevator,
}

pub(super) const CAUSES: [Cause; 3] = [Cause::Incidence, Cause::PitchRate, Cause::Elevator];

impl Cause {
    pub(super) fn of(self, reference: &Reference) -> RigidFlexible {
        let all = reference.derivatives.static_aeroelastic;
        match self {
            Self::Incidence => all.alpha,
            Self::PitchRate => all.q,
            Self::Elevator => all.de,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Incidence => "α",
            Self::PitchRate => "q c/2V",
            Self::Elevator => "elevator",
        }
    }
}

/// Derivatives of lift and pitching moment with the elastic deformation in equilibrium:
/// `(K - rho V^2 Q_eta) eta = q S c Q`, and the loads of `eta` added to the rigid aircraft's.
pub(super) fn flexible(model: &Model, trimmed: &Trimmed, cause: Cause) -> Result<[f64; 2], Error> {
    let aircraft = &model.aircraft;
    let elevator = control_index(&aircraft.controls, &model.point.control)?;
    let of = |c: &albatross::flight::aerodynamics::Coefficient| match cause {
        Cause::Incidence => c.alpha,
        Cause::PitchRate => c.q_hat,
        Cause::Elevator => c.controls.get(elevator).copied().unwrap_or(0.0),
    };
    let rigid = [of(&aircraft.rigid.lift), of(&aircraft.rigid.pitch)];
    let Some(elastic) = &aircraft.elastic else {
        return Ok(rigid);
    };
    let (area, chord) = (aircraft.reference.area, aircraft.reference.chord);
    let (rho, speed) = (trimmed.trim.density, trimmed.trim.speed());
    let pressure = 0.5 * rho * speed.powi(2);
    let (matrix, column) = match cause {
        Cause::Incidence => (&elastic.q_x, 0),
        Cause::PitchRate => (&elastic.q_x, 3),
        Cause::Elevator => (&elastic.q_u, elevator),
    };
    let load = Mat::from_fn(matrix.nrows(), 1, |k, _| {
        pressure * area * chord * matrix[(k, column)]
    });
    let stiffness = elastic
        .model
        .static_stiffness(Flow { rho, speed })
        .map_err(albatross::flight::Error::from)?;
    let eta = solve::solve(stiffness.as_ref(), load.as_ref())?;
    // Rows: forces x, y, z (down), moments x, y, z.
    let loads = &elastic.rigid_rows.eta_eta() * &eta * albatross::numerics::faer::Scale(rho * speed.powi(2));
    Ok([
        rigid[0] - loads[(2, 0)] / (pressure * area),
        rigid[1] + loads[(4, 0)] / (pressure * area * chord),
    ])
}

/// Static derivatives: rigid, and with the deformation in equilibrium.
pub(super) fn static_table(study: &Study) -> Result<Table, Error> {
    let number = |name: &str, group: &str| Column::new(name, "", Format::Fixed(4)).in_group(group);
    let mut table = Table::new(
        "Static aeroelastic derivatives",
        [
            Column::text("derivative"),
            Column::text("with"),
            number("rigid", "reference"),
            number("flexible", "reference"),
            number("flexible", "AVL only"),
            number("flexible", "corrected"),
            Column::new("relief, reference", "%", Format::Fixed(1)),
            Column::new("relief, corrected", "%", Format::Fixed(1)),
        ],
    )
    .with_caption(
        "Per rad and per q c/2V. The corrected model has the rigid derivatives of the reference. Relief is what the \
         deformation takes off the rigid value.",
    );
    let (avl, corrected) = (study.variant(AVL)?, study.variant(CORRECTED)?);
    for cause in CAUSES {
        let wanted = cause.of(&study.reference);
        let avl = flexible(&avl.model, &avl.trimmed, cause)?;
        let corrected = flexible(&corrected.model, &corrected.trimmed, cause)?;
        for (i, name, rigid, flex) in [
            (0, "CL", wanted.rigid_CL, wanted.flex_CL),
            (1, "Cm", wanted.rigid_Cm, wanted.flex_Cm),
        ] {
            table.push([
                Cell::from(name),
                cause.name().into(),
                rigid.into(),
                flex.into(),
                avl[i].into(),
                corrected[i].into(),
                (100.0 * (1.0 - flex / rigid)).into(),
                (100.0 * (1.0 - corrected[i] / rigid)).into(),
            ])?;
        }
    }
    Ok(table)
}

/// Derivatives with the elevator's rate at low frequency. A strip's lift `k w` through lags `A_i s b/(s b - a_i)` is
/// `k (w + w' b/V sum A_i/(-a_i))` for slow motion.
fn elevator_rate(variant: &Variant) -> Result<[f64; 2], Error> {
    let Some(elastic) = &variant.model.aircraft.elastic else {
        return Ok([0.0; 2]);
    };
    let (shape, mass) = (&variant.model.aircraft.reference, &variant.model.mass);
    let elevator = control_index(&variant.model.aircraft.controls, &variant.model.point.control)?;
    let per_semi_chord: f64 = JONES.iter().map(|lag| -lag.gain / lag.rate).sum();
    let mut rate = [0.0; 2];
    for (j, strip) in elastic.model.strips.iter().enumerate() {
        let incidence = elastic.control_incidence[(j, elevator)];
        let lift = strip.cl_alpha * incidence * strip.chord * strip.width / shape.area;
        // Time in units of c/2V of the aircraft; b/V of the strip is its chord's.
        let late = lift * per_semi_chord * strip.chord / shape.chord;
        rate[0] += late;
        rate[1] += late * (mass.cg[0] - strip.x_ac) / shape.chord;
    }
    Ok(rate)
}

pub(super) fn elevator_rate_table(study: &Study) -> Result<Table, Error> {
    let number = |name: &str| Column::new(name, "", Format::Fixed(3));
    let mut table = Table::new(
        "Derivatives with the elevator's rate, δ' c/2V, at low frequency",
        [
            Column::text("derivative"),
            number("reference"),
            number("corrected"),
            number("corrected, lagged elevator"),
        ],
    )
    .with_caption(
        "Lift that lags makes the derivative of lift negative and that of pitching moment positive. The reference's hold \
         its hinge rate and its apparent mass, which lead.",
    );
    let reference = &study.reference.derivatives;
    let lagged = elevator_rate(study.variant(LAGGED)?)?;
    for (name, reference, lagged) in [
        ("CL", reference.CLde_dot_low_frequency, lagged[0]),
        ("Cm", reference.Cmde_dot_low_frequency, lagged[1]),
    ] {
        table.push([Cell::from(name), reference.into(), Cell::from(0.0), lagged.into()])?;
    }
    Ok(table)
}
