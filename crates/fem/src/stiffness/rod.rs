//! CROD and CONROD: tension and torsion between two grids.

use nalgebra::{Matrix3, Matrix6};

use super::{GridPair, Stiffness};
use crate::context::Context;
use crate::error::Error;
use crate::stiffness::section::moduli;

pub(super) fn add(context: &Context<'_>, stiffness: &mut Stiffness) -> Result<(), Error> {
    let mut rods = Vec::new();
    for rod in context.deck.rods.values() {
        let p = context.deck.rod_properties.get(&rod.pid);
        let p = p.ok_or_else(|| context.missing("CROD", rod.id, format!("PROD {}", rod.pid)))?;
        rods.push(("CROD", rod.id, rod.grids, p.mid, p.area, p.torsion_constant));
    }
    for rod in context.deck.conrods.values() {
        rods.push((
            "CONROD",
            rod.id,
            rod.grids,
            rod.mid,
            rod.area,
            rod.torsion_constant,
        ));
    }
    for (name, id, [a, b], mid, area, torsion) in rods {
        let (e, g) = moduli(context, name, id, mid)?;
        let vector = context.grid(name, id, b)?.position - context.grid(name, id, a)?.position;
        let length = vector.norm();
        let axis = vector.try_normalize(0.0).ok_or_else(|| {
            context.bad_element(
                name,
                id,
                format!("its length between grids {a} and {b} is {length} m; correct the grids"),
            )
        })?;
        let along: Matrix3<f64> = axis * axis.transpose();
        let mut block = Matrix6::zeros();
        block
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&(along * (e * area / length)));
        block
            .fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&(along * (g * torsion / length)));
        if !block.iter().all(|k| k.is_finite()) {
            return Err(context.bad_element(
                name,
                id,
                "its stiffness is not finite; correct the numbers on its cards",
            ));
        }
        stiffness.pairs.push(GridPair {
            a,
            b: Some(b),
            blocks: [block, -block, block],
        });
    }
    Ok(())
}
