//! `albatross export`: files of the F25-like case given to other programs where these are installed.
//!
//! Python is `python3`, or what `ALBATROSS_PYTHON` names; each test says by whom a file was read back. The readers of
//! `crates/export/tests` need no other program.

use crate::support::{CaseCopy, albatross, case, failure, json};
use albatross::lti::{StateSpace, Zpk};
use albatross::numerics::{C64, eigen};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder with files exported into it.
struct Exported(tempfile::TempDir);

impl Exported {
    fn new(case: &str, options: &[&str], files: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let paths: Vec<String> = files
            .iter()
            .map(|f| folder.path().join(f).display().to_string())
            .collect();
        let to = ["--quiet", "--to"]
            .into_iter()
            .chain(paths.iter().map(String::as_str));
        let arguments: Vec<&str> = ["export", case]
            .iter()
            .chain(options)
            .copied()
            .chain(to)
            .collect();
        let output = albatross(&arguments);
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        assert_eq!(
            String::from_utf8_lossy(&output.stdout).lines().count(),
            files.len()
        );
        Self(folder)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.at(name)).unwrap()
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    /// What a Python program prints as JSON in the folder; none without the module.
    fn python(&self, module: &str, program: &str) -> Option<Value> {
        let python = std::env::var("ALBATROSS_PYTHON").unwrap_or_else(|_| "python3".into());
        let run = |program: &str| {
            Command::new(&python)
                .args(["-c", program])
                .current_dir(self.0.path())
                .output()
        };
        let there = run(&format!("import {module}")).is_ok_and(|output| output.status.success());
        if !there {
            say(&format!(
                "{module} is not installed for {python}: not read back by it"
            ));
            return None;
        }
        let output = run(program).unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        say(&format!("read back by {module}"));
        Some(serde_json::from_slice(&output.stdout).unwrap())
    }

    /// What Octave prints between `<<` and `>>`, as JSON; none without Octave.
    fn octave(&self, program: &str) -> Option<Value> {
        let program = format!("{program}; printf('<<%s>>', jsonencode(r))");
        let output = Command::new("octave-cli")
            .args(["--no-init-file", "--quiet", "--eval", &program])
            .current_dir(self.0.path())
            .output();
        let Ok(output) = output else {
            say("octave-cli is not installed: not read back by it");
            return None;
        };
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let begin = text
            .find("<<")
            .unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(&output.stderr)));
        say("read back by Octave");
        Some(serde_json::from_str(&text[begin + 2..text.rfind(">>").unwrap()]).unwrap())
    }
}

#[allow(clippy::print_stderr, reason = "tests say who read a file")]
fn say(what: &str) {
    eprintln!("{what}");
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().unwrap_or_else(|| panic!("{other} is no number"))],
    }
}

fn complex(re: &Value, im: &Value) -> Vec<C64> {
    numbers(re)
        .into_iter()
        .zip(numbers(im))
        .map(|(re, im)| C64::new(re, im))
        .collect()
}

/// Eigenvalues that another program finds in its file are ours to 1e-12 of their modulus, absolutely
/// below 1 rad/s, each taken once.
fn same_eigenvalues(system: &StateSpace, mut found: Vec<C64>) {
    let ours = eigen::eigenvalues(system.a.as_ref()).unwrap();
    assert_eq!(ours.len(), found.len());
    for value in ours {
        let distance = |other: &C64| (other - value).norm();
        let (k, nearest) = found
            .iter()
            .map(distance)
            .enumerate()
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap();
        assert!(nearest <= 1e-12 * value.norm().max(1.0), "{value}: {nearest:e}");
        found.swap_remove(k);
    }
}

const FILES: [&str; 4] = ["m.mat", "m.npz", "m.json", "m.csv"];

#[test]
fn val_the_linear_model_in_scipy_numpy_and_octave() {
    let exported = Exported::new(&case(), &[], &FILES);
    // The JSON is that of `linearize`, and holds every bit.
    let printed = json(&["linearize", &case(), "--json", "--quiet"]);
    assert_eq!(exported.json("m.json"), printed);
    let system: StateSpace = serde_json::from_value(printed).unwrap();

    let header = exported.text("m.csv");
    let header = header.lines().next().unwrap();
    assert!(
        header.starts_with("row,name,unit,state u [m/s],state v [m/s],"),
        "{}",
        &header[..80]
    );
    assert!(header.ends_with(",input thrust [N]"));

    let names = |value: &Value| -> Vec<String> { serde_json::from_value(value.clone()).unwrap() };
    let check = |read: &Value| {
        same_eigenvalues(&system, complex(&read["re"], &read["im"]));
        let states: Vec<&str> = system.states.iter().map(|s| s.name.as_str()).collect();
        assert_eq!(names(&read["states"]), states);
        let units: Vec<&str> = system.outputs.iter().map(|s| s.unit.as_str()).collect();
        assert_eq!(names(&read["units"]), units);
        // In level flight the body sees the speed of trim.
        let trim = json(&["trim", &case(), "--json", "--quiet"]);
        let x = numbers(&read["x"]);
        assert!((x[0].hypot(x[2]) - trim["speed"].as_f64().unwrap()).abs() < 1e-10);
        // The first output is the incidence, which the trim reports.
        assert_eq!(numbers(&read["y"])[0], trim["alpha_rad"].as_f64().unwrap());
    };
    let read = exported.python(
        "scipy",
        "import csv, json, numpy as np, scipy.io\n\
         m, z, j = scipy.io.loadmat('m.mat'), np.load('m.npz'), json.load(open('m.json'))\n\
         rows = list(csv.reader(open('m.csv')))\n\
         t = np.array([[float(v) for v in r[3:]] for r in rows[1:]])\n\
         n = sum(h.startswith('state') for h in rows[0])\n\
         table = dict(A=t[:n, :n], B=t[:n, n:], C=t[n:, :n], D=t[n:, n:])\n\
         same = all(np.array_equal(m[k], o) for k in 'ABCD' for o in (z[k], j[k.lower()], table[k]))\n\
         text = lambda cells: [str(c[0]) for c in cells.ravel()]\n\
         assert text(m['StateName']) == list(z['StateName']) and text(m['InputUnit']) == list(z['InputUnit'])\n\
         e = np.linalg.eigvals(m['A'])\n\
         print(json.dumps(dict(same=same, re=e.real.tolist(), im=e.imag.tolist(), states=text(m['StateName']),\n\
         units=z['OutputUnit'].tolist(), x=m['Trim']['x'][0, 0].ravel().tolist(), y=z['Trim.y'].tolist())))",
    );
    if let Some(read) = read {
        assert_eq!(
            read["same"], true,
            "all four files hold the same matrices, bit by bit"
        );
        check(&read);
    }
    // Numbers are printed with 17 digits: jsonencode has 15.
    let read = exported.octave(
        "m = load('m.mat'); e = eig(m.A); f = @(v) arrayfun(@(x) sprintf('%.17g', x), v, 'UniformOutput', false); \
         r = struct('re', {f(real(e))}, 'im', {f(imag(e))}, 'states', {m.StateName}, 'units', {m.OutputUnit}, \
         'x', {f(m.Trim.x)}, 'y', {f(m.Trim.y)})",
    );
    if let Some(mut read) = read {
        for key in ["re", "im", "x", "y"] {
            for value in read[key].as_array_mut().unwrap() {
                *value = value.as_str().unwrap().parse::<f64>().unwrap().into();
            }
        }
        check(&read);
    }
}

/// Zeros, poles and gain are the frequency response that `bode` finds by other means; SciPy agrees from its own file.
#[test]
fn val_a_transfer_function() {
    let omega = "0.05,0.5,2,10,40";
    let bode = json(&["bode", &case(), "--json", "--quiet", "--omega", omega]);
    let expected = complex(&bode["outputs"]["q"]["re"], &bode["outputs"]["q"]["im"]);
    let omega = numbers(&bode["omega_rad_s"]);
    let close = |found: &[C64], tolerance: f64| {
        for (h, e) in found.iter().zip(&expected) {
            assert!((h - e).norm() <= tolerance * e.norm(), "{h} {e}");
        }
    };

    let exported = Exported::new(
        &case(),
        &["--transfer", "elevator", "q"],
        &["t.json", "t.mat", "t.npz"],
    );
    let read = exported.json("t.json");
    let zpk: Zpk = serde_json::from_value(read.clone()).unwrap();
    let responses =
        |zpk: &Zpk| -> Vec<C64> { omega.iter().map(|w| zpk.evaluate(C64::new(0.0, *w))).collect() };
    close(&responses(&zpk), 1e-9);
    assert_eq!(
        read["output"],
        serde_json::json!({ "name": "q", "unit": "rad/s" })
    );
    assert!(
        read["transfer_function"].is_null(),
        "order 399 has no coefficients in range"
    );
    let found = exported.python(
        "scipy",
        &format!(
            "import json, numpy as np, scipy.io\n\
             t, z = scipy.io.loadmat('t.mat'), np.load('t.npz')\n\
             assert all(np.array_equal(t[k].ravel(), z[k].ravel()) for k in 'ZPK') and t['Numerator'].size == 0\n\
             assert t['InputName'][0, 0][0] == 'elevator' and z['OutputUnit'][0] == 'rad/s'\n\
             Z, P, s = t['Z'].ravel(), t['P'].ravel(), 1j * np.array({omega:?})\n\
             h = [t['K'].item() * np.prod((w - Z) / (w - P[:len(Z)])) / np.prod(w - P[len(Z):]) for w in s]\n\
             print(json.dumps(dict(re=np.real(h).tolist(), im=np.imag(h).tolist())))"
        ),
    );
    if let Some(found) = found {
        close(&complex(&found["re"], &found["im"]), 1e-9);
    }

    // Without lag states and without what pitch does not see, an order that polynomials can bear.
    let copy = CaseCopy::new();
    copy.replace(
        "case.toml",
        "name = \"avl\"\n",
        "name = \"avl\"\nfidelity = \"rigid\"\n",
    );
    let options = ["--transfer", "elevator", "q", "--cancel", "1e-6"];
    let exported = Exported::new(&copy.arg("case.toml"), &options, &["t.json", "t.mat"]);
    let read = exported.json("t.json");
    assert!(
        read["transfer_function_error"].as_f64().unwrap() < 1e-10,
        "{read}"
    );
    let denominator = numbers(&read["transfer_function"]["denominator"]);
    assert_eq!(denominator.len(), read["poles"].as_array().unwrap().len() + 1);
    let read = exported.octave(
        "t = load('t.mat'); r = struct('error', max(abs(sort(real(roots(t.Denominator))) - sort(real(t.P)))), \
         'size', {size(t.Numerator)})",
    );
    if let Some(read) = read {
        assert!(read["error"].as_f64().unwrap() < 1e-8, "{read}");
        assert_eq!(read["size"][0], 1);
    }
}

#[test]
fn val_mode_shapes_in_vtk() {
    let exported = Exported::new(&case(), &[], &["shapes.vtu"]);
    let again = exported.at("again.vtu").display().to_string();
    let told = json(&["export", &case(), "--json", "--to", &again]);
    assert_eq!(told["files"][0]["file"], again);
    assert_eq!(
        told["files"][0]["content"],
        "20 modes on 898 points and 421 cells"
    );
    assert_eq!(exported.text("again.vtu"), exported.text("shapes.vtu"));
    let text = exported.text("shapes.vtu");
    // 114 grids and 196 strips of four corners; twenty modes of the case.
    assert!(text.contains("NumberOfPoints=\"898\" NumberOfCells=\"421\""));
    assert_eq!(text.matches("Name=\"mode_").count(), 20);
    let read = exported.python(
        "vtk",
        "import json, vtk\n\
         from vtk.util.numpy_support import vtk_to_numpy as n\n\
         r = vtk.vtkXMLUnstructuredGridReader(); r.SetFileName('shapes.vtu'); r.Update(); g = r.GetOutput()\n\
         d = g.GetPointData(); names = [d.GetArrayName(i) for i in range(d.GetNumberOfArrays())]\n\
         grid, kind = n(d.GetArray('grid')), n(g.GetCellData().GetArray('kind'))\n\
         print(json.dumps(dict(points=g.GetNumberOfPoints(), cells=[int((kind == k).sum()) for k in range(6)],\n\
         names=names, tip=n(d.GetArray(names[1]))[list(grid).index(1025)].tolist(),\n\
         f=n(g.GetFieldData().GetArray('frequency_hz')).tolist())))",
    );
    let modes = json(&["modes", &case(), "--json", "--quiet"]);
    let frequency = |k: usize| modes["modes"][k]["frequency_hz"].as_f64().unwrap();
    assert!(text.contains(&format!("Name=\"mode_01_{:.3}_Hz\"", frequency(0))));
    if let Some(read) = read {
        assert_eq!(read["points"], 898);
        assert_eq!(numbers(&read["cells"]), [112.0, 108.0, 0.0, 0.0, 5.0, 196.0]);
        assert_eq!(numbers(&read["f"])[19], frequency(19));
        let basis = albatross::Inputs::read(Path::new(&case()))
            .unwrap()
            .basis()
            .unwrap();
        assert_eq!(numbers(&read["tip"]), basis.shape_at(1025).unwrap()[0][..3]);
    }
}

#[test]
fn val_time_histories() {
    let copy = CaseCopy::new();
    copy.replace("case.toml", "end = 10.0\n", "end = 0.2\n");
    let case = copy.arg("case.toml");
    let name = "doublet_0p5Hz";
    let mut files = vec!["h.csv", "h.npz", "h.mat", "h.json"];
    if cfg!(feature = "parquet") {
        files.push("h.parquet");
    }
    let exported = Exported::new(&case, &["--manoeuvre", name], &files);
    let printed = json(&["simulate", &case, "--manoeuvre", name, "--json", "--quiet"]);
    assert_eq!(exported.json("h.json"), printed);
    let csv = exported.text("h.csv");
    assert!(csv.starts_with("t [s],aileron_in [rad],"), "{}", &csv[..80]);
    let read = exported.python(
        "scipy",
        "import csv, json, numpy as np, scipy.io\n\
         m, z = scipy.io.loadmat('h.mat'), np.load('h.npz')\n\
         rows = list(csv.reader(open('h.csv')))\n\
         t = np.array(rows[1:], dtype=float)\n\
         names = ['t [s]'] + [f'{n} [{u}]' for n, u in zip(z['ChannelName'], z['ChannelUnit'])]\n\
         assert rows[0] == names and np.array_equal(m['Data'], z['Data']) and m['ChannelName'].size + 1 == len(names)\n\
         print(json.dumps(dict(table=t.tolist(), t=z['Time'].tolist(), data=m['Data'].tolist())))",
    );
    let channels = printed["channels"].as_array().unwrap();
    let rows = numbers(&printed["t"]).len();
    let expected: Vec<f64> = (0..rows)
        .flat_map(|i| channels.iter().map(move |c| c["values"][i].as_f64().unwrap()))
        .collect();
    if let Some(read) = read {
        assert_eq!(read["t"], printed["t"]);
        assert_eq!(numbers(&read["data"]), expected);
        let both: Vec<f64> = numbers(&printed["t"])
            .into_iter()
            .zip(expected.chunks(channels.len()))
            .flat_map(|(t, row)| std::iter::once(t).chain(row.iter().copied()))
            .collect();
        assert_eq!(numbers(&read["table"]), both);
    }
    if cfg!(feature = "parquet") {
        let read = exported.python(
            "pyarrow",
            "import json, pyarrow.parquet as q\n\
             t = q.read_table('h.parquet')\n\
             print(json.dumps(dict(names=t.column_names, columns=[c.to_pylist() for c in t.columns])))",
        );
        if let Some(read) = read {
            assert_eq!(read["names"][0], "t [s]");
            assert_eq!(read["names"].as_array().unwrap().len(), channels.len() + 1);
            for (column, channel) in read["columns"].as_array().unwrap().iter().skip(1).zip(channels) {
                assert_eq!(column, &channel["values"]);
            }
        }
    }
}

/// What cannot be written is refused before anything is computed, with what could be.
#[test]
fn val_refusals_leave_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let (good, case) = (at("m.mat"), case());
    for (file, options, words) in [
        ("m.xls", &[][..], &["m.xls", ".mat", ".vtu"][..]),
        ("m", &[], &["no format"]),
        ("m.parquet", &[], &["--manoeuvre NAME"]),
        ("t.csv", &["--transfer", "elevator", "q"], &["no table", ".json"]),
        (
            "t.json",
            &["--transfer", "elevatr", "q"],
            &["elevatr", "elevator"],
        ),
        ("t.json", &["--transfer", "elevator", "qq"], &["qq", "alpha"]),
        (
            "t.json",
            &["--transfer", "elevator", "q", "--cancel", "NaN"],
            &["--cancel NaN"],
        ),
        ("h.csv", &["--manoeuvre", "loop"], &["loop", "doublet_3Hz"]),
        ("nowhere/m.csv", &[], &["nowhere"]),
    ] {
        let file = at(file);
        let arguments: Vec<&str> = ["export", &case, "--quiet"]
            .iter()
            .chain(options)
            .copied()
            .chain(["--to", file.as_str(), good.as_str()])
            .collect();
        let message = failure(&arguments);
        for word in words {
            assert!(message.contains(word), "`{word}` is missing in: {message}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{message}");
    }
}

/// Without the feature the message says how to have it.
#[cfg(not(feature = "parquet"))]
#[test]
fn val_parquet_names_its_feature() {
    let message = failure(&[
        "export",
        &case(),
        "--manoeuvre",
        "doublet_3Hz",
        "--to",
        "h.parquet",
    ]);
    assert!(message.contains("--features parquet"), "{message}");
}
