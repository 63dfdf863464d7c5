//! What must not change the result.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use proptest::prelude::*;

use super::super::*;
use super::{apart, bar, bind, both, deform, ring, select, sheet};
use crate::mesh::Mesh;

const BOTH: [Reconstruction; 2] = [Reconstruction::Coordinates, Reconstruction::Edges];

fn moved(mesh: &Mesh, by: impl Fn(DVec3) -> DVec3) -> Mesh {
    mesh.with_positions(mesh.positions().iter().map(|p| by(*p)).collect(), None).unwrap()
}

#[test]
fn handles_that_stay_leave_the_mesh() {
    for mesh in [bar(4, 16, true), bar(4, 16, false), ring(24, 12, true), sheet(12, 12)] {
        let along = |p: DVec3| p.x + p.y + p.z;
        let reach = |more: f64| mesh.positions().iter().map(|p| more * along(*p)).fold(f64::MIN, f64::max);
        let (low, high) = (-reach(-1.0) + 0.5, reach(1.0) - 0.5);
        let handles = [select(&mesh, |p| along(p) < low), select(&mesh, |p| along(p) > high)];
        for reconstruction in BOTH {
            let bound = bind(&mesh, &both([&handles[0], &handles[1]]), reconstruction).unwrap();
            let still = [HandleTransform::default(); 2];
            assert!(apart(&mesh, &bound.drag(&still).unwrap()) < 1e-12);
            let made = deform(&bound, &still, Passes::Converged { tolerance: 1e-9, most: 20 });
            assert!(apart(&mesh, made.mesh.positions()) < 1e-12);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn a_similarity_of_all_handles_is_one_of_the_mesh(
        turn in prop::array::uniform3(-1.7..1.7_f64),
        scale in 0.3..3.0_f64,
        shift in prop::array::uniform3(-5.0..5.0_f64),
        edges: bool,
        flat: bool,
    ) {
        let mesh = if flat { bar(5, 20, true) } else { ring(24, 12, false) };
        let (low, high) = (select(&mesh, |p| p.y + 3.0 * p.x < -1.0), select(&mesh, |p| p.y + 3.0 * p.x > 2.5));
        let reconstruction = BOTH[usize::from(edges)];
        let bound = bind(&mesh, &both([&low, &high]), reconstruction).unwrap();
        let map = HandleTransform::rotation(DVec3::ONE, DVec3::from(turn), DVec3::from(turn).length())
            .scaled(scale)
            .shifted(DVec3::from(shift));
        let wanted = moved(&mesh, |p| map.apply(p));
        let made = deform(&bound, &[map; 2], Passes::Once);
        prop_assert!(!made.wound);
        let off = apart(&wanted, made.mesh.positions());
        prop_assert!(off < 1e-10, "{off:.1e}");
    }

    #[test]
    fn the_first_system_reproduces_affine_maps(entries in prop::array::uniform9(-0.6..0.6_f64), flat: bool) {
        let mesh = if flat { bar(5, 20, false) } else { ring(24, 12, true) };
        let (low, high) = (select(&mesh, |p| p.y + 3.0 * p.x < -1.0), select(&mesh, |p| p.y + 3.0 * p.x > 2.5));
        let bound = bind(&mesh, &both([&low, &high]), Reconstruction::Coordinates).unwrap();
        let matrix = DMat3::IDENTITY + DMat3::from_cols_array(&entries);
        prop_assume!(matrix.determinant() > 0.05);
        let affine = DAffine3::from_mat3_translation(matrix, DVec3::new(0.5, 2.0, -1.0));
        let map = HandleTransform::affine(&affine).unwrap();
        let wanted = moved(&mesh, |p| affine.transform_point3(p));
        let off = apart(&wanted, &bound.drag(&[map; 2]).unwrap());
        prop_assert!(off < 1e-9, "{off:.1e}");
    }

    #[test]
    fn the_result_turns_and_scales_with_the_input(
        turn in prop::array::uniform3(-2.0..2.0_f64),
        unit in prop::sample::select(vec![1e-3, 1.0, 1e3]),
        edges: bool,
        quads: bool,
    ) {
        let mesh = bar(4, 20, !quads);
        let frame = DQuat::from_scaled_axis(DVec3::from(turn));
        let there = |p: DVec3| unit * (frame * p) + unit * DVec3::new(3.0, 1.0, -2.0);
        let other = moved(&mesh, there);
        let (low, high) = (select(&mesh, |p| p.y < 0.6), select(&mesh, |p| p.y > 4.4));
        let handles = both([&low, &high]);
        let (pivot, axis) = (DVec3::new(0.0, 4.0, 0.5), DVec3::new(0.3, 0.2, 1.0));
        let shift = DVec3::new(0.5, -0.7, 0.2);
        let here = [HandleTransform::default(), HandleTransform::rotation(pivot, axis, 1.4).shifted(shift)];
        let yonder = [
            HandleTransform::default(),
            HandleTransform::rotation(there(pivot), frame * axis, 1.4).shifted(unit * (frame * shift)),
        ];
        let reconstruction = BOTH[usize::from(edges)];
        let first = deform(&bind(&mesh, &handles, reconstruction).unwrap(), &here, Passes::Once);
        let second = deform(&bind(&other, &handles, reconstruction).unwrap(), &yonder, Passes::Once);
        let off = apart(&moved(&first.mesh, there), second.mesh.positions());
        prop_assert!(off < 1e-9, "{off:.1e}");
    }
}

#[test]
fn a_symmetric_mesh_of_quads_stays_symmetric() {
    let mesh = bar(4, 24, false);
    let (low, high) = (select(&mesh, |p| p.y < 0.6), select(&mesh, |p| p.y > 5.4));
    let bound = bind(&mesh, &both([&low, &high]), Reconstruction::Coordinates).unwrap();
    let turn = HandleTransform::rotation(DVec3::new(-1.0, 4.0, 0.0), DVec3::Z, 1.2);
    let made = deform(&bound, &[HandleTransform::default(), turn], Passes::Once);
    let mirrored = |p: DVec3| DVec3::new(p.x, p.y, -p.z);
    for (index, p) in mesh.positions().iter().enumerate() {
        let other = mesh.positions().iter().position(|q| q.distance(mirrored(*p)) < 1e-9).unwrap();
        let (one, two) = (made.mesh.positions()[index], made.mesh.positions()[other]);
        assert!(one.distance(mirrored(two)) < 1e-9);
    }
}

#[test]
fn the_number_of_threads_does_not_show() {
    let mesh = ring(60, 30, true);
    let (low, high) = (select(&mesh, |p| p.x < -1.1), select(&mesh, |p| p.x > 1.1));
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let bound = bind(&mesh, &both([&low, &high]), Reconstruction::Edges).unwrap();
            let turn = HandleTransform::rotation(DVec3::X, DVec3::X, 2.0);
            let passes = Passes::Converged { tolerance: 1e-6, most: 30 };
            deform(&bound, &[HandleTransform::default(), turn], passes).mesh
        })
    };
    assert_eq!(on(1), on(3));
}
