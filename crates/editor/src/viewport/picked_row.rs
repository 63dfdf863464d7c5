//! What a row of a report's table speaks of, among the lines that the views draw: by the number in a column `section`, `curve` or
//! `rail`, by its place where a table has a row a curve, or a point by its columns `x`, `y` and `z`.

use maquette_graph::{Cell, Node, Table};

use crate::drawable::{Drawable, Line, LineRole, Segment};

/// Half the size of the cross that marks a point, metres, for each metre of what is drawn.
const CROSS: f32 = 0.03;

fn column<'a>(table: &Table, row: &'a [Cell], name: &str) -> Option<&'a Cell> {
    row.get(table.columns.iter().position(|column| column.name == name)?)
}

#[expect(clippy::cast_possible_truncation, reason = "coordinates for the graphics card")]
fn number(table: &Table, row: &[Cell], name: &str) -> Option<f32> {
    match column(table, row, name)? {
        Cell::Number(number) => Some(*number as f32),
        Cell::Text(_) => None,
    }
}

/// The number in a cell: its own, or the last word of a text such as `curve 3`.
fn counted(cell: &Cell) -> Option<usize> {
    match cell {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        Cell::Number(number) => (*number >= 0.0 && number.fract() == 0.0 && *number < 1e9).then_some(*number as usize),
        Cell::Text(text) => text.rsplit(' ').next()?.parse().ok(),
    }
}

/// The nth line of a role: of the output that is called as the table, or else of what has as many as the table has rows, or else
/// of what has enough.
fn line<'a>(drawables: &[&'a Drawable], node: &Node, table: &Table, role: LineRole, index: usize) -> Option<&'a Line> {
    let of = |drawable: &&'a Drawable| drawable.lines.iter().filter(|line| line.role == role).collect::<Vec<_>>();
    let named = node.kind().and_then(|kind| kind.outputs().iter().position(|output| output.name == table.name));
    let found: Vec<Vec<&Line>> = drawables.iter().map(of).collect();
    let has = |lines: &&Vec<&Line>| lines.len() > index;
    let by_name = named.and_then(|at| found.get(at)).filter(has);
    let by_count = || found.iter().filter(has).find(|lines| lines.len() == table.rows.len());
    by_name.or_else(by_count).or_else(|| found.iter().find(has)).and_then(|lines| lines.get(index).copied())
}

fn pieces(line: &Line) -> Vec<Segment> {
    let place = |point: &glam::Vec3| point.to_array();
    let joint = line.points.last().zip(line.points.first()).filter(|_| line.closed);
    let pairs = line.points.windows(2).map(|pair| (&pair[0], &pair[1])).chain(joint);
    pairs.map(|(from, to)| Segment { from: place(from), to: place(to) }).collect()
}

/// What to draw of a row of a table that a node reported; empty where the row speaks of nothing that is drawn.
pub(super) fn segments(drawables: &[&Drawable], node: &Node, table: &Table, index: usize) -> Vec<Segment> {
    let Some(row) = table.rows.get(index) else { return Vec::new() };
    if let (Some(x), Some(y), Some(z)) = (number(table, row, "x"), number(table, row, "y"), number(table, row, "z")) {
        return cross(drawables, glam::vec3(x, y, z));
    }
    let by_number = |name: &str, role| {
        let at = counted(column(table, row, name)?)?;
        line(drawables, node, table, role, at)
    };
    // Where rails are not marked on sections, they are curves themselves.
    let rail = || by_number("rail", LineRole::Rail).or_else(|| by_number("rail", LineRole::Curve));
    let curve = || {
        column(table, row, "curve")?;
        line(drawables, node, table, LineRole::Curve, index)
    };
    let found = by_number("section", LineRole::Section).or_else(rail).or_else(curve);
    found.map(pieces).unwrap_or_default()
}

/// Three strokes through a point, as large as can be seen beside what is drawn.
fn cross(drawables: &[&Drawable], at: glam::Vec3) -> Vec<Segment> {
    let size = drawables.iter().filter_map(|drawable| drawable.bounds).map(|[low, high]| low.distance(high));
    #[expect(clippy::cast_possible_truncation, reason = "metres for the graphics card")]
    let size = size.fold(0.0, f64::max) as f32;
    let arm = CROSS * if size > 0.0 { size } else { 1.0 };
    let along = |axis: glam::Vec3| Segment { from: (at - arm * axis).to_array(), to: (at + arm * axis).to_array() };
    glam::Vec3::AXES.map(along).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use maquette_graph::{Column, Graph, Unit};

    fn table(name: &str, columns: &[&str], rows: Vec<Vec<Cell>>) -> Table {
        let column = |name: &&str| Column { name: (*name).to_owned(), unit: Unit::None };
        Table { name: name.to_owned(), columns: columns.iter().map(column).collect(), rows }
    }

    fn drawable(lines: &[(LineRole, f32)]) -> Drawable {
        let line = |(role, at): &(LineRole, f32)| Line {
            points: vec![glam::vec3(*at, 0.0, 0.0), glam::vec3(*at, 1.0, 0.0), glam::vec3(*at, 1.0, 1.0)],
            closed: *role == LineRole::Section,
            role: *role,
        };
        let lines = lines.iter().map(line).collect();
        Drawable { id: 0, is_selection: false, surface: None, lines, colour: None, bounds: None }
    }

    fn at(segments: &[Segment]) -> (usize, Option<f32>) {
        (segments.len(), segments.first().map(|segment| segment.from[0]))
    }

    #[test]
    fn rows_find_their_lines_and_points() {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let mut graph = Graph::new();
        let sort = graph.add(&catalogue, "sort", "sorted").unwrap();
        let sort = graph.node(sort).unwrap();
        let sections = drawable(&[
            (LineRole::Section, 0.0),
            (LineRole::Section, 1.0),
            (LineRole::Rail, 7.0),
            (LineRole::Rail, 8.0),
        ]);
        let rails = drawable(&[(LineRole::Curve, 3.0), (LineRole::Curve, 4.0)]);
        let closed = drawable(&[(LineRole::Curve, 5.0), (LineRole::Curve, 6.0)]);
        let by_section = table("sections", &["section", "J"], vec![vec![1.0.into(), 0.5.into()]]);
        assert_eq!(at(&segments(&[&sections], sort, &by_section, 0)), (3, Some(1.0)), "closed");
        let by_rail = table("rails", &["rail"], vec![vec![0.0.into()], vec![1.0.into()]]);
        assert_eq!(at(&segments(&[&sections], sort, &by_rail, 1)), (2, Some(8.0)));
        assert_eq!(at(&segments(&[&rails, &closed], sort, &by_rail, 1)), (2, Some(4.0)));
        let by_curve = table("closed", &["curve"], vec![vec!["curve \"hem\"".into()], vec!["curve \"neck\"".into()]]);
        assert_eq!(at(&segments(&[&rails, &closed], sort, &by_curve, 1)), (2, Some(6.0)), "of the output of that name");
        let point =
            table("joints", &["joint", "x", "y", "z"], vec![vec!["a".into(), 2.0.into(), 0.0.into(), 0.0.into()]]);
        assert_eq!(segments(&[&rails], sort, &point, 0).len(), 3);
        let nothing = table("bounds", &["axis", "low"], vec![vec!["x".into(), 0.0.into()]]);
        assert!(segments(&[&rails], sort, &nothing, 0).is_empty() && segments(&[], sort, &by_rail, 9).is_empty());
    }
}
