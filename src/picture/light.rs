//! The studio: a dome of sky, a large key light with soft shadows, a fill and a rim light, all moving with the camera.

use glam::Vec3;
use rayon::prelude::*;

use super::camera::Camera;
use super::shadow_map::ShadowMap;
use super::subject::Subject;

/// Directions the sky is sampled in, for a subject of few triangles and for one of very many.
const DOME: [usize; 2] = [56, 20];
/// Texels a side of the shadow maps of the sky and of the key light.
const SIDES: [usize; 2] = [200, 240];
/// Directions across the key light.
const KEY: usize = 16;
/// Half the angle under which the key light is seen, degrees.
const KEY_RADIUS_DEGREES: f32 = 15.0;
/// Triangles drawn into shadow maps for one picture, at most about.
const SHADOW_BUDGET: usize = 6_000_000;
/// Angle between neighbours of a sunflower arrangement, radians.
const GOLDEN_ANGLE: f32 = 2.399_963_1;

/// Lights of a picture. Directions are unit vectors towards the light, in world axes.
pub(super) struct Studio {
    /// Main light, upper left.
    pub key: Vec3,
    /// Weak light from the right, against black shadows.
    pub fill: Vec3,
    /// Light from behind, that draws the outline.
    pub rim: Vec3,
    key_maps: Vec<ShadowMap>,
    dome: Vec<(ShadowMap, f32)>,
}

impl Studio {
    /// Lights the subject for a camera.
    pub fn new(subject: &Subject, camera: &Camera) -> Self {
        let from_camera = |right: f64, up: f64, back: f64| {
            (camera.right * right + camera.up * up + camera.back * back).normalize().as_vec3()
        };
        let key = from_camera(-0.70, 0.72, 0.60);
        let fill = from_camera(0.85, 0.10, 0.60);
        let rim = from_camera(0.55, 0.55, -0.70);
        let triangles = subject.triangles.len().max(1);
        let [most, least] = DOME;
        let dome: Vec<Vec3> = dome_directions((SHADOW_BUDGET / triangles).clamp(least, most));
        let draw = |side: usize, towards: Vec3| {
            ShadowMap::of(side, towards, subject.extents, &subject.places, &subject.triangles)
        };
        Self {
            key,
            fill,
            rim,
            key_maps: around(key).into_par_iter().map(|towards| draw(SIDES[1], towards)).collect(),
            dome: dome.into_par_iter().map(|towards| (draw(SIDES[0], towards), sky(towards.y))).collect(),
        }
    }

    /// Share of the sky's light that reaches a surface, 0 to 1.
    pub fn sky_visibility(&self, place: Vec3, normal: Vec3) -> f32 {
        gather(self.dome.iter().map(|(map, weight)| (map, *weight)), place, normal)
    }

    /// Share of the key light that reaches a surface, 0 to 1.
    pub fn key_visibility(&self, place: Vec3, normal: Vec3) -> f32 {
        gather(self.key_maps.iter().map(|map| (map, 1.0)), place, normal)
    }
}

/// Brightness of the sky at a height of -1 (below) to 1 (above).
fn sky(height: f32) -> f32 {
    0.55 + 0.45 * height
}

/// Mean visibility of lights, weighted by brightness and cosine; 1 where none of them faces the surface.
fn gather<'a>(lights: impl Iterator<Item = (&'a ShadowMap, f32)>, place: Vec3, normal: Vec3) -> f32 {
    let mut seen = 0.0;
    let mut all = 0.0;
    for (map, brightness) in lights {
        let cosine = normal.dot(map.towards());
        if cosine > 0.02 {
            let weight = cosine * brightness;
            all += weight;
            seen += weight * map.visibility(place, cosine);
        }
    }
    if all > 0.0 { seen / all } else { 1.0 }
}

/// Directions spread evenly over the sky, down to a little below the horizon.
fn dome_directions(count: usize) -> Vec<Vec3> {
    (0..count)
        .map(|i| {
            let y = 1.0 - 1.3 * (i as f32 + 0.5) / count as f32;
            let (sin, cos) = (i as f32 * GOLDEN_ANGLE).sin_cos();
            let across = (1.0 - y * y).sqrt();
            Vec3::new(across * cos, y, across * sin)
        })
        .collect()
}

/// Directions spread evenly over the disc of the key light.
fn around(centre: Vec3) -> Vec<Vec3> {
    let (right, up) = centre.any_orthonormal_pair();
    (0..KEY)
        .map(|i| {
            let radius = ((i as f32 + 0.5) / KEY as f32).sqrt() * KEY_RADIUS_DEGREES.to_radians().tan();
            let (sin, cos) = (i as f32 * GOLDEN_ANGLE).sin_cos();
            (centre + (right * cos + up * sin) * radius).normalize()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::camera::View;
    use glam::{DVec2, DVec3};
    use maquette_geometry::mesh::Mesh;
    use maquette_geometry::scene::{Material, MeshItem, Scene};

    /// A box of side 2 that is open at the top, and has its floor in two colours of air: one corner far outside.
    fn well() -> Scene {
        let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - 1.0;
        let walls = [[0u32, 4, 5, 1], [0, 2, 6, 4], [1, 5, 7, 3], [0, 1, 3, 2], [4, 6, 7, 5]];
        let mesh = Mesh::new((0..8).map(corner).collect(), walls).unwrap();
        Scene { meshes: vec![MeshItem { name: "well".into(), mesh, material: Material::default() }], curves: vec![] }
    }

    #[test]
    fn a_well_is_dark_at_its_bottom() {
        let scene = well();
        let subject = Subject::new(&scene, true).unwrap();
        let camera = Camera::framing(
            View::Front,
            crate::picture::subject::points(&scene, true),
            &subject.bounds,
            DVec2::new(100.0, 100.0),
        );
        let studio = Studio::new(&subject, &camera);
        let seen = |y: f64| studio.sky_visibility(subject.place(DVec3::new(0.1, y, 0.05)), Vec3::Y);
        assert!(seen(1.5) > 0.999);
        // Seen from the middle of the floor the opening, a square at twice its half side, has a form factor of 0.24;
        // the sky is brighter above.
        assert!((0.2..0.5).contains(&seen(-0.98)), "{}", seen(-0.98));
        assert!(seen(0.0) > seen(-0.5) && seen(-0.5) > seen(-0.98));
        // From the left at 45 degrees the key light does not reach the bottom.
        assert!(studio.key_visibility(subject.place(DVec3::new(-0.5, -0.95, 0.0)), Vec3::Y) < 0.05);
        assert!(studio.key_visibility(subject.place(DVec3::new(0.0, 1.5, 0.0)), Vec3::Y) > 0.999);
    }

    #[test]
    fn directions_are_unit_vectors_spread_evenly() {
        let all = dome_directions(200);
        assert!(all.iter().all(|d| (d.length() - 1.0).abs() < 1e-5 && d.y > -0.31));
        let mean = all.iter().sum::<Vec3>() / 200.0;
        assert!(mean.x.abs() < 0.02 && mean.z.abs() < 0.02, "{mean}");
        let key = Vec3::new(-0.6, 0.7, 0.4).normalize();
        assert!(around(key).iter().all(|d| d.dot(key) >= KEY_RADIUS_DEGREES.to_radians().cos()));
    }
}
