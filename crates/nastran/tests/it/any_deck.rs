//! Arbitrary decks: every card that the writer knows, with values that a 16-column field holds exactly.

use std::collections::{BTreeMap, BTreeSet};

use albatross_nastran::Deck;
use albatross_nastran::deck::{
    BarProperty, BeamEndData, BeamProperty, BeamSectionStation, BeamStation, Cbar, Cbeam, Cbush, Celas,
    Cmass, Components, Conm1, Conm2, Conm2Frame, Conrod, CoordinateDefinition, CoordinateKind,
    CoordinateSystem, Crod, DofSet, Eigr, Eigrl, Grdset, Grid, Mat1, Mpc, MpcTerm, Orientation, Param, Pbar,
    Pbarl, Pbeam, Pbeaml, Pbush, Pelas, Prod, RawCard, Rbar, Rbe2, Rbe3, Rbe3Group, ScalarEnd,
    ScalarMassValue, ScalarSpringValue, Section, SectionShape, Set1, Spc, Spc1, Suport,
};
use proptest::collection::{btree_set, vec};
use proptest::option::of;
use proptest::prelude::*;

/// Up to nine significant digits and an exponent of two: exact in 16 columns.
fn real() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        (-999_999_999_i64..=999_999_999, -30_i32..30).prop_map(|(m, e)| format!("{m}e{e}").parse().unwrap()),
        (-9999_i64..=9999, -4_i32..4).prop_map(|(m, e)| format!("{m}e{e}").parse().unwrap()),
    ]
}

fn id() -> impl Strategy<Value = u32> {
    prop_oneof![1_u32..200, 1_u32..=99_999_999]
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    [real(), real(), real()]
}

fn components() -> impl Strategy<Value = Components> {
    (0_u8..64).prop_map(Components::from_bits)
}

fn some_components() -> impl Strategy<Value = Components> {
    (1_u8..64).prop_map(Components::from_bits)
}

fn word() -> impl Strategy<Value = String> {
    "[A-Z][A-Z0-9]{0,7}"
}

fn ids() -> impl Strategy<Value = Vec<u32>> {
    vec(id(), 1..20)
}

/// A map from values that know their number.
fn by_id<T: std::fmt::Debug + Clone>(
    value: impl Strategy<Value = T>,
    set_id: impl Fn(&mut T, u32) + Clone,
) -> impl Strategy<Value = BTreeMap<u32, T>> {
    vec((id(), value), 0..4).prop_map(move |list| {
        list.into_iter()
            .map(|(id, mut value)| {
                set_id(&mut value, id);
                (id, value)
            })
            .collect()
    })
}

fn orientation() -> impl Strategy<Value = Option<Orientation>> {
    of(prop_oneof![
        vector().prop_map(Orientation::Vector),
        id().prop_map(Orientation::Grid)
    ])
}

fn scalar_end() -> impl Strategy<Value = ScalarEnd> {
    (0_u32..1000, 0_u8..=6).prop_map(|(point, component)| ScalarEnd { point, component })
}

fn section() -> impl Strategy<Value = Section> {
    use SectionShape as S;
    prop::sample::select(vec![
        S::Rod,
        S::Tube,
        S::Bar,
        S::Box,
        S::I,
        S::L,
        S::Dbox,
        S::Hat1,
    ])
    .prop_flat_map(|shape| vec(real(), shape.dimension_count()).prop_map(move |dims| Section { shape, dims }))
}

fn points(deck: Deck) -> impl Strategy<Value = Deck> {
    let grid = (id(), vector(), id(), any::<bool>(), components(), 0_u32..9).prop_map(
        |(cp, position, cd, fluid, ps, seid)| Grid {
            id: 0,
            cp: if cp > 100 { 0 } else { cp },
            position,
            cd: if fluid || cd > 100 { 0 } else { cd },
            fluid,
            ps,
            seid,
        },
    );
    let kind = prop::sample::select(vec![
        CoordinateKind::Rectangular,
        CoordinateKind::Cylindrical,
        CoordinateKind::Spherical,
    ]);
    let definition = prop_oneof![
        [id(), id(), id()].prop_map(|grids| CoordinateDefinition::Grids { grids }),
        (0_u32..50, vector(), vector(), vector())
            .prop_map(|(reference, a, b, c)| CoordinateDefinition::Points { reference, a, b, c }),
    ];
    let system = (kind, definition).prop_map(|(kind, definition)| CoordinateSystem {
        id: 0,
        kind,
        definition,
    });
    let grdset = (0_u32..9, 0_u32..9, components(), 0_u32..9).prop_map(|(cp, cd, ps, seid)| Grdset {
        cp,
        cd,
        ps,
        seid,
    });
    (
        by_id(grid, |g, id| g.id = id),
        by_id(system, |s, id| s.id = id),
        of(grdset),
        btree_set(id(), 0..5),
    )
        .prop_map(
            move |(grids, coordinate_systems, grdset, scalar_points): (_, _, _, BTreeSet<u32>)| Deck {
                grids,
                coordinate_systems,
                grdset,
                scalar_points,
                ..deck.clone()
            },
        )
}

fn line_elements(deck: Deck) -> impl Strategy<Value = Deck> {
    let bar = (
        id(),
        [id(), id()],
        orientation(),
        [components(), components()],
        vector(),
        vector(),
    )
        .prop_map(|(pid, grids, orientation, pins, wa, wb)| Cbar {
            id: 0,
            pid,
            grids,
            orientation,
            offset_frames: if pid % 2 == 0 { "GGG".into() } else { "GOO".into() },
            pins,
            wa,
            wb,
        });
    let beam = (
        id(),
        [id(), id()],
        orientation(),
        of(real()),
        [components(), components()],
        vector(),
        [0_u32..9, 0_u32..9],
    )
        .prop_map(|(pid, grids, orientation, bit, pins, wa, warping)| Cbeam {
            id: 0,
            pid,
            grids,
            orientation,
            offset_frames: "GGG".into(),
            bit,
            pins,
            wa,
            wb: [wa[2], wa[0], wa[1]],
            warping,
        });
    let rod = (id(), [id(), id()]).prop_map(|(pid, grids)| Crod { id: 0, pid, grids });
    let conrod =
        ([id(), id()], id(), real(), real(), real(), real()).prop_map(|(grids, mid, a, j, c, nsm)| Conrod {
            id: 0,
            grids,
            mid,
            area: a,
            torsion_constant: j,
            stress_coefficient: c,
            nsm,
        });
    let bush = (
        id(),
        id(),
        0_u32..9,
        orientation(),
        of(0_u32..9),
        real(),
        of(0_u32..9),
        vector(),
    )
        .prop_map(
            |(pid, a, b, orientation, cid, location, offset_cid, offset)| Cbush {
                id: 0,
                pid,
                grids: [a, b],
                orientation,
                cid,
                location,
                offset_cid,
                offset,
            },
        );
    (
        by_id(bar, |e, id| e.id = id),
        by_id(beam, |e, id| e.id = id),
        by_id(rod, |e, id| e.id = id),
        by_id(conrod, |e, id| e.id = id),
        by_id(bush, |e, id| e.id = id),
    )
        .prop_map(move |(bars, beams, rods, conrods, bushes)| Deck {
            bars,
            beams,
            rods,
            conrods,
            bushes,
            ..deck.clone()
        })
}

fn mass_elements(deck: Deck) -> impl Strategy<Value = Deck> {
    let conm1 = (id(), 0_u32..9, vec(real(), 21)).prop_map(|(grid, cid, lower): (_, _, Vec<f64>)| {
        let term = |i: usize, j: usize| lower[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
        let mass = std::array::from_fn(|i| std::array::from_fn(|j| term(i, j)));
        Conm1 {
            id: 0,
            grid,
            cid,
            mass,
        }
    });
    let frame = prop_oneof![
        Just(Conm2Frame::BasicPosition),
        (0_u32..9).prop_map(Conm2Frame::System)
    ];
    let conm2 =
        (id(), frame, real(), vector(), vector(), vector()).prop_map(|(grid, frame, mass, offset, i, j)| {
            Conm2 {
                id: 0,
                grid,
                frame,
                mass,
                offset,
                inertia: [i[0], i[1], i[2], j[0], j[1], j[2]],
            }
        });
    let mass_value = prop_oneof![
        id().prop_map(ScalarMassValue::Property),
        real().prop_map(ScalarMassValue::Value)
    ];
    let cmass =
        (mass_value, [scalar_end(), scalar_end()], any::<bool>()).prop_map(|(value, mut ends, scalar)| {
            if scalar {
                ends.iter_mut().for_each(|e| e.component = 0);
            }
            Cmass {
                id: 0,
                value,
                ends,
                scalar_points_only: scalar,
            }
        });
    let spring_value = prop_oneof![
        id().prop_map(ScalarSpringValue::Property),
        (real(), real(), real()).prop_map(|(k, ge, s)| ScalarSpringValue::Value { k, ge, s }),
    ];
    let spring =
        (spring_value, [scalar_end(), scalar_end()]).prop_map(|(value, ends)| Celas { id: 0, value, ends });
    (
        by_id(conm1, |e, id| e.id = id),
        by_id(conm2, |e, id| e.id = id),
        by_id(cmass, |e, id| e.id = id),
        by_id(spring, |e, id| e.id = id),
        by_id(real(), |_, _| {}),
    )
        .prop_map(
            move |(conm1, conm2, scalar_masses, springs, mass_properties)| Deck {
                conm1,
                conm2,
                scalar_masses,
                springs,
                mass_properties,
                ..deck.clone()
            },
        )
}

fn properties(deck: Deck) -> impl Strategy<Value = Deck> {
    let pbar = (
        id(),
        [real(), real(), real(), real(), real()],
        [
            [real(), real()],
            [real(), real()],
            [real(), real()],
            [real(), real()],
        ],
        of(real()),
        of(real()),
        real(),
    )
        .prop_map(|(mid, [a, i1, i2, j, nsm], stress_points, k1, k2, i12)| {
            BarProperty::Pbar(Pbar {
                id: 0,
                mid,
                area: a,
                i1,
                i2,
                i12,
                torsion_constant: j,
                nsm,
                stress_points,
                k1,
                k2,
            })
        });
    let pbarl = (id(), word(), section(), real()).prop_map(|(mid, group, section, nsm)| {
        BarProperty::Pbarl(Pbarl {
            id: 0,
            mid,
            group,
            section,
            nsm,
        })
    });
    let set_bar = |p: &mut BarProperty, id| match p {
        BarProperty::Pbar(p) => p.id = id,
        BarProperty::Pbarl(p) => p.id = id,
    };
    let set_beam = |p: &mut BeamProperty, id| match p {
        BeamProperty::Pbeam(p) => p.id = id,
        BeamProperty::Pbeaml(p) => p.id = id,
    };
    let prod = (id(), [real(), real(), real(), real()]).prop_map(|(mid, [a, j, c, nsm])| Prod {
        id: 0,
        mid,
        area: a,
        torsion_constant: j,
        stress_coefficient: c,
        nsm,
    });
    let pelas = [real(), real(), real()].prop_map(|[k, ge, s]| Pelas { id: 0, k, ge, s });
    let bush_line = || {
        of([
            of(real()),
            of(real()),
            of(real()),
            of(real()),
            of(real()),
            of(real()),
        ])
    };
    let pbush =
        [bush_line(), bush_line(), bush_line(), bush_line(), bush_line()].prop_map(|[k, b, ge, m, rcv]| {
            Pbush {
                id: 0,
                k,
                b,
                ge,
                m,
                rcv,
            }
        });
    let mat1 = (vec(of(real()), 9), real(), of(0_u32..9)).prop_map(|(v, rho, mcsid)| Mat1 {
        id: 0,
        e: v[0],
        g: v[1],
        nu: v[2],
        rho,
        expansion: v[3],
        reference_temperature: v[4],
        ge: v[5],
        stress_limits: [v[6], v[7], v[8]],
        mcsid,
    });
    (
        by_id(prop_oneof![pbar, pbarl], set_bar),
        by_id(prop_oneof![pbeam(), pbeaml()], set_beam),
        by_id(prod, |p, id| p.id = id),
        by_id(pelas, |p, id| p.id = id),
        by_id(pbush, |p, id| p.id = id),
        by_id(mat1, |p, id| p.id = id),
    )
        .prop_map(
            move |(
                bar_properties,
                beam_properties,
                rod_properties,
                spring_properties,
                bush_properties,
                materials,
            )| {
                Deck {
                    bar_properties,
                    beam_properties,
                    rod_properties,
                    spring_properties,
                    bush_properties,
                    materials,
                    ..deck.clone()
                }
            },
        )
}

fn pbeam() -> impl Strategy<Value = BeamProperty> {
    // A line of blanks stands for no stress points, so at least one is given.
    let stress = of((real(), vec(of(real()), 7))
        .prop_map(|(first, v)| [Some(first), v[0], v[1], v[2], v[3], v[4], v[5], v[6]]));
    let station = (
        prop::sample::select(vec!["YES", "YESA", "NO"]),
        real(),
        vec(of(real()), 6),
        stress,
    )
        .prop_map(|(so, x, v, stress)| BeamStation {
            stress_output: so.into(),
            x,
            area: v[0],
            i1: v[1],
            i2: v[2],
            i12: v[3],
            torsion_constant: v[4],
            nsm: v[5],
            stress_points: if so == "YES" { stress } else { None },
        });
    let pair = || [of(real()), of(real())];
    let four = || [of(real()), of(real()), of(real()), of(real())];
    let ends =
        (pair(), pair(), pair(), pair(), four(), four()).prop_map(|(k, s, nsi, cw, m, n)| BeamEndData {
            shear_factors: k,
            shear_relief: s,
            nsi,
            warping: cw,
            nsm_center: m,
            neutral_axis: n,
        });
    let ends = prop_oneof![Just(BeamEndData::default()), ends];
    (id(), vec(station, 1..4), ends).prop_map(|(mid, mut stations, ends)| {
        stations[0].stress_output.clear();
        stations[0].x = 0.0;
        BeamProperty::Pbeam(Box::new(Pbeam {
            id: 0,
            mid,
            stations,
            ends,
        }))
    })
}

fn pbeaml() -> impl Strategy<Value = BeamProperty> {
    section().prop_flat_map(|first| {
        let count = first.dims.len();
        let shape = first.shape;
        let other = (
            prop::sample::select(vec!["YES", "NO"]),
            real(),
            vec(real(), count),
            real(),
        )
            .prop_map(move |(so, x, dims, nsm)| BeamSectionStation {
                stress_output: so.into(),
                x,
                section: Section { shape, dims },
                nsm,
            });
        (id(), word(), Just(first), real(), vec(other, 0..4)).prop_map(
            |(mid, group, section, nsm, others)| {
                let at_a = BeamSectionStation {
                    stress_output: String::new(),
                    x: 0.0,
                    section,
                    nsm,
                };
                let stations = std::iter::once(at_a).chain(others).collect();
                BeamProperty::Pbeaml(Pbeaml {
                    id: 0,
                    mid,
                    group,
                    stations,
                })
            },
        )
    })
}

fn rigid_elements(deck: Deck) -> impl Strategy<Value = Deck> {
    let rbe2 = (id(), components(), ids(), of(real())).prop_map(
        |(independent, components, dependents, expansion)| Rbe2 {
            id: 0,
            independent,
            components,
            dependents,
            expansion,
        },
    );
    let group = (real(), some_components(), ids()).prop_map(|(weight, components, grids)| Rbe3Group {
        weight,
        components,
        grids,
    });
    let rbe3 = (
        id(),
        components(),
        vec(group, 1..4),
        vec((id(), some_components()), 0..8),
        of(real()),
    )
        .prop_map(|(reference, components, groups, um, expansion)| Rbe3 {
            id: 0,
            reference,
            components,
            groups,
            um,
            expansion,
        });
    let rbar = (
        [id(), id()],
        [components(), components()],
        [components(), components()],
        of(real()),
    )
        .prop_map(|(grids, independent, dependent, expansion)| Rbar {
            id: 0,
            grids,
            independent,
            dependent,
            expansion,
        });
    (
        by_id(rbe2, |e, id| e.id = id),
        by_id(rbe3, |e, id| e.id = id),
        by_id(rbar, |e, id| e.id = id),
    )
        .prop_map(move |(rbe2, rbe3, rbars)| Deck {
            rbe2,
            rbe3,
            rbars,
            ..deck.clone()
        })
}

fn constraints(deck: Deck) -> impl Strategy<Value = Deck> {
    let term = (id(), 0_u8..=6, real()).prop_map(|(point, component, coefficient)| MpcTerm {
        point,
        component,
        coefficient,
    });
    let mpc = (id(), vec(term, 0..6)).prop_map(|(sid, terms)| Mpc { sid, terms });
    let spc = (id(), id(), components(), real()).prop_map(|(sid, point, components, enforced)| Spc {
        sid,
        point,
        components,
        enforced,
    });
    let spc1 = (id(), components(), ids()).prop_map(|(sid, components, points)| Spc1 {
        sid,
        components,
        points,
    });
    let suport = (of(id()), id(), components()).prop_map(|(sid, point, components)| Suport {
        sid,
        point,
        components,
    });
    let dofs = || (components(), ids()).prop_map(|(components, points)| DofSet { components, points });
    let set1 = (any::<bool>(), ids()).prop_map(|(skin, members)| Set1 { id: 0, skin, members });
    (
        vec(mpc, 0..3),
        vec(spc, 0..3),
        vec(spc1, 0..3),
        vec(suport, 0..3),
        vec(dofs(), 0..3),
        vec(dofs(), 0..3),
        by_id(set1, |s, id| s.id = id),
    )
        .prop_map(move |(mpcs, spcs, spc1s, suports, asets, omits, sets)| Deck {
            mpcs,
            spcs,
            spc1s,
            suports,
            asets,
            omits,
            sets,
            ..deck.clone()
        })
}

fn control(deck: Deck) -> impl Strategy<Value = Deck> {
    let eigr = (
        word(),
        vec(of(real()), 3),
        vec(of(-99_i32..99), 3),
        of(id()),
        of(1_u8..=6),
    )
        .prop_map(|(method, v, n, point, component)| Eigr {
            id: 0,
            method,
            lower_hz: v[0],
            upper_hz: v[1],
            estimated: n[0],
            desired: n[1],
            zero_roots: n[2],
            criterion: v[2],
            normalization: "MAX".into(),
            point,
            component,
        });
    let eigrl = (
        vec(of(real()), 3),
        vec(of(-99_i32..99), 3),
        vec("[A-Z]{1,4}=[0-9]{1,3}", 0..4),
    )
        .prop_map(|(v, n, options)| Eigrl {
            id: 0,
            lower_hz: v[0],
            upper_hz: v[1],
            desired: n[0],
            message_level: n[1],
            block_size: n[2],
            shift_hz: v[2],
            normalization: "MASS".into(),
            options,
        });
    let param =
        (word(), word(), prop_oneof![Just(String::new()), word()]).prop_map(|(name, value, imaginary)| {
            (
                name.clone(),
                Param {
                    name,
                    value,
                    imaginary,
                },
            )
        });
    // Of every length, so that all three field formats are used.
    let field = prop_oneof![
        Just(String::new()),
        "[A-Z0-9.+*-]{1,8}",
        "[A-Z0-9.+*-]{9,16}",
        "[A-Z0-9.]{17,30}"
    ];
    let raw = ("X[A-Z]{1,7}", vec(field, 0..20), "[A-Z0-9]{1,8}").prop_map(|(name, mut fields, last)| {
        fields.push(last);
        RawCard {
            name,
            fields,
            origin: None,
        }
    });
    let line = "[A-Z]{2,6} = [a-z0-9]{1,9}";
    (
        by_id(eigr, |e, id| e.id = id),
        by_id(eigrl, |e, id| e.id = id),
        vec(param, 0..4),
        vec(raw, 0..4),
        vec(line, 0..3),
        vec(line, 0..3),
    )
        .prop_map(move |(eigr, eigrl, params, raw, executive, case_control)| Deck {
            eigr,
            eigrl,
            params: params.into_iter().collect(),
            raw,
            executive,
            case_control,
            ..deck.clone()
        })
}

/// A deck with a few cards of every kind; its references need not lead anywhere.
pub(crate) fn deck() -> impl Strategy<Value = Deck> {
    control(Deck::default())
        .prop_flat_map(points)
        .prop_flat_map(line_elements)
        .prop_flat_map(mass_elements)
        .prop_flat_map(properties)
        .prop_flat_map(rigid_elements)
        .prop_flat_map(constraints)
}
