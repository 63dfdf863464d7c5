//! Sizes: bounds, area, enclosed volume, and the normal and area of a single polygon.

use std::convert::Infallible;

use glam::{DVec2, DVec3};

use super::Mesh;
use super::topology::Topology;
use super::triangulate::triangles;

/// Lowest and highest coordinates of the vertices in metres, or `None` where there is no vertex.
pub fn bounds(mesh: &Mesh) -> Option<(DVec3, DVec3)> {
    points_bounds(mesh.positions().iter().copied())
}

/// Lowest and highest coordinates of points in metres, or `None` where there is no point.
pub fn points_bounds(points: impl IntoIterator<Item = DVec3>) -> Option<(DVec3, DVec3)> {
    let mut points = points.into_iter();
    let first = points.next()?;
    Some(points.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
}

/// Diagonal of the box around the vertices in metres; 0 where there is no vertex.
pub fn diagonal(mesh: &Mesh) -> f64 {
    bounds(mesh).map_or(0.0, |(low, high)| (high - low).length())
}

/// Diagonal of the box around points in metres; 0 where there is none.
pub fn points_diagonal(points: &[DVec3]) -> f64 {
    points_bounds(points.iter().copied()).map_or(0.0, |(low, high)| (high - low).length())
}

/// Vector area of a loop of points in square metres: its direction is the normal of the loop, its length the area
/// enclosed by the loop's projection along that normal.
///
/// Newell's method, taken about the first point so that loops far from the origin lose no digits. For loops that are
/// not flat this is the normal of the plane in which the projected area is largest.
pub fn vector_area(points: impl IntoIterator<Item = DVec3>) -> DVec3 {
    let mut points = points.into_iter();
    let (Some(origin), Some(second)) = (points.next(), points.next()) else { return DVec3::ZERO };
    let mut previous = second - origin;
    let mut sum = DVec3::ZERO;
    for point in points {
        let arm = point - origin;
        sum += previous.cross(arm);
        previous = arm;
    }
    0.5 * sum
}

/// Unit normal of a polygon (Newell), or zero where the polygon has no area.
///
/// `polygon` must be less than [`Mesh::polygon_count`].
pub fn polygon_normal(mesh: &Mesh, polygon: usize) -> DVec3 {
    vector_area(polygon_points(mesh, polygon)).normalize_or_zero()
}

/// Area of a polygon in square metres: the length of its vector area ([`vector_area`]). A quad that crosses itself has
/// the difference of its two parts.
///
/// `polygon` must be less than [`Mesh::polygon_count`].
pub fn polygon_area(mesh: &Mesh, polygon: usize) -> f64 {
    vector_area(polygon_points(mesh, polygon)).length()
}

/// Area of the mesh in square metres, as the sum over its [`triangles`].
pub fn area(mesh: &Mesh) -> f64 {
    match area_while::<Infallible>(mesh, &|| Ok(())) {
        Ok(area) => area,
    }
}

/// Triangles between two questions whether to go on.
const STEP: usize = 1 << 16;

/// The same, or the error with which `go_on`, asked every 65,536 triangles, says stop.
pub(crate) fn area_while<Stop>(mesh: &Mesh, go_on: &dyn Fn() -> Result<(), Stop>) -> Result<f64, Stop> {
    let mut area = 0.0;
    for (done, corners) in triangles(mesh).enumerate() {
        if done.is_multiple_of(STEP) {
            go_on()?;
        }
        area += triangle_area(corner_points(mesh, corners));
    }
    Ok(area)
}

/// Volume enclosed by the mesh in cubic metres, positive where the polygons face outwards.
///
/// Divergence theorem over the [`triangles`], taken about the centre of the bounds. A mesh with holes is closed first:
/// each boundary loop by a fan about the mean of its points. A flat sheet has volume 0.
pub fn signed_volume(mesh: &Mesh) -> f64 {
    signed_volume_with(mesh, &Topology::new(mesh))
}

/// As [`signed_volume`], with the topology already at hand.
pub fn signed_volume_with(mesh: &Mesh, topology: &Topology) -> f64 {
    let Some((low, high)) = bounds(mesh) else { return 0.0 };
    let origin = 0.5 * (low + high);
    let sides: f64 = triangles(mesh).map(|corners| tetrahedron(corner_points(mesh, corners), origin)).sum();
    let lids: f64 = topology.boundary_loops().iter().map(|lid| fan_volume(mesh, lid, origin)).sum();
    sides + lids
}

/// Signed volume in cubic metres of each shell, in the order of [`Topology::shells`], each closed as in
/// [`signed_volume`].
pub fn shell_volumes(mesh: &Mesh, topology: &Topology) -> Vec<f64> {
    match shell_volumes_while::<Infallible>(mesh, topology, &|| Ok(())) {
        Ok(volumes) => volumes,
    }
}

/// The same, or the error with which `go_on`, asked every 65,536 triangles, says stop.
pub(crate) fn shell_volumes_while<Stop>(
    mesh: &Mesh,
    topology: &Topology,
    go_on: &dyn Fn() -> Result<(), Stop>,
) -> Result<Vec<f64>, Stop> {
    let Some((low, high)) = bounds(mesh) else { return Ok(Vec::new()) };
    let origin = 0.5 * (low + high);
    let shells = topology.shells();
    let mut shell_of = vec![0; mesh.polygon_count()];
    for (shell, polygons) in shells.iter().enumerate() {
        for &polygon in polygons {
            shell_of[polygon] = shell;
        }
    }
    let mut volumes = vec![0.0; shells.len()];
    let mut polygon = 0;
    for (done, corners) in triangles(mesh).enumerate() {
        if done.is_multiple_of(STEP) {
            go_on()?;
        }
        while mesh.corner_range(polygon).end <= corners[0] {
            polygon += 1;
        }
        volumes[shell_of[polygon]] += tetrahedron(corner_points(mesh, corners), origin);
    }
    // An edge of a loop belongs to one polygon, and so the loop to the shell of that polygon.
    for lid in topology.boundary_loops() {
        if let Some(polygon) = topology.boundary_polygon(lid[0], lid[1]) {
            volumes[shell_of[polygon]] += fan_volume(mesh, &lid, origin);
        }
    }
    Ok(volumes)
}

/// Area in square metres of the fans that close the boundary loops in [`signed_volume`].
pub(crate) fn lid_area(mesh: &Mesh, topology: &Topology) -> f64 {
    topology.boundary_loops().iter().flat_map(|lid| fan(mesh, lid)).map(triangle_area).sum()
}

/// The points of a polygon in order.
pub(crate) fn polygon_points(mesh: &Mesh, polygon: usize) -> impl Iterator<Item = DVec3> + '_ {
    mesh.polygon(polygon).iter().map(|v| mesh.positions()[*v as usize])
}

/// The points of three corners.
pub(crate) fn corner_points(mesh: &Mesh, corners: [usize; 3]) -> [DVec3; 3] {
    corners.map(|corner| mesh.positions()[mesh.corners()[corner] as usize])
}

/// Points seen along a unit `normal`, in a plane where a loop around the normal runs counter-clockwise.
pub(crate) fn project(points: impl IntoIterator<Item = DVec3>, normal: DVec3) -> Vec<DVec2> {
    let x = normal.any_orthonormal_vector();
    let y = normal.cross(x);
    let mut points = points.into_iter().peekable();
    let origin = points.peek().copied().unwrap_or_default();
    points.map(|p| DVec2::new((p - origin).dot(x), (p - origin).dot(y))).collect()
}

fn triangle_area([a, b, c]: [DVec3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

fn tetrahedron([a, b, c]: [DVec3; 3], origin: DVec3) -> f64 {
    (a - origin).dot((b - origin).cross(c - origin)) / 6.0
}

fn fan<'a>(mesh: &'a Mesh, lid: &'a [u32]) -> impl Iterator<Item = [DVec3; 3]> + 'a {
    let point = |v: u32| mesh.positions()[v as usize];
    let centre = lid.iter().map(|v| point(*v)).sum::<DVec3>() / lid.len() as f64;
    (0..lid.len()).map(move |i| [centre, point(lid[i]), point(lid[(i + 1) % lid.len()])])
}

fn fan_volume(mesh: &Mesh, lid: &[u32], origin: DVec3) -> f64 {
    fan(mesh, lid).map(|triangle| tetrahedron(triangle, origin)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: [&[u32]; 6] =
        [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];

    fn cube(low: DVec3, size: f64, polygons: &[&[u32]]) -> Mesh {
        let ring = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let points = [0.0, 1.0].iter().flat_map(|z| ring.map(|[x, y]| low + size * DVec3::new(x, y, *z))).collect();
        Mesh::new(points, polygons).unwrap()
    }

    #[test]
    fn a_cube_far_from_the_origin_keeps_its_digits() {
        let cube = cube(DVec3::new(1e5, -3e5, 2e5), 0.5, &CUBE);
        assert!((area(&cube) - 1.5).abs() < 1e-9);
        assert!((signed_volume(&cube) - 0.125).abs() < 1e-9);
        assert_eq!(bounds(&cube).unwrap().0, DVec3::new(1e5, -3e5, 2e5));
        assert!((diagonal(&cube) - 0.75_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn polygons_have_normals_and_areas() {
        let cube = cube(DVec3::ZERO, 2.0, &CUBE);
        assert_eq!(polygon_normal(&cube, 0), DVec3::NEG_Z);
        assert_eq!(polygon_normal(&cube, 3), DVec3::X);
        assert_eq!(polygon_area(&cube, 3), 4.0);
        let flat = Mesh::new(vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X], [[0, 1, 2]]).unwrap();
        assert_eq!(polygon_normal(&flat, 0), DVec3::ZERO);
    }

    #[test]
    fn holes_are_closed_before_the_volume_is_taken() {
        let open = cube(DVec3::splat(7.0), 1.0, &CUBE[1..]);
        assert!((signed_volume(&open) - 1.0).abs() < 1e-12);
        let tube = cube(DVec3::splat(7.0), 1.0, &CUBE[2..]);
        assert!((signed_volume(&tube) - 1.0).abs() < 1e-12);
        assert!((lid_area(&tube, &Topology::new(&tube)) - 2.0).abs() < 1e-12);
        let inside_out: Vec<Vec<u32>> = CUBE.iter().map(|p| p.iter().rev().copied().collect()).collect();
        let inside_out = Mesh::new(open.positions().to_vec(), inside_out).unwrap();
        assert!((signed_volume(&inside_out) + 1.0).abs() < 1e-12);
    }

    #[test]
    fn each_shell_has_its_volume() {
        let one = cube(DVec3::ZERO, 1.0, &CUBE[1..]);
        let two = cube(DVec3::splat(5.0), 2.0, &CUBE);
        let positions = [one.positions(), two.positions()].concat();
        let behind = two.polygons().map(|p| p.iter().rev().map(|v| v + 8).collect::<Vec<_>>());
        let both = Mesh::new(positions, one.polygons().map(<[u32]>::to_vec).chain(behind)).unwrap();
        let volumes = shell_volumes(&both, &Topology::new(&both));
        assert!((volumes[0] - 1.0).abs() < 1e-12 && (volumes[1] + 8.0).abs() < 1e-12, "{volumes:?}");
        assert!((signed_volume(&both) + 7.0).abs() < 1e-12);
    }

    #[test]
    fn bounds_hold_all_points() {
        let points = [[1.0, -2.0, 0.5], [-1.0, 3.0, 0.0], [0.0, 0.0, -4.0]].map(DVec3::from_array);
        let wanted = (DVec3::new(-1.0, -2.0, -4.0), DVec3::new(1.0, 3.0, 0.5));
        assert_eq!(points_bounds(points), Some(wanted));
        assert_eq!(points_diagonal(&points), wanted.0.distance(wanted.1));
        assert_eq!(points_bounds([DVec3::ONE]), Some((DVec3::ONE, DVec3::ONE)));
        assert_eq!((points_bounds([]), points_diagonal(&[])), (None, 0.0));
    }

    #[test]
    fn an_empty_mesh_measures_nothing() {
        let none = Mesh::default();
        assert!(bounds(&none).is_none());
        assert_eq!((area(&none), signed_volume(&none), diagonal(&none)), (0.0, 0.0, 0.0));
        assert!(shell_volumes(&none, &Topology::new(&none)).is_empty());
        assert_eq!(vector_area([]), DVec3::ZERO);
    }

    #[test]
    fn projected_loops_turn_counter_clockwise() {
        for normal in [DVec3::X, DVec3::Y, DVec3::NEG_Z, DVec3::new(1.0, -2.0, 0.5).normalize()] {
            let x = normal.any_orthonormal_vector();
            let loop_around = [x, normal.cross(x), -x].map(|p| p + DVec3::splat(3.0));
            let flat = project(loop_around, normal);
            assert!((flat[1] - flat[0]).perp_dot(flat[2] - flat[0]) > 0.9);
        }
    }
}
