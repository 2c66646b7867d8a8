//! Reading speed on about 50 MB made from the fixtures, beside a plain count of lines of the same bytes.
//!
//! Results: the pages of one mode are repeated with other mode numbers. Decks: the bulk data is repeated with other
//! numbers. So all values and layouts are those of real files.

#![allow(
    missing_docs,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark"
)]

use std::collections::{BTreeMap, BTreeSet};
use std::hint::black_box;

use albatross_nastran::{bdf, f06};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

const SIZE: usize = 50_000_000;

fn fixture(name: &str) -> String {
    let path = format!(
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like/{}"),
        name
    );
    std::fs::read_to_string(path).unwrap()
}

/// The vector pages of mode 7, repeated under rising mode numbers after all that stands before mode 1. Grid numbers
/// get another leading digit from copy to copy.
fn many_modes(name: &str, mark: &str, width: usize) -> Vec<u8> {
    let text = fixture(name);
    let at = |mode: usize| {
        let heading = text
            .find(&format!("{mark}{mode:width$}\n"))
            .or_else(|| text.find(&format!("{mark}{mode:width$} ")));
        // The page begins before its heading.
        let heading = heading.unwrap();
        text[..heading]
            .rfind("\n1")
            .filter(|_| !mark.contains("OUTPUT"))
            .map_or(heading, |p| p + 1)
    };
    let mut out = text.as_bytes()[..at(1)].to_vec();
    let page = &text[at(7)..at(8)];
    let heading = format!("{mark}{:width$}", 7);
    let mut mode = 1;
    while out.len() < SIZE {
        out.extend_from_slice(page.replace(&heading, &format!("{mark}{mode:width$}")).as_bytes());
        mode += 1;
    }
    out
}

/// The bulk data, repeated with other numbers of grids, elements and properties: dense ones, so that copies do not
/// collide.
fn many_grids() -> Vec<u8> {
    let text = fixture("f25.bdf");
    let begin = text.find("BEGIN BULK").unwrap() + "BEGIN BULK\n".len();
    let is_model = |l: &&str| {
        !l.starts_with("$")
            && !["PARAM", "EIGRL", "MAT1", "ENDDATA"]
                .iter()
                .any(|n| l.starts_with(n))
    };
    let bulk: Vec<&str> = text[begin..].lines().filter(is_model).collect();
    let ids: BTreeSet<u32> = bulk.iter().flat_map(|l| numbers(l)).collect();
    let dense: BTreeMap<u32, u32> = ids.into_iter().zip(1..).collect();
    let count = u32::try_from(dense.len()).unwrap();
    let mut out = text.as_bytes()[..begin].to_vec();
    out.extend_from_slice(b"MAT1           1   7.+10  2.7+10              0.\n");
    let mut copy = 0;
    while out.len() < SIZE {
        for line in &bulk {
            let mut line = (*line).to_owned();
            for start in (8..line.len()).step_by(8) {
                let end = line.len().min(start + 8);
                if let Some(id) = number(&line[start..end]) {
                    line.replace_range(start..end, &format!("{:8}", 1000 + copy * count + dense[&id]));
                }
            }
            out.extend_from_slice(line.as_bytes());
            out.push(b'\n');
        }
        copy += 1;
    }
    out.extend_from_slice(b"ENDDATA\n");
    out
}

/// Integers of four digits or more are numbers of grids, elements and properties.
fn number(field: &str) -> Option<u32> {
    field
        .trim()
        .parse()
        .ok()
        .filter(|&id| (1000..123_456).contains(&id) || id > 123_456)
}

fn numbers(line: &str) -> Vec<u32> {
    (8..line.len())
        .step_by(8)
        .filter_map(|at| number(&line[at..line.len().min(at + 8)]))
        .collect()
}

fn line_count(text: &[u8]) -> usize {
    text.iter().filter(|&&b| b == b'\n').count()
}

fn reading(c: &mut Criterion) {
    let mystran = many_modes("f25.f06", " OUTPUT FOR EIGENVECTOR", 9);
    let n95 = many_modes("f25_nastran95.f06", "R E A L   E I G E N V E C T O R   N O .", 11);
    let deck = many_grids();

    let mut group = c.benchmark_group("reading");
    group.sample_size(10);
    for (name, text) in [("f06 MYSTRAN", &mystran), ("f06 NASTRAN-95", &n95)] {
        let results = f06::parse(text, name).unwrap();
        let rows: usize = results.eigenvectors.iter().map(|v| v.rows.len()).sum();
        println!(
            "{name}: {} bytes, {} vectors, {rows} rows",
            text.len(),
            results.eigenvectors.len()
        );
        group.throughput(Throughput::Bytes(text.len() as u64));
        group.bench_function(name, |b| b.iter(|| f06::parse(black_box(text), name).unwrap()));
        group.bench_function(format!("{name}, lines counted"), |b| {
            b.iter(|| line_count(black_box(text)))
        });
    }
    let (read, remarks) = bdf::parse(&deck, "bdf");
    println!(
        "bdf: {} bytes, {} grids, {} bars, {} remarks",
        deck.len(),
        read.grids.len(),
        read.bars.len(),
        remarks.len()
    );
    group.throughput(Throughput::Bytes(deck.len() as u64));
    group.bench_function("bdf", |b| b.iter(|| bdf::parse(black_box(&deck), "bdf")));
    group.bench_function("bdf, lines counted", |b| b.iter(|| line_count(black_box(&deck))));
    group.finish();
}

criterion_group!(benches, reading);
criterion_main!(benches);
