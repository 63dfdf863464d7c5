//! **Select points**: vertices picked by hand, remembered by where they are.

use glam::DVec3;
use maquette_geometry::mesh::select::{Picked, SelectError, Selection, by_points};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::selecting::SelectionOutput;
use crate::wire;

/// Most points: each is compared with every vertex.
const MOST: usize = 4096;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "select-points",
        1,
        "select",
        "Selects the vertices nearest to points picked by hand; they are found again when the mesh changes, as far as \
         they are where they were.",
    );
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let points = node.text(
        "points",
        "0 0 0",
        "The points: three coordinates in metres each, with commas between points: 0.1 1.2 0, 0.1 1.3 0.05.",
    );
    let tolerance =
        node.length("tolerance", 0.01, 0.0..=1e6, "Largest distance of a point from the vertex that it selects.");
    node.soft_range(tolerance, 0.0..=0.1);
    let output = SelectionOutput::declare(&mut node);
    let lost = node.figure("lost", Unit::None, "Points that found no vertex within the tolerance.");
    let table = node.table(
        "points",
        &[
            ("point", Unit::None),
            ("vertex", Unit::None),
            ("distance", Unit::Length),
            ("found", Unit::None),
            ("x", Unit::Length),
            ("y", Unit::Length),
            ("z", Unit::Length),
        ],
        "The points, counted from 0: the vertex nearest to each, how far it is, whether it is selected, where it is.",
    );
    node.evaluate(move |ports| {
        let body = &ports.read(mesh).0;
        let places = parse(ports.read(points).as_str()).at(points)?;
        let found = if places.is_empty() && body.polygon_count() > 0 {
            // Before the first one is picked, nothing is selected, and what is selected of is known.
            Some((Selection::new(vec![0.0; body.positions().len()]).at(mesh)?, Vec::new()))
        } else {
            match by_points(body, &places, ports.value(tolerance), &ports.progress_callback()) {
                Err(error @ SelectError::NoPolygons) => Err(error).at(mesh),
                found => found.at(points),
            }?
        };
        let Some((weights, picked)) = found else { return Err(NodeError::Cancelled) };
        for (index, (place, one)) in places.iter().zip(&picked).enumerate().filter(|(_, (_, one))| !one.found) {
            ports.warn(format!(
                "point {index} at ({}, {}, {}) no longer finds its place: the nearest vertex is {:.4} m away; pick it \
                 again, or raise the tolerance",
                place.x, place.y, place.z, one.distance
            ));
        }
        let row = |(index, one): (usize, &Picked)| {
            let at = body.positions()[one.vertex as usize];
            let vertex = one.vertex as usize;
            let figures = [at.x.into(), at.y.into(), at.z.into()];
            let known = [index.into(), vertex.into(), one.distance.into(), one.found.into()];
            known.into_iter().chain(figures).collect()
        };
        ports.table(table, picked.iter().enumerate().map(row).collect());
        #[expect(clippy::cast_precision_loss, reason = "small")]
        ports.figure(lost, picked.iter().filter(|one| !one.found).count() as f64);
        let mesh_hash = ports.content_hash(mesh);
        let selection = wire::Selection { weights: weights.into(), mesh: body.clone(), mesh_hash };
        output.write(ports, selection, "pick vertices of it");
        Ok(())
    });
    node
}

fn parse(text: &str) -> Result<Vec<DVec3>, String> {
    let entries: Vec<&str> = text.split([',', ';', '\n']).map(str::trim).filter(|entry| !entry.is_empty()).collect();
    if entries.len() > MOST {
        return Err(format!("there are {} points, and at most {MOST}: select by a shape or a stroke", entries.len()));
    }
    let point = |entry: &&str| {
        let numbers: Option<Vec<f64>> =
            entry.split_whitespace().map(|word| word.parse::<f64>().ok().filter(|n| n.is_finite())).collect();
        match numbers.as_deref() {
            Some([x, y, z]) => Ok(DVec3::new(*x, *y, *z)),
            _ => {
                let shown: String = entry.chars().take(40).collect();
                Err(format!("\"{shown}\" is no point: give three numbers each, as in 0.1 1.2 0, 0.1 1.3 0.05"))
            }
        }
    };
    entries.iter().map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_three_numbers_each() {
        assert_eq!(parse(" 1 2 3, -1e-3 0 4;\n").unwrap(), [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1e-3, 0.0, 4.0)]);
        assert_eq!(parse("").unwrap(), []);
        for wrong in ["1 2", "1 2 3 4", "a b c", "1 2 inf"] {
            assert!(parse(wrong).unwrap_err().contains("is no point"), "{wrong}");
        }
        assert!(parse(&"0 0 0,".repeat(5000)).unwrap_err().contains("at most 4096"));
    }
}
