//! The F25-like surrogate through all stages.

use albatross::analysis::{self, with_fidelity};
use albatross::flight::Fidelity;
use albatross::lti::{FrequencySolver, Method};
use albatross::numerics::eigen;
use albatross::{Case, Error, Inputs, Model};
use std::path::PathBuf;

fn case_file() -> PathBuf {
    PathBuf::from(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../fixtures/f25-like/case.toml"
    ))
}

fn inputs() -> Inputs {
    Inputs::read(&case_file()).unwrap()
}

fn model(inputs: &Inputs, variant: &str) -> Model {
    Model::build(inputs, &inputs.case.variant(Some(variant)).unwrap()).unwrap()
}

/// State count of theory: 12 rigid, 2 x 20 modal, 2 x (146 + 30 + 20) lags.
#[test]
fn val_size_of_the_full_model() {
    let inputs = inputs();
    let model = model(&inputs, "avl");
    assert_eq!(model.strips.strips.len(), 146 + 30 + 20);
    let trimmed = analysis::trimmed(&model).unwrap();
    assert_eq!(trimmed.system.a.nrows(), 444);
    // Strip areas of the wing along the dihedral against Sref = 130.1 in projection: 130.1/cos 5 deg but for the
    // unswept centre; AVL prints 65.261 m2 a side.
    let wing: f64 = model
        .strips
        .records
        .iter()
        .filter(|r| r.surface.starts_with("Wing"))
        .map(|r| r.chord * r.width)
        .sum();
    assert!((wing - 2.0 * 65.261202).abs() < 1e-2, "{wing}");
}

/// AVL's own trim at CL 0.5644 is 1.33236 deg and -0.01128 deg; here thrust carries T sin(alpha) of the weight, which
/// is 0.0012 of it and worth 0.005 deg.
#[test]
fn val_trim_with_avl_data() {
    let inputs = inputs();
    let (_, trim) = model(&inputs, "avl").trim().unwrap();
    let alpha = trim.alpha_rad.to_degrees();
    assert!((alpha - 1.33).abs() < 0.005, "{alpha}");
    let lift_by_thrust = trim.thrust * trim.alpha_rad.sin() / (130.1 * trim.dynamic_pressure) / 7.296941;
    assert!(
        (alpha + lift_by_thrust.to_degrees() - 1.33236).abs() < 1e-3,
        "{alpha}"
    );
    assert!(trim.residual < 1e-9);
    assert!(
        trim.eta.iter().all(|eta| *eta == 0.0),
        "modes count from the trimmed shape"
    );
}

/// The two solvers' results files lead to the same aircraft: frequencies of its modes within 1e-5.
#[test]
fn val_two_results_files_agree() {
    let inputs = inputs();
    let first = analysis::trimmed(&model(&inputs, "avl")).unwrap();
    let mut other = inputs.clone();
    other.results = albatross::nastran::f06::read(case_file().with_file_name("f25_nastran95.f06")).unwrap();
    let second = analysis::trimmed(&model(&other, "avl")).unwrap();
    let a = eigen::eigenvalues(first.system.a.as_ref()).unwrap();
    let b = eigen::eigenvalues(second.system.a.as_ref()).unwrap();
    let band = |v: &&albatross::numerics::C64| v.im > 10.0 && v.norm() < 95.0;
    let pairs: Vec<_> = a.iter().filter(band).zip(b.iter().filter(band)).collect();
    assert_eq!(pairs.len(), 20);
    for (x, y) in pairs {
        assert!((x - y).norm() < 1e-5 * x.norm(), "{x} {y}");
    }
}

/// Every tracked mode is an eigenvalue of the full matrix, each is another one, and heavily damped lag roots that lie
/// between them are none of them.
#[test]
fn val_mode_table_is_one_to_one() {
    let inputs = inputs();
    let model = model(&inputs, "avl");
    let trimmed = analysis::trimmed(&model).unwrap();
    let table = analysis::mode_table_without_lags(&model, &trimmed).unwrap();
    let values = eigen::eigenvalues(trimmed.system.a.as_ref()).unwrap();
    let mut used = vec![false; values.len()];
    for mode in &table.elastic {
        let (index, distance) = values
            .iter()
            .enumerate()
            .map(|(i, v)| (i, (v.re - mode.re).hypot(v.im - mode.im)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap();
        assert!(distance < 1e-7 * mode.omega_rad_s, "mode {}", mode.mode);
        assert!(
            !std::mem::replace(&mut used[index], true),
            "mode {} taken twice",
            mode.mode
        );
        assert!(mode.damping_ratio < 0.3 && mode.confidence > 0.75);
    }
    let named = |name: &str| table.rigid_body.iter().find(|m| m.name == name).unwrap();
    let short_period = named("short period").rigid.omega_rad_s;
    assert!((1.6..1.8).contains(&short_period), "{short_period}");
    let phugoid = named("phugoid").rigid.omega_rad_s;
    assert!((0.055..0.075).contains(&phugoid), "{phugoid}");
}

/// The response with lags eliminated one by one against the dense solve of the full system.
#[test]
fn val_lag_eliminated_response_is_dense_response() {
    let inputs = inputs();
    for variant in ["avl", "corrected_lagged"] {
        let trimmed = analysis::trimmed(&model(&inputs, variant)).unwrap();
        let omega = [0.05, 1.7, 19.0, 54.0, 120.0];
        let fast = analysis::frequency_response(&trimmed, "elevator", &omega).unwrap();
        let outputs: Vec<&str> = trimmed.system.outputs.iter().map(|o| o.name.as_str()).collect();
        let system = trimmed.system.select(&["elevator"], &outputs).unwrap();
        let dense = FrequencySolver::new(&system, Method::Lu)
            .unwrap()
            .response(&omega)
            .unwrap();
        for (a, b) in fast.values.iter().zip(&dense.values) {
            for i in 0..outputs.len() {
                let (x, y) = (a[(i, 0)], b[(i, 0)]);
                assert!(
                    (x - y).norm() < 1e-8 * y.norm().max(1e-6),
                    "{variant} {}: {x} {y}",
                    outputs[i]
                );
            }
        }
    }
}

/// The corrections reach their places: slopes of the table on the strips, eight derivatives in the aircraft.
#[test]
fn val_corrections_are_applied() {
    let inputs = inputs();
    let (plain, corrected) = (model(&inputs, "avl"), model(&inputs, "corrected"));
    let rigid = &corrected.aircraft.rigid;
    assert_eq!(rigid.lift.alpha, 7.2145603873626705);
    assert_eq!(rigid.pitch.controls[2], -3.8605300359807933);
    // y = 0.4938 is the middle of the table's innermost bin (0 to 0.9875).
    let strip = &corrected.strips.records[1];
    assert!((strip.leading_edge[1] - 0.49375).abs() < 1e-3);
    assert!((strip.cl_alpha - 5.46235).abs() < 1e-4, "{}", strip.cl_alpha);
    let fin = |m: &Model| {
        m.strips
            .records
            .iter()
            .find(|r| r.surface == "VTP")
            .unwrap()
            .cl_alpha
    };
    assert_eq!(
        fin(&plain),
        fin(&corrected),
        "a surface that the table lacks keeps its slopes"
    );
    assert!(
        corrected
            .notes
            .iter()
            .any(|n| n.contains("VTP") && n.contains("keeps"))
    );
    assert!(
        corrected.notes.iter().any(|n| n.contains("not CFD")),
        "provenance is kept"
    );
}

/// Sums over strips against what AVL prints: the lift slopes of wing and tail (the rest of `CLa` is the nacelles'),
/// elevator lift by construction, its moment by the tail arm within the induced part that strips leave out.
#[test]
fn val_strip_sums_against_rigid_derivatives() {
    let inputs = inputs();
    let model = model(&inputs, "avl");
    let horizontal = |s: &str| s.starts_with("Wing") || s.starts_with("HTP");
    let lift_slope: f64 = model
        .strips
        .records
        .iter()
        .filter(|r| horizontal(&r.surface))
        .map(|r| r.chord * r.width * r.cl_alpha * r.dihedral_rad.cos() / 130.1)
        .sum();
    let surfaces = |i: usize| -> f64 {
        inputs.strips[i]
            .surfaces
            .iter()
            .filter(|s| horizontal(&s.name))
            .map(|s| s.coefficients.c_lift)
            .sum()
    };
    let printed = (surfaces(1) - surfaces(0)) / 1.0_f64.to_radians();
    // A strip's c_l leaves out the in-plane part of its force: 0.35 % of the slope here.
    assert!(
        (lift_slope / printed - 1.0).abs() < 5e-3,
        "{lift_slope} {printed}"
    );
    let part = model.aircraft.elastic.as_ref().unwrap();
    let (mut lift, mut moment) = (0.0, 0.0);
    for (j, s) in part.model.strips.iter().enumerate() {
        let force = part.control_incidence[(j, 2)] * s.cl_alpha * s.area() * s.dihedral_rad.cos();
        lift += force / 130.1;
        moment += force * (model.mass.cg[0] - s.x_ac) / (130.1 * model.aircraft.reference.chord);
    }
    assert!(
        (lift / model.aircraft.rigid.lift.controls[2] - 1.0).abs() < 1e-9,
        "{lift}"
    );
    assert!(
        (moment / model.aircraft.rigid.pitch.controls[2] - 1.0).abs() < 0.05,
        "{moment}"
    );
}

/// Static aeroelastic derivatives, the modes following at once, against those of the reference's vortex lattice with 50
/// modes (fixtures/f25-like/reference/derivatives_reference.json): strips carry no induced load, so a few percent.
#[test]
fn val_static_aeroelastic_derivatives() {
    let inputs = inputs();
    let model = model(&inputs, "corrected");
    let (_, trim) = model.trim().unwrap();
    let part = model.aircraft.elastic.as_ref().unwrap();
    let flow = albatross::strip::Flow {
        rho: trim.density,
        speed: trim.speed(),
    };
    let stiffness = part.model.static_stiffness(flow).unwrap();
    let (area, chord) = (model.aircraft.reference.area, model.aircraft.reference.chord);
    let pressure = trim.dynamic_pressure;
    let increments = |load: &dyn Fn(usize) -> f64| -> (f64, f64) {
        let force: Vec<f64> = (0..part.model.n_modes())
            .map(|k| pressure * area * chord * load(k))
            .collect();
        let eta = albatross::numerics::solve::solve_vec(stiffness.as_ref(), &force).unwrap();
        let row = |i: usize| -> f64 {
            let q = part.rigid_rows.eta_eta();
            2.0 * pressure * (0..eta.len()).map(|k| q[(i, k)] * eta[k]).sum::<f64>()
        };
        (-row(2) / (pressure * area), row(4) / (pressure * area * chord))
    };
    let rigid = &model.aircraft.rigid;
    let reference =
        std::fs::read_to_string(case_file().with_file_name("reference/derivatives_reference.json")).unwrap();
    let reference: serde_json::Value = serde_json::from_str(&reference).unwrap();
    let alpha = increments(&|k| part.q_x[(k, 0)]);
    let rate = increments(&|k| part.q_x[(k, 3)]);
    let elevator = increments(&|k| part.q_u[(k, 2)]);
    for (name, (lift, pitch), (rigid_lift, rigid_pitch)) in [
        ("alpha", alpha, (rigid.lift.alpha, rigid.pitch.alpha)),
        ("q", rate, (rigid.lift.q_hat, rigid.pitch.q_hat)),
        ("de", elevator, (rigid.lift.controls[2], rigid.pitch.controls[2])),
    ] {
        let expected = |key: &str| reference["static_aeroelastic"][name][key].as_f64().unwrap();
        println!(
            "{name}: CL {:.4} ({:.4}) Cm {:.4} ({:.4})",
            rigid_lift + lift,
            expected("flex_CL"),
            rigid_pitch + pitch,
            expected("flex_Cm")
        );
        assert!(
            ((rigid_lift + lift) / expected("flex_CL") - 1.0).abs() < 0.1,
            "{name} lift"
        );
        assert!(
            ((rigid_pitch + pitch) / expected("flex_Cm") - 1.0).abs() < 0.1,
            "{name} pitch"
        );
    }
}

/// With the engines at their place the thrust lifts the nose (they hang below the centre of gravity): the elevator goes
/// down by the moment that it must balance.
#[test]
fn val_engines_in_place() {
    let inputs = inputs();
    let (_, through_cg) = model(&inputs, "avl").trim().unwrap();
    let in_place = model(&inputs, "engines_in_place");
    let (_, trim) = in_place.trim().unwrap();
    let arm = -0.42767713408013835 - -2.30411;
    let moment = trim.thrust * arm / (trim.dynamic_pressure * 130.1 * 3.3465);
    let by_hand = -moment / in_place.aircraft.rigid.pitch.controls[2];
    let change = trim.controls_rad[2] - through_cg.controls_rad[2];
    // alpha moves with it, which trims a few percent of the moment.
    assert!((change / by_hand - 1.0).abs() < 0.15, "{change} {by_hand}");
}

/// Quasi-steady and rigid fidelity keep their state counts and trims.
#[test]
fn val_fidelities() {
    let inputs = inputs();
    let model = model(&inputs, "avl");
    let states = |f| with_fidelity(&model, f).unwrap().system.a.nrows();
    assert_eq!(states(Fidelity::QuasiSteady), 12 + 40);
    assert_eq!(states(Fidelity::Rigid), 12);
}

fn changed(from: &str, to: &str) -> Result<Case, Error> {
    let text = std::fs::read_to_string(case_file()).unwrap();
    assert!(text.contains(from), "the case has changed");
    Case::parse(&text.replacen(from, to, 1), "case.toml")
}

#[test]
fn val_case_errors_name_place_and_cure() {
    let message = |from: &str, to: &str| changed(from, to).unwrap_err().to_string();
    let missing = message("damping_ratio = 0.01", "# none");
    assert!(
        missing.contains("damping_ratio") && missing.contains("case.toml"),
        "{missing}"
    );
    let unknown = message("mach = 0.78", "mack = 0.78");
    assert!(
        unknown.starts_with("case.toml:") && unknown.contains("mack"),
        "{unknown}"
    );
    let axis = message("lra = \"wing_right\"", "lra = \"wing\"");
    assert!(axis.contains("`wing`") && axis.contains("wing_right"), "{axis}");
    let both = message("mach = 0.78", "mach = 0.78\nspeed = 200.0");
    assert!(both.contains("both"), "{both}");
}

#[test]
fn regress_case_choices_that_would_mislead_are_refused() {
    let message = |from: &str, to: &str| changed(from, to).unwrap_err().to_string();
    let twice = message("name = \"HTP\"", "name = \"Wing\"");
    assert!(twice.contains("listed twice"), "{twice}");
    let path = message("name = \"doublet_3Hz\"", "name = \"../doublet_3Hz\"");
    assert!(path.contains("../doublet_3Hz"), "{path}");
    let same = message("name = \"doublet_3Hz\"", "name = \"doublet_10Hz\"");
    assert!(same.contains("two manoeuvres"), "{same}");
    let many = message("points = 600", "points = 1000000000000000");
    assert!(many.contains("100000"), "{many}");

    let mut inputs = inputs();
    inputs.case.engines.clear();
    let variant = inputs.case.variant(Some("engines_in_place")).unwrap();
    assert!(
        Model::build(&inputs, &variant)
            .unwrap_err()
            .to_string()
            .contains("[[engine]]")
    );
    inputs.strips[1] = inputs.strips[0].clone();
    let variant = inputs.case.variant(None).unwrap();
    assert!(
        Model::build(&inputs, &variant)
            .unwrap_err()
            .to_string()
            .contains("named twice")
    );
}

/// A rigid variant has rigid-body modes and no others.
#[test]
fn regress_mode_table_of_a_rigid_variant() {
    let inputs = inputs();
    let mut variant = inputs.case.variant(None).unwrap();
    variant.fidelity = Fidelity::Rigid;
    let model = Model::build(&inputs, &variant).unwrap();
    let table = analysis::mode_table_without_lags(&model, &analysis::trimmed(&model).unwrap()).unwrap();
    assert!(table.elastic.is_empty());
    for mode in &table.rigid_body {
        let flexible = mode.flexible.as_ref().unwrap();
        assert!(
            (flexible.omega_rad_s - mode.rigid.omega_rad_s).abs() < 1e-9,
            "{}",
            mode.name
        );
    }
}

#[test]
fn val_unknown_grid_is_named() {
    let mut inputs = inputs();
    inputs.case.sensors[5].grid = Some(3999);
    let error = Model::build(&inputs, &inputs.case.variant(None).unwrap())
        .unwrap_err()
        .to_string();
    assert!(error.contains("3999"), "{error}");
}

/// A results file without eigenvectors is refused with the output request that makes them.
#[test]
fn val_results_without_vectors_are_refused() {
    let text = std::fs::read_to_string(case_file().with_file_name("f25.f06")).unwrap();
    let cut = text.find("E I G E N V E C T O R").unwrap();
    let error = match albatross::nastran::f06::parse(&text.as_bytes()[..cut], "cut.f06") {
        Err(error) => error.to_string(),
        Ok(results) => {
            let mut inputs = inputs();
            inputs.results = results;
            inputs.basis().unwrap_err().to_string()
        }
    };
    assert!(
        error.contains("DISPLACEMENT") || error.contains("VECTOR"),
        "{error}"
    );
}
