//! A grillage of bars in the x-y plane, numbered at random.

use albatross_nastran::Deck;
use albatross_nastran::deck::{BarProperty, Cbar, Components, Grid, Id, Mat1, Orientation, Pbar};

pub(crate) const E: f64 = 7.0e10;
pub(crate) const STEP: f64 = 0.5;
/// Out-of-plane second moments of bars along x and along y.
pub(crate) const I_X: f64 = 4.0e-6;
pub(crate) const I_Y: f64 = 2.5e-6;
/// Mass per length of a bar.
pub(crate) const MU: f64 = 10.0;

/// `nx` by `ny` grids, `STEP` apart; bars on the edges have half of everything. With `torsion` = 0 bending in x and y
/// do not know of each other. `skew` turns the plane, so that no component of stiffness is zero.
pub(crate) fn grillage(nx: usize, ny: usize, torsion: f64, skew: bool) -> Deck {
    let mut deck = Deck::default();
    let mut numbers: Vec<Id> = (1..=(nx * ny) as Id).collect();
    // Fisher-Yates with a congruential generator.
    let mut state = 12345_u64;
    for i in (1..numbers.len()).rev() {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        numbers.swap(i, ((state >> 33) as usize) % (i + 1));
    }
    let turn = nalgebra::Rotation3::from_euler_angles(0.4, -0.3, 0.7);
    let place = |x: f64, y: f64, z: f64| -> [f64; 3] {
        let p = nalgebra::Vector3::new(x, y, z);
        if skew { (turn * p).into() } else { p.into() }
    };
    deck.materials.insert(
        1,
        Mat1 {
            id: 1,
            e: Some(E),
            g: Some(2.6e10),
            ..Mat1::default()
        },
    );
    for (id, factor, i_out) in [(1, 1.0, I_X), (2, 0.5, I_X), (3, 1.0, I_Y), (4, 0.5, I_Y)] {
        let bar = Pbar {
            id,
            mid: 1,
            area: 0.01 * factor,
            i1: i_out * factor,
            i2: 1e-3 * factor,
            torsion_constant: torsion * factor,
            nsm: MU * factor,
            ..Pbar::default()
        };
        deck.bar_properties.insert(id, BarProperty::Pbar(bar));
    }
    let at = |i: usize, j: usize| numbers[i * ny + j];
    let mut next = 0;
    let mut bar = |deck: &mut Deck, grids: [Id; 2], pid: Id| {
        next += 1;
        let bar = Cbar {
            id: next,
            pid,
            grids,
            orientation: Some(Orientation::Vector(place(0.0, 0.0, 1.0))),
            offset_frames: "GGG".into(),
            pins: [Components::NONE; 2],
            wa: [0.0; 3],
            wb: [0.0; 3],
        };
        deck.bars.insert(next, bar);
    };
    for i in 0..nx {
        for j in 0..ny {
            let id = at(i, j);
            let position = place(i as f64 * STEP, j as f64 * STEP, 0.0);
            deck.grids.insert(
                id,
                Grid {
                    id,
                    position,
                    ..Grid::default()
                },
            );
            if i + 1 < nx {
                bar(
                    &mut deck,
                    [id, at(i + 1, j)],
                    if j == 0 || j + 1 == ny { 2 } else { 1 },
                );
            }
            if j + 1 < ny {
                bar(
                    &mut deck,
                    [id, at(i, j + 1)],
                    if i == 0 || i + 1 == nx { 4 } else { 3 },
                );
            }
        }
    }
    deck
}
