//! Bessel functions.
//!
//! Theodorsen's function is H1/(H1 + i H0) with Hankel functions of the second kind of the reduced frequency,
//! or K1/(K0 + K1) of the reduced Laplace variable; both forms are served. First and second kind of real
//! argument come from the C library's algorithms (crate `libm`); the modified functions are computed here to
//! about 1e-14 of their value.

use std::f64::consts::PI;

use crate::C64;

/// Euler's constant (OEIS A001620).
const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// Bessel function of the first kind, order 0.
pub fn bessel_j0(x: f64) -> f64 {
    libm::j0(x)
}

/// Bessel function of the first kind, order 1.
pub fn bessel_j1(x: f64) -> f64 {
    libm::j1(x)
}

/// Bessel function of the second kind, order 0; minus infinity at 0, NaN for negative argument.
pub fn bessel_y0(x: f64) -> f64 {
    libm::y0(x)
}

/// Bessel function of the second kind, order 1; minus infinity at 0, NaN for negative argument.
pub fn bessel_y1(x: f64) -> f64 {
    libm::y1(x)
}

/// Modified Bessel function of the first kind, order 0.
pub fn bessel_i0(x: f64) -> f64 {
    scaled_i(0, x.abs()) * x.abs().exp()
}

/// Modified Bessel function of the first kind, order 1 (odd).
pub fn bessel_i1(x: f64) -> f64 {
    scaled_i(1, x.abs()).copysign(x) * x.abs().exp()
}

/// exp(-|x|) I0(x).
pub fn bessel_i0_scaled(x: f64) -> f64 {
    scaled_i(0, x.abs())
}

/// exp(-|x|) I1(x).
pub fn bessel_i1_scaled(x: f64) -> f64 {
    scaled_i(1, x.abs()).copysign(x)
}

/// Modified Bessel function of the second kind, order 0; infinite at 0, NaN for negative argument.
pub fn bessel_k0(x: f64) -> f64 {
    real_k(x, false, |k| k[0])
}

/// Modified Bessel function of the second kind, order 1; infinite at 0, NaN for negative argument.
pub fn bessel_k1(x: f64) -> f64 {
    real_k(x, false, |k| k[1])
}

/// exp(x) K0(x).
pub fn bessel_k0_scaled(x: f64) -> f64 {
    real_k(x, true, |k| k[0])
}

/// exp(x) K1(x).
pub fn bessel_k1_scaled(x: f64) -> f64 {
    real_k(x, true, |k| k[1])
}

/// exp(z) K0(z) and exp(z) K1(z), principal branch (cut along the negative real axis).
///
/// The ratio K1/(K0 + K1) needs no unscaling. Not finite at z = 0.
pub fn bessel_k01_scaled_complex(z: C64) -> [C64; 2] {
    if z.norm() <= 2.0 {
        let e = z.exp();
        series_k(z).map(|k| k * e)
    } else {
        contour_k(z)
    }
}

/// Power series to 30 (positive terms: no cancellation), asymptotic series beyond (its least term is below
/// exp(-60)). Abramowitz and Stegun 9.6.10, 9.7.1.
fn scaled_i(order: u32, x: f64) -> f64 {
    let nu = f64::from(order);
    if x.is_nan() {
        return x;
    }
    if x <= 30.0 {
        let q = 0.25 * x * x;
        let mut term = if order == 0 { 1.0 } else { 0.5 * x };
        let mut sum = 0.0;
        let mut k = 0.0;
        while term > 1e-17 * sum {
            sum += term;
            k += 1.0;
            term *= q / (k * (k + nu));
        }
        sum * (-x).exp()
    } else {
        let mu = 4.0 * nu * nu;
        let (mut term, mut sum, mut k) = (1.0_f64, 0.0_f64, 0.0_f64);
        while term.abs() > 1e-17 * sum.abs() {
            sum += term;
            k += 1.0;
            term *= ((2.0 * k - 1.0).powi(2) - mu) / (8.0 * k * x);
        }
        sum / (2.0 * PI * x).sqrt()
    }
}

fn real_k(x: f64, scaled: bool, pick: impl Fn([C64; 2]) -> C64) -> f64 {
    if x.is_nan() || x < 0.0 {
        return f64::NAN;
    }
    if x == 0.0 {
        return f64::INFINITY;
    }
    let z = C64::new(x, 0.0);
    match (x <= 1.0, scaled) {
        (true, true) => pick(series_k(z)).re * x.exp(),
        (true, false) => pick(series_k(z)).re,
        (false, true) => pick(contour_k(z)).re,
        (false, false) => pick(contour_k(z)).re * (-x).exp(),
    }
}

/// K0, K1 by power series. Abramowitz and Stegun 9.6.11, 9.6.13.
fn series_k(z: C64) -> [C64; 2] {
    let q = 0.25 * z * z;
    let log = (0.5 * z).ln() + EULER_GAMMA;
    // term = q^k/(k!)^2; harmonic = 1 + 1/2 + ... + 1/k.
    let (mut term, mut harmonic, mut k) = (C64::new(1.0, 0.0), 0.0, 0.0);
    let (mut k0, mut k1) = (C64::new(0.0, 0.0), C64::new(0.0, 0.0));
    while term.norm() > 1e-18 || k < 2.0 {
        k0 += term * (harmonic - log);
        // q^k/(k!(k+1)!), with psi(k+1) + psi(k+2) = 2 harmonic + 1/(k+1) - 2 gamma.
        k1 += term / (k + 1.0) * (log - harmonic - 0.5 / (k + 1.0));
        k += 1.0;
        harmonic += 1.0 / k;
        term *= q / (k * k);
    }
    [k0, z.inv() + 0.5 * z * k1]
}

/// exp(z) K_nu(z) = integral over t from 0 to infinity of exp(-z (cosh t - 1)) cosh(nu t).
///
/// The path t = s - i arg(z) tanh(s) turns the oscillation for complex z into decay, so the trapezoidal rule
/// converges geometrically (Trefethen and Weideman, SIAM Review 56, 2014).
fn contour_k(z: C64) -> [C64; 2] {
    let (r, alpha) = z.to_polar();
    let h = 0.1_f64.min(0.3 / r.sqrt());
    let (mut k0, mut k1) = (
        C64::new(0.5, 0.0) * C64::new(1.0, -alpha),
        C64::new(0.5, 0.0) * C64::new(1.0, -alpha),
    );
    let mut s = 0.0;
    loop {
        s += h;
        let tanh = f64::tanh(s);
        let t = C64::new(s, -alpha * tanh);
        let half = (0.5 * t).sinh();
        let exponent = 2.0 * z * half * half;
        if exponent.re > 45.0 || exponent.is_nan() {
            break;
        }
        let value = (-exponent).exp() * C64::new(1.0, -alpha * (1.0 - tanh * tanh));
        k0 += value;
        k1 += value * t.cosh();
    }
    [k0 * h, k1 * h]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (x, exp(-x) I0, exp(-x) I1, exp(x) K0, exp(x) K1), 30-digit evaluation with mpmath 1.3.
    const MODIFIED: [(f64, [f64; 4]); 14] = [
        (
            1e-06,
            [
                0.99999900000075,
                4.999995000003125e-07,
                13.931456005075459,
                1000000.9999932842,
            ],
        ),
        (
            0.1,
            [
                0.9071009257823011,
                0.045298446808809324,
                2.6823261022628944,
                10.890182683049696,
            ],
        ),
        (
            0.9,
            [
                0.4931629661007054,
                0.20211653087685583,
                1.1971633802518509,
                1.7623882196059197,
            ],
        ),
        (
            1.1,
            [
                0.4414403775096749,
                0.21220161315067482,
                1.0983302829475998,
                1.5314037539811933,
            ],
        ),
        (
            2.0,
            [
                0.30850832255367105,
                0.21526928924893765,
                0.8415682150707714,
                1.0334768470686886,
            ],
        ),
        (
            3.7,
            [
                0.2160494416729737,
                0.18383785802735622,
                0.6322180591987406,
                0.7130065010495762,
            ],
        ),
        (
            8.0,
            [
                0.14343178185685032,
                0.13414249329269817,
                0.4366230186015861,
                0.4631490928704961,
            ],
        ),
        (
            14.5,
            [
                0.105708407377795,
                0.10199555938748292,
                0.3264019331264772,
                0.3374752337294424,
            ],
        ),
        (
            19.0,
            [
                0.09214465721171876,
                0.08968605682161496,
                0.28569149437685853,
                0.29311558766967166,
            ],
        ),
        (
            21.0,
            [
                0.08758915965422785,
                0.08547759644522977,
                0.27190920396701534,
                0.2783095820172623,
            ],
        ),
        (
            33.0,
            [
                0.06971462607491771,
                0.06865008696700392,
                0.2173612320297307,
                0.2206303567404213,
            ],
        ),
        (
            60.0,
            [
                0.05161154917360984,
                0.05117963018902872,
                0.16146817823629392,
                0.16280823094404426,
            ],
        ),
        (
            120.0,
            [
                0.036456396116413915,
                0.036304175332028954,
                0.11429277942292937,
                0.11476801537425148,
            ],
        ),
        (
            650.0,
            [
                0.015650815436407735,
                0.01563877171005083,
                0.04914957945420027,
                0.04918737230403312,
            ],
        ),
    ];

    /// (z, K0, K1), 30-digit evaluation with mpmath 1.3.
    const COMPLEX_K: [[(f64, f64); 3]; 12] = [
        [
            (0.0, 0.01),
            (4.720958675076007, -1.570757057132163),
            (-0.00785388345961312, -100.02610513531604),
        ],
        [
            (0.0, 1.0),
            (-0.138633715204054, -1.2019697153172064),
            (-0.6912298436920843, -1.2271262301435715),
        ],
        [
            (0.3, 0.4),
            (0.8306787099792591, -0.8029880059113018),
            (0.830775401167656, -1.7349694575503871),
        ],
        [
            (0.0, 7.0),
            (0.040761762504960344, -0.47136341587941005),
            (0.00735576192509772, -0.47542858415874995),
        ],
        [
            (-0.5, 2.0),
            (-1.3792839001374901, -0.4162565196023831),
            (-1.4343134291649209, -0.07622982101526031),
        ],
        [
            (-2.0, 0.5),
            (-2.3258408931469385, -6.523855369394092),
            (-2.362108373235517, -4.599564977858535),
        ],
        [
            (1.0, 30.0),
            (0.06691270270046783, 0.051009370585853336),
            (0.06780756034142206, 0.04993165198907303),
        ],
        [
            (-0.2, -60.0),
            (-0.09056947602273753, -0.17564742826578061),
            (-0.08910645268221593, -0.1764033520944663),
        ],
        [
            (5.0, -5.0),
            (0.0019451630724588178, -0.002460604699954409),
            (0.002159526923811522, -0.002490313491042557),
        ],
        [
            (0.0, 300.0),
            (0.05000141546282953, 0.05230524768727924),
            (0.050088660078701254, 0.05222198487123706),
        ],
        [
            (1e-05, -1e-05),
            (11.282283390387938, 0.7853981627833342),
            (49999.999937161585, 50000.00005498442),
        ],
        [
            (-1.9, 0.1),
            (-0.32660373737791804, -6.647144640349908),
            (-0.586493524268183, -4.553242348787958),
        ],
    ];

    #[test]
    fn val_modified_functions() {
        for (x, expected) in MODIFIED {
            let found = [
                bessel_i0_scaled(x),
                bessel_i1_scaled(x),
                bessel_k0_scaled(x),
                bessel_k1_scaled(x),
            ];
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 2e-14, "{x}: {found} {expected}");
            }
            // Wronskian, A&S 9.6.15: I0 K1 + I1 K0 = 1/x.
            let wronskian = found[0] * found[3] + found[1] * found[2];
            assert!((wronskian * x - 1.0).abs() < 2e-14);
        }
    }

    #[test]
    fn val_unscaled_functions_and_limits() {
        // A&S Table 9.8 at x = 1: I0 = 1.26606 58778, I1 = 0.56515 91040; Table 9.8: K0, K1.
        assert!((bessel_i0(1.0) - 1.266_065_877_752_008_4).abs() < 4e-15);
        assert!((bessel_i1(-1.0) + 0.565_159_103_992_485_1).abs() < 2e-15);
        assert!((bessel_k0(1.0) - 0.421_024_438_240_708_3).abs() < 2e-15);
        assert!((bessel_k1(1.0) - 0.601_907_230_197_234_6).abs() < 2e-15);
        assert_eq!(bessel_i0(0.0), 1.0);
        assert_eq!(bessel_i1(0.0), 0.0);
        assert_eq!(bessel_k0(0.0), f64::INFINITY);
        assert!(bessel_k1(-1.0).is_nan() && bessel_i0(f64::NAN).is_nan());
    }

    #[test]
    fn val_complex_k() {
        for [z, k0, k1] in COMPLEX_K {
            let c = |p: (f64, f64)| C64::new(p.0, p.1);
            let z = c(z);
            let [f0, f1] = bessel_k01_scaled_complex(z).map(|k| k * (-z).exp());
            assert!(
                (f0 / c(k0) - 1.0).norm() < 1e-13,
                "K0({z}) = {f0}, expected {}",
                c(k0)
            );
            assert!(
                (f1 / c(k1) - 1.0).norm() < 1e-13,
                "K1({z}) = {f1}, expected {}",
                c(k1)
            );
        }
    }

    /// K0(ik) = -(pi/2)(Y0 + i J0), K1(ik) = -(pi/2)(J1 - i Y1): A&S 9.6.4.
    #[test]
    fn val_imaginary_axis_is_the_hankel_function() {
        for k in [1e-3, 0.2, 1.9, 2.1, 5.0, 40.0] {
            let z = C64::new(0.0, k);
            let [k0, k1] = bessel_k01_scaled_complex(z).map(|v| v * (-z).exp());
            let h0 = -0.5 * PI * C64::new(bessel_y0(k), bessel_j0(k));
            let h1 = -0.5 * PI * C64::new(bessel_j1(k), -bessel_y1(k));
            assert!((k0 / h0 - 1.0).norm() < 1e-13, "{k}: {k0} {h0}");
            assert!((k1 / h1 - 1.0).norm() < 1e-13, "{k}: {k1} {h1}");
        }
    }

    #[test]
    fn val_functions_join_where_the_method_changes() {
        let ends = |f: &dyn Fn(f64) -> f64, x: f64| (f(x * (1.0 + 1e-15)) / f(x * (1.0 - 1e-15)) - 1.0).abs();
        assert!(ends(&bessel_i0_scaled, 30.0) < 1e-14 && ends(&bessel_i1_scaled, 30.0) < 1e-14);
        assert!(ends(&bessel_k0, 1.0) < 1e-14 && ends(&bessel_k1, 1.0) < 1e-14);
    }
}
