//! Transfer functions and the measure of their polynomials.

use albatross_export::{Transfer, Value};
use albatross_lti::{Signal, Zpk};
use albatross_numerics::C64;

fn transfer(zeros: &[(f64, f64)], poles: &[(f64, f64)], gain: f64) -> Transfer {
    let both = |list: &[(f64, f64)]| -> Vec<C64> {
        let pair = |&(re, im): &(f64, f64)| {
            let count = if im == 0.0 { 1 } else { 2 };
            [C64::new(re, im), C64::new(re, -im)].into_iter().take(count)
        };
        list.iter().flat_map(pair).collect()
    };
    let zpk = Zpk::try_new(both(zeros), both(poles), gain).unwrap();
    Transfer::new(Signal::new("elevator", "rad"), Signal::new("q", "rad/s"), zpk).unwrap()
}

/// -5 (s + 1)/((s + 2)(s^2 + 2 s + 17)), multiplied out by hand.
#[test]
fn val_low_order_by_hand() {
    let of = transfer(&[(-1.0, 0.0)], &[(-2.0, 0.0), (-1.0, 4.0)], -5.0);
    let polynomials = of.transfer_function.as_ref().unwrap();
    assert_eq!(polynomials.numerator, [-5.0, -5.0]);
    assert_eq!(polynomials.denominator, [1.0, 4.0, 21.0, 34.0]);
    assert!(of.transfer_function_error.unwrap() < 1e-14);
    let record = of.record();
    assert_eq!(record.get("K"), Some(&Value::Scalar(-5.0)));
    assert_eq!(record.get("InputUnit"), Some(&Value::Texts(vec!["rad".into()])));
    let json = serde_json::to_value(&of).unwrap();
    assert_eq!(json["poles"][2]["im"].as_f64().unwrap().abs(), 4.0);
    assert_eq!(json["transfer_function"]["denominator"][3], 34.0);
}

/// Lightly damped modes close to each other: the polynomials lose digits with their order, and the error says so;
/// beyond the range of numbers they are left out.
#[test]
fn val_the_error_grows_with_the_order() {
    let chain = |n: usize| -> Vec<(f64, f64)> {
        let mode = |k: usize| (-0.01 * (10.0 + k as f64), 10.0 + k as f64);
        (0..n).map(mode).collect()
    };
    let error = |n: usize| transfer(&[], &chain(n), 1.0).transfer_function_error.unwrap();
    assert!(error(2) < 1e-12, "{:e}", error(2));
    assert!(error(20) > 1e3 * error(2), "{:e} {:e}", error(20), error(2));
    let beyond = transfer(&[], &chain(120), 1.0);
    assert_eq!(
        (beyond.transfer_function, beyond.transfer_function_error),
        (None, None)
    );
}
