//! Fourier transform, and the autocovariance at all lags by means of it.

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

/// Forward transform in place.
pub(crate) fn transform(values: &mut [C64]) {
    rustfft::FftPlanner::new()
        .plan_fft_forward(values.len())
        .process(values);
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
