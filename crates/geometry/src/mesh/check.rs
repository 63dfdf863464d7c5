//! What is wrong with a mesh, for reports and tests.

use std::convert::Infallible;
use std::fmt;

use glam::DVec3;

use super::Mesh;
use super::measure::{self, corner_points, polygon_points, project, vector_area};
use super::topology::Topology;
use super::triangulate::polygon_triangles;

/// Polygons between two questions whether to go on.
const STEP: usize = 1 << 16;

/// What [`check`] finds.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshCheck {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of polygons.
    pub polygons: usize,
    /// Whether every edge has two polygons or more.
    pub closed: bool,
    /// Parts that do not hang together by edges.
    pub shells: usize,
    /// Vertices in use minus edges plus polygons; 2 for each closed shell without handles.
    pub euler_characteristic: i64,
    /// Holes: loops of edges with one polygon.
    pub boundary_loops: usize,
    /// Edges of more than two polygons.
    pub non_manifold_edges: Vec<[u32; 2]>,
    /// Edges at which one of two polygons faces in where the other faces out.
    pub inconsistent_edges: Vec<[u32; 2]>,
    /// Polygons that repeat a vertex, or with an area of less than 1e-12 of the squared diagonal of the mesh.
    pub degenerate_polygons: Vec<usize>,
    /// Polygons that cross themselves, and triangles and quads that are turned over against what surrounds them: most
    /// of their edge neighbours, which agree with one another, face the other way.
    pub folded_polygons: Vec<usize>,
    /// Whether the volume, with holes closed by fans, is positive. `None` where the mesh is more of a sheet than a
    /// body: the fans are larger than three quarters of it, or the volume is below 1e-9 of area times diagonal.
    pub normals_outward: Option<bool>,
    /// First polygon of each shell whose own volume is negative: a part turned inside out, or the inside of a hollow
    /// one.
    pub inward_shells: Vec<usize>,
    /// Whether each corner's normal is within 90 degrees of its polygon's. True where there are no normals.
    pub corner_normals_agree: bool,
    /// Vertices of no polygon.
    pub unused_vertices: Vec<u32>,
    /// Largest angle between the normals of two polygons at one edge, degrees; 0 where there is none.
    pub largest_fold_degrees: f64,
}

impl MeshCheck {
    /// Whether nothing is broken. Holes are allowed, and sheets may face either way; bodies face outwards.
    pub fn is_sound(&self) -> bool {
        self.fault_count() == 0
    }

    /// Number of things that are broken: edges, polygons and vertices at fault, a body inside out, corner normals that
    /// do not agree.
    pub fn fault_count(&self) -> usize {
        self.non_manifold_edges.len()
            + self.inconsistent_edges.len()
            + self.degenerate_polygons.len()
            + self.folded_polygons.len()
            + self.unused_vertices.len()
            + usize::from(self.normals_outward == Some(false))
            + usize::from(!self.corner_normals_agree)
    }
}

impl fmt::Display for MeshCheck {
    /// One line, the faults behind the counts: `1024 vertices, 1022 polygons, 1 shell, closed, outward: sound`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        let (shells, loops) = (self.shells, self.boundary_loops);
        write!(f, "{} vertices, {} polygons, {shells} shell{}", self.vertices, self.polygons, plural(shells))?;
        if self.closed {
            write!(f, ", closed")?;
        } else {
            write!(f, ", {loops} boundary loop{}", plural(loops))?;
        }
        let facing = match self.normals_outward {
            Some(true) => "outward",
            Some(false) => "inside out",
            None => "a sheet",
        };
        write!(f, ", {facing}: {}", if self.is_sound() { "sound" } else { "not sound" })?;
        let faults = [
            ("non-manifold edge", self.non_manifold_edges.len()),
            ("inconsistently oriented edge", self.inconsistent_edges.len()),
            ("degenerate polygon", self.degenerate_polygons.len()),
            ("folded polygon", self.folded_polygons.len()),
            ("inward shell", self.inward_shells.len()),
        ];
        for (fault, count) in faults {
            if count > 0 {
                write!(f, ", {count} {fault}{}", plural(count))?;
            }
        }
        match self.unused_vertices.len() {
            0 => {}
            1 => write!(f, ", 1 unused vertex")?,
            unused => write!(f, ", {unused} unused vertices")?,
        }
        if !self.corner_normals_agree {
            write!(f, ", corner normals against their polygons")?;
        }
        Ok(())
    }
}

/// Examines a mesh. The lists are in ascending order.
pub fn check(mesh: &Mesh) -> MeshCheck {
    match examine::<Infallible>(mesh, &|_| Ok(())) {
        Ok(found) => found,
    }
}

/// The same, `None` where `progress`, called with the fraction done, says stop.
pub fn check_while(mesh: &Mesh, progress: &dyn Fn(f64) -> bool) -> Option<MeshCheck> {
    examine(mesh, &|done| if progress(done) { Ok(()) } else { Err(()) }).ok()
}

fn examine<Stop>(mesh: &Mesh, progress: &dyn Fn(f64) -> Result<(), Stop>) -> Result<MeshCheck, Stop> {
    // About a third of the time goes into the topology.
    let mut steps = (0..).map(|step| 0.3 + 0.04 * f64::from(step));
    let mut go_on = || progress(steps.next().unwrap_or(1.0));
    let topology = Topology::new_while(mesh, &|| progress(0.0))?;
    go_on()?;
    let diagonal = measure::diagonal(mesh);
    let normals: Vec<DVec3> = (0..mesh.polygon_count()).map(|p| measure::polygon_normal(mesh, p)).collect();
    go_on()?;
    let shells = topology.shells();
    go_on()?;
    let shell_volumes = measure::shell_volumes_while(mesh, &topology, &|| progress(0.4))?;
    go_on()?;
    let area = measure::area_while(mesh, &|| progress(0.42))?;
    let volume: f64 = shell_volumes.iter().sum();
    let negligible = 1e-9 * area * diagonal;
    go_on()?;
    let body = volume.abs() > negligible && measure::lid_area(mesh, &topology) <= 0.75 * area;
    go_on()?;
    let mut used = vec![false; mesh.positions().len()];
    for vertex in mesh.corners() {
        used[*vertex as usize] = true;
    }
    go_on()?;
    let mut degenerate_polygons = Vec::new();
    for polygon in 0..normals.len() {
        if polygon.is_multiple_of(STEP) {
            progress(0.55)?;
        }
        if is_degenerate(mesh, polygon, diagonal) {
            degenerate_polygons.push(polygon);
        }
    }
    go_on()?;
    let folded_polygons = folded_polygons(mesh, &topology, &normals, &mut go_on)?;
    go_on()?;
    let corner_normals_agree = corner_normals_agree(mesh, &normals);
    go_on()?;
    let largest_fold_degrees = largest_fold(&topology, &normals).to_degrees();
    go_on()?;
    let (closed, boundary_loops) = (topology.is_closed(), topology.boundary_loops().len());
    go_on()?;
    let (non_manifold_edges, inconsistent_edges) = (topology.non_manifold_edges(), topology.inconsistent_edges());
    go_on()?;
    Ok(MeshCheck {
        vertices: mesh.positions().len(),
        polygons: mesh.polygon_count(),
        closed,
        shells: shells.len(),
        euler_characteristic: topology.euler_characteristic(),
        boundary_loops,
        non_manifold_edges,
        inconsistent_edges,
        degenerate_polygons,
        folded_polygons,
        normals_outward: body.then_some(volume > 0.0),
        inward_shells: if body {
            shells.iter().zip(&shell_volumes).filter(|(_, v)| **v < -negligible).map(|(s, _)| s[0]).collect()
        } else {
            Vec::new()
        },
        corner_normals_agree,
        unused_vertices: (0..).zip(&used).filter(|(_, used)| !**used).map(|(v, _)| v).collect(),
        largest_fold_degrees,
    })
}

fn is_degenerate(mesh: &Mesh, polygon: usize, diagonal: f64) -> bool {
    let corners = mesh.polygon(polygon);
    let repeated = match corners {
        [a, b, c] => a == b || b == c || c == a,
        [a, b, c, d] => a == b || b == c || c == d || d == a || a == c || b == d,
        _ => {
            let mut sorted = corners.to_vec();
            sorted.sort_unstable();
            sorted.windows(2).any(|pair| pair[0] == pair[1])
        }
    };
    repeated || {
        let triangles = polygon_triangles(mesh, polygon);
        let area: f64 = triangles.iter().map(|t| vector_area(corner_points(mesh, *t)).length()).sum();
        area < 1e-12 * diagonal * diagonal
    }
}

fn folded_polygons<Stop>(
    mesh: &Mesh,
    topology: &Topology,
    normals: &[DVec3],
    go_on: &mut dyn FnMut() -> Result<(), Stop>,
) -> Result<Vec<usize>, Stop> {
    /// Neighbours that face the other way: their number and sum; and the sum of all.
    #[derive(Clone, Copy, Default)]
    struct Around {
        opposing: usize,
        opposing_sum: DVec3,
        sum: DVec3,
    }
    let mut around = vec![Around::default(); normals.len()];
    for uses in topology.edges() {
        if let [a, b] = uses {
            // A polygon that runs the edge in the same direction is turned, not folded.
            let sign = if a.forward == b.forward { -1.0 } else { 1.0 };
            for (own, other) in [(a.polygon as usize, b.polygon as usize), (b.polygon as usize, a.polygon as usize)] {
                let other = sign * normals[other];
                around[own].sum += other;
                if normals[own].dot(other) < 0.0 {
                    around[own].opposing += 1;
                    around[own].opposing_sum += other;
                }
            }
        }
    }
    go_on()?;
    let turned_over = |polygon: usize| {
        let corners = mesh.polygon(polygon).len();
        let Around { opposing, opposing_sum, sum } = around[polygon];
        // The base of a pyramid opposes all its neighbours too; but unless it is low, they do not agree.
        corners <= 4
            && 2 * opposing > corners
            && opposing_sum.length() > 0.8 * opposing as f64
            && sum.dot(normals[polygon]) < 0.0
    };
    Ok((0..normals.len()).filter(|p| turned_over(*p) || crosses_itself(mesh, *p, normals[*p])).collect())
}

fn crosses_itself(mesh: &Mesh, polygon: usize, normal: DVec3) -> bool {
    let mut points = polygon_points(mesh, polygon);
    match mesh.polygon(polygon).len() {
        0..=3 => false,
        4 => {
            let [a, b, c, d] = std::array::from_fn(|_| points.next().unwrap_or_default());
            // Only where sides cross do both diagonals part the quad into halves that oppose each other.
            let opposing = |p: DVec3, q: DVec3| p.dot(q) < 0.0;
            opposing((b - a).cross(c - a), (c - a).cross(d - a)) && opposing((c - b).cross(d - b), (d - b).cross(a - b))
        }
        count => {
            let flat = project(points, normal);
            let side = |i: usize, j: usize, k: usize| {
                (flat[j % count] - flat[i % count]).perp_dot(flat[k % count] - flat[i % count])
            };
            let cross = |i: usize, j: usize| {
                side(i, i + 1, j) * side(i, i + 1, j + 1) < 0.0 && side(j, j + 1, i) * side(j, j + 1, i + 1) < 0.0
            };
            (0..count).any(|i| (i + 2..count).any(|j| (i, j) != (0, count - 1) && cross(i, j)))
        }
    }
}

fn corner_normals_agree(mesh: &Mesh, normals: &[DVec3]) -> bool {
    let Some(corner_normals) = mesh.normals() else { return true };
    normals
        .iter()
        .enumerate()
        .all(|(polygon, normal)| corner_normals[mesh.corner_range(polygon)].iter().all(|n| n.dot(*normal) >= -1e-9))
}

fn largest_fold(topology: &Topology, normals: &[DVec3]) -> f64 {
    let mut largest: f64 = 0.0;
    for uses in topology.edges() {
        if let [a, b] = uses {
            let sign = if a.forward == b.forward { -1.0 } else { 1.0 };
            let (own, other) = (normals[a.polygon as usize], sign * normals[b.polygon as usize]);
            if own != DVec3::ZERO && other != DVec3::ZERO {
                largest = largest.max(own.cross(other).length().atan2(own.dot(other)));
            }
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: [&[u32]; 6] =
        [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];

    fn corners_of_a_cube() -> Vec<DVec3> {
        let ring = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        [0.0, 1.0].iter().flat_map(|z| ring.map(|[x, y]| DVec3::new(x, y, *z))).collect()
    }

    fn cube(polygons: &[&[u32]]) -> Mesh {
        Mesh::new(corners_of_a_cube(), polygons).unwrap()
    }

    /// A flat net of unit quads in the plane y = 0, facing up.
    fn net(width: u32, depth: u32) -> Vec<DVec3> {
        (0..depth).flat_map(|z| (0..width).map(move |x| DVec3::new(x.into(), 0.0, z.into()))).collect()
    }

    fn quads(width: u32, depth: u32) -> Vec<[u32; 4]> {
        let at = |x: u32, z: u32| z * width + x;
        (0..depth - 1)
            .flat_map(|z| (0..width - 1).map(move |x| [at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z)]))
            .collect()
    }

    #[test]
    fn a_cube_is_sound() {
        let found = check(&cube(&CUBE));
        assert!(found.is_sound());
        assert_eq!(found.normals_outward, Some(true));
        assert!((found.largest_fold_degrees - 90.0).abs() < 1e-12);
        assert_eq!(found.to_string(), "8 vertices, 6 polygons, 1 shell, closed, outward: sound");
        let open = check(&cube(&CUBE[1..]));
        assert!(open.is_sound() && !open.closed);
        assert_eq!(open.to_string(), "8 vertices, 5 polygons, 1 shell, 1 boundary loop, outward: sound");
    }

    #[test]
    fn bodies_inside_out_are_not_sound_and_sheets_face_either_way() {
        let reversed: Vec<Vec<u32>> = CUBE.iter().map(|p| p.iter().rev().copied().collect()).collect();
        let found = check(&Mesh::new(corners_of_a_cube(), &reversed).unwrap());
        assert_eq!((found.normals_outward, found.is_sound()), (Some(false), false));
        assert_eq!(found.inward_shells, [0]);

        let mut bent = net(4, 4);
        for p in &mut bent {
            p.y = 0.1 * (p.x - 1.5).powi(2);
        }
        let sheet = check(&Mesh::new(bent, quads(4, 4)).unwrap());
        assert!(sheet.is_sound(), "{sheet}");
        assert_eq!(sheet.normals_outward, None);
    }

    #[test]
    fn one_part_inside_out_among_others_is_named() {
        let mut points = corners_of_a_cube();
        points.extend(corners_of_a_cube().iter().map(|p| 0.5 * *p + 5.0 * DVec3::X));
        let mut polygons: Vec<Vec<u32>> = CUBE.iter().map(|p| p.to_vec()).collect();
        polygons.extend(CUBE.iter().map(|p| p.iter().rev().map(|v| v + 8).collect()));
        let found = check(&Mesh::new(points, &polygons).unwrap());
        assert_eq!((found.shells, found.normals_outward), (2, Some(true)));
        assert_eq!(found.inward_shells, [6]);
    }

    #[test]
    fn a_turned_polygon_is_inconsistent_and_not_folded() {
        let mut polygons = CUBE;
        polygons[1] = &[7, 6, 5, 4];
        let found = check(&cube(&polygons));
        assert_eq!(found.inconsistent_edges.len(), 4);
        assert!(found.folded_polygons.is_empty() && !found.is_sound());
    }

    #[test]
    fn polygons_without_area_are_degenerate() {
        let mut points = corners_of_a_cube();
        points.push(DVec3::new(0.5, 0.0, 0.0));
        let polygons: Vec<&[u32]> = vec![&[0, 1, 8], &[2, 3, 2], &[0, 1, 2, 3], &[0, 1, 0, 3], &[0, 1, 2, 3, 1]];
        let found = check(&Mesh::new(points, &polygons).unwrap());
        assert_eq!(found.degenerate_polygons, [0, 1, 3, 4]);
        assert_eq!(found.unused_vertices, [4, 5, 6, 7]);
        assert!(found.to_string().contains("4 degenerate polygons"), "{found}");
        assert!(found.to_string().contains("4 unused vertices"), "{found}");
    }

    #[test]
    fn quads_that_cross_themselves_or_turn_over_are_folded() {
        let bow_tie: Vec<[u32; 4]> = vec![[0, 1, 3, 2]];
        let mut points = net(2, 2);
        points[3].z = 1.5;
        assert_eq!(check(&Mesh::new(points, &bow_tie).unwrap()).folded_polygons, [] as [usize; 0]);
        assert_eq!(check(&Mesh::new(net(2, 2), [[0, 3, 1, 2]]).unwrap()).folded_polygons, [0]);
        // A notch is no crossing.
        let dart = [[-1.0, 0.0], [0.0, 0.4], [1.0, 0.0], [0.0, 3.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        assert!(check(&Mesh::new(dart.to_vec(), [[0, 1, 2, 3]]).unwrap()).folded_polygons.is_empty());
        // The middle quad of five by five, its corners drawn through their centre.
        let mut points = net(6, 6);
        for vertex in [14, 15, 20, 21] {
            points[vertex] = DVec3::new(5.0, 0.0, 5.0) - points[vertex];
        }
        let flipped = check(&Mesh::new(points, quads(6, 6)).unwrap());
        assert!(flipped.folded_polygons.contains(&7), "{:?}", flipped.folded_polygons);
        assert!(check(&Mesh::new(net(6, 6), quads(6, 6)).unwrap()).is_sound());
    }

    #[test]
    fn a_quad_turned_over_among_flat_ones_is_folded() {
        // A strip that runs back over itself for one quad.
        let xs = [0.0, 2.0, 4.0, 3.0, 5.0, 7.0];
        let points = xs.iter().flat_map(|x| [0.0, 1.0].map(|z| DVec3::new(*x, 0.0, z))).collect();
        let strip: Vec<[u32; 4]> = (0..5).map(|i| [2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2]).collect();
        let found = check(&Mesh::new(points, &strip).unwrap());
        assert!((found.largest_fold_degrees - 180.0).abs() < 1e-9);
        // A triangle whose three neighbours agree is found by them.
        let points = vec![
            DVec3::new(0.0, 0.0, 0.0),
            DVec3::new(1.0, 0.0, 0.0),
            DVec3::new(0.0, 1.0, 0.0),
            DVec3::new(-1.0, 1.0, 0.0),
            DVec3::new(1.0, -1.0, 0.0),
            DVec3::new(1.0, 1.0, 0.0),
        ];
        let flower: Vec<[u32; 3]> = vec![[0, 2, 1], [0, 3, 2], [2, 5, 1], [1, 4, 0]];
        assert!(check(&Mesh::new(points.clone(), &flower).unwrap()).folded_polygons.is_empty());
        let mut over = points;
        over[0] = DVec3::new(1.2, 1.2, 0.0);
        over[3] = DVec3::new(-1.0, 0.0, 0.0);
        over[4] = DVec3::new(0.0, -1.0, 0.0);
        let found = check(&Mesh::new(over, &flower).unwrap());
        assert_eq!(found.folded_polygons, [0]);
    }

    #[test]
    fn sharp_solids_are_not_folded() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let tetrahedron = check(&Mesh::new(points, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap());
        assert!(tetrahedron.is_sound(), "{tetrahedron}");
    }

    #[test]
    fn corner_normals_against_their_polygon_are_found() {
        let up = Mesh::new(net(2, 2), quads(2, 2)).unwrap();
        assert!(check(&up.clone().with_normals(vec![DVec3::new(0.9, 0.4, 0.0); 4]).unwrap()).is_sound());
        let found = check(&up.with_normals(vec![DVec3::Y, DVec3::Y, DVec3::NEG_Y, DVec3::Y]).unwrap());
        assert!(!found.corner_normals_agree && !found.is_sound());
        assert!(found.to_string().ends_with("corner normals against their polygons"), "{found}");
    }

    #[test]
    fn an_empty_mesh_has_nothing_wrong() {
        let found = check(&Mesh::default());
        assert!(found.is_sound() && found.closed);
        assert_eq!((found.shells, found.normals_outward), (0, None));
    }
}
