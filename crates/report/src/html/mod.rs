//! Reports as one HTML file that needs nothing else: style sheet, scripts and data are inside, and nothing is fetched.
//!
//! | part | shows |
//! |---|---|
//! | [`Section`] | paragraphs, facts, lists, tables, code, below a heading of the table of contents |
//! | [`Figure`] | any plot of [`plot`](crate::plot): to zoom and read off on a screen, drawn as SVG in print |
//! | [`Shapes`] | deformed shapes of lines and quadrilaterals in space, which swing and can be turned |
//!
//! Without JavaScript, and in print, the SVG drawings stand for what moves. Text is escaped wherever it comes from; equal
//! input gives equal bytes.

mod escape;
mod figure;
mod shapes;
mod table;

pub use shapes::{Shape, Shapes};

use crate::error::ReportError;
use crate::plot::sheet::Sheet;
use crate::plot::{BodePlot, GridPlot, LinePlot, ScatterPlot};
use crate::table::Table;
use escape::{data, text};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Rows up to which a folded table is shown open.
const OPEN_ROWS: usize = 30;

/// A report in the making.
///
/// ```
/// use albatross_report::html::{HtmlReport, Section};
/// let mut section = Section::new("Trim");
/// section.paragraph("Level flight at < 10 km.");
/// let mut report = HtmlReport::new("Surrogate", "cruise");
/// report.push(section);
/// let page = report.render();
/// assert!(page.starts_with("<!DOCTYPE html>"));
/// assert!(page.contains("<p>Level flight at &lt; 10 km.</p>"));
/// ```
#[derive(Debug, Clone)]
pub struct HtmlReport {
    title: String,
    subtitle: String,
    sections: Vec<Section>,
}

impl HtmlReport {
    /// A report without sections.
    pub fn new(title: impl Into<String>, subtitle: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            subtitle: subtitle.into(),
            sections: Vec::new(),
        }
    }

    /// Appends a section.
    pub fn push(&mut self, section: Section) -> &mut Self {
        self.sections.push(section);
        self
    }

    /// The whole file. The plotting library is in it only if there is something to plot.
    pub fn render(&self) -> String {
        let mut contents = String::new();
        let mut body = String::new();
        for (i, section) in self.sections.iter().enumerate() {
            let heading = text(&section.heading);
            contents += &format!("<li><a href=\"#s{i}\">{heading}</a></li>\n");
            body += &format!(
                "<section id=\"s{i}\">\n<h2>{heading}</h2>\n{}</section>\n",
                section.body
            );
        }
        let scripts = if self.sections.iter().any(|section| section.live) {
            format!("{}\n<script>\n{SCRIPT}</script>\n", plotting_library())
        } else {
            String::new()
        };
        let (title, subtitle) = (text(&self.title), text(&self.subtitle));
        // The empty icon keeps browsers from asking a server for one.
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <link rel=\"icon\" href=\"data:,\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
             <header>\n<h1>{title}</h1>\n<p class=\"subtitle\">{subtitle}</p>\n</header>\n\
             <nav aria-label=\"Contents\"><ul>\n{contents}</ul></nav>\n<main>\n{body}</main>\n{scripts}</body>\n</html>\n"
        )
    }
}

/// plotly.js as a script element. The crate hands it out together with MathJax, which no plot here needs and which
/// would add two megabytes: the first of the two elements is plotly.js.
fn plotting_library() -> String {
    const END: &str = "</script>";
    let sources = plotly::Plot::offline_js_sources();
    match sources.split_once(END) {
        Some((library, _)) => format!("{library}{END}"),
        None => sources,
    }
}

/// A plot of this crate, to be shown in a report.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum Figure<'a> {
    /// Curves over one abscissa.
    Lines(&'a LinePlot),
    /// Diagrams with abscissae of their own.
    Grid(&'a GridPlot),
    /// Bode diagrams.
    Bode(&'a BodePlot),
    /// Points in a plane.
    Scatter(&'a ScatterPlot),
}

impl Figure<'_> {
    fn sheet(&self) -> Result<Sheet<'_>, ReportError> {
        match self {
            Self::Lines(plot) => plot.sheet(),
            Self::Grid(plot) => plot.sheet(),
            Self::Bode(plot) => plot.sheet(),
            Self::Scatter(plot) => plot.sheet(),
        }
    }
}

impl<'a> From<&'a LinePlot> for Figure<'a> {
    fn from(plot: &'a LinePlot) -> Self {
        Self::Lines(plot)
    }
}

impl<'a> From<&'a GridPlot> for Figure<'a> {
    fn from(plot: &'a GridPlot) -> Self {
        Self::Grid(plot)
    }
}

impl<'a> From<&'a BodePlot> for Figure<'a> {
    fn from(plot: &'a BodePlot) -> Self {
        Self::Bode(plot)
    }
}

impl<'a> From<&'a ScatterPlot> for Figure<'a> {
    fn from(plot: &'a ScatterPlot) -> Self {
        Self::Scatter(plot)
    }
}

/// A part of a report with a heading.
#[derive(Debug, Clone)]
pub struct Section {
    heading: String,
    body: String,
    /// Whether something in it needs the scripts.
    live: bool,
}

impl Section {
    /// A section without content.
    pub fn new(heading: impl Into<String>) -> Self {
        Self {
            heading: heading.into(),
            body: String::new(),
            live: false,
        }
    }

    /// A heading within the section.
    pub fn heading(&mut self, heading: &str) -> &mut Self {
        self.add(&format!("<h3>{}</h3>\n", text(heading)))
    }

    /// A paragraph of plain text.
    pub fn paragraph(&mut self, paragraph: &str) -> &mut Self {
        self.add(&format!("<p>{}</p>\n", text(paragraph)))
    }

    /// A list of plain texts; nothing if there are none.
    pub fn list<'a>(&mut self, items: impl IntoIterator<Item = &'a str>) -> &mut Self {
        let items: String = items
            .into_iter()
            .map(|item| format!("<li>{}</li>\n", text(item)))
            .collect();
        if items.is_empty() {
            return self;
        }
        self.add(&format!("<ul>\n{items}</ul>\n"))
    }

    /// Figures at a glance: what, how much with its unit.
    pub fn facts<'a>(&mut self, facts: impl IntoIterator<Item = (&'a str, String)>) -> &mut Self {
        let facts: String = facts
            .into_iter()
            .map(|(what, value)| {
                format!(
                    "<div><dt>{}</dt><dd>{}</dd></div>\n",
                    text(what),
                    escape::marked(&value)
                )
            })
            .collect();
        self.add(&format!("<dl class=\"facts\">\n{facts}</dl>\n"))
    }

    /// A table with its title, caption and notes.
    pub fn table(&mut self, table: &Table) -> &mut Self {
        self.add(&table::element(table))
    }

    /// A table below a title that unfolds it; open from the start if it is short.
    pub fn folded_table(&mut self, table: &Table) -> &mut Self {
        let rows = table.rows().len();
        let open = if rows <= OPEN_ROWS { " open" } else { "" };
        let element = table::element(table);
        self.add(&format!(
            "<details{open}>\n<summary>{}, {rows} rows</summary>\n{element}</details>\n",
            text(&table.title)
        ))
    }

    /// Text of a file or a program as it stands, below a title that unfolds it.
    pub fn code(&mut self, title: &str, code: &str) -> &mut Self {
        self.add(&format!(
            "<details>\n<summary>{}</summary>\n<pre tabindex=\"0\">{}</pre>\n</details>\n",
            text(title),
            text(code)
        ))
    }

    /// A plot, with a caption of plain text (none if empty).
    ///
    /// # Errors
    /// As the plot's `render`.
    pub fn figure<'a>(
        &mut self,
        figure: impl Into<Figure<'a>>,
        caption: &str,
    ) -> Result<&mut Self, ReportError> {
        let figure = figure.into();
        let sheet = figure.sheet()?;
        let still = sheet.render()?;
        let plots: String = figure::plots(&sheet)
            .iter()
            .map(|plot| {
                format!(
                    "<div class=\"plot\"><script type=\"application/json\">{}</script></div>\n",
                    data(plot)
                )
            })
            .collect();
        let heading = if sheet.with_heading {
            format!("<p class=\"title\">{}</p>\n", escape::marked(sheet.title))
        } else {
            String::new()
        };
        let notes: String = still
            .notes
            .iter()
            .map(|note| format!("<p class=\"note\">{}</p>\n", text(note)))
            .collect();
        let live =
            format!("<div class=\"live\">\n{heading}<div class=\"plots\">\n{plots}</div>\n{notes}</div>\n");
        Ok(self.lively(&live, &still.markup, caption))
    }

    /// Shapes in space, with a caption of plain text (none if empty).
    ///
    /// # Errors
    /// [`ReportError::ShapePoints`], [`ReportError::ShapeIndex`].
    pub fn shapes(&mut self, shapes: &Shapes, caption: &str) -> Result<&mut Self, ReportError> {
        shapes.check()?;
        let live = format!(
            "<div class=\"live shapes\"><script type=\"application/json\">{}</script></div>\n",
            data(&shapes.json())
        );
        Ok(self.lively(&live, &shapes.still(), caption))
    }

    fn lively(&mut self, live: &str, still: &str, caption: &str) -> &mut Self {
        self.live = true;
        let caption = if caption.is_empty() {
            String::new()
        } else {
            format!("<figcaption>{}</figcaption>\n", text(caption))
        };
        self.add(&format!(
            "<figure>\n{live}<div class=\"still\">\n{still}</div>\n{caption}</figure>\n"
        ))
    }

    fn add(&mut self, html: &str) -> &mut Self {
        self.body += html;
        self
    }
}
