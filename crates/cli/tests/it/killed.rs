//! A command that is killed leaves whole files.

use crate::support::albatross;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// How often a run is killed.
const KILLS: u32 = 100;
/// Begins the names of what is not complete.
const TEMPORARY: &str = ".albatross-";

/// Name and content of the files of a directory, temporary ones apart.
fn files(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in std::fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if !name.starts_with(TEMPORARY) {
            files.insert(name, std::fs::read(&path).unwrap());
        }
    }
    files
}

/// Temporary directories of runs in a directory.
fn leftovers(directory: &Path) -> Vec<std::path::PathBuf> {
    let names = std::fs::read_dir(directory).unwrap().map(|e| e.unwrap());
    names
        .filter(|e| e.file_name().to_string_lossy().starts_with(TEMPORARY))
        .map(|e| e.path())
        .collect()
}

/// Whether a run has begun to move its files: the temporary directory has lost the first of them.
fn moves(out: &Path) -> bool {
    leftovers(out)
        .iter()
        .any(|d| d.join("notes.txt").exists() && !d.join("bode.csv").exists())
}

/// Two cases that differ in the flight speed write the same files with other content into one directory. A run is killed
/// a hundred times, at moments drawn from its whole duration, every second time in the milliseconds in which it moves its
/// files. Each file is then that of one case or of the other, to the last byte.
#[test]
fn val_killed_runs_leave_whole_files() {
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| place.path().join(name);
    let arg = |name: &str| at(name).display().to_string();
    assert!(albatross(&["new", &arg("."), "--quiet"]).status.success());
    let case = std::fs::read_to_string(at("case.toml")).unwrap();
    // A coarse lattice of few strips, and so of few states: the computation only fills the time.
    let mut geometry = std::fs::read_to_string(at("aircraft.avl")).unwrap();
    for (from, to) in [
        ("\n12 1.0\n", "\n3 1.0\n"),
        ("1.20  0.0  6 0.0", "1.20  0.0  1 0.0"),
        ("1.20  0.0  4 0.0", "1.20  0.0  1 0.0"),
        ("-0.8  5 0.0", "-0.8  1 0.0"),
        ("-1.8  2 0.0", "-1.8  1 0.0"),
    ] {
        assert!(geometry.contains(from), "{from}");
        geometry = geometry.replace(from, to);
    }
    std::fs::write(at("aircraft.avl"), geometry).unwrap();
    // One case file, so that its name, which the report shows, is the same.
    let write_case = |speed: &str| {
        let text = case
            .replace("speed = 50.0", &format!("speed = {speed}"))
            .replace("end = 6.0", "end = 0.1")
            .replace("start = 0.5", "start = 0.0")
            .replace("modes = 12 ", "modes = 2 ")
            .replace("points = 300", "points = 20");
        assert!(text.contains(&format!("speed = {speed}")) && text.contains("end = 0.1"));
        std::fs::write(at("case.toml"), text).unwrap();
    };
    let speeds = ["50.0", "55.0"];
    let mut duration = Duration::ZERO;
    let whole = speeds.map(|speed| {
        write_case(speed);
        let began = Instant::now();
        assert!(
            albatross(&["run", &arg("case.toml"), "--out", &arg("whole"), "--quiet"])
                .status
                .success()
        );
        duration = began.elapsed();
        files(&at("whole"))
    });
    assert!(whole[0].keys().eq(whole[1].keys()) && whole[0].len() > 15);
    let differ = whole[0]
        .iter()
        .filter(|(name, content)| whole[1][*name] != **content)
        .count();
    assert!(differ > 10, "only {differ} files tell the two cases apart");

    let out = at("out");
    write_case(speeds[0]);
    assert!(
        albatross(&["run", &arg("case.toml"), "--out", &arg("out"), "--quiet"])
            .status
            .success()
    );
    let mut random = Random(0x5eed);
    let (mut killed, mut mixed) = (0, 0);
    for round in 0..KILLS {
        write_case(speeds[(round % 4 / 2) as usize]);
        let mut run = Command::new(env!("CARGO_BIN_EXE_albatross"))
            .args(["run", &arg("case.toml"), "--out", &arg("out"), "--quiet"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        if round % 2 == 0 {
            sleep(duration.mul_f64(random.next()));
        } else {
            while run.try_wait().unwrap().is_none() && !moves(&out) {
                sleep(Duration::from_micros(100));
            }
            sleep(Duration::from_micros((400.0 * random.next()) as u64));
        }
        run.kill().unwrap();
        killed += u32::from(!run.wait().unwrap().success());
        let found = files(&out);
        assert!(
            found.keys().eq(whole[0].keys()),
            "round {round}: {:?}",
            found.keys()
        );
        let mut of = [0, 0];
        for (name, content) in &found {
            let which = whole.each_ref().map(|w| w[name] == *content);
            assert!(
                which[0] || which[1],
                "round {round}: {name} is that of neither case"
            );
            if which[0] != which[1] {
                of[usize::from(which[1])] += 1;
            }
        }
        mixed += u32::from(of[0] > 0 && of[1] > 0);
        // The next run removes what this one left: only one at a time is there, its own or the one that it had begun to
        // remove.
        let left = leftovers(&out)
            .into_iter()
            .filter(|d| d.join("in-use.lock").exists());
        assert!(left.count() <= 1, "round {round}: {:?}", leftovers(&out));
    }
    // The test has tested something: most runs died, and some of them while they moved.
    assert!(killed >= KILLS / 4, "{killed} of {KILLS} runs were killed");
    eprintln!("{killed} of {KILLS} runs died, {mixed} left files of both cases");

    write_case(speeds[1]);
    assert!(
        albatross(&["run", &arg("case.toml"), "--out", &arg("out"), "--quiet"])
            .status
            .success()
    );
    assert_eq!(files(&out), whole[1], "the next run is not disturbed");
    assert!(leftovers(place.path()).is_empty());
    for left in leftovers(&out) {
        // Killed between its creation and its lock, some microseconds: nothing of value.
        assert!(
            files(&left).keys().all(|name| name == "not-yet.lock"),
            "{left:?} was not removed"
        );
    }
}

/// A run that is alive is not taken for a dead one.
#[test]
fn val_living_runs_are_left_alone() {
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| place.path().join(name);
    let arg = |name: &str| at(name).display().to_string();
    assert!(albatross(&["new", &arg("."), "--quiet"]).status.success());
    let living = at(".albatross-living");
    std::fs::create_dir(&living).unwrap();
    let lock = std::fs::File::create(living.join("in-use.lock")).unwrap();
    lock.lock().unwrap();
    let dead = at(".albatross-dead");
    std::fs::create_dir(&dead).unwrap();
    std::fs::write(dead.join("in-use.lock"), "").unwrap();
    std::fs::write(dead.join("trim.json"), "{").unwrap();
    let run = || albatross(&["run", &arg("case.toml"), "--out", &arg("out"), "--quiet"]);
    assert!(run().status.success());
    assert!(living.join("in-use.lock").exists());
    assert!(!dead.exists());
    drop(lock);
    assert!(run().status.success());
    assert!(!living.exists());
}

/// Numbers from 0 to 1, the same in every run (xorshift).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}
