//! Criteria by which models of different order are compared on the data that they were fitted to.
//!
//! With the mean square residual `V` of `N` samples and `d` estimated parameters, Gaussian residuals assumed white:
//! ```text
//! FPE  = V (1 + d/N)/(1 - d/N)                    Ljung, System Identification, 1999, sec. 16.4
//! AIC  = N (ln V + ln 2 pi + 1) + 2 d             Akaike, IEEE Trans. Autom. Control 19, 1974
//! AICc = AIC + 2 d (d + 1)/(N - d - 1)            Hurvich & Tsai, Biometrika 76, 1989
//! BIC  = N (ln V + ln 2 pi + 1) + d ln N          Schwarz, Ann. Statist. 6, 1978
//! nAIC = ln V + 2 d/N
//! ```
//! These are the definitions of MATLAB's `aic` and `fpe` for one output. The variance is not counted in `d`; Hurvich
//! and Tsai's own derivation for regressions counts it. Less is better in all. Residuals of a deterministic simulation
//! are model error, not noise: neighbouring samples are alike, `N` overstates the information, and all criteria favour
//! high orders.
//!
//! Equations: THEORY (35).

use serde::Serialize;

/// Criteria of one model on one output; less is better.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Criteria {
    /// Number of samples `N`, of all experiments together.
    pub samples: usize,
    /// Number of estimated parameters `d`.
    pub parameters: usize,
    /// Mean square residual `V`, in the unit of the output squared.
    pub mse: f64,
    /// Final prediction error, unit as `mse`; none unless `d < N`.
    pub fpe: Option<f64>,
    /// Akaike's criterion; none unless `V` is positive.
    pub aic: Option<f64>,
    /// Akaike's criterion corrected for few samples; none unless `d + 1 < N` and `V` is positive.
    pub aicc: Option<f64>,
    /// Bayesian criterion; none unless `V` is positive.
    pub bic: Option<f64>,
    /// Akaike's criterion for one sample, without the constant; none unless `V` is positive.
    pub naic: Option<f64>,
}

/// Criteria from the mean square residual `mse`, `samples` and the number of estimated `parameters`.
///
/// A perfect fit (`mse` of 0) has no logarithm; a negative or non-finite one has no criteria.
pub fn criteria(mse: f64, samples: usize, parameters: usize) -> Criteria {
    let (n, d) = (samples as f64, parameters as f64);
    let sound = mse.is_finite() && mse >= 0.0;
    let log = (sound && mse > 0.0 && samples > 0).then(|| mse.ln());
    // Minus twice the largest logarithm of the likelihood.
    let deviance = log.map(|log| n * (log + std::f64::consts::TAU.ln() + 1.0));
    let aic = deviance.map(|v| v + 2.0 * d);
    Criteria {
        samples,
        parameters,
        mse,
        fpe: (sound && d < n).then(|| mse * (1.0 + d / n) / (1.0 - d / n)),
        aic,
        aicc: aic
            .filter(|_| d + 1.0 < n)
            .map(|v| v + 2.0 * d * (d + 1.0) / (n - d - 1.0)),
        bic: deviance.map(|v| v + d * n.ln()),
        naic: log.map(|log| log + 2.0 * d / n),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: Option<f64>, expected: f64) {
        assert!(
            found.is_some_and(|v| (v - expected).abs() < 1e-9),
            "{found:?} {expected}"
        );
    }

    /// By hand: V = 1, N = 100, d = 10. ln 2 pi = 1.8378770664, ln 100 = 4.6051701860.
    #[test]
    fn val_by_hand() {
        let c = criteria(1.0, 100, 10);
        close(c.fpe, 1.1 / 0.9);
        close(c.aic, 283.787_706_640_934_5 + 20.0);
        close(c.aicc, 283.787_706_640_934_5 + 20.0 + 220.0 / 89.0);
        close(c.bic, 283.787_706_640_934_5 + 46.051_701_859_880_92);
        close(c.naic, 0.2);
        // AIC/N and nAIC differ by the constant; e^nAIC is FPE to first order in d/N (Ljung 1999, sec. 16.4).
        let c = criteria(0.04, 20_000, 21);
        assert!((c.naic.unwrap().exp() / c.fpe.unwrap() - 1.0).abs() < 1e-8);
    }

    #[test]
    fn val_undefined() {
        let c = criteria(1.0, 11, 10);
        assert!(c.fpe.is_some() && c.aicc.is_none() && c.aic.is_some());
        assert!(criteria(1.0, 10, 10).fpe.is_none());
        let perfect = criteria(0.0, 100, 3);
        assert_eq!((perfect.fpe, perfect.aic, perfect.bic), (Some(0.0), None, None));
        for bad in [f64::NAN, -1.0, f64::INFINITY] {
            let c = criteria(bad, 100, 3);
            assert!(c.fpe.is_none() && c.aic.is_none() && c.naic.is_none());
        }
        assert!(criteria(1.0, 0, 0).aic.is_none());
    }

    /// One parameter of no use lowers N ln V by 1 in the mean: AIC does not reward it, BIC punishes it more.
    #[test]
    fn prop_useless_parameter_raises_aic_and_bic() {
        let (n, d) = (1000, 5);
        let before = criteria(2.0, n, d);
        let after = criteria(2.0 * (-1.0 / n as f64).exp(), n, d + 1);
        assert!(after.aic > before.aic);
        assert!(after.bic.unwrap() - before.bic.unwrap() > 5.0);
    }
}
