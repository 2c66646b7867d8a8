//! Data and models altered by hand, and orders and lengths without measure: errors that say what was found.

use albatross_lti::Signal;
use albatross_numerics::C64;
use albatross_sysid::arx::arx;
use albatross_sysid::convert::realise;
use albatross_sysid::discrete::{Orders, Polynomials};
use albatross_sysid::iv4::iv4;
use albatross_sysid::subspace::{SubspaceOptions, poles};
use albatross_sysid::{
    Band, Block, DataSet, Error, Experiment, InitialCondition, Intersample, Model, Options, SearchOptions,
    estimate, search, simulate_records,
};

use crate::systems::{Noise, data};

/// Two poles, no zero.
fn model() -> Model {
    Model {
        input: Signal::new("u", "1"),
        outputs: vec![Signal::new("y", "1")],
        blocks: vec![Block::Second { a1: 0.6, a0: 9.0 }],
        coefficients: vec![vec![1.0, 0.0]],
        direct: vec![0.0],
        zeros: 0,
        delay: 0.0,
    }
}

/// A record of white noise through the model.
fn record(samples: usize) -> DataSet {
    let mut noise = Noise::new(1);
    let u: Vec<f64> = (0..samples).map(|_| noise.next()).collect();
    let mut y = model().simulate(&u, 0.05, Intersample::Zoh).unwrap().remove(0);
    noise.add(&mut y, 40.0);
    data(vec![Experiment::new("x", 0.05, u, vec![y])])
}

/// What the message says, and the change that it is about.
type Alteration<T> = (&'static str, fn(&mut T));

const ORDERS: Orders = Orders { na: 2, nb: 2, nk: 1 };

#[test]
fn regress_altered_data_are_refused() {
    let alterations: [Alteration<DataSet>; 7] = [
        ("experiments: found none", |d| d.experiments.clear()),
        ("outputs: found none", |d| d.outputs.clear()),
        ("outputs of x: found 0", |d| d.experiments[0].outputs.clear()),
        ("outputs of x: found 1", |d| d.outputs.push(Signal::new("z", "1"))),
        ("samples of y in x: found 300", |d| {
            d.experiments[0].input.truncate(200)
        }),
        ("samples of y in x: found 200", |d| {
            d.experiments[0].outputs[0].truncate(200)
        }),
        ("y is not finite at sample 7", |d| {
            d.experiments[0].outputs[0][7] = f64::NAN
        }),
    ];
    for (what, alter) in alterations {
        let mut set = record(300);
        alter(&mut set);
        for error in [
            set.check().unwrap_err(),
            estimate(&set, &Options::new(2, 0)).unwrap_err(),
            arx(&set, 0, ORDERS).unwrap_err(),
            iv4(&set, 0, ORDERS).unwrap_err(),
            poles(&set, 2, &SubspaceOptions::default()).unwrap_err(),
            simulate_records(&model(), &set, true).unwrap_err(),
            search(&set, &SearchOptions::new(2, 2), &|_, _| ()).unwrap_err(),
        ] {
            assert!(error.to_string().contains(what), "{what}: {error}");
        }
    }
}

#[test]
fn regress_altered_models_are_refused() {
    let alterations: [Alteration<Model>; 7] = [
        ("lists of coefficients of the model: found 0", |m| {
            m.coefficients.clear()
        }),
        ("lists of coefficients of the model: found 1", |m| {
            m.outputs.push(Signal::new("z", "1"))
        }),
        ("direct paths of the model: found 0", |m| m.direct.clear()),
        ("coefficients of y: found 1", |m| m.coefficients[0].truncate(1)),
        ("coefficients of y: found 2", |m| {
            m.blocks.push(Block::First { a: 1.0 })
        }),
        ("2 poles and 3 zeros", |m| m.zeros = 3),
        ("the transport delay [s] is -1", |m| m.delay = -1.0),
    ];
    for (what, alter) in alterations {
        let mut altered = model();
        alter(&mut altered);
        for error in [
            altered.evaluate(0, C64::new(0.0, 1.0)).unwrap_err(),
            altered.frequency_response(0, &[1.0]).unwrap_err(),
            altered.zpk(0).unwrap_err(),
            altered.transfer_function(0).unwrap_err(),
            altered.state_space().unwrap_err(),
            altered.simulate(&[1.0, 2.0], 0.1, Intersample::Foh).unwrap_err(),
        ] {
            assert!(error.to_string().contains(what), "{what}: {error}");
        }
    }

    // Standard deviations belong to the model that was estimated.
    let found = estimate(&record(300), &Options::new(2, 0)).unwrap();
    let uncertainty = found.uncertainty.unwrap();
    assert!(uncertainty.band(&found.model, 0, &[1.0], false).is_ok());
    let (mut larger, mut wider) = (found.model.clone(), found.model);
    larger.blocks.push(Block::First { a: 1.0 });
    larger.coefficients[0].push(1.0);
    wider.outputs.push(Signal::new("z", "1"));
    wider.coefficients.push(vec![1.0, 1.0]);
    wider.direct.push(0.0);
    for (other, output) in [(&larger, 0), (&wider, 0), (&wider, 1)] {
        let error = uncertainty.band(other, output, &[1.0], true).unwrap_err();
        assert!(matches!(error, Error::Mismatch { .. }), "{error}");
    }
}

#[test]
fn regress_orders_without_measure_are_refused() {
    const HUGE: usize = usize::MAX;
    let (short, long) = (record(300), record(4200));
    let estimated = |set: &DataSet, poles, initial| {
        let mut options = Options::new(poles, poles);
        options.initial = initial;
        estimate(set, &options).unwrap_err()
    };
    for initial in [InitialCondition::Zero, InitialCondition::Estimate] {
        let error = estimated(&short, HUGE, initial);
        assert!(matches!(error, Error::TooFewSamples { .. }), "{error}");
    }
    let error = estimated(&long, 501, InitialCondition::Zero);
    assert!(matches!(error, Error::Order { .. }), "{error}");
    for (set, most) in [(&short, HUGE), (&short, 301), (&long, 501)] {
        let error = search(set, &SearchOptions::new(1, most), &|_, _| ()).unwrap_err();
        assert!(matches!(error, Error::Order { .. }), "{error}");
    }

    for orders in [
        Orders { na: HUGE, ..ORDERS },
        Orders { nb: HUGE, ..ORDERS },
        Orders { nk: HUGE, ..ORDERS },
        Orders {
            na: HUGE,
            nb: HUGE,
            nk: HUGE,
        },
    ] {
        for error in [
            arx(&short, 0, orders).unwrap_err(),
            iv4(&short, 0, orders).unwrap_err(),
        ] {
            assert!(matches!(error, Error::TooFewSamples { .. }), "{error}");
        }
    }
    for orders in [Orders { na: 501, ..ORDERS }, Orders { nb: 501, ..ORDERS }] {
        let error = arx(&long, 0, orders).unwrap_err();
        assert!(matches!(error, Error::Domain { value: 501.0, .. }), "{error}");
    }

    let subspace = |set: &DataSet, np, horizon| {
        let options = SubspaceOptions {
            decimation: Some(1),
            horizon,
            ..SubspaceOptions::default()
        };
        poles(set, np, &options).unwrap_err()
    };
    let error = subspace(&short, HUGE, None);
    assert!(matches!(error, Error::Order { poles: HUGE, .. }), "{error}");
    let error = subspace(&short, 2, Some(HUGE));
    assert!(
        matches!(error, Error::ShortRecord { horizon: HUGE, .. }),
        "{error}"
    );
    let error = subspace(&record(8100), 2, Some(2001));
    assert!(matches!(error, Error::Domain { value: 2001.0, .. }), "{error}");

    for nk in [5001, HUGE] {
        let model = Polynomials::try_new(vec![1.0, -0.5], vec![1.0, 2.0], nk, 0.1).unwrap();
        let error = realise(&model).unwrap_err();
        assert!(error.to_string().starts_with("the delay [samples] is"), "{error}");
        assert_eq!(model.simulate(&[1.0, 1.0, 1.0]), [0.0; 3]);
    }
    let band = Band {
        points: 10_000_001,
        ..Band::default()
    };
    assert!(matches!(band.grid(), Err(Error::Domain { .. })));
}

#[test]
fn regress_numbers_without_measure_give_results() {
    let late = Model {
        delay: 1e300,
        ..model()
    };
    for hold in [Intersample::Zoh, Intersample::Foh] {
        assert_eq!(late.simulate(&[1.0; 4], 0.1, hold).unwrap(), [vec![0.0; 4]]);
    }
    let mut options = Options::new(2, 0);
    options.reallocations = usize::MAX;
    assert!(estimate(&record(300), &options).is_ok());
    // Nothing to order by.
    let real = |i: i32| {
        if i % 3 == 0 {
            f64::NAN
        } else {
            f64::from(i * i * 37 % 1009)
        }
    };
    let gaps: Vec<C64> = (0..50).map(|i| C64::new(real(i), 0.0)).collect();
    assert_eq!(Block::from_poles(&gaps).len(), 25);
}
