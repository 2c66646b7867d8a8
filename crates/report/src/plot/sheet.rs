//! The page on which all plots are laid out: a heading, frames in a grid, the legend, notes.
//!
//! Every plot is a grid of stacks; a stack is a column of panels over one abscissa. Space is given out in the
//! order in which it becomes known: ordinates from the heights of the panels, the left margin from their tick
//! labels, the abscissae from the width that is left.

use super::Svg;
use super::axis::{Axis, Extent, Margin, Ruler, Scale};
use super::curve::Window;
use super::drawing::Drawing;
use super::legend::Legend;
use super::panel::Panel;
use super::svg::{Anchor, Canvas, Label, Stroke};
use super::text;
use super::theme::{FAINT_INK, FRAME, HEADING, INK, LABEL, LINE, NOTE, RIM, TICK, TICK_MARK};
use crate::error::ReportError;

/// Space between panels of a stack: tick labels at their ends keep apart.
const PANEL_GAP: f64 = 16.0;
/// Space right of a frame: half of the last tick label.
const RIGHT: f64 = 20.0;
/// Space below a stack.
const BELOW: f64 = 12.0;
/// Narrowest frame; a plot that is too narrow for its tick labels grows.
const LEAST_FRAME: f64 = 80.0;

/// Where the legend stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum LegendPlace {
    /// Below the frames.
    #[default]
    Below,
    /// Between heading and frames.
    Above,
    /// Nowhere.
    Hidden,
}

/// Panels over one abscissa.
pub(crate) struct Stack {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) panels: Vec<Panel>,
    pub(crate) margin: Margin,
}

/// A plot ready to be laid out.
pub(crate) struct Sheet<'a> {
    pub(crate) title: &'a str,
    pub(crate) description: &'a str,
    pub(crate) with_heading: bool,
    pub(crate) legend: LegendPlace,
    pub(crate) width: f64,
    /// Height of panels that do not set their own.
    pub(crate) panel_height: f64,
    pub(crate) columns: usize,
    pub(crate) stacks: Vec<Stack>,
    pub(crate) notes: Vec<String>,
}

/// A stack with fitted ordinates.
struct Fitted<'a> {
    stack: &'a Stack,
    x_extent: Extent,
    rulers: Vec<Ruler>,
    heights: Vec<f64>,
    /// Lines of the ordinates' labels, broken to the heights of the panels.
    labels: Vec<Vec<String>>,
}

impl Sheet<'_> {
    pub(crate) fn render(&self) -> Result<Svg, ReportError> {
        self.check()?;
        let fitted: Vec<Fitted<'_>> = self.stacks.iter().map(|stack| self.fit(stack)).collect();
        let columns = self.columns.clamp(1, fitted.len().max(1));
        let gutters: Vec<f64> = (0..columns)
            .map(|j| {
                fitted
                    .iter()
                    .skip(j)
                    .step_by(columns)
                    .map(Fitted::gutter)
                    .fold(0.0, f64::max)
            })
            .collect();
        let taken = 2.0 * RIM + gutters.iter().sum::<f64>() + RIGHT * columns as f64 - RIM;
        let frame = ((self.width - taken) / columns as f64).max(LEAST_FRAME).floor();
        let width = self.width.max(taken + frame * columns as f64);

        let notes: Vec<String> = self.all_notes();
        let mut canvas = Canvas::default();
        let mut y = RIM + self.heading(&mut canvas, width);
        let first_gutter = gutters.first().copied().unwrap_or(0.0);
        let middle = 0.5 * (RIM + first_gutter + width - RIGHT);
        let room = 2.0 * (width - RIGHT - middle).min(middle - RIM);
        let legend = Legend::new(self.stacks.iter().flat_map(|stack| &stack.panels), room);
        if self.legend == LegendPlace::Above {
            legend.draw(&mut canvas, middle, y);
            y += legend.height();
        }
        for row in fitted.chunks(columns) {
            let title_lines = |stack: &Fitted<'_>| text::wrap(&stack.stack.title, LABEL, frame);
            let most = row
                .iter()
                .map(|stack| title_lines(stack).len())
                .max()
                .unwrap_or(0);
            y += self.headroom(row, most);
            let mut left = RIM;
            let mut lowest = y;
            for (stack, gutter) in row.iter().zip(&gutters) {
                let lines = title_lines(stack);
                let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
                let top =
                    y - lines.len() as f64 * LABEL * LINE - if self.has_rays(row) { NOTE + 3.0 } else { 0.0 };
                // Half pixels make thin lines sharp.
                let corner = ((left + gutter).round() + 0.5, y.round() + 0.5);
                column_of_text(
                    &mut canvas,
                    &lines,
                    corner.0 + 0.5 * frame,
                    top - 4.0,
                    LABEL,
                    true,
                );
                lowest = lowest.max(stack.draw(&mut canvas, corner, frame));
                left += gutter + frame + RIGHT;
            }
            y = lowest + BELOW;
        }
        y -= BELOW;
        if self.legend == LegendPlace::Below {
            legend.draw(&mut canvas, middle, y);
            y += legend.height();
        }
        for line in notes
            .iter()
            .flat_map(|note| text::wrap(note, NOTE, width - 2.0 * RIM))
        {
            y += NOTE * LINE;
            canvas.label(&Label::new(&line, (RIM, y), NOTE, Anchor::Start, FAINT_INK));
        }
        let height = (y + RIM).ceil();
        let markup = canvas.finish(width, height, &text::plain(self.title), &self.summary(&notes));
        Ok(Svg { markup, notes })
    }

    pub(crate) fn check(&self) -> Result<(), ReportError> {
        if self.stacks.iter().all(|stack| stack.panels.is_empty()) {
            return Err(ReportError::NoPanels {
                plot: self.title.to_owned(),
            });
        }
        let size = |what, value: f64, least, most| {
            let plot = self.title.to_owned();
            if (least..=most).contains(&value) {
                Ok(())
            } else {
                Err(ReportError::Size {
                    plot,
                    what,
                    value,
                    least,
                    most,
                })
            }
        };
        size("width", self.width, 200.0, 10_000.0)?;
        size("panel height", self.panel_height, 40.0, 10_000.0)?;
        for stack in &self.stacks {
            stack.x.check()?;
            for panel in &stack.panels {
                panel.check()?;
                if let Some(height) = panel.height {
                    size("panel height", height, 40.0, 10_000.0)?;
                }
            }
        }
        Ok(())
    }

    pub(crate) fn all_notes(&self) -> Vec<String> {
        let mut notes = self.notes.clone();
        for stack in &self.stacks {
            for note in stack.panels.iter().flat_map(|panel| panel.omissions(&stack.x)) {
                if !notes.contains(&note) {
                    notes.push(note);
                }
            }
        }
        notes
    }

    /// Draws the heading and tells its height.
    fn heading(&self, canvas: &mut Canvas, width: f64) -> f64 {
        if !self.with_heading {
            return 0.0;
        }
        let lines = text::wrap(self.title, 1.1 * HEADING, width - 2.0 * RIM);
        let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
        column_of_text(canvas, &lines, 0.5 * width, RIM, HEADING, true);
        lines.len() as f64 * HEADING * LINE + 2.0
    }

    /// Space above the frames of a row: titles, and labels of rays.
    fn headroom(&self, row: &[Fitted<'_>], title_lines: usize) -> f64 {
        let titles = if title_lines == 0 {
            0.0
        } else {
            title_lines as f64 * LABEL * LINE + 4.0
        };
        let rays = if self.has_rays(row) { NOTE + 3.0 } else { 0.0 };
        titles + rays + 4.0
    }

    fn has_rays(&self, row: &[Fitted<'_>]) -> bool {
        row.iter()
            .flat_map(|stack| &stack.stack.panels)
            .any(|panel| !panel.damping_rays.is_empty())
    }

    fn fit<'s>(&self, stack: &'s Stack) -> Fitted<'s> {
        let mut x_extent = Extent::default();
        let mut fitted = Fitted {
            stack,
            x_extent,
            rulers: Vec::new(),
            heights: Vec::new(),
            labels: Vec::new(),
        };
        for panel in &stack.panels {
            let mut y_extent = Extent::default();
            panel.extend(&stack.x, &mut x_extent, &mut y_extent);
            let height = panel.height.unwrap_or(self.panel_height).round();
            // Tick labels stand about two lines apart.
            let most = ((height / (2.0 * TICK)).round() as usize).clamp(2, 9);
            let ruler = Ruler::fit(&panel.y, y_extent, Margin::Airy, most);
            fitted
                .labels
                .push(text::wrap(&ruler.title(), LABEL, height + PANEL_GAP - 4.0));
            fitted.rulers.push(ruler);
            fitted.heights.push(height);
        }
        fitted.x_extent = x_extent;
        fitted
    }

    /// What a reader who does not see the plot is told.
    fn summary(&self, notes: &[String]) -> String {
        let mut sentences: Vec<String> = Vec::new();
        if !self.description.is_empty() {
            sentences.push(self.description.to_owned());
        }
        let mut names: Vec<&str> = Vec::new();
        for stack in &self.stacks {
            let shown: Vec<String> = stack
                .panels
                .iter()
                .map(|panel| text::plain(&panel.y.title(0)))
                .collect();
            let title = if stack.title.is_empty() {
                String::new()
            } else {
                format!("{}: ", text::plain(&stack.title))
            };
            sentences.push(format!(
                "{title}{} over {}.",
                shown.join("; "),
                text::plain(&stack.x.title(0))
            ));
            for series in stack.panels.iter().flat_map(|panel| &panel.series) {
                if !series.name.is_empty() && !names.contains(&series.name.as_str()) {
                    names.push(&series.name);
                }
            }
        }
        if !names.is_empty() {
            sentences.push(format!("Series: {}.", text::plain(&names.join("; "))));
        }
        sentences.extend(notes.iter().map(|note| text::plain(note)));
        sentences.join(" ")
    }
}

impl Fitted<'_> {
    /// Space left of the frame: tick marks, tick labels, the label of the ordinate.
    fn gutter(&self) -> f64 {
        let ticks = self.tick_width();
        let lines = self.labels.iter().map(Vec::len).max().unwrap_or(0);
        let labels = if lines == 0 {
            0.0
        } else {
            lines as f64 * LABEL * LINE + 4.0
        };
        (TICK_MARK + 4.0 + ticks + labels).ceil()
    }

    fn tick_width(&self) -> f64 {
        let labels = self.rulers.iter().flat_map(Ruler::major);
        labels
            .map(|(_, label)| text::width(label, TICK))
            .fold(0.0, f64::max)
    }

    /// As many ticks as have room for their labels side by side.
    fn fit_x(&self, width: f64) -> Ruler {
        let fit = |most| Ruler::fit(&self.stack.x, self.x_extent, self.stack.margin, most);
        let fits = |ruler: &Ruler| {
            let labels = ruler.major();
            let room = labels.windows(2).filter_map(|pair| match pair {
                [(a, _), (b, _)] => Some((b - a) * width),
                _ => None,
            });
            let widest = labels
                .iter()
                .map(|(_, label)| text::width(label, TICK))
                .fold(0.0, f64::max);
            room.fold(f64::INFINITY, f64::min) >= widest + 1.2 * TICK
        };
        // Powers of ten are short and every decade is wanted; other ticks are best not too many.
        let room = if self.stack.x.scale == Scale::Log {
            30.0
        } else {
            55.0
        };
        let most = ((width / room) as usize).clamp(2, 12);
        (2..=most).rev().map(fit).find(fits).unwrap_or_else(|| fit(2))
    }

    /// Draws the stack with its first frame's corner at the point given, and tells where it ends below.
    fn draw(&self, canvas: &mut Canvas, (left, top): (f64, f64), width: f64) -> f64 {
        let x = self.fit_x(width);
        let label_edge = left - TICK_MARK - 4.0 - self.tick_width() - 4.0;
        let mut y = top;
        for (((panel, ruler), height), label) in self
            .stack
            .panels
            .iter()
            .zip(&self.rulers)
            .zip(&self.heights)
            .zip(&self.labels)
        {
            let window = Window {
                left,
                top: y,
                width,
                height: *height,
            };
            canvas.open_group("panel");
            Drawing {
                panel,
                window,
                x: &x,
                y: ruler,
            }
            .draw(canvas);
            self.ordinate(canvas, &window, ruler, label, label_edge);
            canvas.close_group();
            y = window.bottom() + PANEL_GAP;
        }
        self.abscissa(canvas, &x, left, y - PANEL_GAP, width)
    }

    fn ordinate(&self, canvas: &mut Canvas, window: &Window, ruler: &Ruler, lines: &[String], edge: f64) {
        for (part, label) in ruler.major() {
            let (x, y) = window.at(0.0, part);
            canvas.line((x - TICK_MARK, y), (x, y), &Stroke::solid(FRAME, 0.9));
            canvas.label(&Label::new(
                label,
                (x - TICK_MARK - 4.0, y),
                TICK,
                Anchor::End,
                INK,
            ));
        }
        for (i, line) in lines.iter().rev().enumerate() {
            let x = edge - (i as f64 + 0.5) * LABEL * LINE;
            let label = Label::new(line, (x, window.middle().1), LABEL, Anchor::Middle, INK);
            canvas.label(&Label {
                upright: true,
                ..label
            });
        }
    }

    /// Tick labels and label below the lowest frame; tells where they end.
    fn abscissa(&self, canvas: &mut Canvas, ruler: &Ruler, left: f64, bottom: f64, width: f64) -> f64 {
        for (part, label) in ruler.major() {
            let x = left + part * width;
            canvas.line((x, bottom), (x, bottom + TICK_MARK), &Stroke::solid(FRAME, 0.9));
            let at = (x, bottom + TICK_MARK + 3.0 + 0.5 * TICK);
            canvas.label(&Label::new(label, at, TICK, Anchor::Middle, INK));
        }
        let below = bottom + TICK_MARK + 3.0 + 1.1 * TICK;
        let title = text::wrap(&ruler.title(), LABEL, width + RIGHT);
        let lines: Vec<&str> = title.iter().map(String::as_str).collect();
        column_of_text(canvas, &lines, left + 0.5 * width, below + 2.0, LABEL, false);
        below + 4.0 + lines.len() as f64 * LABEL * LINE
    }
}

/// Centred lines of text from `top` down.
fn column_of_text(canvas: &mut Canvas, lines: &[&str], middle: f64, top: f64, size: f64, bold: bool) {
    for (i, line) in lines.iter().enumerate() {
        let at = (middle, top + (i as f64 + 0.5) * size * LINE);
        canvas.label(&Label {
            bold,
            ..Label::new(line, at, size, Anchor::Middle, INK)
        });
    }
}
