//! Minimum-cost assignment of rows to columns when some pairs are forbidden.
//!
//! H. W. Kuhn, The Hungarian method for the assignment problem, Naval Res. Logist. Q. 2, 1955; J. Munkres, Algorithms
//! for the assignment and transportation problems, J. SIAM 5, 1957; in the form that augments along shortest paths
//! row by row, R. Jonker, A. Volgenant, Computing 38, 1987. The time grows with the square of the shorter side times
//! the longer one.

/// The column of every row, none if it stays alone.
///
/// Among all assignments that use no column twice and no forbidden pair (`None`, an infinite cost, a row that ends
/// before the column), those with the most pairs are considered, and of these one with the least sum of costs is
/// returned.
pub fn assign(costs: &[Vec<Option<f64>>]) -> Vec<Option<usize>> {
    let rows = costs.len();
    let columns = costs.iter().map(Vec::len).max().unwrap_or(0);
    let cost = |i: usize, j: usize| -> Option<f64> {
        let value = costs.get(i)?.get(j).copied().flatten();
        value.filter(|c| c.is_finite())
    };
    let allowed = || (0..rows).flat_map(|i| (0..columns).filter_map(move |j| cost(i, j)));
    let least = allowed().fold(f64::INFINITY, f64::min);
    let greatest = allowed().fold(f64::NEG_INFINITY, f64::max);
    if greatest < least {
        return vec![None; rows];
    }
    // One forbidden pair more must cost more than any change of the allowed ones. Costs count from the least: the
    // number of pairs of the complete assignment is fixed, so that a constant decides nothing.
    let range = if greatest > least { greatest - least } else { 1.0 };
    let forbidden = (rows.min(columns) + 1) as f64 * range;
    let filled = |i: usize, j: usize| cost(i, j).map_or(forbidden, |c| c - least);

    let mut chosen = vec![None; rows];
    if rows <= columns {
        for (column, row) in complete(rows, columns, filled).into_iter().enumerate() {
            if let Some(row) = row {
                chosen[row] = cost(row, column).map(|_| column);
            }
        }
    } else {
        for (row, column) in complete(columns, rows, |j, i| filled(i, j))
            .into_iter()
            .enumerate()
        {
            chosen[row] = column.filter(|&column| cost(row, column).is_some());
        }
    }
    chosen
}

/// The row of every column in the cheapest assignment of all rows; `rows` is not greater than `columns`.
fn complete(rows: usize, columns: usize, cost: impl Fn(usize, usize) -> f64) -> Vec<Option<usize>> {
    let mut row_price = vec![0.0; rows];
    let mut column_price = vec![0.0; columns];
    let mut row_of: Vec<Option<usize>> = vec![None; columns];
    for start in 0..rows {
        // Shortest path of reduced costs from the new row to a free column (Dijkstra).
        let mut distance = vec![f64::INFINITY; columns];
        let mut previous: Vec<Option<usize>> = vec![None; columns];
        let mut visited = vec![false; columns];
        let (mut row, mut at): (usize, Option<usize>) = (start, None);
        loop {
            let mut nearest: Option<usize> = None;
            for j in (0..columns).filter(|&j| !visited[j]) {
                let reduced = cost(row, j) - row_price[row] - column_price[j];
                if reduced < distance[j] {
                    distance[j] = reduced;
                    previous[j] = at;
                }
                if nearest.is_none_or(|n| distance[j] < distance[n]) {
                    nearest = Some(j);
                }
            }
            // Every turn visits a column, and there are at least as many as rows: a free one is met.
            let Some(column) = nearest else { break };
            // Prices change so that the pairs on the tree stay free of reduced cost.
            let step = distance[column];
            row_price[start] += step;
            for j in 0..columns {
                if visited[j] {
                    column_price[j] -= step;
                    if let Some(owner) = row_of[j] {
                        row_price[owner] += step;
                    }
                } else {
                    distance[j] -= step;
                }
            }
            visited[column] = true;
            at = Some(column);
            match row_of[column] {
                Some(owner) => row = owner,
                None => break,
            }
        }
        // Every column on the path passes to the row from which it was reached.
        while let Some(column) = at {
            at = previous[column];
            row_of[column] = at.map_or(Some(start), |before| row_of[before]);
        }
    }
    row_of
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Pairs and cost of the best assignment among all, tried one by one.
    pub(crate) fn brute_force(costs: &[Vec<Option<f64>>]) -> (usize, f64) {
        fn best(costs: &[Vec<Option<f64>>], used: &mut Vec<usize>) -> (usize, f64) {
            let Some((row, rest)) = costs.split_first() else {
                return (0, 0.0);
            };
            let mut found = best(rest, used);
            for (j, cost) in row.iter().enumerate() {
                let Some(cost) = cost.filter(|_| !used.contains(&j)) else {
                    continue;
                };
                used.push(j);
                let (pairs, sum) = best(rest, used);
                used.pop();
                if (pairs + 1, -(sum + cost)) > (found.0, -found.1) {
                    found = (pairs + 1, sum + cost);
                }
            }
            found
        }
        best(costs, &mut Vec::new())
    }

    fn pairs_and_cost(costs: &[Vec<Option<f64>>]) -> (usize, f64) {
        let chosen = assign(costs);
        let mut columns: Vec<usize> = chosen.iter().flatten().copied().collect();
        let pairs = columns.len();
        columns.sort_unstable();
        columns.dedup();
        assert_eq!(columns.len(), pairs, "a column is used twice");
        let cost = chosen
            .iter()
            .enumerate()
            .filter_map(|(i, j)| j.map(|j| costs[i][j].unwrap()))
            .sum();
        (pairs, cost)
    }

    /// By hand, the sums of the six permutations: 1100, 1000, 1050, 950, 1150, 1150.
    #[test]
    fn val_six_permutations() {
        let costs: Vec<Vec<Option<f64>>> = [
            [250.0, 400.0, 350.0],
            [400.0, 600.0, 350.0],
            [200.0, 400.0, 250.0],
        ]
        .iter()
        .map(|row| row.iter().copied().map(Some).collect())
        .collect();
        assert_eq!(assign(&costs), [Some(1), Some(2), Some(0)]);
        assert_eq!(pairs_and_cost(&costs), (3, 950.0));
    }

    /// Two dear pairs are preferred to one cheap one.
    #[test]
    fn val_most_pairs_come_first() {
        let costs = [vec![Some(0.0), Some(100.0)], vec![Some(100.0), None]];
        assert_eq!(assign(&costs), [Some(1), Some(0)]);
        assert_eq!(assign(&[]), []);
        assert_eq!(assign(&[vec![], vec![]]), [None, None]);
        assert_eq!(assign(&[vec![None, Some(f64::NAN)]]), [None]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        /// Of up to six rows and columns, with and without forbidden pairs, equal costs among them.
        #[test]
        fn prop_no_assignment_is_better(
            (columns, entries) in (1_usize..=6, 1_usize..=6).prop_flat_map(|(rows, columns)| {
                let entry = prop_oneof![
                    1 => Just(None),
                    2 => (0.0..1.0_f64).prop_map(Some),
                    1 => (-2_i8..3).prop_map(|c| Some(f64::from(c))),
                ];
                (Just(columns), prop::collection::vec(entry, rows * columns))
            })
        ) {
            let costs: Vec<Vec<Option<f64>>> = entries.chunks(columns).map(<[_]>::to_vec).collect();
            let (pairs, cost) = pairs_and_cost(&costs);
            let (most, least) = brute_force(&costs);
            prop_assert_eq!(pairs, most);
            prop_assert!((cost - least).abs() < 1e-12, "{cost} {least}");
        }
    }
}
