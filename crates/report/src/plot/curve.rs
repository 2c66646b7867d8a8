//! From data to the path of a curve: gaps, cutting at the frame, and leaving out what cannot be seen.
//!
//! A simulation of 10 s at 1 kHz has 10 000 points on some 700 pixels. Keeping the first, lowest, highest and
//! last point of each pixel column keeps every peak; dropping points that lie on the line between their
//! neighbours to within a twentieth of a pixel (Ramer, 1972; Douglas and Peucker, 1973) keeps the shape.

use super::svg::coordinate;

/// A point of the drawing in pixels.
pub(crate) type Point = (f64, f64);

/// Distances measured for each point of a line before it is split in the middle rather than where it is farthest off.
/// Curves need some tens; a diverging oscillation, which splits off one point at a time, would need half its points.
const PATIENCE: usize = 200;

/// Distance in pixels by which a simplified curve may leave the true one.
const TOLERANCE: f64 = 0.05;

/// A rectangle of the drawing in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Window {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Window {
    pub(crate) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    pub(crate) fn middle(&self) -> Point {
        (self.left + 0.5 * self.width, self.top + 0.5 * self.height)
    }

    /// Whether a point lies inside or within a pixel of the edge.
    pub(crate) fn holds(&self, (x, y): Point) -> bool {
        x >= self.left - 1.0 && x <= self.right() + 1.0 && y >= self.top - 1.0 && y <= self.bottom() + 1.0
    }

    /// Point at fractions of width (from the left) and height (from the bottom).
    pub(crate) fn at(&self, x: f64, y: f64) -> Point {
        (self.left + x * self.width, self.bottom() - y * self.height)
    }

    /// The part of a straight line inside the window (Liang and Barsky, 1984).
    pub(crate) fn clip(&self, from: Point, to: Point) -> Option<(Point, Point)> {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for (slope, room) in [
            (-dx, from.0 - self.left),
            (dx, self.right() - from.0),
            (-dy, from.1 - self.top),
            (dy, self.bottom() - from.1),
        ] {
            if slope == 0.0 {
                if room < 0.0 {
                    return None;
                }
            } else if slope < 0.0 {
                enter = enter.max(room / slope);
            } else {
                leave = leave.min(room / slope);
            }
        }
        // Whole ends are passed on unchanged, so that neighbouring parts join exactly.
        let along = |t: f64| (from.0 + t * dx, from.1 + t * dy);
        let start = if enter == 0.0 { from } else { along(enter) };
        let end = if leave == 1.0 { to } else { along(leave) };
        (enter <= leave).then_some((start, end))
    }
}

/// The visible parts of a curve: unbroken lines inside the window, as few points as show the same.
pub(crate) fn visible(points: &[Option<Point>], window: &Window) -> Vec<Vec<Point>> {
    points
        .split(Option::is_none)
        .map(|run| run.iter().flatten().copied().collect::<Vec<Point>>())
        .filter(|run| !run.is_empty())
        .flat_map(|run| cut(&thin(&run), window))
        .map(|line| simplify(&line))
        .collect()
}

/// Closed outlines of a band between two curves over the same abscissae, cut off at the window; gaps part it.
pub(crate) fn outlines(lower: &[Option<Point>], upper: &[Option<Point>], window: &Window) -> Vec<Vec<Point>> {
    let inside = |point: Point| (window.left..=window.right()).contains(&point.0);
    let cut = |(x, y): Point| (x, y.clamp(window.top, window.bottom()));
    let pairs: Vec<Option<(Point, Point)>> = lower
        .iter()
        .zip(upper)
        .map(|(low, high)| Some((cut((*low).filter(|p| inside(*p))?), cut((*high)?))))
        .collect();
    pairs
        .split(Option::is_none)
        .filter(|run| run.len() > 1)
        .map(|run| {
            let (low, high): (Vec<Point>, Vec<Point>) = run.iter().flatten().copied().unzip();
            let mut outline = simplify(&high);
            outline.extend(simplify(&low).into_iter().rev());
            outline
        })
        .collect()
}

/// First, lowest, highest and last point of each pixel column, in order, if the abscissa never turns back.
fn thin(run: &[Point]) -> Vec<Point> {
    extremes(run, f64::floor)
}

/// First, lowest, highest and last point of each column of abscissae, in order, if the abscissa never turns back.
pub(crate) fn extremes(run: &[Point], column: impl Fn(f64) -> f64) -> Vec<Point> {
    if !run.is_sorted_by(|a, b| a.0 <= b.0) {
        return run.to_vec();
    }
    let mut kept = Vec::new();
    for part in run.chunk_by(|a, b| column(a.0) == column(b.0)) {
        let lowest = part.iter().enumerate().min_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let highest = part.iter().enumerate().max_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let ends = [(0, part.first()), (part.len() - 1, part.last())];
        let ends = ends.into_iter().filter_map(|(i, point)| Some((i, point?)));
        let mut chosen: Vec<(usize, &Point)> = ends.chain(lowest).chain(highest).collect();
        chosen.sort_by_key(|(i, _)| *i);
        chosen.dedup_by_key(|(i, _)| *i);
        kept.extend(chosen.into_iter().map(|(_, point)| *point));
    }
    kept
}

/// Cuts a line at the window into the parts inside.
fn cut(line: &[Point], window: &Window) -> Vec<Vec<Point>> {
    if let [only] = line {
        return if window.holds(*only) {
            vec![vec![*only]]
        } else {
            Vec::new()
        };
    }
    let mut parts: Vec<Vec<Point>> = Vec::new();
    for pair in line.windows(2) {
        let &[from, to] = pair else { continue };
        let Some((from, to)) = window.clip(from, to) else {
            continue;
        };
        match parts.last_mut() {
            Some(part) if part.last() == Some(&from) => part.push(to),
            _ => parts.push(vec![from, to]),
        }
    }
    parts
}

/// Drops points within the tolerance of the line between those kept. The work list replaces recursion, whose
/// depth would grow with the data.
pub(crate) fn simplify(line: &[Point]) -> Vec<Point> {
    if line.len() < 3 {
        return line.to_vec();
    }
    let mut keep = vec![false; line.len()];
    let mut open = vec![(0, line.len() - 1)];
    let mut patience = PATIENCE.saturating_mul(line.len());
    while let Some((first, last)) = open.pop() {
        for end in [first, last] {
            if let Some(mark) = keep.get_mut(end) {
                *mark = true;
            }
        }
        let (Some(a), Some(b), Some(inner)) = (line.get(first), line.get(last), line.get(first + 1..last))
        else {
            continue;
        };
        let farthest = inner
            .iter()
            .enumerate()
            .map(|(i, point)| (first + 1 + i, distance(*point, *a, *b)))
            .max_by(|p, q| p.1.total_cmp(&q.1));
        if let Some((index, away)) = farthest
            && away > TOLERANCE
        {
            patience = patience.saturating_sub(inner.len());
            let index = if patience > 0 { index } else { first.midpoint(last) };
            open.push((first, index));
            open.push((index, last));
        }
    }
    line.iter()
        .zip(keep)
        .filter_map(|(point, keep)| keep.then_some(*point))
        .collect()
}

/// Distance of a point from the straight line between two others.
fn distance(p: Point, a: Point, b: Point) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let square = dx * dx + dy * dy;
    let along = if square > 0.0 {
        (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (p.0 - a.0 - along * dx).hypot(p.1 - a.1 - along * dy)
}

/// Path data of the lines among the parts; single points are left to [`dots`].
pub(crate) fn path(parts: &[Vec<Point>]) -> String {
    let mut out = String::new();
    for part in parts.iter().filter(|part| part.len() > 1) {
        for (i, (x, y)) in part.iter().enumerate() {
            out += match i {
                0 => "M",
                1 => "L",
                _ => " ",
            };
            out += &coordinate(*x);
            out.push(' ');
            out += &coordinate(*y);
        }
    }
    out
}

/// Points that stand alone between gaps.
pub(crate) fn dots(parts: &[Vec<Point>]) -> Vec<Point> {
    parts
        .iter()
        .filter(|part| part.len() == 1)
        .flatten()
        .copied()
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const WINDOW: Window = Window {
        left: 0.0,
        top: 0.0,
        width: 700.0,
        height: 100.0,
    };

    #[test]
    fn gaps_break_the_line_and_single_points_remain() {
        let points = [
            Some((0.0, 1.0)),
            Some((1.0, 5.0)),
            None,
            Some((3.0, 2.0)),
            None,
            None,
        ];
        let parts = visible(&points, &WINDOW);
        assert_eq!(path(&parts), "M0 1L1 5");
        assert_eq!(dots(&parts), [(3.0, 2.0)]);
    }

    #[test]
    fn curves_end_at_the_frame() {
        let parts = visible(
            &[Some((10.0, -50.0)), Some((20.0, 50.0)), Some((30.0, 150.0))],
            &WINDOW,
        );
        assert_eq!(path(&parts), "M15 0L25 100");
        assert!(visible(&[Some((-5.0, 10.0)), Some((-1.0, 20.0))], &WINDOW).is_empty());
    }

    #[test]
    fn a_single_sample_spike_is_kept() {
        let points: Vec<Option<Point>> = (0..100_000)
            .map(|i| Some((f64::from(i) * 0.007, if i == 54_321 { 3.0 } else { 50.0 })))
            .collect();
        let parts = visible(&points, &WINDOW);
        assert!(parts[0].iter().any(|point| point.1 == 3.0));
        assert!(parts[0].len() < 10, "{}", parts[0].len());
    }

    #[test]
    fn a_band_is_cut_off_at_the_frame_and_parted_by_gaps() {
        let at = |x: f64, y: f64| Some((x, y));
        let lower = [
            at(0.0, 60.0),
            at(10.0, 60.0),
            at(20.0, 60.0),
            None,
            at(40.0, 60.0),
            at(50.0, 60.0),
        ];
        let upper = [
            at(0.0, 40.0),
            at(10.0, -90.0),
            at(20.0, 40.0),
            at(30.0, 40.0),
            at(40.0, 40.0),
            at(50.0, 40.0),
        ];
        let outlines = outlines(&lower, &upper, &WINDOW);
        assert_eq!(outlines.len(), 2);
        assert_eq!(
            outlines[0],
            [(0.0, 40.0), (10.0, 0.0), (20.0, 40.0), (20.0, 60.0), (0.0, 60.0)]
        );
        assert_eq!(
            outlines[1],
            [(40.0, 40.0), (50.0, 40.0), (50.0, 60.0), (40.0, 60.0)]
        );
    }

    /// Of a growing oscillation the last point is always the farthest off: 2e10 distances, if it were split there.
    #[test]
    fn regress_growing_oscillations_are_simplified_in_time() {
        let line: Vec<Point> = (0..200_000)
            .map(|i| (0.0, f64::from(i) * if i % 2 == 0 { 1.0 } else { -1.0 }))
            .collect();
        let start = std::time::Instant::now();
        assert_eq!(simplify(&line), line);
        assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
    }

    proptest! {
        #[test]
        fn prop_a_simplified_curve_stays_within_the_tolerance(
            ys in proptest::collection::vec(0.0..100.0f64, 3..200), dx in 1.0..3.0f64,
        ) {
            let line: Vec<Point> = ys.iter().enumerate().map(|(i, y)| (dx * i as f64, *y)).collect();
            let short = simplify(&line);
            for point in &line {
                let nearest = short.windows(2).map(|s| distance(*point, s[0], s[1])).fold(f64::MAX, f64::min);
                prop_assert!(nearest <= TOLERANCE + 1e-12);
            }
        }

        #[test]
        fn prop_nothing_is_drawn_outside_the_window(
            points in proptest::collection::vec((-900.0..900.0f64, -300.0..300.0f64), 1..80),
        ) {
            let points: Vec<Option<Point>> = points.into_iter().map(Some).collect();
            for (x, y) in visible(&points, &WINDOW).into_iter().flatten() {
                prop_assert!((-1.0..=701.0).contains(&x) && (-1.0..=101.0).contains(&y), "{x} {y}");
            }
        }

        #[test]
        fn prop_extremes_survive_thinning(ys in proptest::collection::vec(0.0..100.0f64, 2..3000)) {
            let n = ys.len() as f64;
            let points: Vec<Option<Point>> =
                ys.iter().enumerate().map(|(i, y)| Some((700.0 * i as f64 / n, *y))).collect();
            let drawn: Vec<Point> = visible(&points, &WINDOW).into_iter().flatten().collect();
            let range = |ys: &[f64]| (ys.iter().copied().fold(f64::MAX, f64::min), ys.iter().copied().fold(f64::MIN, f64::max));
            let (low, high) = range(&ys);
            let (lowest, highest) = range(&drawn.iter().map(|p| p.1).collect::<Vec<_>>());
            prop_assert!((low - lowest).abs() <= TOLERANCE && (high - highest).abs() <= TOLERANCE);
        }
    }
}
