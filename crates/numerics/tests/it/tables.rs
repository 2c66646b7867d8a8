use albatross_numerics::interp::{Interpolant, Method};
use proptest::collection::vec;
use proptest::prelude::*;

const METHODS: [Method; 4] = [Method::Linear, Method::Pchip, Method::Cubic, Method::Akima];

fn table() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
    vec((0.01..3.0_f64, -5.0..5.0_f64), 2..15).prop_map(|pairs| {
        let mut at = -4.0;
        pairs
            .into_iter()
            .map(|(step, y)| {
                at += step;
                (at, y)
            })
            .unzip()
    })
}

proptest! {
    #[test]
    fn prop_tables_are_met_and_joined_smoothly((x, y) in table()) {
        for method in METHODS {
            let f = Interpolant::new(method, &x, &y).unwrap();
            let size = y.iter().fold(1.0_f64, |m, v| m.max(v.abs()));
            // Terms of a cubic grow so where a short step meets a long one, and cancel to rounding.
            let steps = || x.windows(2).map(|w| w[1] - w[0]);
            let (shortest, longest) = (steps().fold(f64::MAX, f64::min), steps().fold(0.0, f64::max));
            let terms = size / shortest * longest * (longest / shortest);
            for (x, y) in x.iter().zip(&y) {
                prop_assert!((f.eval(*x) - y).abs() < 1e-12 * size + 4.0 * f64::EPSILON * terms);
            }
            for w in x[1..x.len() - 1].iter() {
                // Value from the left, extrapolated over one rounding.
                let left = w - 1e-12;
                prop_assert!((f.eval(left) - f.eval(*w)).abs() < 1e-6 * (1.0 + f.derivative(left).abs()));
                if method != Method::Linear {
                    let curvature = (f.derivative(left) - f.derivative(left - 1e-4)).abs() / 1e-4;
                    prop_assert!((f.derivative(left) - f.derivative(*w)).abs() < 1e-9 * (1.0 + curvature) * size);
                }
            }
        }
    }

    #[test]
    fn prop_slope_is_the_derivative_of_the_value((x, y) in table(), at in 0.0..1.0_f64) {
        for method in METHODS {
            let f = Interpolant::new(method, &x, &y).unwrap();
            let (low, high) = f.range();
            let (at, h) = (low + at * (high - low), 1e-5);
            let inside = x.iter().all(|x| (x - at).abs() > 2.0 * h);
            if inside {
                let difference = (f.eval(at + h) - f.eval(at - h)) / (2.0 * h);
                let third = 1e-10 * (1.0 + (f.derivative(at + h) - f.derivative(at - h)).abs() / h / h);
                prop_assert!((difference - f.derivative(at)).abs() < 1e-6 * (1.0 + difference.abs()) + third);
            }
        }
    }
}
