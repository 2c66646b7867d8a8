//! The matrix exponential.

use albatross_numerics::matrix::{check_finite, check_shape};
use albatross_numerics::{Mat, MatRef, eigen, solve};

use crate::Result;

/// Coefficients of the diagonal Pade approximant of degree 13, ascending.
const PADE: [f64; 14] = [
    64_764_752_532_480_000.0,
    32_382_376_266_240_000.0,
    7_771_770_303_897_600.0,
    1_187_353_796_428_800.0,
    129_060_195_264_000.0,
    10_559_470_521_600.0,
    670_442_572_800.0,
    33_522_128_640.0,
    1_323_241_920.0,
    40_840_800.0,
    960_960.0,
    16_380.0,
    182.0,
    1.0,
];

/// 1-norm up to which that approximant is accurate to the rounding unit.
const REACH: f64 = 5.371_920_351_148_152;

/// exp(A) by scaling and squaring (Higham, SIAM J. Matrix Anal. Appl. 26, 2005, Algorithm 2.3), A balanced first.
///
/// # Errors
/// [`crate::Error::Numerics`] when A is not square or not finite, or when exp(A) overflows; [`crate::Error::Domain`] when the
/// norm of A does.
pub fn exponential(a: MatRef<'_, f64>) -> Result<Mat<f64>> {
    let n = a.nrows();
    check_shape("the matrix", (n, a.ncols()), (n, n))?;
    check_finite("the matrix", a)?;
    let (balanced, scaling) = eigen::balance(a);
    let norm = (0..n)
        .map(|j| (0..n).map(|i| balanced[(i, j)].abs()).sum::<f64>())
        .fold(0.0, f64::max);
    if !norm.is_finite() {
        return Err(crate::Error::Domain {
            what: "the norm of the matrix",
            value: norm,
            expected: "a finite number; check the units of the states and the time step",
        });
    }
    let squarings = if norm > REACH {
        (norm / REACH).log2().ceil() as i32
    } else {
        0
    };
    let shrink = 2.0_f64.powi(-squarings);

    let a1 = Mat::from_fn(n, n, |i, j| shrink * balanced[(i, j)]);
    let a2 = &a1 * &a1;
    let a4 = &a2 * &a2;
    let a6 = &a2 * &a4;
    let sum = |c6: f64, c4: f64, c2: f64, c0: f64| {
        Mat::from_fn(n, n, |i, j| {
            let identity = if i == j { c0 } else { 0.0 };
            c6 * a6[(i, j)] + c4 * a4[(i, j)] + c2 * a2[(i, j)] + identity
        })
    };
    let odd = &a1 * (&a6 * sum(PADE[13], PADE[11], PADE[9], 0.0) + sum(PADE[7], PADE[5], PADE[3], PADE[1]));
    let even = &a6 * sum(PADE[12], PADE[10], PADE[8], 0.0) + sum(PADE[6], PADE[4], PADE[2], PADE[0]);
    let mut result = solve::solve((&even - &odd).as_ref(), (&even + &odd).as_ref())?;
    for _ in 0..squarings {
        result = &result * &result;
    }
    let result = Mat::from_fn(n, n, |i, j| result[(i, j)] * (scaling[i] / scaling[j]));
    check_finite("the matrix exponential", result.as_ref())?;
    Ok(result)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mat(rows: &[&[f64]]) -> Mat<f64> {
        Mat::from_fn(rows.len(), rows.len(), |i, j| rows[i][j])
    }

    fn assert_close(found: &Mat<f64>, expected: &[&[f64]], tolerance: f64) {
        for (i, row) in expected.iter().enumerate() {
            for (j, expected) in row.iter().enumerate() {
                let difference = (found[(i, j)] - expected).abs();
                assert!(
                    difference <= tolerance * expected.abs().max(1e-300),
                    "({i}, {j}): {}",
                    found[(i, j)]
                );
            }
        }
    }

    #[test]
    fn val_closed_forms() {
        let (t, c, s) = (40.0_f64, 40.0_f64.cos(), 40.0_f64.sin());
        assert_close(
            &exponential(mat(&[&[0.0, t], &[-t, 0.0]]).as_ref()).unwrap(),
            &[&[c, s], &[-s, c]],
            1e-13,
        );
        let nilpotent = mat(&[&[0.0, 3.0, 1.0], &[0.0, 0.0, 2.0], &[0.0, 0.0, 0.0]]);
        let exact: [&[f64]; 3] = [&[1.0, 3.0, 4.0], &[0.0, 1.0, 2.0], &[0.0, 0.0, 1.0]];
        assert_close(&exponential(nilpotent.as_ref()).unwrap(), &exact, 1e-15);
        let diagonal = Mat::from_fn(3, 3, |i, j| if i == j { -10.0 * i as f64 } else { 0.0 });
        assert!((exponential(diagonal.as_ref()).unwrap()[(2, 2)] / (-20.0_f64).exp() - 1.0).abs() < 1e-13);
        assert_eq!(exponential(Mat::zeros(0, 0).as_ref()).unwrap().nrows(), 0);
    }

    /// Moler and Van Loan, SIAM Review 20 (1978), Sec. 3: the series method loses every digit here.
    #[test]
    fn val_moler_and_van_loan() {
        let e = exponential(mat(&[&[-49.0, 24.0], &[-64.0, 31.0]]).as_ref()).unwrap();
        // Eigenvalues -1 and -17 with vectors (1, 2) and (3, 4).
        let (p, q) = ((-1.0_f64).exp(), (-17.0_f64).exp());
        let exact: [&[f64]; 2] = [
            &[3.0 * q - 2.0 * p, 1.5 * (p - q)],
            &[4.0 * (q - p), 3.0 * p - 2.0 * q],
        ];
        assert_close(&e, &exact, 1e-12);
    }

    #[test]
    fn val_bad_input_is_refused() {
        assert!(exponential(Mat::zeros(2, 3).as_ref()).is_err());
        assert!(exponential(mat(&[&[f64::NAN]]).as_ref()).is_err());
        assert!(exponential(mat(&[&[800.0]]).as_ref()).is_err());
    }
}
