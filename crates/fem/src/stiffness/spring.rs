//! CELAS1, CELAS2 and CBUSH.

use albatross_nastran::deck::{Cbush, Orientation, ScalarSpringValue};
use nalgebra::{Matrix3, Matrix6, Vector3};

use super::{GridPair, ScalarPair, Stiffness};
use crate::context::Context;
use crate::dofs::Freedoms;
use crate::error::Error;
use crate::rigid::{rigid_transfer, rotation_blocks};

pub(super) fn add(
    context: &Context<'_>,
    freedoms: &Freedoms,
    stiffness: &mut Stiffness,
) -> Result<(), Error> {
    for spring in context.deck.springs.values() {
        let (name, k) = match spring.value {
            ScalarSpringValue::Value { k, .. } => ("CELAS2", k),
            ScalarSpringValue::Property(pid) => {
                let p = context.deck.spring_properties.get(&pid);
                let p = p.ok_or_else(|| context.missing("CELAS1", spring.id, format!("PELAS {pid}")))?;
                ("CELAS1", p.k)
            }
        };
        if !k.is_finite() {
            return Err(context.bad_element(name, spring.id, format!("its stiffness is {k}")));
        }
        let mut ends = [None; 2];
        for (end, at) in ends.iter_mut().zip(&spring.ends) {
            *end = scalar_end(context, freedoms, (name, spring.id), at)?;
        }
        stiffness.scalars.push(ScalarPair { ends, value: k });
    }
    for bush in context.deck.bushes.values() {
        let pair = bush_pair(context, bush)?;
        stiffness.pairs.push(pair);
    }
    Ok(())
}

/// The freedom that an end of a scalar element names; `None` is the ground.
pub(crate) fn scalar_end(
    context: &Context<'_>,
    freedoms: &Freedoms,
    (name, id): (&str, albatross_nastran::deck::Id),
    end: &albatross_nastran::deck::ScalarEnd,
) -> Result<Option<usize>, Error> {
    if end.point == 0 {
        return Ok(None);
    }
    if freedoms.point(end.point).is_none() {
        return Err(context.missing(name, id, format!("point {}", end.point)));
    }
    let freedom = freedoms.index(end.point, end.component);
    freedom.map(Some).ok_or_else(|| {
        context.bad_element(
            name,
            id,
            format!(
                "component {} of point {} does not exist; grids have 1 to 6, scalar points 0",
                end.component, end.point
            ),
        )
    })
}

fn bush_pair(context: &Context<'_>, bush: &Cbush) -> Result<GridPair, Error> {
    let id = bush.id;
    let bad = |problem: String| context.bad_element("CBUSH", id, problem);
    let p = context.deck.bush_properties.get(&bush.pid);
    let p = p.ok_or_else(|| context.missing("CBUSH", id, format!("PBUSH {}", bush.pid)))?;
    let k = p.k.unwrap_or_default().map(|k| k.unwrap_or(0.0));
    if !k.iter().all(|k| k.is_finite()) {
        return Err(bad(format!(
            "the stiffnesses of PBUSH {} are not finite",
            bush.pid
        )));
    }
    let [a, b] = bush.grids;
    let at_a = context.grid("CBUSH", id, a)?.position;
    let at_b = match b {
        0 => None,
        b => Some(context.grid("CBUSH", id, b)?.position),
    };
    let line = at_b.unwrap_or(at_a) - at_a;
    let center = match bush.offset_cid {
        Some(cid) => at_a + context.axes("CBUSH", id, cid, at_a)? * Vector3::from(bush.offset),
        None => at_a + line * bush.location,
    };
    let axes = bush_axes(context, bush, line, center, k)?;
    let turn = rotation_blocks(&axes);
    let springs = turn * Matrix6::from_diagonal(&k.into()) * turn.transpose();
    let ea = rigid_transfer(center - at_a);
    let eb = at_b.map_or_else(Matrix6::identity, |at_b| rigid_transfer(center - at_b));
    Ok(GridPair {
        a,
        b: (b != 0).then_some(b),
        blocks: [
            ea.transpose() * springs * ea,
            -ea.transpose() * springs * eb,
            eb.transpose() * springs * eb,
        ],
    })
}

/// The element frame: CID; or x along the line between the grids with the orientation vector in the x-y plane; or,
/// when only K1 and K4 act, x along the line alone.
fn bush_axes(
    context: &Context<'_>,
    bush: &Cbush,
    line: Vector3<f64>,
    center: Vector3<f64>,
    k: [f64; 6],
) -> Result<Matrix3<f64>, Error> {
    let bad = |problem: &str| context.bad_element("CBUSH", bush.id, problem);
    if let Some(cid) = bush.cid {
        return context.axes("CBUSH", bush.id, cid, center);
    }
    let x = line
        .try_normalize(0.0)
        .ok_or_else(|| bad("its grids coincide or it is grounded, and CID is blank; give CID"))?;
    let grid = context.grid("CBUSH", bush.id, bush.grids[0])?;
    let v = match &bush.orientation {
        Some(Orientation::Grid(g0)) => context.grid("CBUSH", bush.id, *g0)?.position - grid.position,
        Some(Orientation::Vector(v)) => grid.axes * Vector3::from(*v),
        None => {
            let [_, k2, k3, _, k5, k6] = k;
            if [k2, k3, k5, k6] != [0.0; 4] {
                return Err(bad(
                    "it has neither CID nor an orientation vector, but stiffness across its axis; give one of them",
                ));
            }
            // Any direction across: the one of the smallest component of x.
            Vector3::ith(x.iamin(), 1.0)
        }
    };
    let z = x.cross(&v);
    if z.norm() <= 1e-8 * v.norm() {
        return Err(bad(
            "its orientation vector is zero or along the element; choose one across it",
        ));
    }
    let z = z.normalize();
    Ok(Matrix3::from_columns(&[x, z.cross(&x), z]))
}
