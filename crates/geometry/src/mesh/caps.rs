//! Open ends of a mesh closed by caps.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::face_names::carried;
use super::topology::Topology;
use super::{Mesh, MeshError, measure};
use crate::curve::place;
use crate::surface::{Lid, MeshParts, NoArea, flat_cap};

/// The shape of a cap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CapShape {
    /// A flat lid with a hard edge: rings of quads around a fan where the loop is star-shaped about its centroid,
    /// triangles between its vertices otherwise.
    #[default]
    Flat,
    /// A fan of triangles about the centroid, with a hard edge.
    Fan,
    /// A dome that goes on in the direction in which the surface ends, and is horizontal at its top.
    Rounded {
        /// Factor of the height that a sphere would have which leaves with the surface's mean slope; 0.05 to 4.
        height: f64,
        /// Rings of quads from the loop to the top, the last one a fan; 2 to 64.
        rings: usize,
    },
}

/// Which open ends are closed, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CapOptions {
    /// The shape of the caps.
    pub shape: CapShape,
    /// Only the loop of which a vertex is nearest to this point (metres); none closes all.
    pub nearest: Option<DVec3>,
}

/// A mesh with caps.
#[derive(Clone, Debug, PartialEq)]
pub struct Capped {
    /// The mesh: its own vertices and polygons first, then those of the caps.
    pub mesh: Mesh,
    /// The loops that were closed.
    pub caps: Vec<ClosedLoop>,
    /// Loops that stay open.
    pub open: usize,
}

/// A loop that was closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedLoop {
    /// Its vertices.
    pub vertices: usize,
    /// The mean of its vertices, metres.
    pub at: DVec3,
    /// Largest distance of its vertices from the plane across its normal through their mean, metres.
    pub flatness: f64,
}

/// Why open ends are not closed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CapError {
    /// Told to stop.
    #[error("stopped")]
    Stopped,
    /// A mesh that has no open end.
    #[error("the mesh has no open loop: there is nothing to close")]
    NothingOpen,
    /// A chain of open edges that does not come back to where it began.
    #[error(
        "the open edges at {} do not make a loop, because edges there have more than two faces or faces that look to \
         different sides: mend the mesh there (`run --report` of `mesh-out` tells the faults)", place(*at)
    )]
    NoLoop {
        /// Mean of the chain's vertices.
        at: DVec3,
    },
    /// A loop that encloses nothing.
    #[error("the loop at {} encloses no area: weld or delete its edges", place(*at))]
    NoArea {
        /// Mean of its vertices.
        at: DVec3,
    },
    /// A loop from whose middle not all of it is seen.
    #[error("not all of the loop at {} is seen from its middle, as a {shape} cap needs: take a flat one", place(*at))]
    NotStarShaped {
        /// The cap's shape.
        shape: &'static str,
        /// Mean of its vertices.
        at: DVec3,
    },
    /// An option that is out of range.
    #[error("{what} of {found} asked for: give a number from {least} to {most}")]
    OutOfRange {
        /// Which option.
        what: &'static str,
        /// Its value.
        found: f64,
        /// The least allowed.
        least: f64,
        /// The most allowed.
        most: f64,
    },
    /// A point that is none.
    #[error("the point {found} is not finite")]
    Point {
        /// The point.
        found: DVec3,
    },
    /// The mesh can't be made.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Closes open ends of a mesh.
///
/// Normals and UVs are given to the caps where the mesh has them: a flat lid and a fan have the normal of the loop; a
/// dome has at its rim the mean of the mesh's normals there, so that no edge is seen. UVs are the place in the plane of
/// the loop, its longer side 0 to 1.
///
/// A dome's meridians are cubics that leave along the surface, square to the rim, and end horizontal in the point above
/// the loop's centroid; on a circular end of a cylinder they are within 0.03 % of a half sphere.
///
/// # Errors
/// [`CapError`] where nothing is open, a loop does not close, encloses nothing or does not suit the shape, or an option
/// is out of range.
pub fn cap(mesh: &Mesh, options: &CapOptions) -> Result<Capped, CapError> {
    cap_while(mesh, options, &|_| true)
}

/// The same, calling `progress` with the share that is done.
///
/// # Errors
/// As [`cap`], and [`CapError::Stopped`] where `progress` answers `false`.
pub fn cap_while(mesh: &Mesh, options: &CapOptions, progress: &dyn Fn(f64) -> bool) -> Result<Capped, CapError> {
    let told = |share: f64| if progress(share) { Ok(()) } else { Err(CapError::Stopped) };
    check(options)?;
    let topology = Topology::new_while(mesh, &|| told(0.0))?;
    told(0.5)?;
    let loops = topology.boundary_loops();
    let mean = |rim: &[u32]| rim.iter().map(|v| mesh.positions()[*v as usize]).sum::<DVec3>() / rim.len() as f64;
    let chosen: Vec<&Vec<u32>> = match options.nearest {
        None => loops.iter().collect(),
        Some(point) => {
            let distance = |rim: &[u32]| {
                rim.iter().map(|v| mesh.positions()[*v as usize].distance(point)).fold(f64::INFINITY, f64::min)
            };
            let nearest = loops.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            nearest.into_iter().collect()
        }
    };
    if chosen.is_empty() {
        return Err(CapError::NothingOpen);
    }
    let mut parts = MeshParts { positions: mesh.positions().to_vec(), ..MeshParts::default() };
    let mut caps = Vec::with_capacity(chosen.len());
    for (done, rim) in chosen.iter().enumerate() {
        told(0.5 + 0.4 * done as f64 / chosen.len() as f64)?;
        let at = mean(rim);
        let open = |k: usize| topology.boundary_polygon(rim[k], rim[(k + 1) % rim.len()]).is_some();
        if rim.len() < 3 || !(0..rim.len()).all(open) {
            return Err(CapError::NoLoop { at });
        }
        let points: Vec<DVec3> = rim.iter().map(|v| mesh.positions()[*v as usize]).collect();
        let lid = Lid::of(&points).map_err(|NoArea| CapError::NoArea { at })?;
        let centre = |shape| lid.centre.ok_or(CapError::NotStarShaped { shape, at });
        match options.shape {
            CapShape::Flat => flat_cap(&mut parts, rim).map_err(|NoArea| CapError::NoArea { at })?,
            CapShape::Fan => fan(&mut parts, rim, &lid, centre("fan")?),
            CapShape::Rounded { height, rings } => {
                let rim = Rim { mesh, topology: &topology, vertices: rim, points: &points, lid: &lid };
                rim.dome(&mut parts, centre("rounded")?, height, rings);
            }
        }
        let flatness = points.iter().map(|p| (*p - at).dot(lid.normal).abs()).fold(0.0, f64::max);
        caps.push(ClosedLoop { vertices: rim.len(), at, flatness });
    }
    told(0.9)?;
    let open = loops.len() - chosen.len();
    Ok(Capped { mesh: joined(mesh, parts)?, caps, open })
}

fn check(options: &CapOptions) -> Result<(), CapError> {
    if let CapShape::Rounded { height, rings } = options.shape {
        if !(0.05..=4.0).contains(&height) {
            return Err(CapError::OutOfRange { what: "a height", found: height, least: 0.05, most: 4.0 });
        }
        if !(2..=64).contains(&rings) {
            return Err(CapError::OutOfRange {
                what: "a number of rings",
                found: rings as f64,
                least: 2.0,
                most: 64.0,
            });
        }
    }
    match options.nearest {
        Some(found) if !found.is_finite() => Err(CapError::Point { found }),
        _ => Ok(()),
    }
}

/// The mesh and its caps as one.
fn joined(mesh: &Mesh, parts: MeshParts) -> Result<Mesh, MeshError> {
    let counts = mesh.polygons().map(<[u32]>::len).chain(parts.counts.iter().map(|count| usize::from(*count)));
    let corners = [mesh.corners(), &parts.corners].concat();
    let mut whole = Mesh::from_corners(parts.positions, corners, counts)?.named(mesh.name());
    if let Some(normals) = mesh.normals() {
        whole = whole.with_normals([normals, &parts.normals].concat())?;
    }
    if let Some(uvs) = mesh.uvs() {
        whole = whole.with_uvs([uvs, &parts.uvs].concat())?;
    }
    let of_the_mesh = (0..mesh.polygon_count()).map(Some);
    let sources: Vec<Option<usize>> = of_the_mesh.chain(parts.counts.iter().map(|_| None)).collect();
    carried(whole, mesh, &sources)
}

fn fan(parts: &mut MeshParts, rim: &[u32], lid: &Lid, (centroid, centre_uv): (DVec3, DVec2)) {
    let centre = parts.positions.len() as u32;
    parts.positions.push(centroid);
    for k in 0..rim.len() {
        let next = (k + 1) % rim.len();
        let corner = |k: usize| (rim[k], lid.normal, lid.rim_uv[k]);
        parts.polygon([corner(k), corner(next), (centre, lid.normal, centre_uv)]);
    }
}

/// A loop with what it bounds.
struct Rim<'a> {
    mesh: &'a Mesh,
    topology: &'a Topology,
    vertices: &'a [u32],
    points: &'a [DVec3],
    lid: &'a Lid,
}

impl Rim<'_> {
    fn dome(&self, parts: &mut MeshParts, (centroid, centre_uv): (DVec3, DVec2), height: f64, rings: usize) {
        let (count, axis) = (self.points.len(), self.lid.normal);
        let leaving = self.leaving();
        let arms: Vec<DVec3> = self.points.iter().map(|p| (*p - centroid).reject_from_normalized(axis)).collect();
        let radius = (measure::vector_area(self.points.iter().copied()).length() / PI).sqrt();
        // As the rounded caps of analytic surfaces: the sphere that leaves with the mean slope.
        let mean = |of: &dyn Fn(usize) -> f64| (0..count).map(of).sum::<f64>() / count as f64;
        let forward = mean(&|k| leaving[k].dot(axis));
        let outward = mean(&|k| leaving[k].dot(arms[k].normalize_or_zero()));
        let top = height * radius * (forward / (1.0 - outward).max(1e-3)).clamp(0.25, 1.5);
        let angle = 2.0 * (top / radius).atan();
        // The speed with which a cubic follows an arc, for a radius of 1 of the rim.
        let speed = 4.0 * (0.25 * angle).tan() / angle.sin().max(0.5);
        let apex = centroid + axis * top;
        let meridian = |k: usize, t: f64| {
            let arm = arms[k].length();
            let (start, end) = (leaving[k] * (speed * arm), -arms[k] * speed);
            let (s, rest) = (t * t * (3.0 - 2.0 * t), 1.0 - t);
            self.points[k] * (1.0 - s) + apex * s + start * (t * rest * rest) - end * (t * t * rest)
        };
        let first = parts.positions.len();
        let mut grid: Vec<Vec<(u32, DVec2)>> =
            vec![self.vertices.iter().copied().zip(self.lid.rim_uv.iter().copied()).collect()];
        for ring in 1..rings {
            let t = ring as f64 / rings as f64;
            let begin = parts.positions.len() as u32;
            parts.positions.extend((0..count).map(|k| meridian(k, t)));
            let uv = |k: usize| self.lid.rim_uv[k].lerp(centre_uv, t);
            grid.push((0..count).map(|k| (begin + k as u32, uv(k))).collect());
        }
        let tip = parts.positions.len() as u32;
        parts.positions.push(apex);

        let mut polygons: Vec<Vec<(u32, DVec2)>> = Vec::with_capacity(rings * count);
        for k in 0..count {
            let next = (k + 1) % count;
            polygons.extend(grid.windows(2).map(|pair| vec![pair[0][k], pair[0][next], pair[1][next], pair[1][k]]));
            let last = &grid[rings - 1];
            polygons.push(vec![last[k], last[next], (tip, centre_uv)]);
        }
        let rim_normals = self.normals();
        let mut normals = vec![DVec3::ZERO; parts.positions.len() - first];
        for polygon in &polygons {
            let area = measure::vector_area(polygon.iter().map(|(v, _)| parts.positions[*v as usize]));
            for (vertex, _) in polygon {
                if let Some(normal) = (*vertex as usize).checked_sub(first).and_then(|v| normals.get_mut(v)) {
                    *normal += area;
                }
            }
        }
        let normal = |vertex: u32| match (vertex as usize).checked_sub(first) {
            Some(own) => normals[own].normalize_or_zero(),
            None => self.vertices.iter().position(|v| *v == vertex).map_or(DVec3::ZERO, |k| rim_normals[k]),
        };
        for polygon in &polygons {
            let corner = |k: usize| (polygon[k].0, normal(polygon[k].0), polygon[k].1);
            match polygon.len() {
                4 => parts.polygon([corner(0), corner(1), corner(2), corner(3)]),
                _ => parts.polygon([corner(0), corner(1), corner(2)]),
            }
        }
    }

    /// The polygon at the side from vertex `k` of the loop to the next.
    fn neighbour(&self, k: usize) -> Option<usize> {
        self.topology.boundary_polygon(self.vertices[k], self.vertices[(k + 1) % self.vertices.len()])
    }

    /// Unit vectors in which the surface ends at each vertex: in the faces, square to the rim; up where there are none.
    fn leaving(&self) -> Vec<DVec3> {
        let count = self.points.len();
        let of_side = |k: usize| {
            let side = self.points[(k + 1) % count] - self.points[k];
            self.neighbour(k).map_or(DVec3::ZERO, |p| measure::polygon_normal(self.mesh, p).cross(side))
        };
        let sides: Vec<DVec3> = (0..count).map(of_side).collect();
        (0..count)
            .map(|k| {
                let along = (self.points[(k + 1) % count] - self.points[(k + count - 1) % count]).normalize_or_zero();
                let both = sides[k] + sides[(k + count - 1) % count];
                (both - along * both.dot(along)).normalize_or(self.lid.normal)
            })
            .collect()
    }

    /// Mean normals of the mesh's corners at the rim; zero where it has none.
    fn normals(&self) -> Vec<DVec3> {
        let Some(normals) = self.mesh.normals() else { return vec![DVec3::ZERO; self.vertices.len()] };
        let mut place = vec![u32::MAX; self.mesh.positions().len()];
        for (k, vertex) in self.vertices.iter().enumerate() {
            place[*vertex as usize] = k as u32;
        }
        let mut sums = vec![DVec3::ZERO; self.vertices.len()];
        for (vertex, normal) in self.mesh.corners().iter().zip(normals) {
            if let Some(sum) = sums.get_mut(place[*vertex as usize] as usize) {
                *sum += *normal;
            }
        }
        sums.into_iter().map(DVec3::normalize_or_zero).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::check;
    use crate::sections::Sections;
    use crate::surface::{SkinOptions, skin};
    use std::f64::consts::TAU;

    /// An open tube of radius 1 from y = 0 to 3, as it comes from sections, with normals and UVs.
    fn tube(radius: impl Fn(f64, f64) -> f64) -> Mesh {
        let ring = |y: f64| -> Vec<DVec3> {
            let at = |k: i32| {
                let angle = TAU * f64::from(k) / 48.0;
                DVec3::new(angle.cos(), 0.0, -angle.sin()) * radius(y, angle) + DVec3::Y * y
            };
            (0..48).map(at).collect()
        };
        let sections = Sections::new((0..=3).map(|y| ring(f64::from(y))).collect(), true, vec![]).unwrap();
        skin(&sections, &SkinOptions { columns: 1, ..SkinOptions::default() }, &|_| true).unwrap()
    }

    const DOME: CapShape = CapShape::Rounded { height: 1.0, rings: 16 };

    #[test]
    fn all_shapes_close_a_tube_soundly() {
        let open = tube(|y, _| 1.0 + 0.1 * y);
        for shape in [CapShape::Flat, CapShape::Fan, DOME] {
            let capped = cap(&open, &CapOptions { shape, nearest: None }).unwrap();
            let found = check(&capped.mesh);
            assert!(found.is_sound() && found.closed && found.normals_outward == Some(true), "{shape:?}: {found}");
            assert_eq!((capped.caps.len(), capped.open, found.shells), (2, 0, 1));
            assert_eq!(capped.caps[0].vertices, 48);
            let kept = open.positions().len();
            assert_eq!(&capped.mesh.positions()[..kept], open.positions());
            assert_eq!(capped.mesh.uvs().unwrap().len(), capped.mesh.corners().len());
        }
    }

    #[test]
    fn a_dome_on_a_cylinder_is_half_a_sphere_without_an_edge() {
        let capped = cap(&tube(|_, _| 1.0), &CapOptions { shape: DOME, nearest: None }).unwrap();
        for point in capped.mesh.positions().iter().filter(|p| p.y > 3.0) {
            let radius = point.distance(DVec3::Y * 3.0);
            assert!((radius - 1.0).abs() < 3e-3, "{point}: {radius}");
        }
        assert!(capped.mesh.positions().iter().any(|p| p.distance(DVec3::Y * 4.0) < 2e-3));
        let fold = check(&capped.mesh).largest_fold_degrees;
        assert!(fold < 10.0, "{fold}");
        let normals = capped.mesh.normals().unwrap();
        for (vertex, normal) in capped.mesh.corners().iter().zip(normals) {
            let point = capped.mesh.positions()[*vertex as usize];
            let exact = (point - DVec3::Y * point.y.clamp(0.0, 3.0)).normalize();
            assert!(normal.angle_between(exact).to_degrees() < 3.0, "{point}: {normal}");
        }
    }

    #[test]
    fn only_the_loop_at_a_point_is_closed() {
        let open = tube(|_, _| 1.0);
        let options = CapOptions { shape: CapShape::Fan, nearest: Some(DVec3::Y * 5.0) };
        let capped = cap(&open, &options).unwrap();
        assert_eq!((capped.caps.len(), capped.open), (1, 1));
        assert!(capped.caps[0].at.distance(DVec3::Y * 3.0) < 1e-12 && capped.caps[0].flatness < 1e-12);
        let both = cap(&capped.mesh, &CapOptions::default()).unwrap();
        assert!(check(&both.mesh).closed);
        assert_eq!(cap(&both.mesh, &CapOptions::default()).unwrap_err(), CapError::NothingOpen);
    }

    #[test]
    fn a_loop_that_is_not_star_shaped_takes_a_flat_cap() {
        // A bean whose middle lies outside of it.
        let open = tube(|_, angle| if angle.cos() < -0.3 { 0.05 } else { 1.0 });
        let flat = cap(&open, &CapOptions::default());
        assert!(check(&flat.unwrap().mesh).closed);
        let spiral = |k: i32| {
            let angle = f64::from(k.min(79 - k)) * 0.2;
            let radius = 1.0 + 0.1 * angle + if k < 40 { 0.0 } else { -0.3 };
            DVec3::new(radius * angle.cos(), 0.0, -radius * angle.sin())
        };
        let rows = [0.0, 1.0].map(|y| (0..80).map(|k| spiral(k) + DVec3::Y * y).collect()).to_vec();
        let wall = Sections::new(rows, true, vec![]).unwrap();
        let wall = skin(&wall, &SkinOptions::default(), &|_| true).unwrap();
        assert!(check(&cap(&wall, &CapOptions::default()).unwrap().mesh).closed);
        for (shape, name) in [(CapShape::Fan, "fan"), (DOME, "rounded")] {
            let message = cap(&wall, &CapOptions { shape, nearest: None }).unwrap_err().to_string();
            assert!(message.ends_with(&format!("as a {name} cap needs: take a flat one")), "{message}");
        }
    }

    #[test]
    fn what_can_not_be_closed_is_refused() {
        let open = tube(|_, _| 1.0);
        let refusal = |mesh: &Mesh, options: CapOptions| cap(mesh, &options).unwrap_err();
        let shape = CapShape::Rounded { height: 0.0, rings: 8 };
        assert!(matches!(refusal(&open, CapOptions { shape, nearest: None }), CapError::OutOfRange { .. }));
        let nearest = Some(DVec3::NAN);
        assert!(matches!(refusal(&open, CapOptions { nearest, ..CapOptions::default() }), CapError::Point { .. }));
        assert_eq!(refusal(&Mesh::default(), CapOptions::default()), CapError::NothingOpen);
        let slit = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0], [[0_u32, 1, 2]]).unwrap();
        assert!(matches!(refusal(&slit, CapOptions::default()), CapError::NoArea { .. }));
    }
}
