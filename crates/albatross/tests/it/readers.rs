//! Every reader of files, as a function of bytes that uses what it reads as a command would.
//!
//! Shared by the mutation test beside this file and by the targets of `fuzz/`. Results and typed errors are both right;
//! a panic, a hang or memory out of proportion is not.

#![allow(unreachable_pub, reason = "the targets of fuzz/ include this file")]

use albatross::avl::geometry::Geometry;
use albatross::avl::mass::MassFile;
use albatross::avl::results::*;
use albatross::avl::run::RunFile;
use albatross::fem::{FemModel, ModelOptions, ModesOptions, NodalLoad, listing};
use albatross::flight::signal::{Side, Signal};
use albatross::linear::{self, LinearModel};
use albatross::modal::{BasisOptions, ModalBasis};
use albatross::nastran::{Severity, bdf, f06, frames::Frames, write};
use albatross::neutral::{aircraft, wing};
use albatross::sysid::{Columns, Intersample, table};
use albatross::tables::{self, longitudinal, slope_table};
use albatross::vlm::{Condition, Lattice, Method, Solver};
use albatross::{Case, lti};
use std::borrow::Cow;

/// A reader of one kind of file.
pub struct Reader {
    /// Name, that of the target too.
    pub name: &'static str,
    /// Reads the bytes of a file; whether it could be read.
    pub read: fn(&[u8]) -> bool,
}

impl Reader {
    /// Files to begin with, in `fixtures/`.
    pub fn fixtures(&self) -> Vec<&'static str> {
        include_str!("../../../../fixtures/fuzz/readers.txt")
            .lines()
            .filter(|line| line.split(' ').next() == Some(self.name))
            .flat_map(|line| line.split(' ').skip(3))
            .collect()
    }
}

macro_rules! readers {
    ($($name:ident,)*) => {
        /// All readers.
        pub const READERS: &[Reader] = &[$(Reader { name: stringify!($name), read: $name },)*];
    };
}

readers! {
    bdf,
    f06,
    modal_basis,
    fem,
    avl_geometry,
    avl_lattice,
    airfoil,
    avl_mass,
    avl_run,
    avl_ft,
    avl_st,
    avl_sb,
    avl_fn,
    avl_fs,
    avl_fsb,
    avl_fe,
    avl_fb,
    avl_hm,
    avl_vm,
    avl_cnc,
    avl_eig,
    avl_sys,
    case,
    wing_json,
    aircraft_json,
    linear_json,
    longitudinal_json,
    records,
    signal,
    slopes,
}

/// Lattices beyond this many vortices, and structures beyond this many freedoms, are made but not solved: the readers are
/// in question here, not the algebra.
const SOLVED: usize = 120;

/// Text as the readers of files decode it: bytes that are not UTF-8 one by one.
fn text(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.into(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

/// A Nastran deck.
pub fn bdf(bytes: &[u8]) -> bool {
    // Files that include themselves and others, for circles and depth.
    let mut left = 40;
    let (deck, remarks) = bdf::parse_with(bytes, "fuzz.bdf", |path, _| {
        left -= 1;
        if left <= 0 {
            return Err("there is no such file".into());
        }
        Ok(bdf::Included {
            name: path.to_owned(),
            text: bytes.get(..bytes.len().min(200)).unwrap_or_default().to_vec(),
        })
    });
    remarks.iter().for_each(|r| drop(r.to_string()));
    drop(Frames::resolve(&deck));
    let written = write::to_text(&deck);
    drop(written.map(|written| bdf::parse(written.as_bytes(), "written.bdf")));
    !remarks.iter().any(|r| r.severity == Severity::Error)
}

/// Results of SOL 103.
pub fn f06(bytes: &[u8]) -> bool {
    let Ok(results) = f06::parse(bytes, "fuzz.f06") else {
        return false;
    };
    results.diagnostics.iter().for_each(|r| drop(r.to_string()));
    for weight in &results.weights {
        let _ = weight.inertia_about_cg();
    }
    drop(results.require_weight().map(|w| w.mass()));
    drop(results.require_eigenvectors().map(|_| ()));
    drop(listing(&results, "fuzz"));
    true
}

/// A deck and its results, with a line of equal signs between.
pub fn modal_basis(bytes: &[u8]) -> bool {
    let mark = b"\n=====\n";
    let Some(at) = bytes.windows(mark.len()).position(|w| w == mark) else {
        return false;
    };
    let (deck, results) = bytes.split_at(at);
    let (deck, _) = bdf::parse(deck, "fuzz.bdf");
    f06::parse(results.get(mark.len()..).unwrap_or_default(), "fuzz.f06")
        .is_ok_and(|results| ModalBasis::from_nastran(&deck, &results, &BasisOptions::default()).is_ok())
}

/// A deck, and the modes of its structure where it is small.
pub fn fem(bytes: &[u8]) -> bool {
    let (deck, _) = bdf::parse(bytes, "fuzz.bdf");
    let options = ModelOptions {
        leave_out_unknown: true,
        ..ModelOptions::default()
    };
    let Ok(model) = FemModel::assemble(&deck, &options) else {
        return false;
    };
    let _ = (model.properties(), model.weight());
    if model.freedoms().count() <= SOLVED {
        if let Ok(modes) = model.modes(&ModesOptions::of_deck(&deck, None)) {
            drop(model.effective_masses(&modes, [0.0; 3]));
            drop(listing(&modes.results(&model, "fuzz"), "fuzz"));
        }
        if let Some(point) = model.freedoms().points().last() {
            let load = NodalLoad {
                point: point.id,
                load: [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            };
            drop(model.static_solution(&[load], [0.0; 3]));
        }
    }
    true
}

/// A geometry, written and read again.
pub fn avl_geometry(bytes: &[u8]) -> bool {
    let Ok((geometry, remarks)) = Geometry::parse(&text(bytes), "fuzz.avl") else {
        return false;
    };
    remarks.iter().for_each(|r| drop(r.to_string()));
    if let Ok(written) = geometry.to_text() {
        drop(Geometry::parse(&written, "written.avl"));
    }
    true
}

/// A geometry, and its flow where it is small.
pub fn avl_lattice(bytes: &[u8]) -> bool {
    Geometry::parse(&text(bytes), "fuzz.avl").is_ok_and(|(geometry, _)| solve_lattice(&geometry, None))
}

/// Whether there is a lattice, which is solved where it is small.
fn solve_lattice(geometry: &Geometry, file: Option<&str>) -> bool {
    let Ok((lattice, _)) = Lattice::new(geometry, &|_| file.map(str::to_owned)) else {
        return false;
    };
    if lattice.vortices.len() > SOLVED || lattice.bodies.iter().any(|b| b.nodes.len() > SOLVED) {
        return true;
    }
    let Ok(solver) = Solver::new(&lattice, &Method::default(), lattice.mach) else {
        return true;
    };
    if let Ok(solution) = solver.solve(&Condition::at_alpha_deg(2.0, &lattice)) {
        drop(solution.stability_derivatives("fuzz").to_text());
        drop(solution.strip_forces().to_text());
        let _ = (solution.body_derivatives("fuzz"), solution.surface_forces());
        let _ = (solution.body_forces(), solution.element_forces());
        drop((
            solution.shear_moments(),
            solution.strip_loads(),
            solution.hinge_moments(Some(1000.0)),
        ));
    }
    true
}

/// The outline of an aerofoil and of a body, the files that `AFILE` and `BFILE` name.
pub fn airfoil(bytes: &[u8]) -> bool {
    let geometry = "wing\n0.0\n0 0 0\n10.0 1.0 10.0\n0 0 0\nSURFACE\nwing\n3 1.0 3 1.0\nSECTION\n0 0 0 1.0 0\n\
                    AFILE\na.dat\nSECTION\n0 5 0 1.0 0\nBODY\nfuselage\n5 1.0\nBFILE\nb.dat\n";
    let file = text(bytes);
    match Geometry::parse(geometry, "fuzz.avl") {
        Ok((mut geometry, _)) => {
            let bodies = std::mem::take(&mut geometry.bodies);
            let section = solve_lattice(&geometry, Some(&file));
            geometry.bodies = bodies;
            solve_lattice(&geometry, Some(&file)) && section
        }
        Err(error) => panic!("{error}"),
    }
}

/// Masses of AVL, written and read again.
pub fn avl_mass(bytes: &[u8]) -> bool {
    let Ok((file, remarks)) = MassFile::parse(&text(bytes), "fuzz.mass") else {
        return false;
    };
    remarks.iter().for_each(|r| drop(r.to_string()));
    if let Ok(written) = file.to_text() {
        drop(MassFile::parse(&written, "written.mass"));
    }
    true
}

/// Run cases of AVL, written and read again.
pub fn avl_run(bytes: &[u8]) -> bool {
    let Ok((file, remarks)) = RunFile::parse(&text(bytes), "fuzz.run") else {
        return false;
    };
    remarks.iter().for_each(|r| drop(r.to_string()));
    if let Ok(written) = file.to_text() {
        drop(RunFile::parse(&written, "written.run"));
    }
    true
}

/// Results of AVL of one kind, and what their content says that they are.
macro_rules! avl_results {
    ($($(#[$doc:meta])* $name:ident: $kind:ty,)*) => {$(
        $(#[$doc])*
        pub fn $name(bytes: &[u8]) -> bool {
            let text = text(bytes);
            drop(parse_any(&text, "fuzz").map_err(|e| e.to_string()));
            <$kind>::parse(&text, "fuzz").map_err(|e| e.to_string()).is_ok()
        }
    )*};
}

avl_results! {
    /// Total forces.
    avl_ft: TotalForces,
    /// Stability derivatives.
    avl_st: StabilityDerivatives,
    /// Body-axis derivatives.
    avl_sb: BodyDerivatives,
    /// Surface forces.
    avl_fn: SurfaceForces,
    /// Strip forces.
    avl_fs: StripForces,
    /// Strip forces in body axes.
    avl_fsb: BodyAxesStripForces,
    /// Element forces.
    avl_fe: ElementForces,
    /// Body forces.
    avl_fb: BodyForces,
    /// Hinge moments.
    avl_hm: HingeMoments,
    /// Shear and moment.
    avl_vm: ShearMoments,
    /// Strip loading.
    avl_cnc: StripLoads,
    /// Eigenvalues.
    avl_eig: Eigenvalues,
    /// System matrix.
    avl_sys: SystemMatrix,
}

/// A case file, with each of its variants.
pub fn case(bytes: &[u8]) -> bool {
    let Ok(case) = Case::parse(&text(bytes), "case.toml").map_err(|e| e.to_string()) else {
        return false;
    };
    drop(case.variant(None).map_err(|e| e.to_string()));
    for variant in &case.variants {
        drop(case.variant(Some(&variant.name)));
    }
    true
}

/// A neutral wing, analysed where it is small.
pub fn wing_json(bytes: &[u8]) -> bool {
    let Ok(wing) = wing::read(&text(bytes), "fuzz.json").map_err(|e| e.to_string()) else {
        return false;
    };
    if wing.y.len() <= 4 && wing.mu.len() <= 2 && wing.speeds.len() <= 3 {
        drop(wing::analyse(&wing, "fuzz.json").map_err(|e| e.to_string()));
    }
    wing::model(&wing, "fuzz.json").map_err(|e| e.to_string()).is_ok()
}

/// A neutral aircraft, analysed where it is small and its runs are short.
pub fn aircraft_json(bytes: &[u8]) -> bool {
    let Ok(neutral) = aircraft::read(&text(bytes), "fuzz.json").map_err(|e| e.to_string()) else {
        return false;
    };
    let short = |r: &aircraft::RunRequest| !(r.t_end / r.dt).is_finite() || r.t_end / r.dt < 100.0;
    let runs = neutral.runs.as_deref().unwrap_or_default();
    if neutral.strips.y.len() <= 4 && neutral.modes.mu.len() <= 2 && runs.len() <= 3 && runs.iter().all(short)
    {
        drop(aircraft::analyse(&neutral, "fuzz.json").map_err(|e| e.to_string()));
    }
    neutral.aircraft("fuzz.json").map_err(|e| e.to_string()).is_ok()
}

/// A linear model: identified, or a state space.
pub fn linear_json(bytes: &[u8]) -> bool {
    let file = linear::parse(&text(bytes), "fuzz.json").map_err(|e| e.to_string());
    match file.as_ref().map(|file| &file.model) {
        Ok(LinearModel::Identified(model)) => {
            drop(model.poles());
            drop(model.frequency_response(0, &[0.1, 1.0]));
            if model.order() < 20 {
                drop(model.state_space());
                drop(model.zpk(0));
                drop(model.simulate(&[0.0, 1.0, 0.0], 0.1, Intersample::Zoh));
            }
        }
        Ok(LinearModel::StateSpace(system)) => {
            drop(system.without_idle_states());
            if system.states.len() < 20 {
                drop(lti::mode_table(system));
                drop(lti::FrequencySolver::new(system, lti::Method::Auto).and_then(|s| s.response(&[1.0])));
            }
        }
        Err(_) => {}
    }
    file.is_ok()
}

/// Longitudinal derivatives.
pub fn longitudinal_json(bytes: &[u8]) -> bool {
    longitudinal(&text(bytes), "fuzz.json")
        .map_err(|e| e.to_string())
        .is_ok()
}

/// Records for identification.
pub fn records(bytes: &[u8]) -> bool {
    let Ok(table) = table::parse(&text(bytes), "fuzz.csv").map_err(|e| e.to_string()) else {
        return false;
    };
    let names: Vec<String> = table.columns.iter().map(|c| c.header.clone()).take(4).collect();
    let columns = Columns {
        input: names.get(1).cloned().unwrap_or_default(),
        outputs: names.get(2..).unwrap_or_default().to_vec(),
        ..Columns::default()
    };
    let sampled = Columns {
        sample_time: Some(0.01),
        ..columns.clone()
    };
    drop(table.experiment(&sampled).map_err(|e| e.to_string()));
    table.experiment(&columns).map_err(|e| e.to_string()).is_ok()
}

/// A signal in columns of times and values.
pub fn signal(bytes: &[u8]) -> bool {
    let Ok(columns) = tables::Columns::parse(&text(bytes), "fuzz.csv").map_err(|e| e.to_string()) else {
        return false;
    };
    let mut numbers = columns.names().iter().take(2).map(|name| columns.numbers(name));
    let (Some(Ok(time)), Some(Ok(value))) = (numbers.next(), numbers.next()) else {
        return false;
    };
    let signal = Signal::Table { time, value };
    let is_usable = signal.check().is_ok();
    if is_usable {
        signal.at(0.1, Side::Left);
    }
    is_usable
}

/// Lift slopes.
pub fn slopes(bytes: &[u8]) -> bool {
    slope_table(&text(bytes), "fuzz.csv", "fuzz")
        .map_err(|e| e.to_string())
        .is_ok()
}
