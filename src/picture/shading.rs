//! How a surface answers to the studio's light: clay, cloth, metal.

use glam::Vec3;
use maquette_geometry::scene::Material;

use super::light::Studio;

/// Colour of single-sided surfaces seen from behind, linear.
const WARNING: Vec3 = Vec3::new(0.60, 0.055, 0.045);
/// Darker and slightly cooler: the inside of a double-sided surface.
const INSIDE: Vec3 = Vec3::new(0.44, 0.48, 0.54);

const KEY_COLOUR: Vec3 = Vec3::new(1.10, 1.05, 0.97);
const FILL_COLOUR: Vec3 = Vec3::new(0.11, 0.13, 0.17);
const RIM_COLOUR: Vec3 = Vec3::new(0.40, 0.43, 0.48);
const SKY_COLOUR: Vec3 = Vec3::new(0.36, 0.39, 0.44);
const GROUND_COLOUR: Vec3 = Vec3::new(0.12, 0.108, 0.095);

/// A material, ready for light: colours are linear.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    colour: Vec3,
    metallic: f32,
    roughness: f32,
    double_sided: bool,
}

/// A point of a surface, as it is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fragment {
    /// Unit normal on the side of the surface that is seen.
    pub normal: Vec3,
    /// Unit vector to the viewer.
    pub towards_eye: Vec3,
    /// Whether it is seen from inside.
    pub back: bool,
    /// Shares of the sky's and of the key light that reach it, 0 to 1.
    pub reached: [f32; 2],
}

impl Surface {
    /// Reads a material; what is out of range is brought into it.
    pub fn new(material: &Material) -> Self {
        let unit = |x: f64| if x.is_finite() { x.clamp(0.0, 1.0) as f32 } else { 0.0 };
        let [r, g, b, _] = material.colour.map(unit);
        Self {
            colour: to_linear(Vec3::new(r, g, b)),
            metallic: unit(material.metallic),
            roughness: unit(material.roughness).max(0.15),
            double_sided: material.double_sided,
        }
    }

    /// Base colour, linear.
    pub fn colour(&self) -> Vec3 {
        self.colour
    }

    /// Light that leaves a point towards the viewer, linear; may exceed 1.
    pub fn shade(&self, studio: &Studio, fragment: &Fragment) -> Vec3 {
        let normal = fragment.normal;
        let base = match (fragment.back, self.double_sided) {
            (false, _) => self.colour,
            (true, true) => self.colour * INSIDE,
            (true, false) => WARNING,
        };
        let view = fragment.towards_eye;
        let [sky_seen, key_seen] = fragment.reached;

        // Wrapped around the edge a little, as light in skin and plaster is.
        let wrapped = |towards: Vec3, wrap: f32| ((normal.dot(towards) + wrap) / (1.0 + wrap)).max(0.0);
        let ambient = GROUND_COLOUR.lerp(SKY_COLOUR, 0.5 + 0.5 * normal.y) * sky_seen;
        let key = KEY_COLOUR * wrapped(studio.key, 0.18) * key_seen;
        let fill = FILL_COLOUR * wrapped(studio.fill, 0.3) * (0.35 + 0.65 * sky_seen);
        let diffuse = base * (1.0 - self.metallic) * (ambient + key + fill);

        let facing = normal.dot(view).clamp(0.0, 1.0);
        let reflectance = Vec3::splat(0.04).lerp(base, self.metallic);
        let fresnel = reflectance + (Vec3::ONE - reflectance) * (1.0 - facing).powi(5) * (1.0 - self.roughness).powi(2);
        let mirrored = (2.0 * facing * normal - view).normalize_or(normal);
        let sky = GROUND_COLOUR.lerp(SKY_COLOUR * 1.6, (0.5 + 0.9 * mirrored.y).clamp(0.0, 1.0));
        let reflected = fresnel * sky * sky_seen;
        let glint = reflectance * KEY_COLOUR * (self.highlight(normal, view, studio.key) * key_seen);

        let grazing = (1.0 - facing).powi(3) * wrapped(studio.rim, 0.4);
        let rim = (base * 0.6 + Vec3::splat(0.10)) * RIM_COLOUR * (grazing * sky_seen);
        diffuse + reflected + glint + rim
    }

    /// Cook-Torrance with the Trowbridge-Reitz (GGX) distribution, times the cosine, without the Fresnel factor.
    fn highlight(&self, normal: Vec3, view: Vec3, light: Vec3) -> f32 {
        let cosine = normal.dot(light);
        if cosine <= 0.0 {
            return 0.0;
        }
        let half = (view + light).normalize_or(normal);
        let alpha = self.roughness * self.roughness;
        let alpha2 = alpha * alpha;
        let nh = normal.dot(half).clamp(0.0, 1.0);
        let lh = light.dot(half).clamp(0.1, 1.0);
        let spread = nh * nh * (alpha2 - 1.0) + 1.0;
        alpha2 / (4.0 * spread * spread * lh * lh * (self.roughness + 0.5)) * cosine
    }
}

/// sRGB, 0 to 1, to linear light.
pub(super) fn to_linear(colour: Vec3) -> Vec3 {
    let decode = |c: f32| if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    Vec3::new(decode(colour.x), decode(colour.y), decode(colour.z))
}

/// Linear light to sRGB bytes, by table.
pub(super) struct ToneCurve(Vec<u8>);

impl ToneCurve {
    /// Entries for each unit of light: at the dark end, where bytes change fastest, 2.5 of them to a byte.
    const FINENESS: f32 = 8192.0;
    /// Light that is no different from white.
    const WHITE: f32 = 2.0;

    /// Highlights above 0.8 are rolled off softly.
    pub fn new() -> Self {
        let encode = |index: usize| {
            let c = index as f32 / Self::FINENESS;
            let c = if c > 0.8 { 0.8 + 0.2 * (1.0 - (-(c - 0.8) / 0.2).exp()) } else { c };
            let encoded = if c <= 0.003_130_8 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
            (encoded * 255.0 + 0.5) as u8
        };
        Self((0..=(Self::FINENESS * Self::WHITE) as usize).map(encode).collect())
    }

    /// The bytes of a colour.
    pub fn bytes(&self, colour: Vec3) -> [u8; 3] {
        let last = self.0.len() - 1;
        colour.to_array().map(|c| self.0[((c * Self::FINENESS + 0.5) as usize).min(last)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_survive_below_the_roll_off() {
        let tone = ToneCurve::new();
        for byte in 0..=230_u8 {
            let linear = to_linear(Vec3::splat(f32::from(byte) / 255.0));
            assert_eq!(tone.bytes(linear), [byte; 3]);
        }
    }

    #[test]
    fn more_light_is_never_darker_and_white_is_reached() {
        let tone = ToneCurve::new();
        assert!(tone.0.is_sorted());
        assert_eq!(tone.bytes(Vec3::splat(9.0)), [255; 3]);
        assert_eq!(tone.bytes(Vec3::new(f32::NAN, -1.0, f32::INFINITY)), [0, 0, 255]);
    }
}
