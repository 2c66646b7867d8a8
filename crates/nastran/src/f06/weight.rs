//! The page of the grid point weight generator.

use crate::results::GridPointWeight;

use super::row::printed_value;

/// The matrix whose rows come next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    Start,
    MassMatrix,
    Transformation,
    MassAndCg,
    Inertia,
    Principal,
    /// Parts that are not kept.
    Skip,
}

/// Reads the lines after the heading one by one.
#[derive(Debug)]
pub(super) struct WeightReader {
    part: Part,
    mystran: bool,
    reference_point: u32,
    mo: Vec<[f64; 6]>,
    s: Vec<[f64; 3]>,
    masses: Vec<f64>,
    cg: Vec<[f64; 3]>,
    inertia: Vec<[f64; 3]>,
    principal: Vec<f64>,
    line: u32,
}

impl WeightReader {
    pub(super) fn new(line: u32) -> Self {
        Self {
            part: Part::Start,
            mystran: false,
            reference_point: 0,
            mo: Vec::new(),
            s: Vec::new(),
            masses: Vec::new(),
            cg: Vec::new(),
            inertia: Vec::new(),
            principal: Vec::new(),
            line,
        }
    }

    /// Takes a line and the same line without blanks. An error is a value that cannot be read.
    pub(super) fn take(&mut self, line: &[u8], squeezed: &[u8]) -> Result<(), String> {
        if self.heading(squeezed) {
            return Ok(());
        }
        // Rows stand between asterisks; lines of asterisks alone are borders.
        let tokens: Vec<&[u8]> = line
            .split(|b| b.is_ascii_whitespace() || *b == b'*')
            .filter(|t| !t.is_empty())
            .collect();
        let has_border = squeezed.starts_with(b"*") && !tokens.is_empty();
        match self.part {
            Part::MassMatrix if has_border => self.mo.push(numbers(&tokens)?),
            Part::Transformation if has_border => self.s.push(numbers(&tokens)?),
            Part::Inertia if has_border => self.inertia.push(numbers(&tokens)?),
            Part::Principal if has_border => {
                // MYSTRAN prints the full matrix, the others the diagonal alone.
                let at = if self.mystran { self.principal.len() } else { 0 };
                let [value] = numbers(tokens.get(at..=at).unwrap_or_default())?;
                self.principal.push(value);
            }
            Part::MassAndCg => {
                let axis = match tokens.first() {
                    Some(&b"X") => 0,
                    Some(&b"Y") => 1,
                    Some(&b"Z") => 2,
                    _ => return Ok(()),
                };
                let rest = tokens.get(1..).unwrap_or_default();
                // A mass tells nothing of the centre along its own axis; some programs leave that blank.
                let [mass, cg @ ..] = if rest.len() == 3 {
                    let [mass, a, b] = numbers(rest)?;
                    match axis {
                        0 => [mass, 0.0, a, b],
                        1 => [mass, a, 0.0, b],
                        _ => [mass, a, b, 0.0],
                    }
                } else {
                    numbers(rest)?
                };
                self.masses.push(mass);
                self.cg.push(cg);
            }
            _ => {}
        }
        Ok(())
    }

    fn heading(&mut self, squeezed: &[u8]) -> bool {
        let starts = |text: &str| squeezed.starts_with(text.as_bytes());
        let is_mystran = |text: &str| squeezed.to_ascii_uppercase().starts_with(text.as_bytes());
        let part = match squeezed {
            b"MO" => Part::MassMatrix,
            b"S" => Part::Transformation,
            b"I(S)" => Part::Inertia,
            b"I(Q)" => Part::Principal,
            b"Q" => Part::Skip,
            _ if starts("MO-") => Part::MassMatrix,
            _ if starts("S-TRANSFORMATION") => Part::Transformation,
            _ if starts("MASSAXISSYSTEM(S)") => Part::MassAndCg,
            _ if starts("I(S)-") => Part::Inertia,
            _ if starts("I(Q)-") => Part::Principal,
            _ if starts("Q-TRANSFORMATION") => Part::Skip,
            _ if is_mystran("6X6RIGIDBODYMASSMATRIX") => {
                self.mystran = true;
                Part::MassMatrix
            }
            _ if is_mystran("M.O.I.MATRIX-ABOUTREFERENCE") => Part::Skip,
            _ if is_mystran("M.O.I.MATRIX-ABOUTABOVEC.G.LOCATIONINBASIC") => Part::Inertia,
            _ if is_mystran("M.O.I.MATRIX-ABOUTABOVEC.G.LOCATIONINPRINCIPAL") => Part::Principal,
            _ if is_mystran("TRANSFORMATIONFROMBASIC") => Part::Skip,
            _ if is_mystran("(REFERENCEPOINTIS") || starts("REFERENCEPOINT=") => {
                let digits = squeezed.iter().rev().skip_while(|b| !b.is_ascii_digit());
                let digits: Vec<u8> = digits.take_while(|b| b.is_ascii_digit()).copied().collect();
                self.reference_point = digits.iter().rev().fold(0_u32, |n, d| {
                    n.saturating_mul(10).saturating_add(u32::from(d - b'0'))
                });
                return true;
            }
            _ => return false,
        };
        self.part = part;
        true
    }

    /// The block, if the mass matrix is complete; otherwise how many rows it has.
    pub(super) fn finish(self) -> Result<GridPointWeight, usize> {
        let mut mo: [[f64; 6]; 6] = self.mo.as_slice().try_into().map_err(|_| self.mo.len())?;
        // MYSTRAN leaves the lower left block zero.
        if mo.iter().skip(3).all(|row| row.iter().take(3).all(|m| *m == 0.0)) {
            let upper = mo;
            for (i, row) in mo.iter_mut().enumerate().skip(3) {
                for (term, mirrored) in row.iter_mut().zip(&upper).take(3) {
                    *term = mirrored.get(i).copied().unwrap_or(0.0);
                }
            }
        }
        Ok(GridPointWeight {
            reference_point: self.reference_point,
            mo,
            masses: self.masses.as_slice().try_into().ok(),
            cg_rows: self.cg.as_slice().try_into().ok(),
            s: self.s.as_slice().try_into().ok(),
            inertia_s: self.inertia.as_slice().try_into().ok(),
            principal_inertia: self.principal.as_slice().try_into().ok(),
            line: self.line,
        })
    }
}

fn numbers<const N: usize>(tokens: &[&[u8]]) -> Result<[f64; N], String> {
    if tokens.len() != N {
        return Err(format!(
            "has {} values where {N} are expected; the file may be truncated",
            tokens.len()
        ));
    }
    let mut values = [0.0; N];
    for (value, token) in values.iter_mut().zip(tokens) {
        *value = printed_value(token)?.unwrap_or(0.0);
    }
    Ok(values)
}
