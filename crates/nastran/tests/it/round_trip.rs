//! Writing a deck and reading it again gives the same deck.

use albatross_nastran::deck::Grid;
use albatross_nastran::{Deck, bdf, write};
use proptest::prelude::*;

use crate::any_deck::deck;
use crate::f06_fixtures::fixture;

#[test]
fn fixtures_survive() {
    for name in [
        "f25-like/f25.bdf",
        "f25-like/f25_nastran95.inp",
        "nastran/cant.bdf",
        "nastran/free.bdf",
        "nastran/stick.bdf",
    ] {
        let (deck, _) = bdf::read_strict(fixture(name)).unwrap();
        let text = write::to_text(&deck).unwrap();
        let (again, remarks) = bdf::parse(text.as_bytes(), name);
        assert_eq!(again, deck, "{name}");
        assert!(remarks.is_empty(), "{name}: {remarks:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, max_shrink_iters: 400, ..ProptestConfig::default() })]

    #[test]
    fn prop_reading_what_was_written_gives_the_deck(deck in deck()) {
        let text = write::to_text(&deck).unwrap();
        let (again, remarks) = bdf::parse(text.as_bytes(), "written");
        prop_assert_eq!(&again, &deck, "{}\n{:?}", text, remarks);
    }

    /// Any number, to the last digit that 16 columns hold.
    #[test]
    fn prop_reals_survive_to_the_width_of_the_field(value in any::<f64>().prop_filter("finite", |v| v.is_finite())) {
        let mut deck = Deck::default();
        deck.grids.insert(1, Grid { id: 1, position: [value, 0.0, -value], ..Grid::default() });
        let text = write::to_text(&deck).unwrap();
        let (again, _) = bdf::parse(text.as_bytes(), "written");
        let [x, _, z] = again.grids[&1].position;
        prop_assert!((x - value).abs() <= 1e-8 * value.abs(), "{}", text);
        prop_assert!((z + value).abs() <= 1e-8 * value.abs(), "{}", text);
    }
}
