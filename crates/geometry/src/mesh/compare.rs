//! How far two meshes are apart, and how much one is a deformation of the other.

use glam::DVec3;

use super::distance::NoPolygons;
use super::{Mesh, MeshDistance, Topology, measure};

/// Points between two questions whether to go on.
const STEP: usize = 4096;

/// Distances of the points of one mesh from the surface of another: of its vertices and of the middles of its polygons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The largest, metres.
    pub largest: f64,
    /// The mean, metres.
    pub mean: f64,
    /// Root of the mean of the squares, metres.
    pub rms: f64,
    /// The point that is farthest.
    pub at: DVec3,
}

/// How the lengths of the edges differ, as shares of those of the mesh that is measured against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeChange {
    /// Root of the mean of the squared changes: 0.1 where lengths differ by ten per cent.
    pub rms: f64,
    /// The largest change, of longer or shorter.
    pub largest: f64,
}

/// How far two meshes are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Of the first from the second.
    pub there: Gap,
    /// Of the second from the first.
    pub back: Gap,
    /// Where both have the same polygons over as many vertices.
    pub edges: Option<EdgeChange>,
    /// Largest distance of vertices of equal number, metres; where both have the same polygons.
    pub largest_move: Option<f64>,
    /// Volume of the first over that of the second; `None` where the second has none.
    pub volume_ratio: Option<f64>,
    /// Area of the first over that of the second; `None` where the second has none.
    pub area_ratio: Option<f64>,
}

/// Measures one mesh against another. Edges without length in the second are left out of what is said of edges.
///
/// `progress` is called with the fraction done; `Ok(None)` where it answers `false`.
///
/// # Errors
/// [`NoPolygons`] where one of them is empty.
pub fn compare(mesh: &Mesh, against: &Mesh, progress: &dyn Fn(f64) -> bool) -> Result<Option<Comparison>, NoPolygons> {
    let Some(there) = gap(mesh, &MeshDistance::new(against)?, &|done| progress(0.4 * done)) else { return Ok(None) };
    let Some(back) = gap(against, &MeshDistance::new(mesh)?, &|done| progress(0.4 + 0.4 * done)) else {
        return Ok(None);
    };
    if !progress(0.8) {
        return Ok(None);
    }
    let same = mesh.corners() == against.corners()
        && mesh.starts() == against.starts()
        && mesh.positions().len() == against.positions().len();
    let ratio = |own: f64, other: f64| (other != 0.0).then_some(own / other).filter(|ratio| ratio.is_finite());
    let largest_move = || {
        mesh.positions().iter().zip(against.positions()).map(|(p, q)| p.distance_squared(*q)).fold(0.0, f64::max).sqrt()
    };
    Ok(Some(Comparison {
        there,
        back,
        edges: same.then(|| edge_change(mesh, against)),
        largest_move: same.then(largest_move),
        volume_ratio: ratio(measure::signed_volume(mesh), measure::signed_volume(against)),
        area_ratio: ratio(measure::area(mesh), measure::area(against)),
    }))
}

fn gap(mesh: &Mesh, to: &MeshDistance, progress: &dyn Fn(f64) -> bool) -> Option<Gap> {
    let middle = |polygon: usize| {
        let sum: DVec3 = measure::polygon_points(mesh, polygon).sum();
        sum / mesh.polygon(polygon).len() as f64
    };
    let points = mesh.positions().iter().copied().chain((0..mesh.polygon_count()).map(middle));
    let count = mesh.positions().len() + mesh.polygon_count();
    let (mut farthest, mut sum, mut squares) = ((0.0, mesh.positions()[0]), 0.0, 0.0);
    for (done, point) in points.enumerate() {
        if done.is_multiple_of(STEP) && !progress(done as f64 / count as f64) {
            return None;
        }
        let distance = to.nearest(point).distance;
        if distance > farthest.0 {
            farthest = (distance, point);
        }
        sum += distance;
        squares += distance * distance;
    }
    let (largest, at) = farthest;
    Some(Gap { largest, mean: sum / count as f64, rms: (squares / count as f64).sqrt(), at })
}

fn edge_change(mesh: &Mesh, against: &Mesh) -> EdgeChange {
    let length = |of: &Mesh, [a, b]: [u32; 2]| of.positions()[a as usize].distance(of.positions()[b as usize]);
    let topology = Topology::new(against);
    let edges = topology.edges().filter_map(|uses| uses.first()).map(|first| first.edge);
    let (mut squares, mut largest, mut count) = (0.0, 0.0_f64, 0_usize);
    for edge in edges {
        let before = length(against, edge);
        if before > 0.0 {
            let change = (length(mesh, edge) / before - 1.0).abs();
            (squares, largest, count) = (squares + change * change, largest.max(change), count + 1);
        }
    }
    EdgeChange { rms: (squares / count.max(1) as f64).sqrt(), largest }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn net(height: f64, scale: f64) -> Mesh {
        let points = (0..25).map(|i| scale * DVec3::new(f64::from(i % 5), height, f64::from(i / 5))).collect();
        let quads = (0..16_u32).map(|i| 5 * (i / 4) + i % 4).map(|a| [a, a + 5, a + 6, a + 1]);
        Mesh::new(points, quads).unwrap()
    }

    #[test]
    fn distances_are_taken_both_ways() {
        let found = compare(&net(0.5, 1.0), &net(0.0, 1.0), &|_| true).unwrap().unwrap();
        for way in [found.there, found.back] {
            assert!((way.largest - 0.5).abs() < 1e-12 && (way.mean - 0.5).abs() < 1e-12);
            assert!((way.rms - 0.5).abs() < 1e-12);
        }
        assert_eq!((found.largest_move, found.volume_ratio), (Some(0.5), None));
        assert!((found.area_ratio.unwrap() - 1.0).abs() < 1e-12);
        // A larger net stands out beyond the smaller one, and not the other way round.
        let found = compare(&net(0.0, 2.0), &net(0.0, 1.0), &|_| true).unwrap().unwrap();
        assert!((found.there.largest - 32.0_f64.sqrt()).abs() < 1e-12 && found.back.largest < 1e-12);
        assert_eq!(found.there.at, DVec3::new(8.0, 0.0, 8.0));
        let edges = found.edges.unwrap();
        assert!((edges.rms - 1.0).abs() < 1e-12 && (edges.largest - 1.0).abs() < 1e-12);
        assert!((found.area_ratio.unwrap() - 4.0).abs() < 1e-12);
    }

    #[test]
    fn other_polygons_have_no_edges_in_common() {
        let whole = net(0.0, 1.0);
        // One in the middle, so that all vertices stay in use.
        let fewer: Vec<&[u32]> = whole.polygons().enumerate().filter(|(i, _)| *i != 5).map(|(_, p)| p).collect();
        let fewer = Mesh::new(whole.positions().to_vec(), fewer).unwrap();
        let found = compare(&fewer, &whole, &|_| true).unwrap().unwrap();
        assert_eq!((found.edges, found.largest_move), (None, None));
        assert!((found.back.largest - 0.5).abs() < 1e-12, "the middle of the missing face: {}", found.back.largest);
        assert_eq!(compare(&whole, &Mesh::default(), &|_| true), Err(NoPolygons));
        assert_eq!(compare(&whole, &whole, &|done| done < 0.5), Ok(None));
    }
}
