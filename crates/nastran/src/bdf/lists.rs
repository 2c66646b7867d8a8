//! Lists of numbers with ranges: `1, 2, 5 THRU 20 BY 5 EXCEPT 10`.

use crate::deck::Id;
use crate::error::Severity;

use super::fields::Fields;

/// Ranges up to this length are expanded as they are. From longer ones only points of the deck are taken, since
/// `1 THRU 99999999` is a common way to say "all".
const EXPANDED: u32 = 10_000;

/// A list that cannot be expanded before all points are known.
pub(super) struct NeedsPoints;

impl Fields<'_> {
    /// Numbers from field `n` to `last`, ranges expanded. `points` are the deck's points in ascending order, once
    /// they are known. Blank fields are skipped.
    pub(super) fn list(
        &mut self,
        n: usize,
        last: usize,
        points: Option<&[Id]>,
    ) -> Result<Vec<Id>, NeedsPoints> {
        let mut members = Vec::new();
        let mut at = n;
        while at <= last {
            if self.is_blank(at) {
                at += 1;
                continue;
            }
            let first = self.id(at, "ID");
            at = self.skip_blanks(at + 1, last);
            if !self.is_word(at, last, b"THRU") {
                members.push(first);
                continue;
            }
            at = self.skip_blanks(at + 1, last);
            let end = self.id(at, "end of THRU");
            if end < first && !self.failed {
                self.wrong(at, "end of THRU", &format!("a number of {first} or more"));
            }
            at = self.skip_blanks(at + 1, last);
            let mut step = 1;
            if self.is_word(at, last, b"BY") {
                at = self.skip_blanks(at + 1, last);
                step = self.id(at, "BY").max(1);
                at = self.skip_blanks(at + 1, last);
            }
            let mut except = Vec::new();
            if self.is_word(at, last, b"EXCEPT") {
                at = self.exceptions(at + 1, last, first..=end, &mut except);
            }
            let before = members.len();
            if *self.ranges_left == 0 {
                self.remark(
                    Severity::Error,
                    "the ranges of the deck have more members in all than a deck of its size can mean; narrow them",
                );
            }
            if self.failed {
                return Ok(members);
            }
            let in_range = |id: &Id| {
                (first..=end).contains(id) && (id - first).is_multiple_of(step) && !is_in(&except, *id)
            };
            if end - first <= EXPANDED {
                members.extend((first..=end).filter(in_range));
            } else {
                let Some(points) = points else {
                    return Err(NeedsPoints);
                };
                let from = points.partition_point(|&p| p < first);
                let upto = points.partition_point(|&p| p <= end);
                members.extend(
                    points
                        .get(from..upto)
                        .unwrap_or_default()
                        .iter()
                        .copied()
                        .filter(in_range),
                );
            }
            *self.ranges_left = self.ranges_left.saturating_sub(members.len() - before);
        }
        Ok(members)
    }

    /// Numbers after EXCEPT that lie in the range, themselves perhaps ranges. The first number outside the range
    /// belongs to the list again. Returns the field after the exceptions, which come out sorted and apart.
    fn exceptions(
        &mut self,
        mut at: usize,
        last: usize,
        range: std::ops::RangeInclusive<Id>,
        except: &mut Vec<(Id, Id)>,
    ) -> usize {
        at = self.skip_blanks(at, last);
        while at <= last && !self.failed {
            let first = self.id(at, "EXCEPT");
            if !range.contains(&first) {
                break;
            }
            at = self.skip_blanks(at + 1, last);
            let mut end = first;
            if self.is_word(at, last, b"THRU") {
                at = self.skip_blanks(at + 1, last);
                end = self.id(at, "end of THRU").min(*range.end());
                at = self.skip_blanks(at + 1, last);
            }
            except.push((first, end));
        }
        except.sort_unstable();
        except.dedup_by(|next, kept| {
            let overlaps = next.0 <= kept.1;
            if overlaps {
                kept.1 = kept.1.max(next.1);
            }
            overlaps
        });
        at
    }

    fn skip_blanks(&self, mut at: usize, last: usize) -> usize {
        while at <= last && self.is_blank(at) {
            at += 1;
        }
        at
    }

    fn is_word(&self, at: usize, last: usize, word: &[u8]) -> bool {
        at <= last && self.text(at).eq_ignore_ascii_case(word)
    }
}

/// Whether a number lies in one of the ranges, which are sorted and apart.
fn is_in(ranges: &[(Id, Id)], id: Id) -> bool {
    let after = ranges.partition_point(|r| r.0 <= id);
    after
        .checked_sub(1)
        .and_then(|k| ranges.get(k))
        .is_some_and(|r| id <= r.1)
}

#[cfg(test)]
mod tests {
    use super::super::card::{BulkLine, Card};
    use super::*;
    use crate::remarks::Remarks;

    fn list(text: &str, points: Option<&[Id]>) -> Option<Vec<Id>> {
        let mut card = Card::default();
        card.start(&BulkLine::new(format!("SET1,{text}").as_bytes(), true), 0, 1);
        let mut remarks = Remarks::default();
        let mut ranges_left = 1000;
        let mut fields = Fields::new(&card, "test", &mut remarks, &mut ranges_left);
        let members = fields.list(1, card.last(), points).ok()?;
        (!fields.failed).then_some(members)
    }

    #[test]
    fn ranges_steps_and_exceptions() {
        assert_eq!(
            list("1,thru,10,EXCEPT,5", None),
            Some(vec![1, 2, 3, 4, 6, 7, 8, 9, 10])
        );
        assert_eq!(
            list("1,THRU,10,EXCEPT,5,THRU,7,9,77", None),
            Some(vec![1, 2, 3, 4, 8, 10, 77])
        );
        assert_eq!(
            list("1,THRU,9,EXCEPT,2,THRU,4,3,THRU,6,6,8", None),
            Some(vec![1, 7, 9])
        );
        assert_eq!(list("10,THRU,20,BY,4,3", None), Some(vec![10, 14, 18, 3]));
        assert_eq!(list("7,,,9", None), Some(vec![7, 9]));
        assert_eq!(list("5,THRU,1", None), None);
        assert_eq!(list("5,THRU", None), None);
        assert_eq!(list("5,TO,9", None), None);
        assert_eq!(list("1,THRU,99999999", None), None);
        assert_eq!(
            list("2,THRU,99999999", Some(&[1, 2, 5, 4_000_000])),
            Some(vec![2, 5, 4_000_000])
        );
    }
}
