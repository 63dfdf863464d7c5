//! Whether enough is held for one solution (thesis 2.4.2).

use glam::{DMat3, DVec3};

use super::error::BindError;
use super::patch::Patch;

/// Least ratio of the extents of held positions, smallest to largest, at which they count as not in one plane.
const LEAST_EXTENT: f64 = 1e-4;

/// Checks each connected part of the free vertices: one position and one gradient, or four positions that are not in one
/// plane.
pub(super) fn check(patch: &Patch) -> Result<(), BindError> {
    let mut seen = vec![false; patch.free];
    // The part whose rim a held vertex was last counted for.
    let mut counted = vec![u32::MAX; patch.len()];
    let mut open = Vec::new();
    for first in 0..patch.free {
        if seen[first] {
            continue;
        }
        let part = first as u32;
        seen[first] = true;
        open.push((part, 0));
        let (mut free, mut gradient) = (0, false);
        let mut positions: Vec<DVec3> = Vec::new();
        // What is held counts within two edges: so far gradients are compared.
        while let Some((vertex, beyond)) = open.pop() {
            let index = vertex as usize;
            gradient |= patch.gradient[index].is_some();
            if index < patch.free {
                free += 1;
            } else {
                positions.push(patch.points[index]);
            }
            if beyond == 2 {
                continue;
            }
            for &next in patch.adjacency.ring(vertex) {
                let other = next as usize;
                if other < patch.free {
                    if beyond == 0 && !seen[other] {
                        seen[other] = true;
                        open.push((next, 0));
                    }
                } else if counted[other] != part {
                    counted[other] = part;
                    open.push((next, beyond + 1));
                }
            }
        }
        let reason = if positions.is_empty() && !gradient {
            "is held by nothing: put a handle on it, or leave it out of the region"
        } else if positions.is_empty() {
            "has no position held, so that it could be anywhere: put a handle on it that holds positions"
        } else if !gradient && !spans_space(&positions) {
            "has only positions held, and these lie in one plane, so that it could turn: hold gradients too, or at least \
             4 positions that are not in one plane"
        } else {
            continue;
        };
        return Err(BindError::Underdetermined {
            vertex: patch.vertices[first],
            at: patch.points[first],
            free,
            reason,
        });
    }
    Ok(())
}

/// Whether points are neither in a plane nor on a line.
fn spans_space(points: &[DVec3]) -> bool {
    let mean = points.iter().sum::<DVec3>() / points.len() as f64;
    let moment = points.iter().fold(DMat3::ZERO, |sum, p| {
        let arm = *p - mean;
        sum + DMat3::from_cols(arm * arm.x, arm * arm.y, arm * arm.z)
    });
    let matrix: nalgebra::Matrix3<f64> = moment.into();
    let values = matrix.symmetric_eigenvalues();
    points.len() >= 4 && values.min() > LEAST_EXTENT * LEAST_EXTENT * values.max()
}
