//! Autocovariance at all lags by the fast Fourier transform.

use std::f64::consts::PI;

use albatross_numerics::C64;

/// `r(k) = 1/N sum_t x(t) x(t - k)` for `k = 0..N-1`, the mean not removed.
///
/// The biased form: its Fourier transform, the periodogram, is nowhere negative.
pub(crate) fn autocovariance(x: &[f64]) -> Vec<f64> {
    let n = x.len();
    // Zeros to twice the length keep the ends of the circular correlation apart.
    let mut values: Vec<C64> = x.iter().map(|&v| C64::new(v, 0.0)).collect();
    values.resize((2 * n).next_power_of_two(), C64::new(0.0, 0.0));
    transform(&mut values);
    for value in &mut values {
        *value = C64::new(value.norm_sqr(), 0.0);
    }
    // A real and even sequence: its inverse transform is the forward one over its length.
    transform(&mut values);
    let scale = 1.0 / (values.len() as f64 * n as f64);
    values.iter().take(n).map(|v| v.re * scale).collect()
}

/// Forward transform in place; the length is a power of two (J. W. Cooley, J. W. Tukey, Math. Comput. 19, 1965).
fn transform(values: &mut [C64]) {
    let n = values.len();
    if n < 2 {
        return;
    }
    let shift = usize::BITS - n.trailing_zeros();
    for i in 0..n {
        let j = i.reverse_bits() >> shift;
        if i < j {
            values.swap(i, j);
        }
    }
    let mut half = 1;
    while half < n {
        // Factors by sine and cosine, not by repeated products, whose errors add up.
        let factors: Vec<C64> = (0..half)
            .map(|k| C64::from_polar(1.0, -PI * k as f64 / half as f64))
            .collect();
        for block in values.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for ((a, b), factor) in low.iter_mut().zip(high).zip(&factors) {
                let product = *b * factor;
                (*a, *b) = (*a + product, *a - product);
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The definition, summed directly.
    #[test]
    fn val_autocovariance_is_the_sum() {
        for n in [1, 2, 3, 64, 301] {
            let x: Vec<f64> = (0..n)
                .map(|i| (f64::from(i) * 0.37).sin() + 0.2 * f64::from(i % 7))
                .collect();
            let found = autocovariance(&x);
            for (k, value) in found.iter().enumerate() {
                let sum: f64 = (k..x.len()).map(|t| x[t] * x[t - k]).sum();
                assert!((value - sum / f64::from(n)).abs() < 1e-13, "{n} {k}");
            }
            assert_eq!(found.len(), x.len());
        }
        assert!(autocovariance(&[]).is_empty());
    }
}
