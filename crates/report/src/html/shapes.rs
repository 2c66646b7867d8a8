//! Shapes in space that swing: a frame of lines and quadrilaterals, and displacements of its points.

use crate::error::ReportError;
use crate::plot::palette::Colour;
use crate::plot::svg::{Anchor, Canvas, Label, Stroke, coordinate};
use crate::plot::theme::{INK, NOTE};
use serde_json::{Value, json};

/// One deformed shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Name in the list of shapes.
    pub name: String,
    /// Displacement of each point, of any size: drawings are scaled to the same greatest displacement.
    pub displacement: Vec<[f64; 3]>,
}

/// Points joined by lines and quadrilaterals, with the shapes into which they deform. Axes: x aft, y right, z up.
#[derive(Debug, Clone, PartialEq)]
pub struct Shapes {
    /// Title.
    pub title: String,
    /// Points at rest.
    pub points: Vec<[f64; 3]>,
    /// Pairs of points, from 0.
    pub lines: Vec<[usize; 2]>,
    /// Corners of quadrilaterals in order around, from 0.
    pub faces: Vec<[usize; 4]>,
    /// The shapes.
    pub shapes: Vec<Shape>,
}

/// Greatest displacement of the drawings, as a part of the largest dimension.
const STILL_SCALE: f64 = 0.09;

/// Drawings side by side, and the size of one in pixels.
const ACROSS: usize = 4;
const CELL: (f64, f64) = (196.0, 150.0);

impl Shapes {
    pub(super) fn check(&self) -> Result<(), ReportError> {
        let expected = self.points.len();
        if let Some(shape) = self.shapes.iter().find(|s| s.displacement.len() != expected) {
            return Err(ReportError::ShapePoints {
                shape: shape.name.clone(),
                found: shape.displacement.len(),
                expected,
            });
        }
        let beyond = |what, index: Option<usize>| {
            index.map_or(Ok(()), |index| {
                Err(ReportError::ShapeIndex {
                    shapes: self.title.clone(),
                    what,
                    index,
                    points: expected,
                })
            })
        };
        beyond(
            "line",
            self.lines.iter().flatten().copied().find(|i| *i >= expected),
        )?;
        beyond(
            "face",
            self.faces.iter().flatten().copied().find(|i| *i >= expected),
        )
    }

    /// Coordinates in millimetres, displacements in thousandths of the greatest of each shape.
    pub(super) fn json(&self) -> Value {
        let points: Vec<[f64; 3]> = self.points.iter().map(|p| p.map(|c| rounded(c, 1e3))).collect();
        let shapes: Vec<Value> = self
            .shapes
            .iter()
            .map(|shape| {
                let unit = 1.0 / greatest(&shape.displacement);
                let moved: Vec<[f64; 3]> = shape
                    .displacement
                    .iter()
                    .map(|d| d.map(|c| rounded(c * unit, 1e4)))
                    .collect();
                json!({ "name": shape.name, "displacement": moved })
            })
            .collect();
        json!({
            "title": self.title, "points": points, "lines": self.lines, "faces": self.faces, "shapes": shapes,
            "colours": { "rest": Colour::GREY.hex(), "line": Colour::BLUE.hex(), "face": Colour::ORANGE.hex() },
        })
    }

    /// All shapes side by side as an SVG document, seen from the front left above, at rest in grey.
    ///
    /// # Errors
    /// [`ReportError`] where points, lines, faces and displacements do not fit together.
    pub fn render(&self) -> Result<String, ReportError> {
        self.check()?;
        Ok(self.still())
    }

    /// The drawing of [`Shapes::render`], of shapes that fit together.
    pub(super) fn still(&self) -> String {
        let (low, high) = bounds(&self.points);
        let size = low.iter().zip(&high).map(|(a, b)| b - a).fold(0.0, f64::max);
        let seen: Vec<(f64, f64)> = self.points.iter().map(|p| view(*p)).collect();
        let span = |f: fn(&(f64, f64)) -> f64| {
            let values = seen.iter().map(f);
            (
                values.clone().fold(f64::INFINITY, f64::min),
                values.fold(f64::NEG_INFINITY, f64::max),
            )
        };
        let ((left, right), (bottom, top)) = (span(|c| c.0), span(|c| c.1));
        let room = STILL_SCALE * size;
        let scale = (CELL.0 / (right - left + room)).min((CELL.1 - 20.0) / (top - bottom + 1.4 * room));
        let scale = if scale.is_finite() && scale > 0.0 {
            scale
        } else {
            1.0
        };
        let middle = (0.5 * (left + right), 0.5 * (bottom + top));

        let mut canvas = Canvas::default();
        for (i, shape) in self.shapes.iter().enumerate() {
            let corner = ((i % ACROSS) as f64 * CELL.0, (i / ACROSS) as f64 * CELL.1);
            let place = |p: [f64; 3]| {
                let (u, v) = view(p);
                (
                    corner.0 + 0.5 * CELL.0 + scale * (u - middle.0),
                    corner.1 + 0.5 * (CELL.1 + 20.0) - scale * (v - middle.1),
                )
            };
            let factor = room / greatest(&shape.displacement);
            let rest: Vec<(f64, f64)> = self.points.iter().map(|p| place(*p)).collect();
            let moved: Vec<(f64, f64)> = self
                .points
                .iter()
                .zip(&shape.displacement)
                .map(|(p, d)| place([p[0] + factor * d[0], p[1] + factor * d[1], p[2] + factor * d[2]]))
                .collect();
            canvas.shaded(&outlines(&self.faces, &moved), &Colour::ORANGE.hex());
            canvas.stroked(
                &segments(&self.lines, &rest),
                &Stroke::solid(&Colour::GREY.hex(), 0.6),
            );
            canvas.stroked(
                &segments(&self.lines, &moved),
                &Stroke::solid(&Colour::BLUE.hex(), 1.4),
            );
            let at = (corner.0 + 0.5 * CELL.0, corner.1 + 10.0);
            canvas.label(&Label::new(&shape.name, at, NOTE, Anchor::Middle, INK));
        }
        let rows = self.shapes.len().div_ceil(ACROSS).max(1);
        canvas.finish(ACROSS as f64 * CELL.0, rows as f64 * CELL.1, &self.title, "")
    }
}

/// Parallel projection seen from the front left above: x aft, y right, z up become right and up.
fn view([x, y, z]: [f64; 3]) -> (f64, f64) {
    let (azimuth, elevation) = (230f64.to_radians(), 28f64.to_radians());
    let toward = x * azimuth.cos() + y * azimuth.sin();
    (
        -x * azimuth.sin() + y * azimuth.cos(),
        z * elevation.cos() - toward * elevation.sin(),
    )
}

fn bounds(points: &[[f64; 3]]) -> ([f64; 3], [f64; 3]) {
    let fold = |start: f64, f: fn(f64, f64) -> f64| {
        points
            .iter()
            .fold([start; 3], |m, p| [f(m[0], p[0]), f(m[1], p[1]), f(m[2], p[2])])
    };
    (fold(f64::INFINITY, f64::min), fold(f64::NEG_INFINITY, f64::max))
}

/// Length of the longest displacement; 1 where nothing moves.
fn greatest(displacement: &[[f64; 3]]) -> f64 {
    let length = |d: &[f64; 3]| d.iter().map(|c| c * c).sum::<f64>().sqrt();
    let greatest = displacement.iter().map(length).fold(0.0, f64::max);
    if greatest > 0.0 && greatest.is_finite() {
        greatest
    } else {
        1.0
    }
}

fn rounded(value: f64, parts: f64) -> f64 {
    (value * parts).round() / parts
}

fn segments(lines: &[[usize; 2]], places: &[(f64, f64)]) -> String {
    lines.iter().map(|line| path(line, places)).collect()
}

fn outlines(faces: &[[usize; 4]], places: &[(f64, f64)]) -> String {
    faces.iter().map(|face| path(face, places) + "Z").collect()
}

fn path(corners: &[usize], places: &[(f64, f64)]) -> String {
    let steps: Vec<String> = corners
        .iter()
        .filter_map(|i| places.get(*i))
        .map(|(x, y)| format!("{} {}", coordinate(*x), coordinate(*y)))
        .collect();
    format!("M{}", steps.join("L"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Shapes {
        Shapes {
            title: "S".into(),
            points: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [0.0, 2.0, 0.0]],
            lines: vec![[0, 2]],
            faces: vec![[0, 1, 2, 3]],
            shapes: vec![Shape {
                name: "1 <up>".into(),
                displacement: vec![[0.0, 0.0, 4.0], [0.0; 3], [0.0, 0.0, -2.0], [0.0; 3]],
            }],
        }
    }

    #[test]
    fn displacements_are_sent_in_parts_of_the_greatest() {
        let json = square().json();
        assert_eq!(json["shapes"][0]["displacement"][0], json!([0.0, 0.0, 1.0]));
        assert_eq!(json["shapes"][0]["displacement"][2], json!([0.0, 0.0, -0.5]));
        assert!(square().still().contains("1 &lt;up&gt;"));
    }

    #[test]
    fn what_does_not_fit_together_is_refused() {
        let mut shapes = square();
        shapes.lines.push([0, 4]);
        assert!(matches!(
            shapes.check(),
            Err(ReportError::ShapeIndex { index: 4, .. })
        ));
        let mut shapes = square();
        shapes.shapes[0].displacement.pop();
        assert_eq!(
            shapes.check().unwrap_err().to_string(),
            "shape `1 <up>`: 3 displacements for 4 points; give one for each"
        );
        let empty = Shapes {
            points: Vec::new(),
            lines: Vec::new(),
            faces: Vec::new(),
            shapes: Vec::new(),
            title: String::new(),
        };
        assert!(empty.check().is_ok());
        assert!(!empty.still().contains("NaN"));
    }

    #[test]
    fn val_the_view_is_right_handed() {
        // Up is up; what lies aft and what lies left of the nose go to opposite sides.
        assert!(view([0.0, 0.0, 1.0]).1 > 0.0);
        assert!(view([1.0, 0.0, 0.0]).0 * view([0.0, 1.0, 0.0]).0 < 0.0);
    }
}
