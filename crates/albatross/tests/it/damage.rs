//! Damaged and hostile files: every reader gives a result or a typed error, soon, and never panics.
//!
//! `fuzz/` searches with the same readers for longer; what it finds is kept in `fixtures/fuzz/<reader>/`.

use crate::readers::{READERS, Reader};
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What a file may take to be read. Files are at most of [`LARGEST`] bytes, and take some milliseconds.
const LONGEST: Duration = Duration::from_secs(1);
const LARGEST: usize = 20_000;
const CUTS: usize = 200;
const MUTATIONS: usize = 2000;

fn fixture(name: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures")).join(name)
}

/// Reads, and says what was wrong: a panic, or the shortest time of three if that is too long on a busy machine too.
fn survive(reader: &Reader, bytes: &[u8]) -> Result<bool, String> {
    let mut shortest = Duration::MAX;
    for _ in 0..3 {
        let start = Instant::now();
        let read = catch_unwind(AssertUnwindSafe(|| (reader.read)(bytes)))
            .map_err(|_| format!("{} panics on {:?}", reader.name, String::from_utf8_lossy(bytes)))?;
        shortest = shortest.min(start.elapsed());
        if shortest < LONGEST {
            return Ok(read);
        }
    }
    Err(format!(
        "{} takes {shortest:?} for {:?}",
        reader.name,
        String::from_utf8_lossy(bytes)
    ))
}

/// Words that a careless or hostile hand may write.
const WORDS: [&[u8]; 20] = [
    b"1e400",
    b"-1e-400",
    b"NaN",
    b"inf",
    b"-1",
    b"0",
    b"0.0",
    b"999999999",
    b"1000000000000000000000",
    b"1 THRU 999999999",
    b",,,,",
    b"\n\n",
    b"\r\n",
    b"\0",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"********",
    b"\"",
    b"[[[[",
    b"1.5-3",
];

/// Flips, swaps, deletions, repetitions and foreign words, a few at a time.
fn mutated(bytes: &[u8], random: &mut fastrand::Rng) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..random.usize(1..=4) {
        if out.is_empty() {
            break;
        }
        let at = random.usize(..out.len());
        let end = out.len().min(at + random.usize(1..=40));
        match random.u8(..6) {
            0 => out[at] ^= 1 << random.u8(..8),
            1 => {
                let other = random.usize(..out.len());
                out.swap(at, other);
            }
            2 => drop(out.drain(at..end)),
            3 => {
                let copy = out[at..end].to_vec();
                let to = random.usize(..out.len());
                out.splice(to..to, copy);
            }
            4 => out[at] = b"0123456789.-+*=,;{}[]\"' \t\n#$|"[random.usize(..29)],
            _ => drop(out.splice(
                at..end.min(at + 8),
                WORDS[random.usize(..WORDS.len())].iter().copied(),
            )),
        }
    }
    out
}

#[test]
fn prop_whole_files_are_read() {
    for reader in READERS {
        assert!(!reader.fixtures().is_empty(), "{} has no files", reader.name);
        for name in reader.fixtures() {
            let bytes = std::fs::read(fixture(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert!((reader.read)(&bytes), "{} does not read {name}", reader.name);
        }
    }
}

#[test]
fn prop_damaged_files_are_survived() {
    let wrong: Vec<String> = READERS
        .par_iter()
        .flat_map(|reader| reader.fixtures().into_par_iter().map(move |name| (reader, name)))
        .filter_map(|(reader, name)| {
            let mut bytes = std::fs::read(fixture(name)).ok()?;
            bytes.truncate(LARGEST);
            let mut random = fastrand::Rng::with_seed(0x5EED);
            let cuts = (0..CUTS).map(|k| bytes[..k * bytes.len() / CUTS].to_vec());
            let mutations = (0..MUTATIONS).map(|_| mutated(&bytes, &mut random));
            cuts.chain(mutations)
                .find_map(|damaged| survive(reader, &damaged).err())
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Inputs that once made a reader panic, hang or allocate without bound.
#[test]
fn regress_found_by_fuzzing() {
    for reader in READERS {
        let Ok(folder) = std::fs::read_dir(fixture("fuzz").join(reader.name)) else {
            continue;
        };
        for file in folder {
            let path = file.unwrap().path();
            let bytes = std::fs::read(&path).unwrap();
            if let Err(wrong) = survive(reader, &bytes) {
                panic!("{}: {wrong}", path.display());
            }
        }
    }
}

/// What any reader may be given in place of its file.
#[test]
fn prop_hostile_files_are_survived() {
    let mut files: Vec<Vec<u8>> = vec![
        Vec::new(),
        b"\n".repeat(1000),
        b"\0".repeat(1000),
        b"\xef\xbb\xbf".to_vec(),
        b"\xff\xfe\x00\x41".repeat(200),
        b"1e400 NaN inf -inf 1e-400\n".repeat(20),
        b"[".repeat(100_000),
        b"{\"a\":".repeat(50_000),
        [b"a = ".as_slice(), &b"[".repeat(50_000)].concat(),
        b"[a."
            .iter()
            .copied()
            .chain(b"a.".repeat(50_000))
            .chain(*b"a]\n")
            .collect(),
        b"9".repeat(100_000),
        b"x".repeat(10_000_000),
        b"1,".repeat(2_000_000),
    ];
    files.push([b"GRID,1,,".as_slice(), &b" ".repeat(1_000_000), b"\n"].concat());
    let wrong: Vec<String> = READERS
        .par_iter()
        .flat_map(|reader| files.par_iter().map(move |file| (reader, file)))
        .filter_map(|(reader, file)| {
            // The longest may take longer: the bound is a second for a megabyte.
            let start = Instant::now();
            let bound = LONGEST * (1 + u32::try_from(file.len() / 1_000_000).unwrap());
            let shown = String::from_utf8_lossy(&file[..file.len().min(40)]).into_owned();
            if catch_unwind(AssertUnwindSafe(|| (reader.read)(file))).is_err() {
                return Some(format!("{} panics on {shown:?}..", reader.name));
            }
            let took = start.elapsed();
            (took > bound).then(|| format!("{} takes {took:?} for {shown:?}..", reader.name))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn reader(name: &str) -> &'static Reader {
    READERS.iter().find(|r| r.name == name).unwrap()
}

/// A surface of as many controls as strips, each of which would look for each.
fn strips_with_controls() -> String {
    let section = |k: usize| format!("SECTION\n0 {k} 0 1 0 1 0\nCONTROL\nc{k} 1 .7 0 1 0 1\n");
    let head = "w\n0\n0 0 0\n1 1 1\n0 0 0\nSURFACE\nw\n1 1\n".to_owned();
    head + &(0..2000).map(section).collect::<String>()
}

/// Announced sizes, ranges and nesting beyond reason.
#[test]
fn prop_hostile_sizes_are_refused() {
    let many_controls = "CONTROL\nc 1 0.7 0 1 0 1\n".repeat(2000);
    let wing = |n_chord: &str, n_span: &str| {
        format!(
            "w\n0\n0 0 0\n1 1 1\n0 0 0\nSURFACE\nw\n{n_chord} 1 {n_span} 1\nSECTION\n0 0 0 1 0\nSECTION\n0 1 0 1 0\n"
        )
    };
    for (name, text) in [
        ("avl_lattice", wing("1e9", "1e9")),
        ("avl_lattice", wing("999999", "999999")),
        ("avl_lattice", wing("3000", "3000")),
        ("avl_lattice", wing("NaN", "3")),
        ("avl_lattice", wing("1e400", "3")),
        (
            "avl_lattice",
            wing("3", "3") + "BODY\nb\n999999 1\nBSECTION\n0 0 0 1\nBSECTION\n1 0 0 1\n",
        ),
        (
            "bdf",
            "SPC1,1,123,1,THRU,999999999\nRBE2,1,1,123,1,THRU,x\n".repeat(200),
        ),
        ("bdf", "ASET1,123,1,THRU,10000\n".repeat(400)),
        ("bdf", "GRID,1\n=,*1\n=(999999)\n".to_owned()),
        ("avl_lattice", strips_with_controls()),
        ("wing_json", r#"{"y": [1], "dy": [1e400]}"#.to_owned()),
        (
            "linear_json",
            r#"{"model": {"blocks": [], "zeros": 18446744073709551615}}"#.to_owned(),
        ),
        (
            "case",
            "title = \"x\"\n[structure]\nmodes = 99999999999999999999\n".to_owned(),
        ),
        ("avl_eig", "1 1e400 1\n".to_owned()),
    ] {
        assert_eq!(
            survive(reader(name), text.as_bytes()),
            Ok(false),
            "{name}: {text:.80}"
        );
    }
    // Odd, but nothing that must be refused.
    for (name, text) in [
        ("avl_geometry", wing("3", "3") + &many_controls),
        (
            "bdf",
            format!("SET1,1,1,THRU,99999999,EXCEPT{}\n", ",1,THRU,1000000".repeat(500)),
        ),
        ("bdf", "SPOINT,1,THRU,999999999\n".to_owned()),
        ("bdf", "SET1,1,1,THRU,999999999,BY,7\n".to_owned()),
        ("bdf", "ASET1,123,1,THRU,999999999\n".to_owned()),
        ("fem", "SPOINT,1,THRU,999999999\nCELAS2,1,1.,1,0\n".to_owned()),
        ("fem", "GRID,1,,0.,0.,0.\nGRID,2,,0.,0.,0.\nMAT1,1,1.,,.3\nPBAR,1,1,1.,1.,1.,1.\nCBAR,1,1,1,2,0.,1.,0.\n".to_owned()),
        ("avl_lattice", wing("3", "3").replace("0 1 0 1 0", "0 0 0 1 0")),
        ("avl_lattice", wing("3", "3").replace("0 1 0 1 0", "0 1 0 0 0")),
    ] {
        assert!(survive(reader(name), text.as_bytes()).is_ok(), "{name}: {text:.80}");
    }
}

/// Files that include others twice, each of which does the same: doubling without an end, if nothing counted.
#[test]
fn regress_includes_that_double_are_bounded() {
    use albatross::nastran::bdf::{Included, parse_with};
    let mut count = 0;
    parse_with(b"INCLUDE 'a'\nINCLUDE 'b'\n", "main.bdf", |path, _| {
        count += 1;
        Ok(Included {
            name: format!("{path}{count}"),
            text: b"INCLUDE 'a'\nINCLUDE 'b'\nGRID,1\n".to_vec(),
        })
    });
    assert_eq!(count, 10_000);
}
