//! The legend: outside the frames, wrapped to the width there is.

use super::curve::path;
use super::drawing::draw_markers;
use super::palette::Style;
use super::panel::Panel;
use super::svg::{Anchor, Canvas, Label, Stroke};
use super::text;
use super::theme::{INK, LEGEND, LINE};

/// Length of the piece of line shown for a series: at least two periods of every dash pattern.
const SAMPLE: f64 = 36.0;
/// Room for a marker where no series has a line.
const MARKER: f64 = 12.0;
/// Space between the sample and its name.
const GAP: f64 = 7.0;
/// Space between entries.
const BETWEEN: f64 = 22.0;

struct Entry {
    lines: Vec<String>,
    style: Style,
    /// Whether a band is shaded around the curve.
    shaded: bool,
    /// Room for line or marker, the same for all entries.
    sample: f64,
}

impl Entry {
    fn width(&self) -> f64 {
        self.sample
            + GAP
            + self
                .lines
                .iter()
                .map(|line| text::width(line, LEGEND))
                .fold(0.0, f64::max)
    }

    fn height(&self) -> f64 {
        self.lines.len().max(1) as f64 * LEGEND * LINE + 3.0
    }
}

/// Entries in rows, measured for the width they may take.
pub(crate) struct Legend {
    rows: Vec<Vec<Entry>>,
    /// Width of each column, if the entries take more than one row.
    columns: Vec<f64>,
}

impl Legend {
    /// One entry for each name and style among the panels, in order of appearance.
    pub(crate) fn new<'a>(panels: impl Iterator<Item = &'a Panel>, width: f64) -> Self {
        let mut known: Vec<(&str, Style, bool)> = Vec::new();
        for series in panels
            .flat_map(|panel| &panel.series)
            .filter(|series| !series.name.is_empty())
        {
            let shaded = !series.band.is_empty();
            let same = |entry: &&mut (&str, Style, bool)| (entry.0, entry.1) == (&*series.name, series.style);
            match known.iter_mut().find(same) {
                Some(entry) => entry.2 |= shaded,
                None => known.push((series.name.as_str(), series.style, shaded)),
            }
        }
        let sample = if known.iter().any(|(_, style, _)| style.line.is_some()) {
            SAMPLE
        } else {
            MARKER
        };
        let room = (width - sample - GAP).max(40.0);
        let entries: Vec<Entry> = known
            .into_iter()
            .map(|(name, style, shaded)| Entry {
                lines: text::wrap(name, LEGEND, room),
                style,
                shaded,
                sample,
            })
            .collect();
        let widths: Vec<f64> = entries.iter().map(Entry::width).collect();
        let fits = |per_row: &usize| total(&columns(&widths, *per_row)) <= width;
        let per_row = (1..=entries.len()).rev().find(fits).unwrap_or(1);
        // As few rows as fit, then as even as they can be: 5 in rows of 4 become 3 and 2.
        let rows = entries.len().div_ceil(per_row);
        let per_row = entries.len().div_ceil(rows.max(1)).max(1);
        let columns = columns(&widths, per_row);
        let mut rows: Vec<Vec<Entry>> = Vec::new();
        for entry in entries {
            match rows.last_mut() {
                Some(row) if row.len() < per_row => row.push(entry),
                _ => rows.push(vec![entry]),
            }
        }
        Self { rows, columns }
    }

    /// Height it takes, with the space that sets it off; nothing if there are no entries.
    pub(crate) fn height(&self) -> f64 {
        if self.rows.is_empty() {
            0.0
        } else {
            self.rows.iter().map(|row| row_height(row)).sum::<f64>() + 8.0
        }
    }

    /// Draws it centred on `middle`, from `top` down.
    pub(crate) fn draw(&self, canvas: &mut Canvas, middle: f64, top: f64) {
        if self.rows.is_empty() {
            return;
        }
        canvas.open_group("legend");
        let left = middle - 0.5 * total(&self.columns);
        let mut y = top + 6.0;
        for row in &self.rows {
            let mut x = left;
            for (entry, column) in row.iter().zip(&self.columns) {
                draw_entry(canvas, entry, x, y);
                x += column + BETWEEN;
            }
            y += row_height(row);
        }
        canvas.close_group();
    }
}

fn columns(widths: &[f64], per_row: usize) -> Vec<f64> {
    (0..per_row.min(widths.len()))
        .map(|j| {
            widths
                .iter()
                .skip(j)
                .step_by(per_row)
                .copied()
                .fold(0.0, f64::max)
        })
        .collect()
}

fn total(columns: &[f64]) -> f64 {
    columns.iter().sum::<f64>() + BETWEEN * columns.len().saturating_sub(1) as f64
}

fn row_height(row: &[Entry]) -> f64 {
    row.iter().map(Entry::height).fold(0.0, f64::max)
}

fn draw_entry(canvas: &mut Canvas, entry: &Entry, x: f64, top: f64) {
    let y = top + 0.5 * LEGEND * LINE;
    let (colour, width) = (entry.style.colour.hex(), entry.style.drawn_width());
    if entry.shaded {
        let (left, right) = (x, x + entry.sample);
        let corners = vec![
            (left, y - 5.0),
            (right, y - 5.0),
            (right, y + 5.0),
            (left, y + 5.0),
        ];
        canvas.shaded(&path(&[corners]), &colour);
    }
    if let Some(dash) = entry.style.line {
        let dashes = dash.lengths(width);
        canvas.line(
            (x, y),
            (x + entry.sample, y),
            &Stroke {
                colour: &colour,
                width,
                dashes: &dashes,
            },
        );
    }
    if let Some(marker) = entry.style.marker {
        draw_markers(canvas, marker, &[(x + 0.5 * entry.sample, y)], &colour, width);
    }
    for (i, line) in entry.lines.iter().enumerate() {
        let at = (x + entry.sample + GAP, y + i as f64 * LEGEND * LINE);
        canvas.label(&Label::new(line, at, LEGEND, Anchor::Start, INK));
    }
}
