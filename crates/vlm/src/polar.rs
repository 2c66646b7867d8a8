//! Drag polar of a section (`CDCL`): parabolas through three points, a steep rise beyond the outer two.

use albatross_avl::geometry::DragPolar;

/// Rise of drag past stall: `RISE` at `REACH` beyond the stall's lift coefficient, growing with its square.
const RISE: f64 = 0.05;
const REACH: f64 = 0.2;

/// Drag coefficient and its slope at a lift coefficient.
pub(crate) fn drag_of_lift(polar: &DragPolar, cl: f64) -> (f64, f64) {
    let [cl1, cl0, cl2] = polar.cl;
    let [cd1, cd0, cd2] = polar.cd;
    let (cl_end, cd_end) = if cl < cl0 { (cl1, cd1) } else { (cl2, cd2) };
    let width = cl_end - cl0;
    if width == 0.0 {
        return (cd0, 0.0);
    }
    let curvature = (cd_end - cd0) / (width * width);
    let beyond = (cl - cl_end) / REACH;
    if beyond * width > 0.0 {
        // The parabola's tangent goes on, so the slope does not jump at stall.
        let slope = 2.0 * curvature * width;
        (
            cd_end + slope * (cl - cl_end) + RISE * beyond * beyond,
            slope + 2.0 * RISE * beyond / REACH,
        )
    } else {
        let d = cl - cl0;
        (cd0 + curvature * d * d, 2.0 * curvature * d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_polar_meets_its_points_with_a_continuous_slope() {
        let polar = DragPolar {
            cl: [-0.5, 0.2, 1.2],
            cd: [0.02, 0.006, 0.03],
        };
        for (cl, cd) in polar.cl.iter().zip(polar.cd) {
            assert!((drag_of_lift(&polar, *cl).0 - cd).abs() < 1e-15);
            let (below, above) = (drag_of_lift(&polar, cl - 1e-9), drag_of_lift(&polar, cl + 1e-9));
            assert!((below.1 - above.1).abs() < 1e-7);
        }
    }
}
