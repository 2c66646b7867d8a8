//! Distribution of elements along chord, span and bodies.
//!
//! AVL's parameter runs from -3 to 3: 0 and +-3 uniform, +-1 cosine, 2 sine with dense points at the start, -2 dense
//! at the end, blended linearly between whole numbers (AVL User Primer, "Vortex Lattice Spacing Distributions").

use std::f64::consts::{FRAC_PI_2, PI};

/// Weights of the uniform, cosine and sine distributions.
fn blend(parameter: f64) -> [f64; 3] {
    let p = parameter.abs();
    if p <= 1.0 {
        [1.0 - p, p, 0.0]
    } else if p <= 2.0 {
        [0.0, 2.0 - p, p - 1.0]
    } else if p <= 3.0 {
        [p - 2.0, 0.0, 3.0 - p]
    } else {
        [1.0, 0.0, 0.0]
    }
}

/// Sum of the three distributions at a uniform fraction and at the angles of the cosine and sine ones.
fn place(parameter: f64, uniform: f64, cosine_angle: f64, sine_angle: f64) -> f64 {
    let [equal, cosine, sine] = blend(parameter);
    let one_sided = if parameter >= 0.0 {
        1.0 - sine_angle.cos()
    } else {
        sine_angle.sin()
    };
    equal * uniform + cosine * 0.5 * (1.0 - cosine_angle.cos()) + sine * one_sided
}

/// `n` points from 0 to 1.
pub(crate) fn points(n: usize, parameter: f64) -> Vec<f64> {
    let last = n.saturating_sub(1).max(1) as f64;
    let mut out: Vec<f64> = (0..n)
        .map(|k| {
            let fraction = k as f64 / last;
            place(parameter, fraction, PI * fraction, FRAC_PI_2 * fraction)
        })
        .collect();
    if let [first, .., last] = out.as_mut_slice() {
        *first = 0.0;
        *last = 1.0;
    }
    out
}

/// Chordwise stations of one element, in x/c.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChordStation {
    /// Leading edge of the element.
    pub(crate) x_front: f64,
    /// Trailing edge of the element.
    pub(crate) x_rear: f64,
    /// Bound vortex, a quarter of the way for uniform spacing.
    pub(crate) x_vortex: f64,
    /// Control point, three quarters of the way for a lift slope of 2 pi.
    pub(crate) x_control: f64,
}

/// Stations of `n` elements along a chord for a lift slope of `claf` times 2 pi.
///
/// Quarter steps of the distribution's angle put vortex and control point where a thin aerofoil's lift is exact for
/// any number of elements; `claf` moves the control point only.
pub(crate) fn chord_stations(n: usize, parameter: f64, claf: f64) -> Vec<ChordStation> {
    let n_f = n as f64;
    let (cosine_step, sine_step) = (PI / (4.0 * n_f + 2.0), FRAC_PI_2 / (4.0 * n_f + 1.0));
    let at = |quarters: f64| {
        place(
            parameter,
            quarters / (4.0 * n_f),
            cosine_step * (quarters + 1.0),
            sine_step * (quarters + 1.0),
        )
    };
    (0..n)
        .map(|i| {
            let start = 4.0 * i as f64;
            ChordStation {
                x_front: if i == 0 { 0.0 } else { at(start) },
                x_rear: if i + 1 == n { 1.0 } else { at(start + 4.0) },
                x_vortex: at(start + 1.0),
                x_control: at(start + 1.0 + 2.0 * claf),
            }
        })
        .collect()
}

/// Moves the edges of strips so that every station of `sections` (arc lengths, first and last included) is an edge.
///
/// Edges and centres between two neighbouring sections are stretched linearly. `None` when there are too few
/// strips for that.
pub(crate) fn snap_to_sections(edges: &mut [f64], centres: &mut [f64], sections: &[f64]) -> Option<()> {
    let nearest = |s: f64| {
        edges
            .iter()
            .enumerate()
            .min_by(|a, b| (a.1 - s).abs().total_cmp(&(b.1 - s).abs()))
            .map(|(k, _)| k)
    };
    let mut at: Vec<usize> = sections.iter().map(|&s| nearest(s)).collect::<Option<_>>()?;
    *at.first_mut()? = 0;
    *at.last_mut()? = edges.len().checked_sub(1)?;
    if at.windows(2).any(|w| w[0] >= w[1]) {
        return None;
    }
    let old = edges.to_vec();
    for (w, s) in at.windows(2).zip(sections.windows(2)) {
        let (from, to) = (old[w[0]], old[w[1]]);
        let scale = (s[1] - s[0]) / (to - from);
        for k in w[0]..=w[1] {
            edges[k] = s[0] + scale * (old[k] - from);
        }
        for c in &mut centres[w[0]..w[1]] {
            *c = s[0] + scale * (*c - from);
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_lumped_vortices_sum_to_thin_aerofoil_lift_for_any_spacing_angle() {
        // One element: vortex at c/4, control point at 3c/4.
        let s = chord_stations(1, 1.0, 1.0)[0];
        assert!((s.x_vortex - 0.25).abs() < 1e-15 && (s.x_control - 0.75).abs() < 1e-15);
        let s = chord_stations(4, 0.0, 1.0)[1];
        assert_eq!(
            (s.x_front, s.x_rear, s.x_vortex, s.x_control),
            (0.25, 0.5, 0.3125, 0.4375)
        );
    }

    #[test]
    fn val_blends_end_at_one_and_increase() {
        for parameter in [
            -3.0, -2.5, -2.0, -1.3, -1.0, 0.0, 0.4, 1.0, 1.7, 2.0, 2.2, 3.0, 5.0,
        ] {
            let p = points(9, parameter);
            assert_eq!((p[0], p[8]), (0.0, 1.0));
            assert!(p.windows(2).all(|w| w[1] > w[0]), "{parameter}: {p:?}");
        }
        assert!(points(9, 2.0)[1] < 0.125 && points(9, -2.0)[7] > 0.875);
    }

    #[test]
    fn regress_edges_meet_sections() {
        let mut edges = points(11, 0.0);
        let mut centres: Vec<f64> = edges.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
        assert!(snap_to_sections(&mut edges, &mut centres, &[0.0, 0.33, 1.0]).is_some());
        assert!((edges[3] - 0.33).abs() < 1e-15 && edges[10] == 1.0);
        assert!(
            edges
                .windows(2)
                .zip(&centres)
                .all(|(w, c)| w[0] < *c && *c < w[1])
        );
        assert!(snap_to_sections(&mut [0.0, 1.0], &mut [0.5], &[0.0, 0.4, 1.0]).is_none());
    }
}
