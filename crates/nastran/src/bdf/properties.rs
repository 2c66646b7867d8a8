//! Properties and materials: PBAR(L), PBEAM(L), PROD, PELAS, PBUSH, MAT1.

use crate::deck::{
    BeamEndData, BeamSectionStation, BeamStation, Id, Mat1, Pbar, Pbarl, Pbeam, Pbeaml, Pbush, Pelas, Prod,
    Section, SectionShape,
};
use crate::error::Severity;

use super::fields::Fields;

pub(super) fn pbar(f: &mut Fields<'_>) -> (Id, Pbar) {
    let id = f.id(1, "PID");
    let property = Pbar {
        id,
        mid: f.id(2, "MID"),
        area: f.real_or(3, "A", 0.0),
        i1: f.real_or(4, "I1", 0.0),
        i2: f.real_or(5, "I2", 0.0),
        torsion_constant: f.real_or(6, "J", 0.0),
        nsm: f.real_or(7, "NSM", 0.0),
        stress_points: [9, 11, 13, 15].map(|n| {
            [
                f.real_or(n, "stress point", 0.0),
                f.real_or(n + 1, "stress point", 0.0),
            ]
        }),
        k1: f.real(17, "K1"),
        k2: f.real(18, "K2"),
        i12: f.real_or(19, "I12", 0.0),
    };
    f.ends_at(19);
    (id, property)
}

/// The section shape named in field `n`; `None` if it is not known here.
pub(super) fn shape(f: &Fields<'_>, n: usize) -> Option<SectionShape> {
    SectionShape::from_name(&f.word(n))
}

pub(super) fn pbarl(f: &mut Fields<'_>, shape: SectionShape) -> (Id, Pbarl) {
    let id = f.id(1, "PID");
    let count = shape.dimension_count();
    let dims = (0..count).map(|k| f.required_real(9 + k, "DIM")).collect();
    let property = Pbarl {
        id,
        mid: f.id(2, "MID"),
        group: f.word_or(3, "MSCBML0"),
        section: Section { shape, dims },
        nsm: f.real_or(9 + count, "NSM", 0.0),
    };
    f.ends_at(9 + count);
    (id, property)
}

/// PBEAM: end A, then any number of stations that begin with YES, YESA or NO, then two lines for shear, warping and
/// offsets.
pub(super) fn pbeam(f: &mut Fields<'_>) -> (Id, Pbeam) {
    let id = f.id(1, "PID");
    let mid = f.id(2, "MID");
    let is_station = |f: &Fields<'_>, n: usize| matches!(f.word(n).as_str(), "YES" | "YESA" | "NO");
    let mut stations = vec![section_constants(f, 3, String::new(), 0.0)];
    // Stress points follow end A and a station with YES; a line of blanks stands for none.
    let mut stress_points_next = true;
    let mut n = 9;
    while n <= f.card.len() {
        if is_station(f, n) {
            let stress_output = f.word(n);
            stress_points_next = stress_output == "YES";
            let x = f.real_or(n + 1, "X/XB", 1.0);
            stations.push(section_constants(f, n + 2, stress_output, x));
        } else if let Some(last) = stations.last_mut().filter(|_| stress_points_next) {
            stress_points_next = false;
            let points = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| f.real(n + k, "stress point"));
            last.stress_points = points.iter().any(Option::is_some).then_some(points);
        } else {
            break;
        }
        n += 8;
    }
    let mut pair = |k: usize, what| [f.real(n + k, what), f.real(n + k + 1, what)];
    let [shear_factors, shear_relief, nsi, warping] =
        [pair(0, "K"), pair(2, "S"), pair(4, "NSI"), pair(6, "CW")];
    let ends = BeamEndData {
        shear_factors,
        shear_relief,
        nsi,
        warping,
        nsm_center: [8, 9, 10, 11].map(|k| f.real(n + k, "M")),
        neutral_axis: [12, 13, 14, 15].map(|k| f.real(n + k, "N")),
    };
    f.ends_at(n + 15);
    (
        id,
        Pbeam {
            id,
            mid,
            stations,
            ends,
        },
    )
}

fn section_constants(f: &mut Fields<'_>, n: usize, stress_output: String, x: f64) -> BeamStation {
    BeamStation {
        stress_output,
        x,
        area: f.real(n, "A"),
        i1: f.real(n + 1, "I1"),
        i2: f.real(n + 2, "I2"),
        i12: f.real(n + 3, "I12"),
        torsion_constant: f.real(n + 4, "J"),
        nsm: f.real(n + 5, "NSM"),
        stress_points: None,
    }
}

/// PBEAML: after the first line, a run of dimensions and NSM for end A, then SO, X, dimensions and NSM for each
/// further station, without regard to line ends.
pub(super) fn pbeaml(f: &mut Fields<'_>, shape: SectionShape) -> (Id, Pbeaml) {
    let id = f.id(1, "PID");
    let mid = f.id(2, "MID");
    let group = f.word_or(3, "MSCBML0");
    let count = shape.dimension_count();
    let at_a: Vec<f64> = (0..count).map(|k| f.required_real(9 + k, "DIM")).collect();
    let nsm_a = f.real_or(9 + count, "NSM", 0.0);
    let mut n = 10 + count;
    let mut stations = Vec::new();
    let last = f.card.last();
    while n <= last && !f.failed {
        let stress_output = f.word_or(n, "YES");
        if !matches!(stress_output.as_str(), "YES" | "NO") {
            f.wrong(n, "SO", "YES or NO");
        }
        let x = f.real_or(n + 1, "X/XB", 1.0);
        let dims = at_a
            .iter()
            .enumerate()
            .map(|(k, &a)| f.real_or(n + 2 + k, "DIM", a))
            .collect();
        let nsm = f.real_or(n + 2 + count, "NSM", nsm_a);
        stations.push(BeamSectionStation {
            stress_output,
            x,
            section: Section { shape, dims },
            nsm,
        });
        n += count + 3;
    }
    let first = BeamSectionStation {
        stress_output: String::new(),
        x: 0.0,
        section: Section { shape, dims: at_a },
        nsm: nsm_a,
    };
    stations.insert(0, first);
    (
        id,
        Pbeaml {
            id,
            mid,
            group,
            stations,
        },
    )
}

pub(super) fn prod(f: &mut Fields<'_>) -> (Id, Prod) {
    let id = f.id(1, "PID");
    let property = Prod {
        id,
        mid: f.id(2, "MID"),
        area: f.real_or(3, "A", 0.0),
        torsion_constant: f.real_or(4, "J", 0.0),
        stress_coefficient: f.real_or(5, "C", 0.0),
        nsm: f.real_or(6, "NSM", 0.0),
    };
    f.ends_at(6);
    (id, property)
}

/// PELAS: two properties on a card.
pub(super) fn pelas(f: &mut Fields<'_>) -> Vec<(Id, Pelas)> {
    let mut properties = Vec::with_capacity(2);
    for n in [1, 5] {
        if n == 5 && (5..=8).all(|k| f.is_blank(k)) {
            break;
        }
        let id = f.id(n, "PID");
        let k = f.required_real(n + 1, "K");
        properties.push((
            id,
            Pelas {
                id,
                k,
                ge: f.real_or(n + 2, "GE", 0.0),
                s: f.real_or(n + 3, "S", 0.0),
            },
        ));
    }
    f.ends_at(8);
    properties
}

/// PBUSH: each line has a keyword in its second field and six values.
pub(super) fn pbush(f: &mut Fields<'_>) -> (Id, Pbush) {
    let id = f.id(1, "PID");
    let mut property = Pbush {
        id,
        ..Pbush::default()
    };
    for n in (2..=f.card.last()).step_by(8) {
        let keyword = f.word(n);
        if keyword.is_empty() && (n..n + 7).all(|k| f.is_blank(k)) {
            continue;
        }
        let values = [1, 2, 3, 4, 5, 6].map(|k| f.real(n + k, &keyword));
        match keyword.as_str() {
            "K" => property.k = Some(values),
            "B" => property.b = Some(values),
            "GE" => property.ge = Some(values),
            "M" => property.m = Some(values),
            "RCV" => property.rcv = Some(values),
            _ => f.remark(
                Severity::Warning,
                format!("the line with keyword {keyword:?} is not read; expected K, B, GE, M or RCV"),
            ),
        }
    }
    (id, property)
}

pub(super) fn mat1(f: &mut Fields<'_>) -> (Id, Mat1) {
    let id = f.id(1, "MID");
    let material = Mat1 {
        id,
        e: f.real(2, "E"),
        g: f.real(3, "G"),
        nu: f.real(4, "NU"),
        rho: f.real_or(5, "RHO", 0.0),
        expansion: f.real(6, "A"),
        reference_temperature: f.real(7, "TREF"),
        ge: f.real(8, "GE"),
        stress_limits: [f.real(9, "ST"), f.real(10, "SC"), f.real(11, "SS")],
        mcsid: f.id_or_zero(12, "MCSID"),
    };
    f.ends_at(12);
    (id, material)
}
