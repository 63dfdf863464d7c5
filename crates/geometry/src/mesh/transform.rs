//! Meshes moved, mirrored and put together.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::face_names::{FaceNames, NamedBy, names_of};
use super::{Mesh, MeshError, measure};

/// Corners between two questions whether to go on.
const STEP: usize = 1 << 18;

/// Why a mesh is not transformed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TransformError {
    /// A matrix entry that is not a number or is infinite.
    #[error("the transform has an entry that is not a finite number")]
    NotFinite,
    /// A transform onto a plane, a line or a point.
    #[error("the transform flattens the mesh: give every axis a scale other than 0")]
    Singular,
    /// `progress` asked to stop.
    #[error("stopped")]
    Stopped,
    /// The transformed vertices make no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// The mesh with each vertex `p` at `transform * p`, keeping name and UVs.
///
/// Normals are mapped by the inverse transpose of the linear part. A transform that mirrors turns the order of each
/// polygon's corners around (the first corner stays first), so that polygons and normals still face outwards.
///
/// # Errors
/// [`TransformError`] where the transform is not finite or is singular (a determinant below 1e-14 of the product of its
/// columns' lengths), or a coordinate overflows.
pub fn transform(mesh: &Mesh, transform: &DAffine3) -> Result<Mesh, TransformError> {
    transform_while(mesh, transform, &|_| true)
}

fn ask(progress: &dyn Fn(f64) -> bool, done: f64) -> Result<(), TransformError> {
    if progress(done) { Ok(()) } else { Err(TransformError::Stopped) }
}

/// The same, calling `progress` with the fraction done.
///
/// # Errors
/// As [`transform`], and [`TransformError::Stopped`] where `progress` answers `false`.
pub fn transform_while(
    mesh: &Mesh,
    transform: &DAffine3,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Mesh, TransformError> {
    ask(progress, 0.0)?;
    if !transform.is_finite() {
        return Err(TransformError::NotFinite);
    }
    let linear = transform.matrix3;
    // Scaled to unit columns, so that neither tiny nor huge scales under- or overflow.
    let length = |column: DVec3| {
        let largest = column.abs().max_element();
        if largest > 0.0 { largest * (column / largest).length() } else { 0.0 }
    };
    let size = DVec3::new(length(linear.x_axis), length(linear.y_axis), length(linear.z_axis));
    if size.min_element() <= 0.0 || !size.is_finite() {
        return Err(TransformError::Singular);
    }
    let unit = DMat3::from_cols(linear.x_axis / size.x, linear.y_axis / size.y, linear.z_axis / size.z);
    let determinant = unit.determinant();
    if determinant.abs() < 1e-14 {
        return Err(TransformError::Singular);
    }
    let inverse_transpose = unit.inverse().transpose();
    let shrink = size.min_element() / size;
    let map_normal = |n: &DVec3| {
        let mapped = inverse_transpose * (*n * shrink);
        mapped.try_normalize().unwrap_or(*n)
    };
    let positions = mesh.positions().iter().map(|p| transform.transform_point3(*p)).collect();
    ask(progress, 0.1)?;
    let normals = match mesh.normals() {
        Some(normals) => {
            let mut mapped = Vec::with_capacity(normals.len());
            for part in normals.chunks(STEP) {
                ask(progress, 0.1 + 0.3 * mapped.len() as f64 / normals.len() as f64)?;
                mapped.extend(part.iter().map(map_normal));
            }
            Some(mapped)
        }
        None => None,
    };
    ask(progress, 0.4)?;
    let moved = rebuild(mesh, positions, normals, mesh.uvs().map(<[DVec2]>::to_vec))?;
    ask(progress, 0.7)?;
    if determinant < 0.0 { turned(&moved, &|done| ask(progress, 0.7 + 0.3 * done)) } else { Ok(moved) }
}

/// The mesh inside out: the corners of each polygon the other way round, normals reversed.
///
/// # Errors
/// None for a mesh that exists; the constructor checks all the same.
pub fn flipped(mesh: &Mesh) -> Result<Mesh, MeshError> {
    let turned = turned::<MeshError>(mesh, &|_| Ok(()))?;
    let normals = turned.normals().map(|normals| normals.iter().map(|n| -*n).collect());
    let uvs = turned.uvs().map(<[DVec2]>::to_vec);
    rebuild(&turned, turned.positions().to_vec(), normals, uvs)
}

/// Puts meshes into one, in order: vertices behind vertices, polygons behind polygons.
///
/// Where only some have normals, the others get those of their polygons; where only some have UVs, the others get zero;
/// where only some have groups or materials, the others get empty names.
/// The name is that of the first mesh.
///
/// # Errors
/// [`MeshError::TooLarge`] where there are more vertices or corners than 32-bit indices reach.
pub fn join<'a>(meshes: impl IntoIterator<Item = &'a Mesh>) -> Result<Mesh, MeshError> {
    joined(meshes, |_| Ok(()))
}

/// The same, calling `progress` with the fraction done.
///
/// # Errors
/// As [`join`], and [`TransformError::Stopped`] where `progress` answers `false`.
pub fn join_while<'a>(
    meshes: impl IntoIterator<Item = &'a Mesh>,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Mesh, TransformError> {
    joined(meshes, |done| ask(progress, done))
}

fn joined<'a, E: From<MeshError>>(
    meshes: impl IntoIterator<Item = &'a Mesh>,
    ask: impl Fn(f64) -> Result<(), E>,
) -> Result<Mesh, E> {
    let meshes: Vec<&Mesh> = meshes.into_iter().collect();
    let vertices: usize = meshes.iter().map(|m| m.positions().len()).sum();
    if vertices > u32::MAX as usize {
        return Err(MeshError::TooLarge.into());
    }
    let mut positions = Vec::with_capacity(vertices);
    let mut corners = Vec::with_capacity(meshes.iter().map(|m| m.corners().len()).sum());
    for mesh in &meshes {
        ask(0.3 * positions.len() as f64 / vertices.max(1) as f64)?;
        let behind = positions.len() as u32;
        positions.extend_from_slice(mesh.positions());
        corners.extend(mesh.corners().iter().map(|vertex| vertex + behind));
    }
    ask(0.3)?;
    let counts = meshes.iter().flat_map(|mesh| mesh.polygons().map(<[u32]>::len));
    let mut joined = Mesh::from_corners(positions, corners, counts)?.named(meshes.first().map_or("", |m| m.name()));
    if meshes.iter().any(|m| m.normals().is_some()) {
        let mut normals = Vec::with_capacity(joined.corners().len());
        for mesh in &meshes {
            let share = |done: usize| 0.4 + 0.3 * done as f64 / joined.corners().len().max(1) as f64;
            match mesh.normals() {
                Some(own) => {
                    for part in own.chunks(STEP) {
                        ask(share(normals.len()))?;
                        normals.extend_from_slice(part);
                    }
                }
                None => {
                    ask(share(normals.len()))?;
                    normals.extend(normals_or_flat(mesh));
                }
            }
        }
        ask(0.7)?;
        joined = joined.with_normals(normals)?;
    }
    if meshes.iter().any(|m| m.uvs().is_some()) {
        let mut uvs = Vec::with_capacity(joined.corners().len());
        for mesh in &meshes {
            ask(0.8 + 0.1 * uvs.len() as f64 / joined.corners().len().max(1) as f64)?;
            match mesh.uvs() {
                Some(own) => {
                    for part in own.chunks(STEP) {
                        ask(0.8 + 0.1 * uvs.len() as f64 / joined.corners().len().max(1) as f64)?;
                        uvs.extend_from_slice(part);
                    }
                }
                None => uvs.extend(std::iter::repeat_n(DVec2::ZERO, mesh.corners().len())),
            }
        }
        ask(0.9)?;
        joined = joined.with_uvs(uvs)?;
    }
    for by in NamedBy::ALL {
        if meshes.iter().any(|m| names_of(m, by).is_some()) {
            let names = meshes.iter().flat_map(|mesh| {
                let names = names_of(mesh, by);
                (0..mesh.polygon_count()).map(move |polygon| names.map_or("", |names| names.name(polygon)))
            });
            joined = joined.with_names(by, FaceNames::new(names))?;
        }
    }
    ask(1.0)?;
    Ok(joined)
}

fn normals_or_flat(mesh: &Mesh) -> Vec<DVec3> {
    let flat = || {
        (0..mesh.polygon_count())
            .flat_map(|p| {
                let normal = measure::polygon_normal(mesh, p).try_normalize().unwrap_or(DVec3::Y);
                mesh.corner_range(p).map(move |_| normal)
            })
            .collect()
    };
    mesh.normals().map_or_else(flat, <[DVec3]>::to_vec)
}

/// The corners of each polygon the other way round, their attributes with them.
fn turned<E: From<MeshError>>(mesh: &Mesh, ask: &dyn Fn(f64) -> Result<(), E>) -> Result<Mesh, E> {
    fn reverse<T>(mesh: &Mesh, mut values: Vec<T>) -> Vec<T> {
        for polygon in 0..mesh.polygon_count() {
            values[mesh.corner_range(polygon)][1..].reverse();
        }
        values
    }
    let corners = reverse(mesh, mesh.corners().to_vec());
    ask(0.1)?;
    let counts = mesh.polygons().map(<[u32]>::len);
    let mut turned = Mesh::from_corners(mesh.positions().to_vec(), corners, counts)?.named(mesh.name());
    ask(0.2)?;
    if let Some(normals) = mesh.normals() {
        let reversed = reverse(mesh, normals.to_vec());
        ask(0.5)?;
        turned = turned.with_normals(reversed)?;
    }
    ask(0.6)?;
    if let Some(uvs) = mesh.uvs() {
        let reversed = reverse(mesh, uvs.to_vec());
        ask(0.9)?;
        turned = turned.with_uvs(reversed)?;
    }
    ask(1.0)?;
    Ok(turned.named_like(mesh))
}

/// The polygons and name of a mesh with other data.
fn rebuild(
    mesh: &Mesh,
    positions: Vec<DVec3>,
    normals: Option<Vec<DVec3>>,
    uvs: Option<Vec<DVec2>>,
) -> Result<Mesh, MeshError> {
    let counts = mesh.polygons().map(<[u32]>::len);
    let mut rebuilt = Mesh::from_corners(positions, mesh.corners().to_vec(), counts)?.named(mesh.name());
    if let Some(normals) = normals {
        rebuilt = rebuilt.with_normals(normals)?;
    }
    if let Some(uvs) = uvs {
        rebuilt = rebuilt.with_uvs(uvs)?;
    }
    Ok(rebuilt.named_like(mesh))
}

#[cfg(test)]
mod tests {
    use super::super::check;
    use super::*;

    const CUBE: [[u32; 4]; 6] = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

    fn cube() -> Mesh {
        let ring = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let points = [0.0, 1.0].iter().flat_map(|z| ring.map(|[x, y]| DVec3::new(x, y, *z))).collect();
        let mesh = Mesh::new(points, CUBE).unwrap().named("cube");
        let normals = normals_or_flat(&mesh);
        let uvs = (0..24).map(|i| DVec2::new(f64::from(i), 0.0)).collect();
        mesh.with_normals(normals).unwrap().with_uvs(uvs).unwrap()
    }

    #[test]
    fn normals_stay_at_right_angles_and_outside() {
        let shear = DMat3::from_cols(DVec3::new(2.0, 0.5, 0.0), DVec3::new(-0.3, 1.0, 0.2), DVec3::new(0.1, 0.0, 4.0));
        for (linear, sign) in [(shear, 1.0), (DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)) * shear, -1.0)] {
            let moved =
                transform(&cube(), &DAffine3::from_mat3_translation(linear, DVec3::new(3.0, 1.0, -2.0))).unwrap();
            assert!(check(&moved).is_sound());
            assert!((linear.determinant() * sign - measure::signed_volume(&moved)).abs() < 1e-12);
            assert_eq!(moved.name(), "cube");
            for polygon in 0..6 {
                let face = measure::polygon_normal(&moved, polygon);
                for normal in &moved.normals().unwrap()[moved.corner_range(polygon)] {
                    assert!(normal.distance(face) < 1e-12);
                }
            }
        }
    }

    #[test]
    fn mirroring_turns_the_corners_with_their_uvs() {
        let mirrored = transform(&cube(), &DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0))).unwrap();
        assert_eq!(mirrored.polygon(0), [0, 1, 2, 3]);
        let u: Vec<f64> = mirrored.uvs().unwrap()[4..8].iter().map(|uv| uv.x).collect();
        assert_eq!(u, [4.0, 7.0, 6.0, 5.0]);
        let back = transform(&mirrored, &DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0))).unwrap();
        assert_eq!(back, cube());
    }

    #[test]
    fn extreme_scales_keep_their_normals() {
        for scale in [1e-120, 1e120] {
            let moved = transform(&cube(), &DAffine3::from_scale(DVec3::new(scale, scale, 2.0 * scale))).unwrap();
            assert!(moved.normals().unwrap().iter().all(|n| (n.length() - 1.0).abs() < 1e-12));
        }
    }

    #[test]
    fn transforms_that_lose_the_mesh_are_refused() {
        let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
        assert_eq!(transform(&cube(), &flat), Err(TransformError::Singular));
        let line = DAffine3::from_mat3(DMat3::from_cols(DVec3::ONE, DVec3::ONE, DVec3::X));
        assert_eq!(transform(&cube(), &line), Err(TransformError::Singular));
        let nan = DAffine3::from_translation(DVec3::new(f64::NAN, 0.0, 0.0));
        assert_eq!(transform(&cube(), &nan), Err(TransformError::NotFinite));
        let far = DAffine3::from_mat3_translation(DMat3::from_diagonal(DVec3::splat(1e308)), DVec3::splat(1e308));
        assert!(matches!(transform(&cube(), &far), Err(TransformError::Mesh(MeshError::NotFinite { .. }))));
    }

    #[test]
    fn a_flipped_mesh_is_inside_out_and_comes_back() {
        let inside_out = flipped(&cube()).unwrap();
        assert_eq!(check(&inside_out).normals_outward, Some(false));
        assert!(check(&inside_out).corner_normals_agree);
        assert_eq!(flipped(&inside_out).unwrap(), cube());
    }

    #[test]
    fn joined_meshes_keep_their_polygons_and_attributes() {
        let moved = transform(&cube(), &DAffine3::from_translation(5.0 * DVec3::X)).unwrap();
        let bare = Mesh::new(vec![DVec3::ZERO, DVec3::Z, DVec3::X], [[0, 1, 2]]).unwrap();
        let both = join([&cube(), &moved, &bare]).unwrap();
        assert_eq!((both.name(), both.positions().len(), both.polygon_count()), ("cube", 19, 13));
        assert_eq!(both.polygon(6), [8, 11, 10, 9]);
        assert_eq!(both.normals().unwrap()[48..], [DVec3::Y; 3]);
        assert_eq!(both.uvs().unwrap()[47..], [DVec2::new(23.0, 0.0), DVec2::ZERO, DVec2::ZERO, DVec2::ZERO]);
        assert_eq!(check(&both).shells, 3);
        let plain = join([&bare, &bare]).unwrap();
        assert!(plain.normals().is_none() && plain.uvs().is_none());
        assert_eq!(join([]).unwrap().polygon_count(), 0);
    }
}
