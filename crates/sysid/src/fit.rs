//! The fit of a model to a record, and records counted from their trim.
//!
//! Equations: THEORY (30).

/// Normalised root-mean-square fit in percent, the paper's Eq. 13:
/// `100 (1 - |y - yhat| / |y - mean(y)|)`. 100 is equality, 0 as good as the mean; none for a constant reference.
pub fn nrmse_fit(reference: &[f64], model: &[f64]) -> Option<f64> {
    if reference.len() != model.len() || reference.is_empty() {
        return None;
    }
    let mean = reference.iter().sum::<f64>() / reference.len() as f64;
    let error: f64 = reference.iter().zip(model).map(|(y, m)| (y - m).powi(2)).sum();
    let spread: f64 = reference.iter().map(|y| (y - mean).powi(2)).sum();
    (spread > 0.0).then(|| 100.0 * (1.0 - (error / spread).sqrt()))
}

/// A series counted from its first value: deviations from trim.
pub fn from_trim(series: &[f64]) -> Vec<f64> {
    let first = series.first().copied().unwrap_or(0.0);
    series.iter().map(|v| v - first).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_fit_limits() {
        let y = [0.0, 1.0, 0.0, -1.0];
        assert_eq!(nrmse_fit(&y, &y), Some(100.0));
        assert_eq!(nrmse_fit(&y, &[0.0; 4]), Some(0.0));
        assert_eq!(nrmse_fit(&[2.0, 2.0], &[2.0, 2.0]), None);
        assert_eq!(nrmse_fit(&y, &[0.0]), None);
    }
}
