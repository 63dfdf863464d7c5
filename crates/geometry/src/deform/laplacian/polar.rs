//! The rotation and the size in a 3 x 3 matrix.

use glam::DMat3;

/// Steps of the iteration; it takes up to nine from matrices that come near a flattening one.
const MOST_STEPS: usize = 24;

/// The rotation nearest to a matrix in the Frobenius norm, by polar decomposition.
///
/// Newton's iteration, scaled (Higham, Computing the Polar Decomposition, 1986), to rounding. A matrix that flattens or
/// mirrors goes by its singular values instead: the direction of the smallest is flipped where the product would mirror.
/// A matrix of rank 1 or 0 leaves a choice, which is made in some fixed way; one that is not finite gives the identity.
pub fn nearest_rotation(matrix: DMat3) -> DMat3 {
    let size = frobenius(matrix);
    if !(size.is_finite() && size > 0.0) {
        return DMat3::IDENTITY;
    }
    let mut x = matrix * (1.0 / size);
    if x.determinant() < 1e-3 {
        return by_singular_values(x);
    }
    for _ in 0..MOST_STEPS {
        let inverse = x.inverse().transpose();
        let scale = (frobenius(inverse) / frobenius(x)).sqrt();
        let next = x * (0.5 * scale) + inverse * (0.5 / scale);
        let change = frobenius(next - x);
        x = next;
        if change < 1e-15 {
            break;
        }
    }
    x
}

/// The root mean square of a matrix's singular values: the uniform scale in it (thesis 2.4.4, `s_i`).
pub fn uniform_scale(matrix: DMat3) -> f64 {
    frobenius(matrix) / 3.0_f64.sqrt()
}

fn frobenius(m: DMat3) -> f64 {
    (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
}

fn by_singular_values(matrix: DMat3) -> DMat3 {
    let m: nalgebra::Matrix3<f64> = matrix.into();
    let svd = m.svd(true, true);
    let (Some(mut u), Some(v)) = (svd.u, svd.v_t) else { return DMat3::IDENTITY };
    if (u * v).determinant() < 0.0 {
        let smallest = svd.singular_values.imin();
        u.column_mut(smallest).neg_mut();
    }
    (u * v).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};
    use proptest::prelude::*;

    fn is_rotation(m: DMat3) -> bool {
        frobenius(m * m.transpose() - DMat3::IDENTITY) < 1e-12 && (m.determinant() - 1.0).abs() < 1e-12
    }

    fn turn(axis: [f64; 3], angle: f64) -> DMat3 {
        DMat3::from_quat(DQuat::from_scaled_axis(DVec3::from(axis).normalize_or(DVec3::X) * angle))
    }

    proptest! {
        #[test]
        fn a_rotation_times_a_stretch_gives_the_rotation(
            axis in prop::array::uniform3(-1.0..1.0_f64),
            angle in -3.1..3.1_f64,
            stretch in prop::array::uniform3(0.01..4.0_f64),
            frame in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            let (r, q) = (turn(axis, angle), turn(frame, 1.0));
            let stretched = r * q * DMat3::from_diagonal(DVec3::from(stretch)) * q.transpose();
            prop_assert!(frobenius(nearest_rotation(stretched) - r) < 1e-10);
        }

        #[test]
        fn any_matrix_gives_a_rotation(entries in prop::array::uniform9(-2.0..2.0_f64)) {
            prop_assert!(is_rotation(nearest_rotation(DMat3::from_cols_array(&entries))));
        }
    }

    #[test]
    fn flat_and_mirrored_matrices_give_rotations() {
        let r = turn([1.0, 2.0, -0.5], 2.0);
        for diagonal in [[2.0, 1.0, 0.0], [2.0, 1.0, -1e-3], [1.0, 3.0, -0.5], [1.0, 1.0, 1e-9]] {
            let found = nearest_rotation(r * DMat3::from_diagonal(DVec3::from(diagonal)));
            assert!(frobenius(found - r) < 1e-9, "{diagonal:?}");
        }
        assert!(is_rotation(nearest_rotation(DMat3::from_diagonal(DVec3::new(0.0, 3.0, 0.0)))));
        assert!(is_rotation(nearest_rotation(DMat3::IDENTITY * -1.0)));
        assert_eq!(nearest_rotation(DMat3::ZERO), DMat3::IDENTITY);
        assert_eq!(nearest_rotation(DMat3::IDENTITY * f64::NAN), DMat3::IDENTITY);
        assert!(is_rotation(nearest_rotation(r * 1e-200)) && is_rotation(nearest_rotation(r * 1e100)));
    }

    #[test]
    fn the_scale_is_that_of_a_similarity() {
        assert!((uniform_scale(turn([1.0, 1.0, 0.0], 1.0) * 2.5) - 2.5).abs() < 1e-14);
        assert!((uniform_scale(DMat3::from_diagonal(DVec3::new(1.0, 2.0, 2.0))) - 3.0_f64.sqrt()).abs() < 1e-14);
    }
}
