//! Meshes as VTK's unstructured grids in XML, which ParaView and VisIt open.
//!
//! "VTK File Formats" (Kitware, 2023), in text with all digits. To see a mode: filter *Warp By Vector*.

use crate::mesh::{Cell, Mesh};
use std::fmt::Write;

/// Cell types of VTK by number of points.
fn cell_type(cell: &Cell) -> u8 {
    const VERTEX: u8 = 1;
    const LINE: u8 = 3;
    const QUAD: u8 = 9;
    match cell.points.len() {
        1 => VERTEX,
        2 => LINE,
        _ => QUAD,
    }
}

/// The mesh with one vector field a mode, `mode_01_2.315_Hz`, the numbers `grid` of points, `kind` and `number` of cells,
/// and the field `frequency_hz`.
#[must_use]
pub fn write(mesh: &Mesh) -> String {
    let mut out = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n\
         <UnstructuredGrid>\n<FieldData>\n",
    );
    let frequencies = mesh.modes.iter().map(|mode| mode.frequency_hz.to_string());
    let tuples = format!("NumberOfTuples=\"{}\"", mesh.modes.len());
    array(&mut out, "Float64", "frequency_hz", &tuples, frequencies);
    // Writing to a string does not fail.
    let _ = writeln!(
        out,
        "</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>",
        mesh.points.len(),
        mesh.cells.len()
    );
    array(
        &mut out,
        "UInt32",
        "grid",
        "",
        mesh.grids.iter().map(u32::to_string),
    );
    for mode in &mesh.modes {
        let name = format!("mode_{:02}_{:.3}_Hz", mode.rank, mode.frequency_hz);
        vectors(&mut out, &name, &mode.displacement);
    }
    out.push_str("</PointData>\n<CellData>\n");
    let kinds = mesh.cells.iter().map(|c| (c.kind as u8).to_string());
    array(&mut out, "UInt8", "kind", "", kinds);
    let numbers = mesh.cells.iter().map(|c| c.number.to_string());
    array(&mut out, "UInt32", "number", "", numbers);
    out.push_str("</CellData>\n<Points>\n");
    vectors(&mut out, "position", &mesh.points);
    out.push_str("</Points>\n<Cells>\n");
    let connectivity = mesh.cells.iter().flat_map(|c| &c.points).map(usize::to_string);
    array(&mut out, "Int64", "connectivity", "", connectivity);
    let ends = mesh.cells.iter().scan(0, |end, cell| {
        *end += cell.points.len();
        Some(end.to_string())
    });
    array(&mut out, "Int64", "offsets", "", ends);
    let types = mesh.cells.iter().map(|c| cell_type(c).to_string());
    array(&mut out, "UInt8", "types", "", types);
    out.push_str("</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    out
}

fn vectors(out: &mut String, name: &str, list: &[[f64; 3]]) {
    let rows = list.iter().map(|[x, y, z]| format!("{x:?} {y:?} {z:?}"));
    array(out, "Float64", name, "NumberOfComponents=\"3\"", rows);
}

/// A data array, a value or tuple a line.
fn array(out: &mut String, kind: &str, name: &str, more: &str, values: impl Iterator<Item = String>) {
    let _ = writeln!(
        out,
        "<DataArray type=\"{kind}\" Name=\"{name}\" {more} format=\"ascii\">"
    );
    for value in values {
        out.push_str(&value);
        out.push('\n');
    }
    out.push_str("</DataArray>\n");
}
