//! Fine detail of a silhouette stays near its rail: lips at the mouth, and not around the jaw.

use glam::DVec3;

use super::{GenerateError, Weights};
use crate::beam::{EndCondition, OpenBeam, OpenValues, Stiffness};
use crate::curve::{Ends, smoothed};

/// Share of the wavelength over which detail fades out towards the ends of a rail: there the smooth curve has nothing to
/// lean on, and the roundness of a crown would count as detail.
///
/// Our own choice; local detail is not in the thesis. Beyond a free end the smooth curve goes on straight, which is felt
/// about half a wavelength inwards, and a quarter more is left for the fading. It is not critical: 0.5 and 1.0 move no
/// point of a head by more than 1.4 mm, at its open rim.
const END: f64 = 0.75;

/// What counts as detail of a silhouette, and how far around it reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalDetail {
    /// Bends along the rail of this wavelength count half as detail; longer ones less, shorter ones more. Metres.
    pub wave: f64,
    /// How far around the section detail reaches, as a share of the way to the next rail: above 0, below 1.
    pub reach: f64,
}

/// The detail taken off the rails, and the shape with which each section gets it back.
pub(super) struct Detail {
    /// Station by station, rail by rail.
    offsets: Vec<[DVec3; 4]>,
    /// Share of a rail's detail at each node of the section, counted from the rail.
    falloff: Vec<f64>,
}

/// Takes the detail off the pins: what is left is smooth along the rails.
///
/// `lengths` are those of the rails, metres; `held` says whether all rails meet at the first and the last station; `quarter` is the number of nodes from one rail to the next. The falloff is
/// the beam (thesis 5.5) that is 1 at the rail and clamped to 0 at the end of its reach on both sides, so that the
/// silhouette is met exactly and the section stays smooth where the detail ends.
pub(super) fn take_off(
    pins: &mut [[DVec3; 4]],
    detail: LocalDetail,
    lengths: [f64; 4],
    stations: &[f64],
    held: [bool; 2],
    quarter: usize,
    stiffness: Stiffness,
) -> Result<Detail, GenerateError> {
    let mut offsets = vec![[DVec3::ZERO; 4]; pins.len()];
    for (rail, length) in lengths.into_iter().enumerate() {
        let drawn: Vec<DVec3> = pins.iter().map(|pins| pins[rail]).collect();
        let smooth = smoothed(&drawn, stations, Ends::Open { held }, detail.wave / length)?;
        for (((pins, offsets), smooth), t) in pins.iter_mut().zip(&mut offsets).zip(smooth).zip(stations) {
            let from_end = t.min(1.0 - t) * length / (END * detail.wave);
            offsets[rail] = (pins[rail] - smooth) * Weights::Smooth.at(from_end.clamp(0.0, 1.0));
            pins[rail] -= offsets[rail];
        }
    }
    // The node at the end of the reach gets nothing, and the next rail must not either.
    let reach = ((detail.reach * quarter as f64).round() as usize).clamp(2, quarter.max(2));
    let beam = OpenBeam::new(2 * reach + 1, &[reach], EndCondition::Clamped, EndCondition::Clamped, stiffness)?;
    let falloff = beam.solve(&OpenValues { pins: &[1.0], ..OpenValues::ends(0.0, 0.0) })?;
    Ok(Detail { offsets, falloff: falloff[reach..].to_vec() })
}

impl Detail {
    /// Puts the detail of one station back onto its section; rails stand `quarter` nodes apart.
    pub(super) fn put_back(&self, station: usize, quarter: usize, section: &mut [DVec3]) {
        let nodes = section.len();
        for (rail, offset) in self.offsets[station].iter().enumerate() {
            for (away, share) in self.falloff.iter().enumerate() {
                section[(rail * quarter + away) % nodes] += *offset * *share;
                if away > 0 {
                    section[(rail * quarter + nodes - away) % nodes] += *offset * *share;
                }
            }
        }
    }
}
