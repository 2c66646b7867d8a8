//! Mode shapes in space: the elements of the deck and the strips, as the model moves them.

use crate::inputs::Inputs;
use crate::model::Model;
use albatross_modal::ModalBasis;
use albatross_nastran::Deck;
use albatross_report::html::{Shape, Shapes};
use std::collections::BTreeMap;

/// The modes of a structure, its one-dimensional and rigid elements as lines.
pub fn of_structure(deck: &Deck, basis: &ModalBasis) -> Shapes {
    let grids = &basis.grids;
    let place: BTreeMap<u32, usize> = grids.iter().enumerate().map(|(i, g)| (g.id, i)).collect();
    let lines = connections(deck)
        .into_iter()
        .filter_map(|[a, b]| Some([*place.get(&a)?, *place.get(&b)?]))
        .collect();
    let shapes = basis.modes.iter().enumerate();
    let shapes = shapes.map(|(k, mode)| Shape {
        name: format!("{}: {:.3} Hz", k + 1, mode.frequency_hz),
        displacement: mode.shape.iter().map(|&[x, y, z, ..]| [x, y, z]).collect(),
    });
    Shapes {
        title: "Mode shapes".into(),
        points: grids.iter().map(|g| g.position).collect(),
        lines,
        faces: Vec::new(),
        shapes: shapes.collect(),
    }
}

/// The structural modes of a model with its one-dimensional elements as lines and its strips as quadrilaterals.
///
/// A strip turns about its load reference axis and keeps its chord straight, as in the model: a surface that takes no part
/// in the strip theory stands still. The quadrilateral follows the sweep of the quarter chord.
pub fn mode_shapes(inputs: &Inputs, model: &Model) -> Shapes {
    let mut shapes = of_structure(&inputs.deck, &model.basis);
    let points = &mut shapes.points;
    let first_corner = points.len();
    let set = &model.strips;
    for record in &set.records {
        let (sin, cos) = record.dihedral_rad.sin_cos();
        let half = 0.5 * record.width;
        let aft = half * record.sweep_rad.tan();
        let [x, y, z] = record.leading_edge;
        let corner = |side: f64, x: f64| {
            [
                x + side * outwards(record.leading_edge[1]) * aft,
                y + side * half * cos,
                z + side * half * sin,
            ]
        };
        points.extend([
            corner(-1.0, x),
            corner(1.0, x),
            corner(1.0, x + record.chord),
            corner(-1.0, x + record.chord),
        ]);
    }
    shapes.faces = (0..set.records.len())
        .map(|j| std::array::from_fn(|corner| first_corner + 4 * j + corner))
        .collect();

    let form = inputs.case.aerodynamics.dihedral;
    let (phi, gamma) = (&set.shapes.phi, &set.shapes.gamma);
    let (strips, modes) = (phi.nrows().min(gamma.nrows()), phi.ncols().min(gamma.ncols()));
    for (k, shape) in shapes.shapes.iter_mut().enumerate().take(modes) {
        for (j, strip) in set.strips.iter().enumerate().take(strips) {
            let (vertical, lateral) = form.components(strip);
            let (phi, gamma) = (phi[(j, k)], gamma[(j, k)]);
            let corners = points.iter().skip(first_corner + 4 * j).take(4);
            shape.displacement.extend(corners.map(|corner| {
                let normal = phi - (corner[0] - strip.x_lra) * gamma;
                [0.0, -lateral * normal, vertical * normal]
            }));
        }
    }
    shapes
}

/// Sweep moves the outer edge aft, which is the right one on the right and on a fin.
fn outwards(y: f64) -> f64 {
    if y < 0.0 { -1.0 } else { 1.0 }
}

/// Pairs of grids that an element joins.
fn connections(deck: &Deck) -> Vec<[u32; 2]> {
    let bars = deck.bars.values().map(|e| e.grids);
    let beams = deck.beams.values().map(|e| e.grids);
    let rods = deck.rods.values().map(|e| e.grids);
    let conrods = deck.conrods.values().map(|e| e.grids);
    let rigid = deck.rbars.values().map(|e| e.grids);
    let stars = deck
        .rbe2
        .values()
        .flat_map(|e| e.dependents.iter().map(|d| [e.independent, *d]));
    bars.chain(beams)
        .chain(rods)
        .chain(conrods)
        .chain(rigid)
        .chain(stars)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn val_shapes_of_the_shipped_case() {
        let file = Path::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../fixtures/f25-like/case.toml"
        ));
        let inputs = Inputs::read(file).unwrap();
        let model = Model::build(&inputs, &inputs.case.variant(None).unwrap()).unwrap();
        let shapes = mode_shapes(&inputs, &model);
        assert_eq!(shapes.shapes.len(), 20);
        assert_eq!(shapes.faces.len(), 196);
        assert_eq!(shapes.points.len(), model.basis.grids.len() + 4 * 196);
        // Quadrilaterals of one strip after another make the wing: their spanwise ends meet, to the digits of the file.
        let of_wing: Vec<&[usize; 4]> = shapes.faces.iter().take(2).collect();
        let ends = |face: &[usize; 4]| (shapes.points[face[0]][1], shapes.points[face[1]][1]);
        let gap = (ends(of_wing[0]).1 - ends(of_wing[1]).0).abs();
        assert!(gap < 0.02, "{gap}");
        // The tip of the wing bends with the strip at it in the first mode.
        let tip = model.basis.grid_index(1025).unwrap();
        let (bent, outermost) = (
            shapes.shapes[0].displacement[tip][2],
            (0..196)
                .max_by(|a, b| model.strips.strips[*a].y.total_cmp(&model.strips.strips[*b].y))
                .unwrap(),
        );
        let corner = shapes.faces[outermost][0];
        let ratio = shapes.shapes[0].displacement[corner][2] / bent;
        assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
        // A shape that fits together is drawn.
        let mut section = albatross_report::html::Section::new("s");
        assert!(section.shapes(&shapes, "").is_ok());
    }
}
