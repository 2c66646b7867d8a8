//! Standard cross-sections of PBARL and PBEAML and their constants.
//!
//! Axes as in the manual's figures: y up, z across; I1 is bending in plane 1, `int(y^2 dA)`. A section made of
//! straight walls is a sum of rectangles, some negative, and its constants follow from the parallel-axis theorem
//! about the common centroid. The dimensions are those of the MSC Nastran Quick Reference Guide, entry PBARL
//! (PBEAML for L).

use std::f64::consts::PI;
use std::fmt;

use serde::{Deserialize, Serialize};

/// The shape of a standard section. Its name on the card is the upper-case form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the variants are the names on the card")]
pub enum SectionShape {
    Rod,
    Tube,
    Tube2,
    I,
    Chan,
    T,
    Box,
    Bar,
    Cross,
    H,
    T1,
    I1,
    Chan1,
    Z,
    Chan2,
    T2,
    Box1,
    Hexa,
    Hat,
    Hat1,
    Dbox,
    L,
}

impl SectionShape {
    const TABLE: [(&str, Self, usize); 22] = [
        ("ROD", Self::Rod, 1),
        ("TUBE", Self::Tube, 2),
        ("TUBE2", Self::Tube2, 2),
        ("I", Self::I, 6),
        ("CHAN", Self::Chan, 4),
        ("T", Self::T, 4),
        ("BOX", Self::Box, 4),
        ("BAR", Self::Bar, 2),
        ("CROSS", Self::Cross, 4),
        ("H", Self::H, 4),
        ("T1", Self::T1, 4),
        ("I1", Self::I1, 4),
        ("CHAN1", Self::Chan1, 4),
        ("Z", Self::Z, 4),
        ("CHAN2", Self::Chan2, 4),
        ("T2", Self::T2, 4),
        ("BOX1", Self::Box1, 6),
        ("HEXA", Self::Hexa, 3),
        ("HAT", Self::Hat, 4),
        ("HAT1", Self::Hat1, 5),
        ("DBOX", Self::Dbox, 10),
        ("L", Self::L, 4),
    ];

    /// The shape with this name (upper case), if known.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::TABLE.iter().find(|row| row.0 == name).map(|row| row.1)
    }

    fn row(self) -> (&'static str, usize) {
        Self::TABLE
            .iter()
            .find(|row| row.1 == self)
            .map_or(("", 0), |row| (row.0, row.2))
    }

    /// Name on the card.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// Number of dimensions.
    #[must_use]
    pub fn dimension_count(self) -> usize {
        self.row().1
    }
}

impl fmt::Display for SectionShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A shape with its dimensions, m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// The shape.
    pub shape: SectionShape,
    /// DIM1, DIM2, ... as on the card.
    pub dims: Vec<f64>,
}

/// A wall: width along z, height along y, centre, and +1 for material or -1 for a hole.
struct Rectangle {
    width: f64,
    height: f64,
    z: f64,
    y: f64,
    sign: f64,
}

fn wall(width: f64, height: f64, z: f64, y: f64) -> Rectangle {
    Rectangle {
        width,
        height,
        z,
        y,
        sign: 1.0,
    }
}

fn hole(width: f64, height: f64, z: f64, y: f64) -> Rectangle {
    Rectangle {
        width,
        height,
        z,
        y,
        sign: -1.0,
    }
}

impl Section {
    /// Area, m^2. `None` for HAT, HAT1 and DBOX (no formula here) or when dimensions are missing.
    #[must_use]
    pub fn area(&self) -> Option<f64> {
        match (self.shape, self.dims.as_slice()) {
            (SectionShape::Rod, &[r]) => Some(PI * r * r),
            (SectionShape::Tube, &[outer, inner]) => Some(PI * (outer * outer - inner * inner)),
            (SectionShape::Tube2, &[outer, t]) => Some(PI * t * (2.0 * outer - t)),
            (SectionShape::Hexa, &[point, width, height]) => Some(height * (width - point)),
            _ => Some(
                self.rectangles()?
                    .iter()
                    .map(|r| r.sign * r.width * r.height)
                    .sum(),
            ),
        }
    }

    /// Second moments (I1, I2) about the centroid, m^4: I1 for bending in plane 1, `int(y^2 dA)`. `None` for HAT,
    /// HAT1, DBOX and HEXA.
    #[must_use]
    pub fn second_moments(&self) -> Option<(f64, f64)> {
        let round = |outer: f64, inner: f64| {
            let i = PI / 4.0 * (outer.powi(4) - inner.powi(4));
            Some((i, i))
        };
        match (self.shape, self.dims.as_slice()) {
            (SectionShape::Rod, &[r]) => round(r, 0.0),
            (SectionShape::Tube, &[outer, inner]) => round(outer, inner),
            (SectionShape::Tube2, &[outer, t]) => round(outer, outer - t),
            _ => {
                let walls = self.rectangles()?;
                let area: f64 = walls.iter().map(|r| r.sign * r.width * r.height).sum();
                let y_c = walls
                    .iter()
                    .map(|r| r.sign * r.width * r.height * r.y)
                    .sum::<f64>()
                    / area;
                let z_c = walls
                    .iter()
                    .map(|r| r.sign * r.width * r.height * r.z)
                    .sum::<f64>()
                    / area;
                // Each wall: own moment b h^3 / 12 plus area times squared distance to the common centroid.
                let i1 = walls.iter().map(|r| {
                    r.sign * r.width * r.height * (r.height * r.height / 12.0 + (r.y - y_c).powi(2))
                });
                let i2 = walls
                    .iter()
                    .map(|r| r.sign * r.width * r.height * (r.width * r.width / 12.0 + (r.z - z_c).powi(2)));
                Some((i1.sum(), i2.sum()))
            }
        }
    }

    /// Torsion constant, m^4, where a closed form is standard: round sections exactly; BAR by the usual
    /// polynomial fit to the series of Saint-Venant (Roark, Table 10.1, error below 0.5 %);
    /// BOX by Bredt's thin-wall formula. `None` otherwise.
    #[must_use]
    pub fn torsion_constant(&self) -> Option<f64> {
        match (self.shape, self.dims.as_slice()) {
            (SectionShape::Rod | SectionShape::Tube | SectionShape::Tube2, _) => {
                self.second_moments().map(|(i1, i2)| i1 + i2)
            }
            (SectionShape::Bar, &[width, height]) => {
                let (a, b) = (width.max(height), width.min(height));
                let r = b / a;
                Some(a * b.powi(3) * (1.0 / 3.0 - 0.21 * r * (1.0 - r.powi(4) / 12.0)))
            }
            (SectionShape::Box, &[width, height, t_flange, t_web]) => {
                let (w, h) = (width - t_web, height - t_flange);
                Some(2.0 * t_flange * t_web * w * w * h * h / (w * t_web + h * t_flange))
            }
            _ => None,
        }
    }

    /// The walls of a section made of rectangles.
    fn rectangles(&self) -> Option<Vec<Rectangle>> {
        use SectionShape as S;
        Some(match (self.shape, self.dims.as_slice()) {
            (S::Bar, &[w, h]) => vec![wall(w, h, 0.0, 0.0)],
            (S::Box, &[w, h, t_flange, t_web]) => {
                vec![
                    wall(w, h, 0.0, 0.0),
                    hole(w - 2.0 * t_web, h - 2.0 * t_flange, 0.0, 0.0),
                ]
            }
            (S::Box1, &[w, h, t_top, t_bottom, t_left, t_right]) => vec![
                wall(w, h, 0.0, 0.0),
                hole(
                    w - t_left - t_right,
                    h - t_top - t_bottom,
                    (t_left - t_right) / 2.0,
                    (t_bottom - t_top) / 2.0,
                ),
            ],
            (S::I, &[h, w_bottom, w_top, t_web, t_bottom, t_top]) => vec![
                wall(w_bottom, t_bottom, 0.0, t_bottom / 2.0),
                wall(w_top, t_top, 0.0, h - t_top / 2.0),
                wall(t_web, h - t_bottom - t_top, 0.0, (h + t_bottom - t_top) / 2.0),
            ],
            // DIM1 is the flange width beyond the web, DIM3 the web height between the flanges.
            (S::I1, &[beyond, t_web, inner, h]) => vec![
                wall(beyond + t_web, h, 0.0, 0.0),
                hole(beyond / 2.0, inner, (t_web + beyond / 2.0) / 2.0, 0.0),
                hole(beyond / 2.0, inner, -(t_web + beyond / 2.0) / 2.0, 0.0),
            ],
            (S::H, &[gap, t_sides, h, t_cross]) => vec![
                wall(t_sides / 2.0, h, (gap + t_sides / 2.0) / 2.0, 0.0),
                wall(t_sides / 2.0, h, -(gap + t_sides / 2.0) / 2.0, 0.0),
                wall(gap, t_cross, 0.0, 0.0),
            ],
            (S::Cross, &[beyond, t_upright, h, t_arm]) => vec![
                wall(t_upright, h, 0.0, 0.0),
                wall(beyond / 2.0, t_arm, (t_upright + beyond / 2.0) / 2.0, 0.0),
                wall(beyond / 2.0, t_arm, -(t_upright + beyond / 2.0) / 2.0, 0.0),
            ],
            (S::T | S::T2, &[w, h, t_flange, t_web]) => {
                let flange_at = if self.shape == S::T {
                    h - t_flange / 2.0
                } else {
                    t_flange / 2.0
                };
                let web_at = if self.shape == S::T {
                    (h - t_flange) / 2.0
                } else {
                    (h + t_flange) / 2.0
                };
                vec![
                    wall(w, t_flange, 0.0, flange_at),
                    wall(t_web, h - t_flange, 0.0, web_at),
                ]
            }
            // A T on its side: DIM1 the flange height, DIM2 the stem beyond it.
            (S::T1, &[h, stem, t_flange, t_stem]) => {
                vec![
                    wall(t_flange, h, 0.0, 0.0),
                    wall(stem, t_stem, -(t_flange + stem) / 2.0, 0.0),
                ]
            }
            (S::L, &[w, h, t_foot, t_leg]) => vec![
                wall(w, t_foot, w / 2.0, t_foot / 2.0),
                wall(t_leg, h - t_foot, t_leg / 2.0, (h + t_foot) / 2.0),
            ],
            (S::Chan, &[w, h, t_web, t_flange]) => vec![
                wall(w, h, w / 2.0, 0.0),
                hole(w - t_web, h - 2.0 * t_flange, (w + t_web) / 2.0, 0.0),
            ],
            (S::Chan1, &[beyond, t_web, inner, h]) => vec![
                wall(beyond + t_web, h, (beyond + t_web) / 2.0, 0.0),
                hole(beyond, inner, t_web + beyond / 2.0, 0.0),
            ],
            // A channel open upwards or downwards: two legs and a web across.
            (S::Chan2, &[t_leg, t_web, h, w]) => {
                vec![
                    wall(w, h, 0.0, h / 2.0),
                    hole(w - 2.0 * t_leg, h - t_web, 0.0, (h - t_web) / 2.0),
                ]
            }
            // Flanges to opposite sides of the web.
            (S::Z, &[beyond, t_web, inner, h]) => {
                let t = (h - inner) / 2.0;
                vec![
                    wall(t_web, h, 0.0, 0.0),
                    wall(beyond, t, (t_web + beyond) / 2.0, (h - t) / 2.0),
                    wall(beyond, t, -(t_web + beyond) / 2.0, -(h - t) / 2.0),
                ]
            }
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    fn section(shape: SectionShape, dims: &[f64]) -> Section {
        Section {
            shape,
            dims: dims.to_vec(),
        }
    }

    /// The constants that Simcenter Nastran prints for a PBARL ROD of radius 1: 3.1416, 0.78540, 1.5708.
    #[test]
    fn val_round_sections() {
        let rod = section(SectionShape::Rod, &[1.0]);
        assert_relative_eq!(rod.area().unwrap(), PI);
        assert_relative_eq!(rod.second_moments().unwrap().0, PI / 4.0);
        assert_relative_eq!(rod.torsion_constant().unwrap(), PI / 2.0);
        let by_radii = section(SectionShape::Tube, &[0.5, 0.4]);
        let by_thickness = section(SectionShape::Tube2, &[0.5, 0.1]);
        assert_relative_eq!(
            by_radii.area().unwrap(),
            by_thickness.area().unwrap(),
            max_relative = 1e-14
        );
        assert_relative_eq!(by_radii.area().unwrap(), PI * 0.09, max_relative = 1e-14);
    }

    /// Sections whose bending about the horizontal axis is a rectangle minus rectangles.
    #[test]
    fn val_symmetric_sections_are_rectangles_minus_rectangles() {
        let rectangle = |w: f64, h: f64| w * h.powi(3) / 12.0;
        let whole_minus = |hole_width: f64| rectangle(0.3, 0.5) - rectangle(hole_width, 0.44);
        for (shape, dims, hole) in [
            (SectionShape::I, &[0.5, 0.3, 0.3, 0.02, 0.03, 0.03][..], 0.28),
            (SectionShape::I1, &[0.28, 0.02, 0.44, 0.5], 0.28),
            (SectionShape::Chan, &[0.3, 0.5, 0.02, 0.03], 0.28),
            (SectionShape::Chan1, &[0.28, 0.02, 0.44, 0.5], 0.28),
            (SectionShape::Box, &[0.3, 0.5, 0.03, 0.02], 0.26),
            (SectionShape::Box1, &[0.3, 0.5, 0.03, 0.03, 0.015, 0.025], 0.26),
        ] {
            let s = section(shape, dims);
            assert_relative_eq!(s.area().unwrap(), 0.15 - hole * 0.44, max_relative = 1e-13);
            assert_relative_eq!(
                s.second_moments().unwrap().0,
                whole_minus(hole),
                max_relative = 1e-13
            );
        }
        // A Z has the same heights as the channel made of its parts.
        let z = section(SectionShape::Z, &[0.28, 0.02, 0.44, 0.5]);
        let expected = rectangle(0.02, 0.5) + 0.28 * (0.5_f64.powi(3) - 0.44_f64.powi(3)) / 12.0;
        assert_relative_eq!(z.second_moments().unwrap().0, expected, max_relative = 1e-13);
    }

    /// Beer and Johnston, Mechanics of Materials, sample problem 4.2: a T of 90 x 20 over 30 x 40 mm has its centroid
    /// 38 mm above the foot and I = 868e3 mm^4.
    #[test]
    fn val_tee_of_the_text_book() {
        let tee = section(SectionShape::T, &[90.0, 60.0, 20.0, 30.0]);
        assert_relative_eq!(tee.area().unwrap(), 3000.0);
        assert_relative_eq!(tee.second_moments().unwrap().0, 868e3, max_relative = 1e-12);
        let upside_down = section(SectionShape::T2, &[90.0, 60.0, 20.0, 30.0]);
        assert_relative_eq!(
            upside_down.second_moments().unwrap().0,
            868e3,
            max_relative = 1e-12
        );
        // On its side the moments change places.
        let on_its_side = section(SectionShape::T1, &[90.0, 40.0, 20.0, 30.0]);
        assert_relative_eq!(
            on_its_side.second_moments().unwrap().1,
            868e3,
            max_relative = 1e-12
        );
    }

    #[test]
    fn val_remaining_areas() {
        for (shape, dims, area) in [
            (
                SectionShape::L,
                &[0.3, 0.5, 0.03, 0.02][..],
                0.3 * 0.03 + 0.47 * 0.02,
            ),
            (SectionShape::H, &[0.3, 0.04, 0.5, 0.03], 0.04 * 0.5 + 0.3 * 0.03),
            (
                SectionShape::Cross,
                &[0.3, 0.04, 0.5, 0.03],
                0.04 * 0.5 + 0.3 * 0.03,
            ),
            (
                SectionShape::Chan2,
                &[0.02, 0.03, 0.5, 0.3],
                2.0 * 0.02 * 0.5 + 0.03 * 0.26,
            ),
            (SectionShape::Hexa, &[0.1, 0.3, 0.2], 0.2 * 0.2),
        ] {
            assert_relative_eq!(section(shape, dims).area().unwrap(), area, max_relative = 1e-13);
        }
        for shape in [SectionShape::Hat, SectionShape::Hat1, SectionShape::Dbox] {
            assert_eq!(section(shape, &vec![0.1; shape.dimension_count()]).area(), None);
        }
        // Dimensions of another shape.
        assert_eq!(section(SectionShape::I, &[1.0]).area(), None);
    }

    /// Timoshenko and Goodier, Theory of Elasticity, table of k1: J = k1 a^3 b with k1 0.1406 for a square, 0.229 for
    /// 2 : 1 and 0.312 for 10 : 1.
    #[test]
    fn val_torsion_of_rectangles() {
        for (ratio, k1) in [(1.0, 0.1406), (2.0, 0.229), (10.0, 0.312)] {
            for dims in [[ratio, 1.0], [1.0, ratio]] {
                let j = section(SectionShape::Bar, &dims).torsion_constant().unwrap();
                assert_relative_eq!(j, k1 * ratio, max_relative = 5e-3);
            }
        }
    }

    #[test]
    fn names_and_counts_agree() {
        for (name, shape, count) in SectionShape::TABLE {
            assert_eq!(SectionShape::from_name(name), Some(shape));
            assert_eq!((shape.name(), shape.dimension_count()), (name, count));
        }
    }
}
