//! Mass and run-case files.

use albatross_avl::AvlError;
use albatross_avl::mass::MassFile;
use albatross_avl::run::*;

use crate::support::{fixture_text, third_party};

#[test]
fn val_mass_file_of_the_surrogate() {
    let (m, remarks) = MassFile::parse(&fixture_text("f25-like/f25.mass"), "f25.mass").unwrap();
    assert!(remarks.is_empty());
    assert_eq!((m.length_unit.factor, m.length_unit.name.as_str()), (1.0, "m"));
    assert_eq!((m.gravity, m.density), (Some(9.80665), Some(0.399_667)));
    assert_eq!(m.items.len(), 1);
    let item = &m.items[0];
    assert_eq!((item.mass, item.position), (81018.49, [20.34355, 0.0, -0.42768]));
    assert_eq!(
        (item.moments[1], item.products),
        (6.015_296e6, [0.0, 2.491_144e5, 0.0])
    );
    assert_eq!(item.in_named_units(&m), *item);
}

/// Units, multipliers, adders, comments and bad lines, in the manner of the AVL manual's example (inches, grams).
#[test]
fn mass_file_with_every_kind_of_line() {
    let text = "# comment\n! comment\nMy Lunit = 0.0254 m ! inches\nMunit=.001 kg\nTunit = 1.0 s\ng   = 9.81\nrho = 1.225\n\
                10.0 1.0 2.0 3.0 ! first\n*  2.0 1.  1.  1. 0.5\n+ 0. 0.5\n10.0, 1.0\t2.0 3.0 4.0 ! second\nnot a mass\n\
                stringer = 3\n";
    let (m, remarks) = MassFile::parse(text, "t.mass").unwrap();
    assert_eq!((m.length_unit.factor, m.mass_unit.factor), (0.0254, 0.001));
    assert_eq!(
        (m.mass_unit.name.as_str(), m.time_unit.name.as_str()),
        ("kg", "s")
    );
    assert_eq!(m.items.len(), 2);
    assert_eq!(
        (m.items[0].mass, m.items[0].position, m.items[0].comment.as_str()),
        (10.0, [1.0, 2.0, 3.0], "first")
    );
    assert_eq!(
        (m.items[1].mass, m.items[1].position, m.items[1].moments),
        (20.0, [1.5, 2.0, 3.0], [2.0, 0.0, 0.0])
    );
    let si = m.items[1].in_named_units(&m);
    assert!((si.mass - 0.02).abs() < 1e-15 && (si.position[1] - 0.0508).abs() < 1e-15);
    assert!((si.moments[0] - 2.0e-3 * 0.0254 * 0.0254).abs() < 1e-15);
    // `stringer` holds the letter g before the equals sign: AVL takes it for gravity.
    assert_eq!(m.gravity, Some(3.0));
    assert_eq!((remarks.len(), remarks[0].at.line), (1, 12));
    let (again, _) = MassFile::parse(&m.to_text().unwrap(), "again.mass").unwrap();
    assert_eq!(again, m);
}

#[test]
fn damaged_mass_files() {
    let error = |text: &str| MassFile::parse(text, "t.mass").unwrap_err();
    assert!(matches!(error(""), AvlError::Empty { .. }));
    assert!(matches!(error("Lunit = 1 m\n"), AvlError::Missing { .. }));
    assert!(matches!(
        error("Lunit = one m\n1 0 0 0\n"),
        AvlError::Number { .. }
    ));
    assert!(matches!(error("Lunit = 0 m\n1 0 0 0\n"), AvlError::Syntax { .. }));
    assert!(matches!(
        error("* 1e300\n1e300 0 0 0\n"),
        AvlError::NotFinite { .. }
    ));
}

#[test]
fn val_run_file_of_the_surrogate() {
    let (run, remarks) = RunFile::parse(&fixture_text("f25-like/f25.run"), "f25.run").unwrap();
    assert!(remarks.is_empty(), "{remarks:?}");
    let [case] = run.cases.as_slice() else {
        panic!("one case")
    };
    assert_eq!((case.index, case.title.as_str()), (1, "cruise M0.78 10258 m"));
    assert_eq!((case.constraints.len(), case.parameters.len()), (9, 30));
    let alpha = case.constraint(&RunVariable::Alpha).unwrap();
    assert_eq!((&alpha.target, alpha.value), (&RunTarget::Lift, 0.564_364));
    let elevator = case
        .constraint(&RunVariable::Control("elevator".to_owned()))
        .unwrap();
    assert_eq!(elevator.target, RunTarget::PitchMoment);
    let p = |parameter| case.parameter(parameter).unwrap();
    assert_eq!(
        (p(Parameter::Velocity), p(Parameter::Mach)),
        (232.7019, 0.692_496)
    );
    assert_eq!((p(Parameter::ZCg), p(Parameter::Izx)), (-0.42768, 2.491_144e5));
    assert_eq!(case.parameters[11].unit, "m/s");
    // Six digits are written: the second writing is the same as the first.
    let text = run.to_text().unwrap();
    let (again, _) = RunFile::parse(&text, "again.run").unwrap();
    assert_eq!(again.to_text().unwrap(), text);
    assert_eq!(again.cases[0].constraints.len(), 9);
}

#[test]
fn run_names_are_looked_for_within_avls_names() {
    let text = "ignored = 3\n Run case  2:  t\n alph -> Cm = 0.1\n qc -> Cn yaw =1\n flap -> flap = 2. deg\n vel = 50. m/s\n\
                 nonsense = 1\n visc CL_u = 0.5\n Run case 3: u\n";
    let (run, remarks) = RunFile::parse(text, "t.run").unwrap();
    let case = &run.cases[0];
    assert_eq!(case.index, 2);
    let pairs: Vec<(&RunVariable, &RunTarget)> = case
        .constraints
        .iter()
        .map(|c| (&c.variable, &c.target))
        .collect();
    assert_eq!(pairs[0], (&RunVariable::Alpha, &RunTarget::PitchMoment));
    assert_eq!(pairs[1], (&RunVariable::PitchRate, &RunTarget::YawMoment));
    assert_eq!(*pairs[2].0, RunVariable::Control("flap".to_owned()));
    assert_eq!(case.parameter(Parameter::Velocity), Some(50.0));
    // A missing line: AVL's default is asked for by name.
    assert_eq!(case.parameter(Parameter::Density), None);
    assert_eq!(Parameter::Density.default_value(), 1.0);
    assert_eq!(run.cases[1].parameters.len(), 0);
    assert_eq!(remarks.len(), 2, "{remarks:?}");
    assert_eq!(find_control("flap", &["ail", "inner_flap", "flap"]), Some(2));
    assert_eq!(find_control("flap", &["ail", "inner_flap"]), Some(1));
    assert_eq!(find_control("Flap", &["ail", "inner_flap"]), None);
}

#[test]
fn damaged_run_files() {
    let error = |text: &str| RunFile::parse(text, "t.run").unwrap_err();
    assert!(matches!(error(" "), AvlError::Empty { .. }));
    assert!(matches!(error("alpha = 1\n"), AvlError::Missing { .. }));
    assert!(matches!(error(" Run case one:  t\n"), AvlError::Number { .. }));
    assert!(matches!(
        error(" Run case  1:  t\n alpha -> alpha = x\n"),
        AvlError::Number { .. }
    ));
    assert!(matches!(
        error(" Run case  1:  t\n alpha = ****\n"),
        AvlError::Overflow { .. }
    ));
    assert!(matches!(
        error(" Run case  1:  t\n alpha = NaN deg\n"),
        AvlError::NotFinite { .. }
    ));
    assert!(matches!(
        error(" Run case  1:  t\n alpha =\n"),
        AvlError::Number { .. }
    ));
}

#[test]
fn val_third_party_run_file() {
    let Some(text) = third_party("avl/overflow_out/hershey_overflow.run") else {
        return;
    };
    let (run, _) = RunFile::parse(&text, "hershey.run").unwrap();
    assert_eq!(run.cases[0].title, "-unnamed-");
    assert_eq!(run.cases[0].parameter(Parameter::RollRate), Some(-0.049_809_7));
    assert_eq!(
        run.cases[0].constraint(&RunVariable::RollRate).unwrap().value,
        0.05
    );
}
