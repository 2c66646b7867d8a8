//! Camber lines: slope of the mean line of an aerofoil as a table over x/c.

use albatross_avl::geometry::Airfoil;
use albatross_numerics::interp::{Interpolant, Method};

/// Number of stations of a camber line.
const STATIONS: usize = 50;

/// Slope dz/dx of a camber line against x/c.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CamberSlope(Option<Interpolant>);

/// Why an aerofoil has no camber line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BadAirfoil(pub(crate) String);

impl From<albatross_numerics::Error> for BadAirfoil {
    fn from(error: albatross_numerics::Error) -> Self {
        Self(format!(
            "its points cannot be interpolated ({error}): order them trailing edge, upper side, leading edge, lower side"
        ))
    }
}

impl CamberSlope {
    /// No camber.
    pub(crate) fn flat() -> Self {
        Self(None)
    }

    /// Slope at `x` (x/c).
    pub(crate) fn at(&self, x: f64) -> f64 {
        self.0.as_ref().map_or(0.0, |table| table.eval(x))
    }

    /// The camber line of an aerofoil; `file` holds the text of an `AFILE`.
    ///
    /// # Errors
    /// [`BadAirfoil`] for digits that are no NACA 4-digit section and for points that make no aerofoil.
    pub(crate) fn of(airfoil: &Airfoil, file: Option<&str>) -> Result<Self, BadAirfoil> {
        match airfoil {
            Airfoil::Flat => Ok(Self::flat()),
            Airfoil::Naca { digits, x_range } => Self::naca(digits, *x_range),
            Airfoil::Inline { points, x_range } => Self::from_points(points, *x_range),
            Airfoil::File { x_range, .. } => match file {
                Some(text) => Self::from_points(&read_points(text)?, *x_range),
                None => Ok(Self::flat()),
            },
        }
    }

    /// NACA 4-digit mean line (Abbott and von Doenhoff, Theory of Wing Sections, eq. 6.4).
    fn naca(digits: &str, x_range: Option<[f64; 2]>) -> Result<Self, BadAirfoil> {
        let wrong = || BadAirfoil(format!("`{digits}` is no NACA 4-digit section: give four digits"));
        let number: u32 = digits.trim().parse().map_err(|_| wrong())?;
        if number > 9999 {
            return Err(wrong());
        }
        let m = f64::from(number / 1000) / 100.0;
        let p = f64::from(number / 100 % 10) / 10.0;
        let slope = |x: f64| {
            if x < p {
                2.0 * m / (p * p) * (p - x)
            } else {
                2.0 * m / ((1.0 - p) * (1.0 - p)) * (p - x)
            }
        };
        let x = stations(x_range);
        let y: Vec<f64> = x.iter().map(|&x| slope(x)).collect();
        Ok(Self(Some(Interpolant::new(Method::Akima, &normalised(&x), &y)?)))
    }

    /// Mean line of upper and lower side at equal x/c.
    fn from_points(points: &[[f64; 2]], x_range: Option<[f64; 2]>) -> Result<Self, BadAirfoil> {
        let (x, z) = camber_line(points)?;
        let line = Interpolant::new(Method::Akima, &x, &z)?;
        let x = stations(x_range);
        let y: Vec<f64> = x.iter().map(|&x| line.derivative(x)).collect();
        Ok(Self(Some(Interpolant::new(Method::Akima, &normalised(&x), &y)?)))
    }
}

/// Equal steps over the part of the chord that is used.
fn stations(x_range: Option<[f64; 2]>) -> Vec<f64> {
    let [from, to] = x_range.unwrap_or([0.0, 1.0]);
    (0..STATIONS)
        .map(|k| from + (to - from) * k as f64 / (STATIONS - 1) as f64)
        .collect()
}

/// The used part becomes the chord.
fn normalised(x: &[f64]) -> Vec<f64> {
    let (from, to) = (x[0], x[x.len() - 1]);
    x.iter().map(|x| (x - from) / (to - from)).collect()
}

/// Coordinates of an aerofoil file: an optional title, then pairs. A pair of 999 ends the first element.
pub(crate) fn read_points(text: &str) -> Result<Vec<[f64; 2]>, BadAirfoil> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for line in text.lines() {
        let mut numbers = line
            .split(|c: char| c.is_whitespace() || c == ',')
            .filter(|w| !w.is_empty())
            .map(|w| w.replace(['d', 'D'], "e").parse::<f64>());
        match (numbers.next(), numbers.next()) {
            (Some(Ok(x)), Some(Ok(z))) => {
                if x >= 999.0 {
                    break;
                }
                points.push([x, z]);
            }
            // Titles and domain parameters stand before the points.
            _ if points.is_empty() => {}
            (None, _) => {}
            _ => return Err(BadAirfoil(format!("`{}` is no pair of coordinates", line.trim()))),
        }
    }
    Ok(points)
}

/// Camber line of an outline, normalised to a chord from 0 to 1, at cosine stations.
fn camber_line(points: &[[f64; 2]]) -> Result<(Vec<f64>, Vec<f64>), BadAirfoil> {
    let outline = prepared(points)?;
    let s_le = outline.leading_edge();
    let (le, te) = (outline.at(s_le), outline.trailing_edge());
    let chord = te[0] - le[0];
    let (mut x, mut z) = (vec![0.0], vec![0.0]);
    for fraction in (1..STATIONS).map(cosine) {
        let (upper, lower) = outline.sides(s_le, le[0] + chord * fraction);
        x.push(fraction);
        z.push((0.5 * (upper + lower) - le[1]) / chord);
    }
    Ok((x, z))
}

/// An outline that has been looked over.
fn prepared(points: &[[f64; 2]]) -> Result<Outline, BadAirfoil> {
    if points.len() < 5 {
        return Err(BadAirfoil(format!(
            "{} points make no outline: give five or more",
            points.len()
        )));
    }
    if points.iter().flatten().any(|v| !v.is_finite()) {
        return Err(BadAirfoil("a coordinate is not finite".to_owned()));
    }
    // A point that is given twice is a corner. At the ends it would be a side of no length.
    let first = points.windows(2).position(|w| w[0] != w[1]).unwrap_or(0);
    let last = points.windows(2).rposition(|w| w[0] != w[1]).map_or(0, |k| k + 1);
    let outline = &points[first..=last];
    if outline.len() < 5 {
        return Err(BadAirfoil("fewer than five of its points differ".to_owned()));
    }
    let outline = Outline::new(outline);
    let (le, te) = (outline.at(outline.leading_edge()), outline.trailing_edge());
    if te[0] <= le[0] {
        return Err(BadAirfoil(
            "its trailing edge lies ahead of its leading edge".to_owned(),
        ));
    }
    Ok(outline)
}

/// Mean line and half thickness of an outline in its own coordinates: centre and radius at stations along x.
pub(crate) fn outline_stations(points: &[[f64; 2]]) -> Result<Vec<([f64; 3], f64)>, BadAirfoil> {
    let outline = prepared(points)?;
    let s_le = outline.leading_edge();
    let (le, te) = (outline.at(s_le), outline.trailing_edge());
    let at = |k: usize| {
        let x = le[0] + (te[0] - le[0]) * cosine(k);
        if k == 0 {
            return ([x, 0.0, le[1]], 0.0);
        }
        let (upper, lower) = outline.sides(s_le, x);
        ([x, 0.0, 0.5 * (upper + lower)], 0.5 * (upper - lower).abs())
    };
    Ok((0..STATIONS).map(at).collect())
}

/// Cosine spacing from 0 to 1.
fn cosine(k: usize) -> f64 {
    0.5 * (1.0 - (std::f64::consts::PI * k as f64 / (STATIONS - 1) as f64).cos())
}

/// An aerofoil's outline as two splines over its arc length.
struct Outline {
    s: Vec<f64>,
    x: Spline,
    z: Spline,
}

impl Outline {
    fn new(points: &[[f64; 2]]) -> Self {
        let mut s = vec![0.0];
        for w in points.windows(2) {
            let step = (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]);
            s.push(s[s.len() - 1] + step);
        }
        let coordinate = |k: usize| points.iter().map(|p| p[k]).collect::<Vec<f64>>();
        Self {
            x: Spline::new(&s, coordinate(0)),
            z: Spline::new(&s, coordinate(1)),
            s,
        }
    }

    fn at(&self, s: f64) -> [f64; 2] {
        [self.x.at(&self.s, s), self.z.at(&self.s, s)]
    }

    fn trailing_edge(&self) -> [f64; 2] {
        let (first, last) = (self.s[0], self.s[self.s.len() - 1]);
        let (a, b) = (self.at(first), self.at(last));
        [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
    }

    /// Arc length of the point where the outline is normal to the line to the trailing edge.
    fn leading_edge(&self) -> f64 {
        let te = self.trailing_edge();
        let slope = |s: f64| {
            let p = self.at(s);
            (p[0] - te[0]) * self.x.slope(&self.s, s) + (p[1] - te[1]) * self.z.slope(&self.s, s)
        };
        // The sign changes from positive (outward along the upper side) to negative.
        let nose = self
            .s
            .windows(2)
            .filter(|w| slope(w[0]) > 0.0 && slope(w[1]) <= 0.0)
            .max_by(|a, b| {
                let far = |w: &[f64]| (self.x.at(&self.s, w[0]) - te[0]).abs();
                far(a).total_cmp(&far(b))
            });
        let Some(nose) = nose else {
            let foremost = self
                .s
                .iter()
                .copied()
                .min_by(|a, b| self.x.at(&self.s, *a).total_cmp(&self.x.at(&self.s, *b)));
            return foremost.unwrap_or(0.0);
        };
        bisect(nose[0], nose[1], slope)
    }

    /// z of the upper and of the lower side at an x.
    fn sides(&self, s_le: f64, x: f64) -> (f64, f64) {
        let (first, last) = (self.s[0], self.s[self.s.len() - 1]);
        let upper = bisect(first, s_le, |s| self.x.at(&self.s, s) - x);
        let lower = bisect(s_le, last, |s| x - self.x.at(&self.s, s));
        (self.z.at(&self.s, upper), self.z.at(&self.s, lower))
    }
}

/// A cubic spline with continuous second derivative, broken where an abscissa comes twice, parabolic in the first
/// and last interval of each part.
struct Spline {
    y: Vec<f64>,
    d: Vec<f64>,
}

impl Spline {
    /// Through `y` at increasing `s`.
    fn new(s: &[f64], y: Vec<f64>) -> Self {
        let mut d = vec![0.0; s.len()];
        let mut start = 0;
        for k in 1..=s.len() {
            if k == s.len() || s[k] <= s[k - 1] {
                derivatives(&s[start..k], &y[start..k], &mut d[start..k]);
                start = k;
            }
        }
        Self { y, d }
    }

    /// Value and first derivative.
    fn both(&self, s: &[f64], at: f64) -> (f64, f64) {
        let i = s.partition_point(|&v| v <= at).clamp(1, s.len() - 1) - 1;
        let h = s[i + 1] - s[i];
        let t = (at - s[i]) / h;
        let rise = self.y[i + 1] - self.y[i];
        let (a, b) = (h * self.d[i] - rise, rise - h * self.d[i + 1]);
        let value = self.y[i] + t * rise + t * (1.0 - t) * (a * (1.0 - t) + b * t);
        let slope = rise + (1.0 - 2.0 * t) * (a * (1.0 - t) + b * t) + t * (1.0 - t) * (b - a);
        (value, slope / h)
    }

    fn at(&self, s: &[f64], at: f64) -> f64 {
        self.both(s, at).0
    }

    fn slope(&self, s: &[f64], at: f64) -> f64 {
        self.both(s, at).1
    }
}

/// First derivatives of one part: `h_i d_{i-1} + 2 (h_{i-1} + h_i) d_i + h_{i-1} d_{i+1} = 3 (h_i m_{i-1} +
/// h_{i-1} m_i)` with the secants m, and `d_0 + d_1 = 2 m_0` at the ends (de Boor, A Practical Guide to Splines,
/// ch. IV).
fn derivatives(s: &[f64], y: &[f64], d: &mut [f64]) {
    let n = s.len();
    if n < 2 {
        return;
    }
    let h = |i: usize| s[i + 1] - s[i];
    let m = |i: usize| (y[i + 1] - y[i]) / h(i);
    if n == 2 {
        d.fill(m(0));
        return;
    }
    let (mut diagonal, mut upper) = (vec![1.0; n], vec![1.0; n]);
    d[0] = 2.0 * m(0);
    for i in 1..n {
        let (lower, right);
        if i + 1 < n {
            (lower, diagonal[i], upper[i]) = (h(i), 2.0 * (h(i - 1) + h(i)), h(i - 1));
            right = 3.0 * (h(i) * m(i - 1) + h(i - 1) * m(i));
        } else {
            (lower, right) = (1.0, 2.0 * m(i - 1));
        }
        let factor = lower / diagonal[i - 1];
        diagonal[i] -= factor * upper[i - 1];
        d[i] = right - factor * d[i - 1];
    }
    d[n - 1] /= diagonal[n - 1];
    for i in (0..n - 1).rev() {
        d[i] = (d[i] - upper[i] * d[i + 1]) / diagonal[i];
    }
}

/// Where a function that falls from positive to negative vanishes.
fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Outline of a NACA section with thickness laid off vertically.
    fn outline(m: f64, p: f64, t: f64, n: usize) -> Vec<[f64; 2]> {
        let camber = |x: f64| {
            if x < p {
                m / (p * p) * (2.0 * p * x - x * x)
            } else {
                m / ((1.0 - p) * (1.0 - p)) * (1.0 - 2.0 * p + 2.0 * p * x - x * x)
            }
        };
        let half = |x: f64| {
            5.0 * t
                * (0.2969 * x.sqrt() - 0.1260 * x - 0.3516 * x * x + 0.2843 * x.powi(3) - 0.1036 * x.powi(4))
        };
        let x = |k: usize| 0.5 * (1.0 - (std::f64::consts::PI * k as f64 / n as f64).cos());
        let upper = (0..=n).rev().map(|k| [x(k), camber(x(k)) + half(x(k))]);
        upper
            .chain((1..=n).map(|k| [x(k), camber(x(k)) - half(x(k))]))
            .collect()
    }

    #[test]
    fn val_points_of_a_naca_section_give_its_mean_line() {
        let exact = CamberSlope::naca("2412", None).unwrap();
        let found = CamberSlope::from_points(&outline(0.02, 0.4, 0.12, 80), None).unwrap();
        // The mean line's curvature jumps at 40 % chord, which splines round off.
        for x in [0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 0.97] {
            assert!(
                (exact.at(x) - found.at(x)).abs() < 4e-5,
                "{x}: {} {}",
                exact.at(x),
                found.at(x)
            );
        }
        assert!((exact.at(0.2) - 2.0 * 0.02 / 0.16 * 0.2).abs() < 1e-12);
    }

    #[test]
    fn regress_bad_outlines_are_refused() {
        assert!(CamberSlope::from_points(&[[0.0, 0.0]; 9], None).is_err());
        assert!(CamberSlope::naca("24x2", None).is_err());
        assert!(read_points("name\n1 0\n0.5 0.1\n0 0\nabc def\n").is_err());
        assert_eq!(CamberSlope::naca("0012", None).unwrap().at(0.3), 0.0);
    }
}
