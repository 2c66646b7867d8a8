//! Tables of derivatives: rows of `NAME = value`, in which the name says coefficient and variable.

use super::kind::Layout;
use super::mrf;
use super::{NamedColumn, NamedValue};
use crate::error::{AvlError, Location};
use crate::source::{Line, Source};

/// Width of a number.
const WIDTH: usize = 11;

/// The variable that a derivative's name ends with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Suffix {
    /// A letter: `a` in `CLa`.
    Axis(char),
    /// Control by index from 0: `d01` is 0.
    Control(usize),
    /// Design variable by index from 0: `g01` is 0.
    Design(usize),
}

impl Suffix {
    /// As AVL prints it.
    fn text(self) -> String {
        match self {
            Self::Axis(letter) => letter.to_string(),
            Self::Control(k) => format!("d{:02}", k + 1),
            Self::Design(k) => format!("g{:02}", k + 1),
        }
    }
}

/// The entries of a table, as found.
pub(crate) struct Table<C> {
    file: String,
    line: usize,
    entries: Vec<(C, Suffix, f64)>,
    last: Location,
}

impl<C: Copy + PartialEq> Table<C> {
    /// Reads the rows below the heading. Names start with one of `prefixes` and end with one of the letters of
    /// `axes`, or with `d` or `g` and a number.
    pub(crate) fn read(
        source: &mut Source<'_>,
        layout: Layout,
        prefixes: &[(&str, C)],
        axes: &str,
    ) -> Result<Self, AvlError> {
        let line = source.position();
        let last = Location {
            file: source.file.to_owned(),
            line,
            column: 0,
        };
        let mut table = Self {
            file: source.file.to_owned(),
            line,
            entries: Vec::new(),
            last,
        };
        match layout {
            Layout::Text => table.read_text(source, prefixes, axes)?,
            Layout::Mrf => table.read_mrf(source, prefixes, axes)?,
        }
        Ok(table)
    }

    /// ` z' force CL |    CLa =   7.296941    CLb =   0.000000`, to the neutral point or the end.
    fn read_text(
        &mut self,
        source: &mut Source<'_>,
        prefixes: &[(&str, C)],
        axes: &str,
    ) -> Result<(), AvlError> {
        let mut index = 0;
        while let Some(line) = source.peek() {
            if line.text.contains("Neutral point") || line.text.contains("Clb Cnr") {
                break;
            }
            source.read();
            // A row of more controls than the format holds goes on without a label.
            let start = match line.text.find('|') {
                Some(bar) => {
                    index = 0;
                    bar + 1
                }
                None if line.text.contains('=') => 0,
                None => continue,
            };
            index = self.read_row(&line, start, index, prefixes, axes)?;
            // `F11.6` ends in a digit: a shorter last line was cut.
            let equals = line.text.rfind('=').unwrap_or(0);
            source.refuse_cut(&line, equals + 1 + WIDTH, "the end of a row of derivatives")?;
        }
        Ok(())
    }

    /// The `NAME =` fields of a line, `F11.6` each.
    fn read_row(
        &mut self,
        line: &Line<'_>,
        start: usize,
        first: usize,
        prefixes: &[(&str, C)],
        axes: &str,
    ) -> Result<usize, AvlError> {
        let mut index = first;
        let mut from = start;
        while let Some(equals) = line.text.get(from..).and_then(|t| t.find('=')).map(|i| from + i) {
            let name = line.text.get(from..equals).unwrap_or("").trim();
            let tail = line.text.get(equals + 1..).unwrap_or("");
            let blanks = tail.len() - tail.trim_start().len();
            // The columns of the format, or more if the number is longer.
            let word = tail.trim_start().find([' ', '=']).unwrap_or(tail.len() - blanks);
            let width = if blanks < WIDTH {
                (blanks + word).min(tail.len())
            } else {
                WIDTH.min(tail.len())
            };
            let value = line.parse_real(tail.get(..width).unwrap_or(""), equals + 1, name)?;
            self.push(line, name, index, value, prefixes, axes)?;
            index += 1;
            from = equals + 1 + width;
        }
        Ok(index)
    }

    /// Numbers, then `| z' force CL  : CLp, CLq, CLr` or `: CLd*` for all controls.
    fn read_mrf(
        &mut self,
        source: &mut Source<'_>,
        prefixes: &[(&str, C)],
        axes: &str,
    ) -> Result<(), AvlError> {
        // `Neutral point` ends an `.st`, `# design vars` and its rows an `.sb`.
        while let Some(line) = source.peek() {
            if line.text.contains("Neutral point") {
                break;
            }
            source.read();
            let Some((_, names)) = line.text.split_once('|').and_then(|(_, l)| l.rsplit_once(':')) else {
                continue;
            };
            let values = mrf::all_reals(&line)?;
            let names: Vec<&str> = names.split(',').map(str::trim).collect();
            let starred = names.first().is_some_and(|n| n.ends_with('*'));
            if !starred && names.len() != values.len() {
                return Err(AvlError::Count {
                    at: line.at(None),
                    what: names.join(", "),
                    announced: names.len(),
                    found: values.len(),
                });
            }
            for (k, &value) in values.iter().enumerate() {
                let name = if starred { names.first() } else { names.get(k) };
                self.push(&line, name.copied().unwrap_or(""), k, value, prefixes, axes)?;
            }
        }
        Ok(())
    }

    /// Files a value under its name.
    fn push(
        &mut self,
        line: &Line<'_>,
        name: &str,
        index: usize,
        value: f64,
        prefixes: &[(&str, C)],
        axes: &str,
    ) -> Result<(), AvlError> {
        let found = prefixes.iter().find_map(|&(prefix, coefficient)| {
            let mut rest = name.strip_prefix(prefix)?.chars();
            let suffix = match rest.next()? {
                'd' => Suffix::Control(index),
                'g' => Suffix::Design(index),
                c if axes.contains(c) && rest.next().is_none() => Suffix::Axis(c),
                _ => return None,
            };
            Some((coefficient, suffix))
        });
        let Some((coefficient, suffix)) = found else {
            return Err(line.syntax(format!("a derivative's name instead of `{name}`")));
        };
        if self.get(coefficient, suffix).is_some() {
            return Err(line.syntax(format!("`{name}` once only; it was read before")));
        }
        self.last = line.at(None);
        self.entries.push((coefficient, suffix, value));
        Ok(())
    }

    /// One derivative.
    pub(crate) fn get(&self, coefficient: C, suffix: Suffix) -> Option<f64> {
        self.entries
            .iter()
            .find(|e| e.0 == coefficient && e.1 == suffix)
            .map(|e| e.2)
    }

    /// One derivative that must be there.
    pub(crate) fn require(&self, coefficient: C, suffix: Suffix, prefix: &str) -> Result<f64, AvlError> {
        self.get(coefficient, suffix).ok_or_else(|| AvlError::Missing {
            file: self.file.clone(),
            line: self.line,
            field: format!("{prefix}{}", suffix.text()),
            cure: "the table of derivatives was edited or cut: write the file again",
        })
    }

    /// The columns of all controls or design variables, named as the block of totals names them: the header of
    /// the table cuts names to 12 characters.
    pub(crate) fn named<K>(
        &self,
        variables: &[NamedValue],
        suffix: fn(usize) -> Suffix,
        column: fn(&Self, Suffix) -> Result<K, AvlError>,
    ) -> Result<Vec<NamedColumn<K>>, AvlError> {
        let found = (0..)
            .take_while(|&k| self.entries.iter().any(|e| e.1 == suffix(k)))
            .count();
        // More design columns than variables: AVL 3.40 counts controls there, and the rest is not set.
        let is_control = matches!(suffix(0), Suffix::Control(_));
        if found < variables.len() || (is_control && found > variables.len()) {
            return Err(AvlError::Count {
                at: self.last.clone(),
                what: if is_control {
                    "control columns"
                } else {
                    "design variable columns"
                }
                .to_owned(),
                announced: variables.len(),
                found,
            });
        }
        variables
            .iter()
            .enumerate()
            .map(|(k, v)| {
                Ok(NamedColumn {
                    name: v.name.clone(),
                    column: column(self, suffix(k))?,
                })
            })
            .collect()
    }
}
