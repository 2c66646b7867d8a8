//! Interpolation of tables y(x) with strictly increasing x.
//!
//! Every method is a piecewise polynomial of degree three or less in x - x_i, so value and slope cost one
//! search and a few products. Outside the table the end polynomials continue: a caller that must not
//! extrapolate compares with [`Interpolant::range`].

use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// How to connect the points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Straight lines.
    Linear,
    /// Monotone cubic Hermite interpolation (Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5, 1984): never
    /// overshoots the data.
    Pchip,
    /// Cubic spline with the not-a-knot end condition; the polynomial through the points when there are two
    /// or three.
    #[default]
    Cubic,
    /// Akima's cubic Hermite interpolation (J. ACM 17, 1970): local, little overshoot.
    Akima,
}

/// c0 + c1 t + c2 t^2 + c3 t^3 with t = x - x_i.
type Piece = [f64; 4];

/// A table prepared for evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct Interpolant {
    x: Vec<f64>,
    pieces: Vec<Piece>,
}

impl Interpolant {
    /// Prepares the table of `y` against strictly increasing `x`, two points or more.
    ///
    /// # Errors
    /// [`Error::Shape`] for unequal lengths, [`Error::TooFewPoints`], [`Error::NonFinite`],
    /// [`Error::NotIncreasing`] with the index of the offending abscissa.
    pub fn new(method: Method, x: &[f64], y: &[f64]) -> Result<Self> {
        check_table(x, y)?;
        let slopes = secants(x, y);
        let pieces = match method {
            Method::Linear => slopes.iter().zip(y).map(|(&s, &y)| [y, s, 0.0, 0.0]).collect(),
            Method::Pchip => hermite(x, y, &slopes, &pchip_derivatives(x, &slopes)),
            Method::Cubic => hermite(x, y, &slopes, &not_a_knot_derivatives(x, &slopes)),
            Method::Akima => hermite(x, y, &slopes, &akima_derivatives(&slopes)),
        };
        Ok(Self {
            x: x.to_vec(),
            pieces,
        })
    }

    /// First and last abscissa.
    pub fn range(&self) -> (f64, f64) {
        (self.x[0], self.x[self.x.len() - 1])
    }

    /// Value at `x`; NaN for NaN.
    pub fn eval(&self, x: f64) -> f64 {
        let (t, [c0, c1, c2, c3]) = self.locate(x);
        c0 + t * (c1 + t * (c2 + t * c3))
    }

    /// First derivative at `x` (from the right at a point of the table).
    pub fn derivative(&self, x: f64) -> f64 {
        let (t, [_, c1, c2, c3]) = self.locate(x);
        c1 + t * (2.0 * c2 + t * 3.0 * c3)
    }

    fn locate(&self, x: f64) -> (f64, Piece) {
        let i = self.x.partition_point(|&xi| xi <= x).clamp(1, self.pieces.len()) - 1;
        (x - self.x[i], self.pieces[i])
    }
}

fn check_table(x: &[f64], y: &[f64]) -> Result<()> {
    crate::matrix::check_shape("the ordinates", (y.len(), 1), (x.len(), 1))?;
    if x.len() < 2 {
        return Err(Error::TooFewPoints {
            what: "an interpolation table",
            needed: 2,
            found: x.len(),
        });
    }
    for (what, values) in [("the abscissae", x), ("the ordinates", y)] {
        if let Some(row) = values.iter().position(|v| !v.is_finite()) {
            return Err(Error::NonFinite { what, row, col: 0 });
        }
    }
    match x.windows(2).position(|w| w[1] <= w[0]) {
        Some(i) => Err(Error::NotIncreasing {
            index: i + 1,
            previous: x[i],
            found: x[i + 1],
        }),
        None => Ok(()),
    }
}

fn secants(x: &[f64], y: &[f64]) -> Vec<f64> {
    x.windows(2)
        .zip(y.windows(2))
        .map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0]))
        .collect()
}

/// Cubic pieces from values and first derivatives at the points.
fn hermite(x: &[f64], y: &[f64], slopes: &[f64], d: &[f64]) -> Vec<Piece> {
    (0..slopes.len())
        .map(|i| {
            let h = x[i + 1] - x[i];
            let curvature = (d[i] + d[i + 1] - 2.0 * slopes[i]) / h;
            [y[i], d[i], (slopes[i] - d[i]) / h - curvature, curvature / h]
        })
        .collect()
}

/// Weighted harmonic means inside, three-point formula limited for monotony at the ends.
fn pchip_derivatives(x: &[f64], s: &[f64]) -> Vec<f64> {
    let n = x.len();
    let h = |i: usize| x[i + 1] - x[i];
    if n == 2 {
        return vec![s[0]; 2];
    }
    let end = |h0: f64, h1: f64, s0: f64, s1: f64| {
        let d = ((2.0 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
        if d * s0 <= 0.0 {
            0.0
        } else if s0 * s1 <= 0.0 && d.abs() > 3.0 * s0.abs() {
            3.0 * s0
        } else {
            d
        }
    };
    let mut d = vec![0.0; n];
    for i in 1..n - 1 {
        if s[i - 1] * s[i] > 0.0 {
            let (w1, w2) = (2.0 * h(i) + h(i - 1), h(i) + 2.0 * h(i - 1));
            d[i] = (w1 + w2) / (w1 / s[i - 1] + w2 / s[i]);
        }
    }
    d[0] = end(h(0), h(1), s[0], s[1]);
    d[n - 1] = end(h(n - 2), h(n - 3), s[n - 2], s[n - 3]);
    d
}

/// Derivatives of the C2 spline whose third derivative is continuous at the second and last but one points
/// (de Boor, A Practical Guide to Splines, ch. IV).
fn not_a_knot_derivatives(x: &[f64], s: &[f64]) -> Vec<f64> {
    let n = x.len();
    let h = |i: usize| x[i + 1] - x[i];
    match n {
        2 => return vec![s[0]; 2],
        3 => {
            // Parabola: constant second derivative c.
            let c = (s[1] - s[0]) / (x[2] - x[0]);
            return vec![s[0] - c * h(0), s[0] + c * h(0), s[1] + c * h(1)];
        }
        _ => {}
    }
    // Tridiagonal system lower d[i-1] + diagonal d[i] + upper d[i+1] = rhs.
    let (mut lower, mut diagonal, mut upper, mut rhs) =
        (vec![0.0; n], vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    for i in 1..n - 1 {
        lower[i] = h(i);
        diagonal[i] = 2.0 * (h(i - 1) + h(i));
        upper[i] = h(i - 1);
        rhs[i] = 3.0 * (h(i) * s[i - 1] + h(i - 1) * s[i]);
    }
    let span = x[2] - x[0];
    diagonal[0] = h(1);
    upper[0] = span;
    rhs[0] = ((h(0) + 2.0 * span) * h(1) * s[0] + h(0) * h(0) * s[1]) / span;
    let span = x[n - 1] - x[n - 3];
    diagonal[n - 1] = h(n - 3);
    lower[n - 1] = span;
    rhs[n - 1] = (h(n - 2) * h(n - 2) * s[n - 3] + (2.0 * span + h(n - 2)) * h(n - 3) * s[n - 2]) / span;
    for i in 1..n {
        let factor = lower[i] / diagonal[i - 1];
        diagonal[i] -= factor * upper[i - 1];
        rhs[i] -= factor * rhs[i - 1];
    }
    rhs[n - 1] /= diagonal[n - 1];
    for i in (0..n - 1).rev() {
        rhs[i] = (rhs[i] - upper[i] * rhs[i + 1]) / diagonal[i];
    }
    rhs
}

/// Akima's weights, the secants continued linearly by two at each end; equal weights where both vanish.
fn akima_derivatives(s: &[f64]) -> Vec<f64> {
    let last = s.len() - 1;
    if last == 0 {
        return vec![s[0]; 2];
    }
    let (first_step, last_step) = (s[0] - s[1], s[last] - s[last - 1]);
    let mut m = vec![s[0] + 2.0 * first_step, s[0] + first_step];
    m.extend_from_slice(s);
    m.extend([s[last] + last_step, s[last] + 2.0 * last_step]);

    let change = |i: usize| (m[i + 1] - m[i]).abs();
    let largest = (0..=s.len())
        .map(|i| change(i) + change(i + 2))
        .fold(0.0, f64::max);
    (0..=s.len())
        .map(|i| {
            let (before, after) = (change(i), change(i + 2));
            if before + after > 1e-9 * largest {
                (after * m[i + 1] + before * m[i + 2]) / (before + after)
            } else {
                0.5 * (m[i + 1] + m[i + 2])
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const METHODS: [Method; 4] = [Method::Linear, Method::Pchip, Method::Cubic, Method::Akima];
    const X: [f64; 8] = [0.0, 1.0, 1.5, 3.0, 4.2, 5.0, 7.5, 8.0];
    const Y: [f64; 8] = [0.0, 0.8, 1.1, 1.2, -0.4, -0.9, 0.3, 2.0];
    const AT: [f64; 7] = [-0.5, 0.4, 1.2, 2.5, 4.9, 6.6, 8.4];

    // Golden values for the table in the tests, from scipy 1.17.1: PchipInterpolator, CubicSpline,
    // Akima1DInterpolator, each with extrapolate = True, and their first derivatives.
    const PCHIP: [f64; 7] = [
        -0.5031249999999998,
        0.35119999999999996,
        0.9475538461538462,
        1.1894586894586894,
        -0.8876049601800555,
        -0.42697791911967015,
        2.614182998624483,
    ];
    const PCHIP_SLOPE: [f64; 7] = [
        1.0812499999999998,
        0.8240000000000001,
        0.738692307692308,
        0.04273504273504267,
        -0.24135431094182747,
        0.6118308445667123,
        -2.0337705639614967,
    ];
    const CUBIC: [f64; 7] = [
        -0.579250539827256,
        0.36594809500959713,
        0.9241959740882918,
        1.4387179824678324,
        -0.8544039530475247,
        -1.1332271401151632,
        3.9534835220729394,
    ];
    const CUBIC_SLOPE: [f64; 7] = [
        1.3176267094529772,
        0.8256099928023034,
        0.6038232685540628,
        -0.10209731219343166,
        -0.45207484667406406,
        0.6807270233525267,
        5.614630094369806,
    ];
    const AKIMA: [f64; 7] = [
        -0.4920454545454545,
        0.3396363636363637,
        0.9336727272727273,
        1.3521501367138953,
        -0.8574336664626266,
        -0.6119173349715405,
        4.031984496894411,
    ];
    const AKIMA_SLOPE: [f64; 7] = [
        1.0795454545454546,
        0.8054545454545455,
        0.603878787878788,
        -0.08888888888888902,
        -0.4435593660615532,
        0.7334851912524214,
        4.878571925465837,
    ];

    #[test]
    fn val_scipy_values_and_slopes() {
        for (method, values, slopes) in [
            (Method::Linear, None, None),
            (Method::Pchip, Some(PCHIP), Some(PCHIP_SLOPE)),
            (Method::Cubic, Some(CUBIC), Some(CUBIC_SLOPE)),
            (Method::Akima, Some(AKIMA), Some(AKIMA_SLOPE)),
        ] {
            let f = Interpolant::new(method, &X, &Y).unwrap();
            for (k, &x) in AT.iter().enumerate() {
                if let (Some(values), Some(slopes)) = (values, slopes) {
                    assert!(
                        (f.eval(x) - values[k]).abs() < 1e-13,
                        "{method:?} {x}: {} {}",
                        f.eval(x),
                        values[k]
                    );
                    assert!(
                        (f.derivative(x) - slopes[k]).abs() < 1e-12,
                        "{method:?} slope {x}"
                    );
                }
            }
        }
    }

    #[test]
    fn prop_every_method_passes_through_its_points_and_is_exact_for_lines() {
        for method in METHODS {
            let f = Interpolant::new(method, &X, &Y).unwrap();
            assert!(
                X.iter().zip(Y).all(|(&x, y)| (f.eval(x) - y).abs() < 1e-14),
                "{method:?}"
            );
            let line = X.map(|x| 2.0 - 3.0 * x);
            let f = Interpolant::new(method, &X, &line).unwrap();
            assert!(
                AT.iter().all(|&x| (f.eval(x) - 2.0 + 3.0 * x).abs() < 1e-13),
                "{method:?}"
            );
            assert!(
                AT.iter().all(|&x| (f.derivative(x) + 3.0).abs() < 1e-13),
                "{method:?}"
            );
            assert_eq!(f.range(), (0.0, 8.0));
        }
    }

    #[test]
    fn val_cubic_reproduces_polynomials_of_its_degree() {
        let cubic = |x: f64| 1.0 - x + 0.5 * x * x - 0.2 * x * x * x;
        let parabola = |x: f64| 1.0 - x + 0.5 * x * x;
        let four = Interpolant::new(Method::Cubic, &X[..4], &X.map(cubic)[..4]).unwrap();
        let three = Interpolant::new(Method::Cubic, &X[..3], &X.map(parabola)[..3]).unwrap();
        let all = Interpolant::new(Method::Cubic, &X, &X.map(cubic)).unwrap();
        for x in AT {
            assert!((four.eval(x) - cubic(x)).abs() < 1e-11);
            assert!((three.eval(x) - parabola(x)).abs() < 1e-12);
            assert!((three.derivative(x) - (x - 1.0)).abs() < 1e-12);
            assert!((all.eval(x) - cubic(x)).abs() < 1e-12);
        }
    }

    #[test]
    fn prop_pchip_stays_between_its_points() {
        let f = Interpolant::new(Method::Pchip, &X, &Y).unwrap();
        for i in 0..7 {
            let (low, high) = (Y[i].min(Y[i + 1]), Y[i].max(Y[i + 1]));
            for k in 0..=20 {
                let value = f.eval(X[i] + (X[i + 1] - X[i]) * f64::from(k) / 20.0);
                assert!(value >= low - 1e-15 && value <= high + 1e-15);
            }
        }
    }

    #[test]
    fn val_bad_tables_are_refused() {
        let bad = |x: &[f64], y: &[f64]| Interpolant::new(Method::Linear, x, y).unwrap_err();
        assert_eq!(
            bad(&[0.0, 2.0, 2.0], &[0.0; 3]),
            Error::NotIncreasing {
                index: 2,
                previous: 2.0,
                found: 2.0
            }
        );
        assert_eq!(
            bad(&[0.0], &[1.0]),
            Error::TooFewPoints {
                what: "an interpolation table",
                needed: 2,
                found: 1
            }
        );
        assert!(matches!(bad(&[0.0, 1.0], &[1.0]), Error::Shape { .. }));
        assert!(matches!(
            bad(&[0.0, 1.0], &[1.0, f64::NAN]),
            Error::NonFinite { row: 1, .. }
        ));
    }
}
