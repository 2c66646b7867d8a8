//! Drawing a panel into its frame: grid, rays, guides, curves, and the texts among them.

use super::axis::Ruler;
use super::curve::{Point, Window, dots, outlines, path, visible};
use super::palette::{Marker, marker_path};
use super::panel::{Panel, Series};
use super::svg::{Anchor, Canvas, Label, Stroke};
use super::text;
use super::theme;

/// A panel with everything it takes to draw it.
pub(crate) struct Drawing<'a> {
    pub(crate) panel: &'a Panel,
    pub(crate) window: Window,
    pub(crate) x: &'a Ruler,
    pub(crate) y: &'a Ruler,
}

impl Drawing<'_> {
    pub(crate) fn draw(&self, canvas: &mut Canvas) {
        self.grid(canvas);
        self.rays(canvas);
        self.guide_lines(canvas);
        let (corner, size) = (
            (self.window.left, self.window.top),
            (self.window.width, self.window.height),
        );
        canvas.rectangle(corner, size, "none", Some(&Stroke::solid(theme::FRAME, 0.9)));
        for series in &self.panel.series {
            self.band(canvas, series);
        }
        for series in &self.panel.series {
            self.series(canvas, series);
        }
        if self
            .panel
            .series
            .iter()
            .all(|series| self.pixels(series).iter().all(Option::is_none))
        {
            let label = Label::new(
                "no data",
                self.window.middle(),
                theme::LABEL,
                Anchor::Middle,
                theme::FAINT_INK,
            );
            canvas.label(&label);
        }
        self.guide_labels(canvas);
        self.point_labels(canvas);
    }

    fn grid(&self, canvas: &mut Canvas) {
        let w = &self.window;
        let upright = |x: f64| path(&[vec![w.at(x, 0.0), w.at(x, 1.0)]]);
        let level = |y: f64| path(&[vec![w.at(0.0, y), w.at(1.0, y)]]);
        let minor: String = self
            .x
            .minor()
            .into_iter()
            .map(upright)
            .chain(self.y.minor().into_iter().map(level))
            .collect();
        let (x, y) = (self.x.major(), self.y.major());
        let major: String = x
            .into_iter()
            .map(|(x, _)| upright(x))
            .chain(y.into_iter().map(|(y, _)| level(y)))
            .collect();
        let imaginary_axis = if self.panel.damping_rays.is_empty() {
            None
        } else {
            self.x.zero()
        };
        let zero: String = self
            .y
            .zero()
            .map(level)
            .into_iter()
            .chain(imaginary_axis.map(upright))
            .collect();
        canvas.open_group("grid");
        canvas.stroked(&minor, &Stroke::solid(theme::MINOR_GRID, 0.7));
        canvas.stroked(&major, &Stroke::solid(theme::GRID, 0.8));
        canvas.stroked(&zero, &Stroke::solid(theme::ZERO, 0.9));
        canvas.close_group();
    }

    fn guide_lines(&self, canvas: &mut Canvas) {
        for guide in &self.panel.guides {
            let ruler = if guide.on_x { self.x } else { self.y };
            let Some(part) = ruler.fraction(guide.value).filter(|_| ruler.holds(guide.value)) else {
                continue;
            };
            let (from, to) = if guide.on_x {
                ((part, 0.0), (part, 1.0))
            } else {
                ((0.0, part), (1.0, part))
            };
            let stroke = Stroke {
                colour: theme::GUIDE,
                width: 1.0,
                dashes: &[4.0, 3.0],
            };
            canvas.line(
                self.window.at(from.0, from.1),
                self.window.at(to.0, to.1),
                &stroke,
            );
        }
    }

    /// Labels of guides: beside an upright line at the top, or at the bottom if fewer curves pass there; above a level
    /// line at the right.
    fn guide_labels(&self, canvas: &mut Canvas) {
        for guide in self.panel.guides.iter().filter(|guide| !guide.label.is_empty()) {
            let ruler = if guide.on_x { self.x } else { self.y };
            let Some(part) = ruler.fraction(guide.value).filter(|_| ruler.holds(guide.value)) else {
                continue;
            };
            let half = 0.5 * theme::NOTE + 3.0;
            let (at, anchor) = if guide.on_x {
                let (x, top) = self.window.at(part, 1.0);
                let (_, bottom) = self.window.at(part, 0.0);
                let width = text::width(&guide.label, theme::NOTE);
                let (x, anchor, left) = if x + 5.0 + width < self.window.right() {
                    (x + 5.0, Anchor::Start, x + 5.0)
                } else {
                    (x - 5.0, Anchor::End, x - 5.0 - width)
                };
                let crowd = |y: f64| self.curves_in([left, left + width], [y - half, y + half]);
                let (high, low) = (top + half, bottom - half);
                let y = if crowd(low) < crowd(high) { low } else { high };
                ((x, y), anchor)
            } else {
                let (x, y) = self.window.at(1.0, part);
                let above = y - half > self.window.top + half;
                ((x - 5.0, if above { y - half } else { y + half }), Anchor::End)
            };
            let label = Label {
                rimmed: true,
                ..Label::new(&guide.label, at, theme::NOTE, anchor, theme::GUIDE)
            };
            canvas.label(&label);
        }
    }

    /// How many series pass through a box of pixels.
    fn curves_in(&self, [left, right]: [f64; 2], [top, bottom]: [f64; 2]) -> usize {
        let passes = |a: Point, b: Point| {
            let (from, to) = (a.0.min(b.0).max(left), a.0.max(b.0).min(right));
            if from > to {
                return false;
            }
            let height = |x: f64| a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0);
            let (one, other) = if a.0 == b.0 {
                (a.1, b.1)
            } else {
                (height(from), height(to))
            };
            one.min(other) <= bottom && one.max(other) >= top
        };
        let series = self.panel.series.iter();
        series
            .filter(|series| {
                let pixels = self.pixels(series);
                let mut pairs = pixels.iter().zip(pixels.iter().skip(1));
                pairs.any(|(a, b)| matches!((a, b), (Some(a), Some(b)) if passes(*a, *b)))
            })
            .count()
    }

    /// Rays of constant damping ratio ζ: s = ω (-ζ ± i √(1-ζ²)).
    fn rays(&self, canvas: &mut Canvas) {
        let place = |re: f64, im: f64| Some(self.window.at(self.x.fraction(re)?, self.y.fraction(im)?));
        let Some(origin) = place(0.0, 0.0) else { return };
        let mut labels: Vec<Window> = Vec::new();
        for zeta in self
            .panel
            .damping_rays
            .iter()
            .filter(|zeta| (-1.0..=1.0).contains(*zeta))
        {
            for sign in [1.0, -1.0] {
                // A step of a thousand frames reaches the edge from wherever the origin is.
                let Some(towards) = place(-zeta, sign * (1.0 - zeta * zeta).sqrt()) else {
                    continue;
                };
                let (dx, dy) = (towards.0 - origin.0, towards.1 - origin.1);
                let length = dx.hypot(dy);
                if length <= 0.0 {
                    continue;
                }
                let reach = 1e3 * (self.window.width + self.window.height) / length;
                let far = (origin.0 + reach * dx, origin.1 + reach * dy);
                let Some((from, to)) = self.window.clip(origin, far) else {
                    continue;
                };
                canvas.line(
                    from,
                    to,
                    &Stroke {
                        colour: theme::GUIDE,
                        width: 0.8,
                        dashes: &[1.0, 2.5],
                    },
                );
                let name = format!("ζ = {}", crate::number::shortest(*zeta).replace('-', "\u{2212}"));
                self.ray_label(canvas, &name, (from, to), &mut labels);
            }
        }
    }

    /// Writes a ray's damping ratio above the frame where the ray leaves at the top, else beside the ray near
    /// the left edge, further in where a point is in the way.
    fn ray_label(
        &self,
        canvas: &mut Canvas,
        name: &str,
        (from, to): (Point, Point),
        labels: &mut Vec<Window>,
    ) {
        let (width, height) = (text::width(name, theme::NOTE), theme::NOTE);
        let space = |left: f64, middle: f64| Window {
            left,
            top: middle - 0.5 * height,
            width,
            height,
        };
        let at_top = (to.1 - self.window.top).abs() < 0.5;
        let spaces = if at_top {
            vec![space(to.0 - 0.5 * width, to.1 - 0.5 * height - 3.0)]
        } else if (to.0 - self.window.left).abs() < 0.5 {
            // On the side away from the real axis.
            let away = if to.1 < from.1 {
                -0.5 * height - 2.0
            } else {
                0.5 * height + 2.0
            };
            let along = |part: f64| {
                space(
                    to.0 + part * (from.0 - to.0) + 5.0,
                    to.1 + part * (from.1 - to.1) + away,
                )
            };
            [0.0, 0.1, 0.2, 0.3, 0.4].map(along).to_vec()
        } else {
            Vec::new()
        };
        let points: Vec<Point> = self
            .panel
            .series
            .iter()
            .flat_map(|series| self.pixels(series))
            .flatten()
            .collect();
        let free = |space: &Window| {
            let inside = self.window.holds((space.left, space.top))
                && self.window.holds((space.right(), space.bottom()));
            let covers = |point: &Point| {
                overlap(
                    space,
                    &Window {
                        left: point.0,
                        top: point.1,
                        width: 0.0,
                        height: 0.0,
                    },
                    5.0,
                )
            };
            labels.iter().all(|other| !overlap(other, space, 4.0))
                && (at_top || inside && !points.iter().any(covers))
        };
        if let Some(space) = spaces.into_iter().find(free) {
            let label = Label::new(name, space.middle(), theme::NOTE, Anchor::Middle, theme::GUIDE);
            canvas.label(&Label {
                rimmed: true,
                ..label
            });
            labels.push(space);
        }
    }

    /// Points of a series in pixels; `None` for gaps.
    fn pixels(&self, series: &Series) -> Vec<Option<Point>> {
        let place = |(x, y)| Some(self.window.at(self.x.fraction(x)?, self.y.fraction(y)?));
        series.points().map(place).collect()
    }

    /// The shaded band of a series, below all curves.
    fn band(&self, canvas: &mut Canvas, series: &Series) {
        let place = |(x, y): (f64, f64)| Some(self.window.at(self.x.fraction(x)?, self.y.fraction(y)?));
        let edge = |end: fn(&(f64, f64)) -> f64| -> Vec<Option<Point>> {
            let points = series.x.iter().zip(&series.band);
            points.map(|(x, ends)| place((*x, end(ends)))).collect()
        };
        let outlines = outlines(&edge(|ends| ends.0), &edge(|ends| ends.1), &self.window);
        canvas.shaded(&path(&outlines), &series.style.colour.hex());
    }

    fn series(&self, canvas: &mut Canvas, series: &Series) {
        let pixels = self.pixels(series);
        let (style, width) = (&series.style, series.style.drawn_width());
        let colour = style.colour.hex();
        canvas.open_group("series");
        if let Some(dash) = style.line {
            let parts = visible(&pixels, &self.window);
            let dashes = dash.lengths(width);
            canvas.stroked(
                &path(&parts),
                &Stroke {
                    colour: &colour,
                    width,
                    dashes: &dashes,
                },
            );
            if style.marker.is_none() {
                let dots: String = dots(&parts)
                    .into_iter()
                    .map(|dot| marker_path(Marker::Disc, dot, 1.6 * width))
                    .collect();
                canvas.filled(&dots, &colour, None);
            }
        }
        if let Some(marker) = style.marker {
            let points = marked(&pixels, &self.window, style.line.is_some());
            draw_markers(canvas, marker, &points, &colour, width);
        }
        canvas.close_group();
    }

    /// Texts beside points, each on the side where it covers least.
    fn point_labels(&self, canvas: &mut Canvas) {
        let mut placed: Vec<Window> = Vec::new();
        let labelled: Vec<(Point, &str)> = self
            .panel
            .series
            .iter()
            .flat_map(|series| {
                self.pixels(series)
                    .into_iter()
                    .zip(series.labels.iter().map(String::as_str))
            })
            .filter_map(|(point, label)| Some((point.filter(|p| self.window.holds(*p))?, label)))
            .filter(|(_, label)| !label.is_empty())
            .collect();
        let mark = |(x, y): Point| Window {
            left: x - 4.0,
            top: y - 4.0,
            width: 8.0,
            height: 8.0,
        };
        // Markers of other series are not to be covered either.
        let others = self
            .panel
            .series
            .iter()
            .filter(|s| s.labels.is_empty() && s.style.line.is_none());
        let marks: Vec<Window> = labelled
            .iter()
            .map(|(point, _)| *point)
            .chain(others.flat_map(|series| self.pixels(series)).flatten())
            .map(mark)
            .collect();
        for (point, label) in labelled {
            let (width, height) = (text::width(label, theme::NOTE), theme::NOTE);
            let sides = [
                (1, 0),
                (-1, 0),
                (0, -1),
                (0, 1),
                (1, -1),
                (1, 1),
                (-1, -1),
                (-1, 1),
            ];
            let spaces = sides.map(|(right, down)| {
                let (right, down) = (f64::from(right), f64::from(down));
                let x = point.0 + right * (6.0 + 0.5 * width);
                let y = point.1 + down * (6.0 + 0.5 * height);
                Window {
                    left: x - 0.5 * width,
                    top: y - 0.5 * height,
                    width,
                    height,
                }
            });
            let cost = |space: &Window| {
                let inside = self.window.holds((space.left, space.top))
                    && self.window.holds((space.right(), space.bottom()));
                let covered = placed
                    .iter()
                    .chain(&marks)
                    .filter(|other| overlap(other, space, 1.0))
                    .count();
                covered + if inside { 0 } else { 1000 }
            };
            let Some(best) = spaces.into_iter().min_by_key(cost) else {
                continue;
            };
            canvas.label(&Label {
                rimmed: true,
                ..Label::new(label, best.middle(), theme::NOTE, Anchor::Middle, theme::INK)
            });
            placed.push(best);
        }
    }
}

fn overlap(a: &Window, b: &Window, gap: f64) -> bool {
    a.left < b.right() + gap
        && b.left < a.right() + gap
        && a.top < b.bottom() + gap
        && b.top < a.bottom() + gap
}

/// Points that get a marker: all that are visible and distinct, or on a line those some distance apart.
fn marked(pixels: &[Option<Point>], window: &Window, on_line: bool) -> Vec<Point> {
    const APART: f64 = 22.0;
    let mut seen = std::collections::HashSet::new();
    let mut points: Vec<Point> = Vec::new();
    for point in pixels.iter().flatten().filter(|point| window.holds(**point)) {
        let far = !on_line
            || points
                .last()
                .is_none_or(|last| (point.0 - last.0).hypot(point.1 - last.1) >= APART);
        // A quarter of a pixel cannot be told apart.
        let spot = ((4.0 * point.0).round() as i64, (4.0 * point.1).round() as i64);
        if far && seen.insert(spot) {
            points.push(*point);
        }
    }
    points
}

/// Draws one marker shape at each of the points.
pub(crate) fn draw_markers(canvas: &mut Canvas, marker: Marker, points: &[Point], colour: &str, width: f64) {
    let size = 3.0 + 0.4 * width;
    let shapes: String = points
        .iter()
        .map(|point| marker_path(marker, *point, size))
        .collect();
    let stroke = Stroke::solid(colour, width.min(1.6));
    match marker {
        Marker::Disc => canvas.filled(&shapes, colour, None),
        Marker::Cross | Marker::Plus => canvas.stroked(&shapes, &stroke),
        _ => canvas.filled(&shapes, "#ffffff", Some(&stroke)),
    }
}
