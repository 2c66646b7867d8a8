//! Nastran decks (.bdf) and SOL 103 results (.f06) as plain structs.
