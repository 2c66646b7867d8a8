//! One step of tracking: from the modes of one matrix to those of the next.

use albatross_numerics::C64;

use super::spectrum::Spectrum;

/// A real mode or a conjugate pair under way.
#[derive(Debug, Clone)]
pub(super) struct Block {
    /// Indices in the spectrum: one, or two with the negative imaginary part first.
    pub(super) members: Vec<usize>,
    /// The modes it belongs to: two after a merger of two modes.
    pub(super) owners: Vec<usize>,
    /// Overlap of the last step, 1 - |deviation|.
    pub(super) overlap: f64,
}

/// A block without a certain successor.
#[derive(Debug, Clone, Copy)]
pub(super) struct Doubt {
    pub(super) block: usize,
    pub(super) best: f64,
    pub(super) next: f64,
}

/// A possible successor: its members and its overlap, 1 when certain.
#[derive(Debug, Clone)]
struct Candidate {
    members: Vec<usize>,
    overlap: f64,
}

impl Candidate {
    fn deviation(&self) -> f64 {
        // A NaN overlap (defective vectors) is the worst deviation.
        if self.overlap.is_nan() {
            f64::INFINITY
        } else {
            (1.0 - self.overlap).abs()
        }
    }
}

/// Successors of all blocks, each with an overlap within `tolerance` of 1, no value used twice.
pub(super) fn match_blocks(
    old: &Spectrum,
    blocks: &[Block],
    new: &Spectrum,
    tolerance: f64,
) -> Result<Vec<Block>, Doubt> {
    let groups: Vec<&[usize]> = blocks.iter().map(|b| b.members.as_slice()).collect();
    let overlaps = old.overlaps(&groups, new);

    let mut chosen: Vec<Option<Candidate>> = vec![None; blocks.len()];
    for b in 0..blocks.len() {
        if chosen[b].is_some() {
            continue;
        }
        let (best, next) = best_two(blocks[b].members.len(), &overlaps[b], new);
        if best.deviation() <= tolerance {
            chosen[b] = Some(best);
        } else if let Some(assigned) = match_equal_values(b, old, blocks, &overlaps, new, tolerance) {
            for (block, candidate) in assigned {
                chosen[block] = Some(candidate);
            }
        } else {
            return Err(Doubt {
                block: b,
                best: best.overlap,
                next,
            });
        }
    }
    let chosen: Vec<Candidate> = chosen.into_iter().flatten().collect();
    settle(old, blocks, new, &chosen, tolerance)
}

/// The best successor of a block of dimension `dimension`, and the overlap of the best one apart from it.
fn best_two(dimension: usize, overlap: &[C64], new: &Spectrum) -> (Candidate, f64) {
    let mut candidates = candidates(dimension, overlap, new);
    candidates.sort_by(|p, q| p.deviation().total_cmp(&q.deviation()));
    let none = Candidate {
        members: Vec::new(),
        overlap: 0.0,
    };
    let best = candidates.first().cloned().unwrap_or(none);
    let apart = |c: &&Candidate| c.members.iter().all(|k| !best.members.contains(k));
    let next = candidates
        .iter()
        .filter(apart)
        .map(|c| c.overlap)
        .fold(0.0, f64::max);
    (best, next)
}

/// Real values, pairs, and for a pair also its split into two real values.
fn candidates(dimension: usize, overlap: &[C64], new: &Spectrum) -> Vec<Candidate> {
    // The projector is real, so conjugate members have conjugate shares: a pair has 2 Re o in total. A pair is
    // compared with dimension 2; a single real mode may also vanish into a pair, with a total share of 1.
    let mut list: Vec<Candidate> = (0..new.len())
        .filter(|&k| new.value(k).im > 0.0)
        .map(|k| Candidate {
            members: new.family(k),
            overlap: 2.0 * overlap[k].re / dimension as f64,
        })
        .collect();
    let mut real: Vec<usize> = (0..new.len()).filter(|&k| new.is_real(k)).collect();
    if dimension == 1 {
        list.extend(real.iter().map(|&k| Candidate {
            members: vec![k],
            overlap: overlap[k].re,
        }));
    } else {
        // Close to the split both shares are large, of opposite sign.
        real.sort_by(|&p, &q| overlap[q].norm().total_cmp(&overlap[p].norm()));
        if let [p, q, ..] = real.as_slice() {
            let overlap = 0.5 * (overlap[*p].re + overlap[*q].re);
            list.push(Candidate {
                members: vec![*p.min(q), *p.max(q)],
                overlap,
            });
        }
    }
    list
}

/// Blocks that share an eigenvalue have no vectors of their own: match their common space, then hand out the
/// successors by largest overlap.
fn match_equal_values(
    b: usize,
    old: &Spectrum,
    blocks: &[Block],
    overlaps: &[Vec<C64>],
    new: &Spectrum,
    tolerance: f64,
) -> Option<Vec<(usize, Candidate)>> {
    const SAME: f64 = 1e-6;
    let value = |k: usize| {
        blocks[k]
            .members
            .last()
            .map(|&m| old.value(m))
            .unwrap_or_default()
    };
    let dimension = blocks[b].members.len();
    let mut group: Vec<usize> = (0..blocks.len())
        .filter(|&k| {
            blocks[k].members.len() == dimension && (value(k) - value(b)).norm() <= SAME * value(b).norm()
        })
        .collect();
    if group.len() < 2 {
        return None;
    }
    let total: Vec<C64> = (0..new.len())
        .map(|j| group.iter().map(|&k| overlaps[k][j]).sum())
        .collect();
    let mut successors = candidates(dimension, &total, new);
    successors.retain(|c| c.members.len() == dimension && (dimension == 1 || !new.is_real(c.members[0])));
    successors.sort_by(|p, q| q.overlap.total_cmp(&p.overlap));
    successors.truncate(group.len());
    let common = successors.iter().map(|c| c.overlap).sum::<f64>() / group.len() as f64;
    if successors.len() < group.len() || (1.0 - common).abs() > tolerance || common.is_nan() {
        return None;
    }
    let mut assigned = Vec::with_capacity(group.len());
    for successor in successors {
        let share = |k: usize| successor.members.last().map_or(0.0, |&j| overlaps[k][j].re);
        let at =
            (0..group.len()).max_by(|&p, &q| share(group[p]).total_cmp(&share(group[q])).then(q.cmp(&p)))?;
        assigned.push((
            group.swap_remove(at),
            Candidate {
                overlap: common,
                ..successor
            },
        ));
    }
    Some(assigned)
}

/// Turns the choices into blocks: mergers and splits are booked, and conflicts are doubts.
fn settle(
    old: &Spectrum,
    blocks: &[Block],
    new: &Spectrum,
    chosen: &[Candidate],
    tolerance: f64,
) -> Result<Vec<Block>, Doubt> {
    let mut settled: Vec<Block> = Vec::with_capacity(blocks.len());
    let mut done = vec![false; blocks.len()];
    for (b, candidate) in chosen.iter().enumerate() {
        if done[b] {
            continue;
        }
        let doubt = Doubt {
            block: b,
            best: candidate.overlap,
            next: candidate.overlap,
        };
        let sharing: Vec<usize> = (0..chosen.len())
            .filter(|&k| k != b && chosen[k].members.iter().any(|m| candidate.members.contains(m)))
            .collect();
        let overlap = 1.0 - candidate.deviation();
        match (
            blocks[b].members.len(),
            candidate.members.as_slice(),
            sharing.as_slice(),
        ) {
            // The mode goes on as it is.
            (1, [_], []) => settled.push(Block {
                members: candidate.members.clone(),
                owners: blocks[b].owners.clone(),
                overlap,
            }),
            (2, [p, _], []) if !new.is_real(*p) => {
                settled.push(Block {
                    members: candidate.members.clone(),
                    owners: blocks[b].owners.clone(),
                    overlap,
                });
            }
            // A pair splits into two real modes: one for each owner, or both for the only one.
            (2, [p, q], []) => {
                let (lower, upper) = if new.value(*p).re <= new.value(*q).re {
                    (*p, *q)
                } else {
                    (*q, *p)
                };
                let owners = &blocks[b].owners;
                for (k, members) in [lower, upper].into_iter().enumerate() {
                    let owner = owners.get(k).or(owners.first()).copied();
                    settled.push(Block {
                        members: vec![members],
                        owners: owner.into_iter().collect(),
                        overlap,
                    });
                }
            }
            // Two real modes followed merge.
            (1, [_, _], [other])
                if blocks[*other].members.len() == 1 && chosen[*other].members == candidate.members =>
            {
                let mut pair = [b, *other];
                pair.sort_by(|&p, &q| {
                    old.value(blocks[p].members[0])
                        .re
                        .total_cmp(&old.value(blocks[q].members[0]).re)
                });
                let mut owners: Vec<usize> = pair
                    .iter()
                    .flat_map(|&k| blocks[k].owners.iter().copied())
                    .collect();
                owners.dedup();
                done[*other] = true;
                let overlap = overlap.min(1.0 - chosen[*other].deviation());
                settled.push(Block {
                    members: candidate.members.clone(),
                    owners,
                    overlap,
                });
            }
            // A real mode followed merges with one that is not.
            (1, [_, upper], []) => {
                let with_partner = partner_overlap(old, blocks, new, candidate.overlap, *upper);
                if (1.0 - with_partner).abs() > tolerance || with_partner.is_nan() {
                    return Err(doubt);
                }
                settled.push(Block {
                    members: candidate.members.clone(),
                    owners: blocks[b].owners.clone(),
                    overlap,
                });
            }
            _ => return Err(doubt),
        }
    }
    Ok(settled)
}

/// Overlap of a new pair with a real mode followed (share `own`) and its best partner among the real modes that
/// are not followed.
fn partner_overlap(old: &Spectrum, blocks: &[Block], new: &Spectrum, own: f64, upper: usize) -> f64 {
    let free: Vec<[usize; 1]> = (0..old.len())
        .filter(|&k| old.is_real(k) && !blocks.iter().any(|b| b.members.contains(&k)))
        .map(|k| [k])
        .collect();
    let groups: Vec<&[usize]> = free.iter().map(|k| k.as_slice()).collect();
    let shares = old.overlaps(&groups, new);
    let sums = shares.iter().map(|o| 0.5 * (own + 2.0 * o[upper].re));
    sums.fold(f64::NAN, |best: f64, s| {
        if best.is_nan() || (1.0 - s).abs() < (1.0 - best).abs() {
            s
        } else {
            best
        }
    })
}
