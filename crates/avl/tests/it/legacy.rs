//! Layouts of other versions, made here from AVL's FORMAT statements: up to 3.35, 3.40, design variables, MODE.

use std::fmt::Write as _;

use albatross_avl::AvlError;
use albatross_avl::results::*;

const RULE: &str = " ---------------------------------------------------------------\n";

/// The block of total forces of AVL 3.35: `F10.5` for CDind and CDff.
pub(crate) fn old_totals(controls: &[&str], designs: &[&str]) -> String {
    let mut out = format!(
        "{RULE} Vortex Lattice Output -- Total Forces\n\n Configuration: Mach  =  9 e = 7 sailplane\n     # Surfaces =   3\n     # Strips   =  42\n     # Vortices = 336\n\n  \
         Sref =  12.500       Cref = 0.82000       Bref =  15.000    \n  Xref = 0.25000       Yref =  0.0000       Zref = -1.2500    \n\n \
         Geometric axis orientation,  X aft, Z up          \n\n Run case: cruise\n\n  \
         Alpha =   2.50000     pb/2V =   0.01000     p'b/2V =   0.01100\n  Beta  =  -1.00000     qc/2V =   0.00200\n  \
         Mach  =     0.123     rb/2V =  -0.03000     r'b/2V =  -0.03100\n\n  CXtot =   0.01111     Cltot =  -0.00111     Cl'tot =  -0.00112\n  \
         CYtot =   0.00222     Cmtot =  -0.05000\n  CZtot =   0.65432     Cntot =   0.00333     Cn'tot =   0.00334\n\n  \
         CLtot =   0.65400\n  CDtot =   0.01800\n  CDvis =   0.00800     CDind =   0.01000\n  \
         CLff  =   0.65300     CDff  =   0.01010    | Trefftz\n  CYff  =   0.00210         e =    0.9876    | Plane  \n"
    );
    for names in [controls, designs] {
        out.push('\n');
        for (k, name) in names.iter().enumerate() {
            let _ = writeln!(out, "   {name:<16}={:10.5}", k as f64 + 0.5);
        }
    }
    out + RULE
}

/// One row of derivatives: `I1` numbers overflow to `*` at the tenth.
fn old_row(label: &str, prefix: &str, letter: char, values: impl Iterator<Item = f64>) -> String {
    let mut out = label.to_owned();
    for (k, value) in values.enumerate() {
        if k == 20 {
            out.push('\n');
        }
        let number = if k < 9 {
            (k + 1).to_string()
        } else {
            "*".to_owned()
        };
        let _ = write!(out, " {:>7} ={value:11.6}", format!("{prefix}{letter}{number}"));
    }
    out + "\n"
}

const ROWS: [(&str, &str); 5] = [
    (" z' force CL |", "CL"),
    (" y  force CY |", "CY"),
    (" x' mom.  Cl'|", "Cl"),
    (" y  mom.  Cm |", "Cm"),
    (" z' mom.  Cn'|", "Cn"),
];

/// A stability derivative file of AVL 3.35. Derivative k of row r is `100 r + k` thousandths.
fn old_st(controls: &[&str], designs: &[&str]) -> String {
    let mut out = old_totals(controls, designs);
    out += "\n Stability-axis derivatives...\n\n                             alpha                beta\n                  ----------------    ----------------\n";
    for (r, (label, name)) in ROWS.iter().enumerate() {
        let v = r as f64 + 1.0;
        let _ = writeln!(out, "{label}    {name}a ={:11.6}    {name}b ={:11.6}", v, -v);
    }
    out += "\n                     roll rate  p'      pitch rate  q'        yaw rate  r'\n                  ----------------    ----------------    ----------------\n";
    for (r, (label, name)) in ROWS.iter().enumerate() {
        let v = r as f64 + 1.0;
        let _ = writeln!(
            out,
            "{label}    {name}p ={:11.6}    {name}q ={:11.6}    {name}r ={:11.6}",
            10.0 * v,
            -11000.0 - v,
            12.0 * v
        );
    }
    for (names, letter) in [(controls, 'd'), (designs, 'g')] {
        if names.is_empty() {
            continue;
        }
        out += "\n              ";
        for (k, name) in names.iter().enumerate() {
            let _ = write!(
                out,
                "    {:<12.12} {letter}{} ",
                name,
                if k < 9 { (k + 1).to_string() } else { "*".into() }
            );
        }
        let _ = writeln!(
            out,
            "\n              {}",
            "    ----------------".repeat(names.len())
        );
        for (r, (label, name)) in ROWS.iter().enumerate() {
            out += &old_row(
                label,
                name,
                letter,
                (0..names.len()).map(|k| (100.0 * r as f64 + k as f64) * 1e-3),
            );
        }
        out += &old_row(
            " Trefftz drag|",
            "CDff",
            letter,
            (0..names.len()).map(|k| 1.0 + k as f64),
        );
        out += &old_row(
            " span eff.   |",
            "e",
            letter,
            (0..names.len()).map(|k| 2.0 + k as f64),
        );
        out += "\n\n";
    }
    out + "\n Neutral point  Xnp =   0.333333\n"
}

#[test]
fn val_stability_derivatives_up_to_3_35() {
    let controls = ["flap_left_outer1", "flap_left_outer2", "aileron"];
    let text = old_st(&controls, &["twist", "dihedral"]);
    let st = StabilityDerivatives::parse(&text, "old.st").unwrap();
    assert_eq!(
        (st.run.axes, st.run.mach, st.run.span_efficiency),
        (AxisOrientation::Geometric, 0.123, 0.9876)
    );
    assert_eq!(
        (st.run.c_roll, st.run.c_roll_stability, st.run.c_lift),
        (-0.00111, -0.00112, 0.654)
    );
    assert_eq!((st.run.reference.c_ref, st.run.reference.z_ref), (0.82, -1.25));
    assert_eq!(st.run.title, "Mach  =  9 e = 7 sailplane");
    // No drag row, and no spiral line.
    assert_eq!(st.get(Coefficient::Drag, Variable::Alpha), None);
    assert_eq!((st.neutral_point_x, st.spiral_ratio), (Some(0.333_333), None));
    assert_eq!(st.get(Coefficient::Lift, Variable::Alpha), Some(1.0));
    assert_eq!(st.get(Coefficient::Roll, Variable::Alpha), Some(3.0));
    assert_eq!(st.get(Coefficient::Pitch, Variable::PitchRate), Some(-11004.0));
    // The header's names are cut to 12 characters and the same for both flaps.
    assert_eq!(st.control("flap_left_outer2").unwrap().pitch, 0.301);
    assert_eq!(st.control("aileron").unwrap().trefftz_drag, Some(3.0));
    assert_eq!(st.design("dihedral").unwrap().yaw, 0.401);
    assert_eq!(st.run.designs[1].value, 1.5);
}

#[test]
fn val_more_controls_than_the_label_has_digits() {
    let names: Vec<String> = (1..=23).map(|k| format!("control_{k}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let st = StabilityDerivatives::parse(&old_st(&names, &[]), "old.st").unwrap();
    assert_eq!(st.controls.len(), 23);
    // The tenth is labelled `d*`; the 21st stands on a second line.
    assert_eq!(st.control("control_10").unwrap().lift, 0.009);
    assert_eq!(st.control("control_21").unwrap().yaw, 0.420);
    assert_eq!(st.control("control_23").unwrap().span_efficiency, Some(24.0));
}

#[test]
fn derivatives_that_do_not_match_the_controls_are_refused() {
    let whole = old_st(&["a", "b"], &[]);
    // A column without its name among the deflections, and a name without its column.
    let text = whole.replacen("   b               =   1.50000\n", "", 1);
    let error = StabilityDerivatives::parse(&text, "t.st").unwrap_err();
    assert!(
        matches!(
            &error,
            AvlError::Count {
                announced: 1,
                found: 2,
                ..
            }
        ),
        "{error}"
    );
    let text = whole.replacen(
        "   b               =",
        "   c               =   0.00000\n   b               =",
        1,
    );
    let error = StabilityDerivatives::parse(&text, "t.st").unwrap_err();
    assert!(
        matches!(
            &error,
            AvlError::Count {
                announced: 3,
                found: 2,
                ..
            }
        ),
        "{error}"
    );
    let text = whole.replacen("    Cma =", "    CmA =", 1);
    assert!(matches!(
        StabilityDerivatives::parse(&text, "t.st"),
        Err(AvlError::Syntax { .. })
    ));
    let line = whole.lines().find(|l| l.contains("CLp =")).unwrap();
    let error = StabilityDerivatives::parse(&whole.replacen(line, "", 1), "t.st").unwrap_err();
    assert!(
        matches!(&error, AvlError::Missing { field, .. } if field == "CLp"),
        "{error}"
    );
}

/// Forces in stability axes with moments in body axes: not an `.st`.
#[test]
fn derivatives_in_mixed_axes_are_refused() {
    let text = old_st(&[], &[]).replace("Stability-axis derivatives...", "Derivatives...");
    let error = StabilityDerivatives::parse(&text, "t.st").unwrap_err();
    assert!(
        matches!(
            error,
            AvlError::WrongKind {
                found: FileKind::MixedDerivatives,
                ..
            }
        ),
        "{error}"
    );
    assert!(error.to_string().ends_with("write it with OPER > ST"));
}

/// Machine-readable derivatives of AVL 3.40, which prints as many design columns as there are controls.
#[test]
fn val_machine_readable_design_columns_of_3_40() {
    let es = |v: f64| {
        let text = format!("{v:.15e}");
        let (m, e) = text.split_once('e').unwrap();
        format!("{:>23}", format!("{m}E{:+03}", e.parse::<i32>().unwrap()))
    };
    let line = |values: &[f64], label: &str| {
        format!(
            "{}  | {label}\n",
            values.iter().map(|&v| es(v)).collect::<String>()
        )
    };
    let mut t = "DERMATS\nVERSION 1.0\nVortex Lattice Output -- Total Forces\nTitle\n     1      | # surfaces\n     2      | # strips\n     \
                 8      | # vortices\n"
        .to_owned();
    t += &line(&[0.0], "Y Symmetry: Wall plane");
    t += &line(&[1.0, 2.0, 3.0], "Sref, Cref, Bref");
    t += &line(&[4.0, 5.0, 6.0], "Xref, Yref, Zref");
    t += "Standard axis orientation,  X fwd, Z down\n -unnamed-\n";
    for (n, label) in [
        (3, "Alpha, pb/2V, p'b/2V"),
        (2, "Beta, qc/2V"),
        (3, "Mach, rb/2V, r'b/2V"),
        (3, "CXtot, Cltot, Cl'tot"),
        (2, "CYtot, Cmtot"),
        (3, "CZtot, Cntot, Cn'tot"),
        (1, "CLtot"),
        (1, "CDtot"),
        (2, "CDvis, CDind"),
        (4, "Trefftz Plane: CLff, CDff, CYff, e"),
    ] {
        t += &line(&vec![0.5; n], label);
    }
    t += &format!(
        "CONTROL\n     2\n{}  a\n{}  b\nDESIGN\n     1\n{}  g\n",
        es(1.0),
        es(2.0),
        es(3.0)
    );
    t += "\nStability-axis derivatives...\nalpha, beta\n";
    for (_, n) in ROWS {
        t += &line(&[1.0, 2.0], &format!("label : {n}a, {n}b"));
    }
    t += "roll rate  p', pitch rate  q', yaw rate  r'\n";
    for (_, n) in ROWS {
        t += &line(&[3.0, 4.0, 5.0], &format!("label : {n}p, {n}q ,{n}r"));
    }
    for (heading, letter) in [
        ("   2  | # control vars\na\nb\n", 'd'),
        ("   1  | # design vars\ng\n", 'g'),
    ] {
        t += heading;
        for n in ["CL", "CY", "Cl", "Cm", "Cn", "CDff", "e"] {
            t += &line(&[6.0, 7.0], &format!("label : {n}{letter}*"));
        }
    }
    t += &line(&[0.25], "Neutral point  Xnp");
    t += &line(&[-1.0e30], "Clb Cnr / Clr Cnb ( > 1 if spirally stable )");
    let st = StabilityDerivatives::parse(&t, "t.st").unwrap();
    assert_eq!(st.get(Coefficient::Yaw, Variable::YawRate), Some(5.0));
    assert_eq!((st.alpha.drag, st.control("b").unwrap().pitch), (None, 7.0));
    assert_eq!(
        (st.designs.len(), st.design("g").unwrap().span_efficiency),
        (1, Some(6.0))
    );
    assert_eq!((st.neutral_point_x, st.spiral_ratio), (Some(0.25), None));
    assert_eq!((st.run.n_vortices, st.run.reference.b_ref), (8, 3.0));
}

const OLD_SURFACE: &str = "\n  Surface # 1     Main wing                               \n     # Chordwise =  4   # Spanwise =  3     First strip =  1\n     \
    Surface area =    6.250000       Ave. chord =    0.820000\n     CLsurf  =   0.65400     Clsurf  =  -0.00010\n     CYsurf  =   0.00020     \
    Cmsurf  =  -0.05000\n     CDsurf  =   0.01800     Cnsurf  =   0.00030\n     CDisurf =   0.01000     CDvsurf =   0.00800\n\n  \
    Forces referred to Ssurf, Cave about hinge axis thru LE\n     CLsurf  =   0.66000     CDsurf  =   0.01900\n     Deflect =\n\n Strip \
    Forces referred to Strip Area, Chord\n    j      Yle    Chord     Area     c cl      ai      cl_norm  cl       cd       cdv    cm_c/4    \
    cm_LE  C.P.x/c\n";

fn old_fs() -> String {
    let mut out = format!(
        "{RULE} Surface and Strip Forces by surface\n\n  Forces referred to Sref, Cref, Bref about Xref, Yref, Zref\n Geometric axis \
         orientation,  X aft, Z up          \n{OLD_SURFACE}"
    );
    // The second strip's centre of pressure is outside (-1, 2) and left out.
    for (j, xcp) in [(1, Some(0.25)), (2, None), (3, Some(-0.5))] {
        let _ = write!(out, "  {j:4}");
        for k in 0..11 {
            let _ = write!(out, " {:8.4}", f64::from(j) + f64::from(k) * 0.1);
        }
        match xcp {
            Some(xcp) => writeln!(out, " {xcp:8.3}").unwrap(),
            None => out.push('\n'),
        }
    }
    out + RULE
}

#[test]
fn val_strip_forces_up_to_3_35() {
    let fs = StripForces::parse(&old_fs(), "old.fs").unwrap();
    assert_eq!((fs.reference, fs.axes), (None, AxisOrientation::Geometric));
    let surface = &fs.surfaces[0];
    assert_eq!(
        (surface.name.as_str(), surface.area, surface.average_chord),
        ("Main wing", 6.25, 0.82)
    );
    assert_eq!(
        (surface.coefficients.c_drag_viscous, surface.coefficients.cd_local),
        (0.008, 0.019)
    );
    let [first, second, third] = surface.strips.as_slice() else {
        panic!("three strips")
    };
    assert_eq!(
        (first.x_le, first.y_le, first.z_le, first.chord),
        (None, 1.0, None, 1.1)
    );
    assert_eq!(
        (first.cl_norm, first.cm_le, first.xcp),
        (1.5, Some(2.0), Some(0.25))
    );
    assert_eq!((second.cm_le, second.xcp), (Some(3.0), None));
    assert_eq!(third.xcp, Some(-0.5));
    // It lacks what the layout of 3.52 needs.
    assert!(matches!(fs.to_text(), Err(AvlError::BadText { .. })));
}

#[test]
fn val_element_forces_up_to_3_35_and_their_overflowing_number() {
    let strip = "\n Strip #  1     # Chordwise =  1   First Vortex = 999\n    Xle =   0.00000    Ave. Chord   =    0.2000   Incidence  =    \
                 1.5000 deg\n    Yle =   0.03272    Strip Width  =   0.06540   Strip Area =    0.013081\n    Zle =   0.10000    Strip Dihed. \
                 =    5.0000\n\n    cl  =   0.48950       cd  =   0.00406      cdv =   0.00000\n    cn  =   0.48799       ca  =  -0.03862      \
                 cnc =   0.09760    wake dnwsh =   0.01999\n    cmLE=  -0.12136    cm c/4 =   0.00064\n\n    I        X           Y           Z \
                 DX        Slope        dCp\n";
    let stars = format!(" {}\n", "*".repeat(78));
    let head = OLD_SURFACE
        .split("     Deflect")
        .next()
        .unwrap()
        .replace("# Spanwise =  3", "# Spanwise =  1");
    let file = |index: &str| {
        format!(
            "{RULE} Vortex Strengths (by surface, by strip)\n\n  Forces referred to Sref, Cref, Bref about Xref, Yref, Zref\n  Standard axis \
             orientation,  X fwd, Z down         \n\n{stars}{}{stars}{strip}  {index}     0.00603     0.03270     0.00000     0.03572     0.00000     \
             1.18328\n{RULE}",
            head.trim_start_matches('\n')
        )
    };
    let fe = ElementForces::parse(&file("999"), "old.fe").unwrap();
    let strip = &fe.surfaces[0].strips[0];
    assert_eq!(
        (strip.incidence_deg, strip.dihedral_deg, strip.cm_le),
        (1.5, 5.0, -0.12136)
    );
    assert_eq!(
        (strip.elements[0].index, strip.elements[0].delta_cp),
        (999, 1.18328)
    );
    let error = ElementForces::parse(&file("***"), "old.fe").unwrap_err();
    assert!(
        matches!(&error, AvlError::Overflow { field, .. } if field == "I"),
        "{error}"
    );
}

#[test]
fn val_surface_forces_up_to_3_35() {
    let text = format!(
        "{RULE} Surface Forces (referred to Sref,Cref,Bref about Xref,Yref,Zref)\n Standard axis orientation,  X fwd, Z down         \n\n     Sref \
         =   12.50       Cref =    0.8200   Bref =   15.0000\n     Xref =      0.2500   Yref =    0.0000   Zref =    0.0000\n\n n      Area      CL \
         CD      Cm      CY      Cn      Cl     CDi     CDv\n 1    12.500-46.0673590.2322 -0.0000 16.9672334.2360 46.0673  0.0000  0.0080   Main \
         wing\n\n Surface Forces (referred to Ssurf, Cave about root LE on hinge axis)\n\n   n     Ssurf      Cave       cl       cd      cdv    \
         cm_LE\n   1    12.500     0.820   0.6600   0.0190   0.0080  -0.2000  Main wing\n{RULE}"
    );
    let s = &SurfaceForces::parse(&text, "old.fn").unwrap().surfaces[0];
    assert_eq!(
        (s.c_lift, s.c_drag, s.c_m, s.c_y),
        (-46.0673, 590.2322, 0.0, 16.9672)
    );
    assert_eq!(
        (s.c_n, s.c_roll, s.c_drag_viscous, s.cm_le_local),
        (334.2360, 46.0673, 0.008, Some(-0.2))
    );
    assert_eq!(s.name, "Main wing");
}

#[test]
fn val_body_forces_of_both_widths() {
    let head = |prefix: &str| {
        format!(
            "{RULE} Body Forces (referred to Sref,Cref,Bref about Xref,Yref,Zref)\n Standard axis orientation,  X fwd, Z down         \n\n     Sref \
             =   12.50       Cref =    0.8200   Bref =   15.0000\n     Xref =      0.2500   Yref =    0.0000   Zref =    0.0000\n\n{prefix}"
        )
    };
    let old = head("Ibdy    Length     Asurf       Vol      CL      CD      Cm      CY      Cn      Cl\n")
        + "   1     7.000    12.000     1.500  0.0100 -0.0020-590.002  0.0000  0.0000  0.0000   Fuselage pod\n"
        + RULE;
    // F8.4 cannot hold -590.0020: the point is off its column, and the blanks do not help.
    let error = BodyForces::parse(&old, "old.fb").unwrap_err();
    assert!(
        error.to_string().contains("`Cm` with its decimal point"),
        "{error}"
    );
    let old = old.replace("-590.002", "-90.0020");
    let body = BodyForces::parse(&old, "old.fb").unwrap().bodies[0].clone();
    assert_eq!(
        (body.name.as_str(), body.length, body.c_drag, body.c_m),
        ("Fuselage pod", 7.0, -0.002, -90.002)
    );
    let mut new = head(
        " Ibdy       Length        Asurf          Vol          CL          CD          Cm          CY          Cn          Cl\n",
    );
    let _ = write!(new, " {:4}", 1);
    for v in [7.0, 12.0, 1.5] {
        let _ = write!(new, " {v:12.6}");
    }
    for v in [0.01, -0.002, -0.59, 0.0, 0.0, 0.0] {
        let _ = write!(new, "{v:12.6}");
    }
    let new = new + "   Fuselage pod\n" + RULE;
    let body = BodyForces::parse(&new, "new.fb").unwrap().bodies[0].clone();
    assert_eq!(
        (body.volume, body.c_m, body.name.as_str()),
        (1.5, -0.59, "Fuselage pod")
    );
}

#[test]
fn val_hinge_and_shear_up_to_3_35() {
    let hm = format!(
        "{RULE} Control Hinge Moments\n (referred to    Sref =   12.50       Cref =    0.8200)\n\n Control          Chinge\n ---------------- \
         -----------\n elevator         -0.1234E-02\n sixteen letters.   0.5000    \n{RULE}"
    );
    let hm = HingeMoments::parse(&hm, "old.hm").unwrap();
    assert_eq!(
        (hm.controls[0].c_hinge, hm.controls[0].deflection_deg),
        (-0.1234e-2, None)
    );
    let vm = "\n Shear/q and Bending Moment/q vs Y\n  Configuration: Sailplane\n  Mach  =    0.123\n  alpha =    2.500    CLtot =    0.654\n  beta  =    \
              0.000\n\n  Sref  =    12.50000\n  Bref  =    15.00000\n \n Surface:   1  Main wing\n     2Ymin/Bref =    0.00000\n     2Ymax/Bref =    \
              1.00000\n   2Y/Bref      Vz/(q*Sref)      Mx/(q*Bref*Sref)\n    0.0000  0.327000         0.654000E-01\n    0.5000  0.163000         \
              0.163000E-01\n    1.0000   0.00000          0.00000    \n";
    let parsed = ShearMoments::parse(vm, "old.vm").unwrap();
    assert_eq!(parsed.surfaces[0].name, "Main wing");
    assert_eq!(
        parsed.surfaces[0].stations[1],
        ShearStation {
            eta: 0.5,
            shear: 0.163,
            moment: 0.0163
        }
    );
    let cut = vm.rsplit_once("    1.0000").unwrap().0;
    assert!(matches!(
        ShearMoments::parse(cut, "cut.vm"),
        Err(AvlError::Truncated { .. })
    ));
}

#[test]
fn val_strip_loading_of_both_widths() {
    let old = "   0.250    1.000    0.000     0.5000     0.6100   0.8200   0.1000    0.0820\n";
    let load = StripLoads::parse(old, "old.cnc").unwrap().strips[0];
    assert_eq!(
        (load.position[1], load.cnc, load.cl, load.area),
        (1.0, 0.5, 0.61, 0.082)
    );
    let new: String = [0.25, 1.0, 0.0, 0.5, 0.61, 0.82, 0.1, 0.082]
        .iter()
        .map(|v| format!("{v:12.6} "))
        .collect();
    assert_eq!(StripLoads::parse(&new, "new.cnc").unwrap().strips[0], load);
}

/// `(1X,12F10.4,3X,12G12.4)`, with columns that touch, and OptVL's `12G12.4`.
#[test]
fn val_system_matrices() {
    let head = "\n      u         w         q        the        v         p         r        phi        x         y         z        psi    |  elevator    aileron     \n";
    let mut text = head.to_owned();
    for i in 0..12 {
        text.push(' ');
        for j in 0..12 {
            let value = if j == 2 {
                -1234.5678
            } else {
                f64::from(i) - f64::from(j) / 8.0
            };
            let _ = write!(text, "{value:10.4}");
        }
        text += "    -0.1234E-02   3.500    \n";
    }
    let m = SystemMatrix::parse(&text, "t.sys").unwrap();
    assert_eq!(
        (m.states.len(), m.states[3].as_str(), &m.controls[..]),
        (12, "the", &["elevator".to_owned(), "aileron".to_owned()][..])
    );
    assert_eq!(
        (m.a[5][2], m.a[5][4], m.b[11][0], m.b[11][1]),
        (-1234.5678, 4.5, -0.1234e-2, 3.5)
    );
    let stars = text.replacen("-1234.5678", "**********", 1);
    let error = SystemMatrix::parse(&stars, "t.sys").unwrap_err();
    assert!(
        matches!(&error, AvlError::Overflow { at, .. } if (at.line, at.column) == (3, 22)),
        "{error}"
    );
    let mut text = head.to_owned();
    for _ in 0..12 {
        text += &format!(" {}   {}\n", "  1.250     ".repeat(12), " -0.1234E-02".repeat(2));
    }
    let m = SystemMatrix::parse(&text, "t.sys").unwrap();
    assert_eq!((m.a[11][11], m.b[0][1]), (1.25, -0.1234e-2));
    let cut = text.trim_end().rsplit_once('\n').unwrap().0;
    assert!(matches!(
        SystemMatrix::parse(cut, "cut.sys"),
        Err(AvlError::Truncated { .. })
    ));
}

#[test]
fn val_eigenvalues() {
    let text = "# F25\n# \n#   Run case     Eigenvalue\n       1   -0.98895929E-03   -0.51790625E-01\n       1   -0.98895929E-03    \
                0.51790625E-01\n       2     -2.7311234         0.0000000    \n";
    let Ok(ResultFile::Eigenvalues(eig)) = parse_any(text, "t.eig") else {
        panic!("eigenvalues")
    };
    assert_eq!((eig.title.as_str(), eig.eigenvalues.len()), ("F25", 3));
    assert_eq!(eig.eigenvalues[1].omega_rad_s, 0.051_790_625);
    assert_eq!(
        (eig.eigenvalues[2].run_case, eig.eigenvalues[2].sigma),
        (2, -2.731_123_4)
    );
}
