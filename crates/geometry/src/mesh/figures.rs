//! What can be counted and measured on a mesh, at once.

use glam::DVec3;

use super::topology::Topology;
use super::{Mesh, measure};

/// Counts and sizes of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeshFigures {
    /// All vertices, also those of no polygon.
    pub vertices: usize,
    /// Polygons.
    pub polygons: usize,
    /// Edges, each counted once.
    pub edges: usize,
    /// Parts that do not hang together by edges.
    pub components: usize,
    /// Loops of edges with one polygon.
    pub boundary_loops: usize,
    /// Handles and tunnels of all parts together, as of surfaces with their boundary loops closed; `None` where an edge
    /// has more than two polygons or polygons at it face opposite ways, so that it means nothing.
    pub genus: Option<usize>,
    /// Area in square metres.
    pub area: f64,
    /// Enclosed volume in cubic metres, positive where polygons face outwards; holes are closed by fans.
    pub volume: f64,
    /// Shortest edge, metres; 0 where there is none, as the two below.
    pub shortest_edge: f64,
    /// Mean length of the edges, metres.
    pub mean_edge: f64,
    /// Longest edge, metres.
    pub longest_edge: f64,
    /// Lowest and highest coordinates, metres; `None` without a vertex.
    pub bounds: Option<(DVec3, DVec3)>,
}

/// Counts and measures a mesh; `None` where `progress`, called with the fraction done, answers `false`.
pub fn figures(mesh: &Mesh, progress: &dyn Fn(f64) -> bool) -> Option<MeshFigures> {
    let go_on = |done: f64| if progress(done) { Ok(()) } else { Err(()) };
    go_on(0.0).ok()?;
    let topology = Topology::new_while(mesh, &|| go_on(0.1)).ok()?;
    go_on(0.5).ok()?;
    let area = measure::area_while(mesh, &|| go_on(0.6)).ok()?;
    let components = topology.shells().len();
    let boundary_loops = topology.boundary_loops().len();
    go_on(0.8).ok()?;
    let (mut shortest, mut longest, mut sum) = (f64::INFINITY, 0.0_f64, 0.0);
    for [a, b] in topology.edges().filter_map(|uses| uses.first()).map(|first| first.edge) {
        let length = mesh.positions()[a as usize].distance(mesh.positions()[b as usize]);
        (shortest, longest, sum) = (shortest.min(length), longest.max(length), sum + length);
    }
    let edges = topology.edge_count();
    let is_surface = topology.non_manifold_edges().is_empty() && topology.inconsistent_edges().is_empty();
    // Closed by lids, a part of genus g has the characteristic 2 - 2g.
    let handles = 2 * components as i64 - topology.euler_characteristic() - boundary_loops as i64;
    let genus = usize::try_from(handles).ok().filter(|h| is_surface && h.is_multiple_of(2)).map(|h| h / 2);
    go_on(0.9).ok()?;
    Some(MeshFigures {
        vertices: mesh.positions().len(),
        polygons: mesh.polygon_count(),
        edges,
        components,
        boundary_loops,
        genus,
        area,
        volume: measure::signed_volume_with(mesh, &topology),
        shortest_edge: if edges == 0 { 0.0 } else { shortest },
        mean_edge: if edges == 0 { 0.0 } else { sum / edges as f64 },
        longest_edge: longest,
        bounds: measure::bounds(mesh),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::join;

    /// Rings of `around` x `across` quads.
    fn torus(around: u32, across: u32) -> Mesh {
        let turn = |i: u32, count: u32| std::f64::consts::TAU * f64::from(i) / f64::from(count);
        let points = (0..around).flat_map(|i| {
            (0..across).map(move |j| {
                let (u, v) = (turn(i, around), turn(j, across));
                let from_axis = 1.0 + 0.25 * v.cos();
                DVec3::new(from_axis * u.cos(), 0.25 * v.sin(), -from_axis * u.sin())
            })
        });
        let at = |i: u32, j: u32| (i % around) * across + j % across;
        let quads = (0..around)
            .flat_map(|i| (0..across).map(move |j| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
        Mesh::new(points.collect(), quads).unwrap()
    }

    #[test]
    fn a_torus_has_one_handle_and_a_known_size() {
        let found = figures(&torus(200, 100), &|_| true).unwrap();
        assert_eq!((found.vertices, found.edges, found.polygons), (20_000, 40_000, 20_000));
        assert_eq!((found.components, found.boundary_loops, found.genus), (1, 0, Some(1)));
        // 4 pi^2 R r and 2 pi^2 R r^2.
        assert!((found.area - 9.8696).abs() < 0.01 && (found.volume - 1.2337).abs() < 0.003, "{found:?}");
        let (low, high) = found.bounds.unwrap();
        assert!((high - low).distance(DVec3::new(2.5, 0.5, 2.5)) < 1e-9);
        assert!(found.shortest_edge < found.mean_edge && found.mean_edge < found.longest_edge);
    }

    #[test]
    fn parts_add_their_handles_and_what_is_no_surface_has_no_genus() {
        let two = join([&torus(12, 6), &torus(12, 6)]).unwrap();
        assert_eq!(figures(&two, &|_| true).unwrap().genus, Some(2));
        let fin = Mesh::new((0..5).map(|i| DVec3::X * f64::from(i)).collect(), [[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
        assert_eq!(figures(&fin.unwrap(), &|_| true).unwrap().genus, None);
        let open: Vec<Vec<u32>> = torus(12, 6).polygons().skip(1).map(<[u32]>::to_vec).collect();
        let open = Mesh::new(torus(12, 6).positions().to_vec(), open).unwrap();
        let found = figures(&open, &|_| true).unwrap();
        assert_eq!((found.genus, found.boundary_loops), (Some(1), 1));
        let nothing = figures(&Mesh::default(), &|_| true).unwrap();
        assert_eq!(nothing, MeshFigures { genus: Some(0), ..MeshFigures::default() });
        assert_eq!(figures(&open, &|done| done < 0.8), None);
    }
}
