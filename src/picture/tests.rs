//! Whole pictures, looked at pixel by pixel.

use std::f64::consts::TAU;

use glam::DVec3;
use maquette_geometry::curve::Curve;
use maquette_geometry::mesh::Mesh;
use maquette_geometry::scene::{CurveItem, Material, MeshItem, Scene};

use super::*;

const RED: [f64; 4] = [0.9, 0.05, 0.05, 1.0];
const GREEN: [f64; 4] = [0.05, 0.7, 0.05, 1.0];
const BLUE: [f64; 4] = [0.05, 0.1, 0.9, 1.0];
const VIEWS: [View; 4] = [View::Front, View::Side, View::Top, View::ThreeQuarter];

/// A closed sphere whose outermost vertices lie on all six axes.
fn sphere(centre: DVec3, radius: f64) -> Mesh {
    let (around, rings) = (64_u32, 31_u32);
    let mut points = vec![centre + DVec3::NEG_Y * radius, centre + DVec3::Y * radius];
    for ring in 1..=rings {
        let (across, up) = (TAU * 0.5 * f64::from(ring) / f64::from(rings + 1)).sin_cos();
        points.extend((0..around).map(|i| {
            let (x, z) = (TAU * f64::from(i) / f64::from(around)).sin_cos();
            centre + DVec3::new(x * across, -up, z * across) * radius
        }));
    }
    let at = |ring: u32, i: u32| 2 + ring * around + i % around;
    let mut polygons: Vec<Vec<u32>> = Vec::new();
    for i in 0..around {
        polygons.push(vec![0, at(0, i + 1), at(0, i)]);
        polygons.push(vec![1, at(rings - 1, i), at(rings - 1, i + 1)]);
        polygons.extend((1..rings).map(|r| vec![at(r - 1, i), at(r - 1, i + 1), at(r, i + 1), at(r, i)]));
    }
    Mesh::new(points, polygons).unwrap()
}

/// A square in the plane z = `z`, 2 m wide, that faces the front.
fn square(z: f64) -> Mesh {
    let corners = [[-1.0, -1.0, z], [1.0, -1.0, z], [1.0, 1.0, z], [-1.0, 1.0, z]];
    Mesh::new(corners.map(DVec3::from).to_vec(), [[0u32, 1, 2, 3]]).unwrap()
}

fn flipped(mesh: &Mesh) -> Mesh {
    Mesh::new(mesh.positions().to_vec(), mesh.polygons().map(|p| p.iter().rev().copied().collect::<Vec<_>>())).unwrap()
}

fn item(mesh: Mesh, colour: [f64; 4]) -> MeshItem {
    MeshItem { name: "part".into(), mesh, material: Material { colour, ..Material::default() } }
}

fn line(points: &[[f64; 3]], colour: [f64; 4]) -> CurveItem {
    let points = points.iter().map(|p| DVec3::from(*p)).collect();
    CurveItem { name: "line".into(), curves: vec![Curve::new("line", points, false).unwrap()], colour }
}

fn scene(meshes: Vec<MeshItem>) -> Scene {
    Scene { meshes, curves: Vec::new() }
}

fn options(view: View, width: u32, height: u32) -> PictureOptions {
    PictureOptions { view, width, height, wireframe: false, curves: true }
}

fn pixel(picture: &Picture, x: u32, y: u32) -> [i32; 3] {
    let at = ((y * picture.width + x) * 3) as usize;
    [0, 1, 2].map(|k| i32::from(picture.rgb[at + k]))
}

fn pixels(picture: &Picture) -> impl Iterator<Item = (f64, f64, [i32; 3])> {
    (0..picture.height).flat_map(move |y| {
        (0..picture.width).map(move |x| (f64::from(x) + 0.5, f64::from(y) + 0.5, pixel(picture, x, y)))
    })
}

fn is_red([r, g, b]: [i32; 3]) -> bool {
    r > 60 && r > 2 * g && r > 2 * b
}

fn is_green([r, g, b]: [i32; 3]) -> bool {
    g > 60 && g > 2 * r && g > 2 * b
}

fn is_blue([r, g, b]: [i32; 3]) -> bool {
    b > 60 && b > 2 * r && 2 * b > 3 * g
}

fn is_backdrop([r, g, b]: [i32; 3]) -> bool {
    r > 120 && (g - r).abs() <= 6 && (b - r).abs() <= 10
}

/// Mean place and number of the pixels that a test accepts.
fn centroid(picture: &Picture, accept: impl Fn([i32; 3]) -> bool) -> (f64, f64, f64) {
    let (x, y, count) = pixels(picture)
        .filter(|(_, _, rgb)| accept(*rgb))
        .fold((0.0, 0.0, 0.0), |(sx, sy, n), (x, y, _)| (sx + x, sy + y, n + 1.0));
    assert!(count > 0.0, "the colour is not in the picture");
    (x / count, y / count, count)
}

#[test]
fn bytes_are_the_same_for_any_number_of_threads() {
    let mut scene = scene(vec![
        item(sphere(DVec3::Y, 1.0), [0.8, 0.7, 0.6, 1.0]),
        item(sphere(DVec3::new(1.2, 0.4, 0.5), 0.4), [0.2, 0.4, 0.8, 0.5]),
    ]);
    scene.curves.push(line(&[[-2.0, 0.0, 0.0], [0.0, 1.0, 1.2], [2.0, 1.5, -1.0]], RED));
    for view in VIEWS {
        let options = PictureOptions { wireframe: true, ..options(view, 150, 100) };
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| draw(&scene, &options).unwrap())
        };
        let one = with(1);
        assert!(one == with(2) && one == with(7), "{view:?}");
    }
}

#[test]
fn a_sphere_has_its_radius_to_the_pixel() {
    let scene = scene(vec![item(sphere(DVec3::new(3.0, 7.0, -2.0), 0.35), BLUE)]);
    for view in [View::Front, View::Side, View::Top] {
        let picture = draw(&scene, &options(view, 300, 200)).unwrap();
        // The height decides, less twice 8 %.
        let radius = 200.0 * (0.5 - 0.08);
        let (x, y, count) = centroid(&picture, is_blue);
        assert!((x - 150.0).abs() < 0.3 && (y - 100.0).abs() < 0.3, "{view:?}: {x} {y}");
        let found = (count / std::f64::consts::PI).sqrt();
        assert!((found - radius).abs() < 1.0, "{view:?}: {found} for {radius}");
        for (x, y, rgb) in pixels(&picture) {
            let distance = (x - 150.0).hypot(y - 100.0);
            assert!(distance > radius - 1.0 || is_blue(rgb), "{view:?}: hole at {x}, {y}: {rgb:?}");
            assert!(distance < radius + 1.0 || is_backdrop(rgb), "{view:?}: not backdrop at {x}, {y}: {rgb:?}");
        }
    }
}

#[test]
fn there_are_no_cracks_in_perspective() {
    let picture =
        draw(&scene(vec![item(sphere(DVec3::Y, 1.0), BLUE)]), &options(View::ThreeQuarter, 211, 211)).unwrap();
    for (x, y, rgb) in pixels(&picture) {
        assert!((x - 105.5).hypot(y - 105.5) > 211.0 * 0.42 - 1.5 || is_blue(rgb), "{x}, {y}: {rgb:?}");
    }
}

#[test]
fn axes_lie_on_the_documented_sides() {
    let scene = scene(vec![
        item(sphere(DVec3::X, 0.2), RED),
        item(sphere(DVec3::Y, 0.2), GREEN),
        item(sphere(DVec3::Z, 0.2), BLUE),
        item(sphere(DVec3::NEG_ONE * 1.2, 0.05), [0.8, 0.7, 0.6, 1.0]),
        item(sphere(DVec3::ONE * 1.2, 0.05), [0.8, 0.7, 0.6, 1.0]),
    ]);
    // Right and down, in the order of the axes; 0 in the middle.
    for (view, red, green, blue) in [
        (View::Front, (1, 0), (0, -1), (0, 0)),
        (View::Side, (0, 0), (0, -1), (1, 0)),
        (View::Top, (1, 0), (0, 0), (0, 1)),
    ] {
        let picture = draw(&scene, &options(view, 200, 200)).unwrap();
        for (accept, expected) in [(is_red as fn([i32; 3]) -> bool, red), (is_green, green), (is_blue, blue)] {
            // On the far side of Side the ball on +X is hidden by nothing but lies in the middle too.
            let (x, y, _) = centroid(&picture, accept);
            let side = |v: f64| if (v - 100.0).abs() < 8.0 { 0 } else { (v - 100.0).signum() as i32 };
            assert_eq!((side(x), side(y)), expected, "{view:?} {x} {y}");
        }
    }
    let picture = draw(&scene, &options(View::ThreeQuarter, 200, 200)).unwrap();
    let [red, green, blue] =
        [is_red as fn([i32; 3]) -> bool, is_green, is_blue].map(|accept| centroid(&picture, accept));
    assert!(red.0 > green.0 && green.0 > blue.0 && green.1 < red.1 && red.1 < blue.1, "{red:?} {green:?} {blue:?}");
}

#[test]
fn flipped_polygons_are_red_and_the_inside_of_cloth_is_not() {
    let middle = |mesh: &Mesh, double_sided: bool| {
        let material = Material { double_sided, ..Material::default() };
        let scene = scene(vec![MeshItem { name: "cloth".into(), mesh: mesh.clone(), material }]);
        pixel(&draw(&scene, &options(View::Front, 60, 60)).unwrap(), 30, 30)
    };
    let (front, back) = (square(0.0), flipped(&square(0.0)));
    assert!(is_red(middle(&back, false)), "{:?}", middle(&back, false));
    assert!(!is_red(middle(&front, false)));
    assert_eq!(middle(&front, false), middle(&front, true));
    let (outside, inside) = (middle(&front, true), middle(&back, true));
    assert!(!is_red(inside) && inside.iter().zip(outside).all(|(i, o)| *i < o - 20), "{inside:?} {outside:?}");
    // Cooler: blue has lost less than red.
    assert!(inside[2] * outside[0] > inside[0] * outside[2]);
}

#[test]
fn half_opaque_surfaces_let_the_ones_behind_through() {
    let middle = |opacity: f64| {
        let veil = item(square(0.5), [0.9, 0.05, 0.05, opacity]);
        let picture = draw(&scene(vec![item(square(0.0), BLUE), veil]), &options(View::Front, 60, 60)).unwrap();
        pixel(&picture, 30, 33)
    };
    assert!(is_blue(middle(0.0)) && is_red(middle(1.0)));
    let [r, _, b] = middle(0.5);
    assert!(r > 90 && b > 90, "{:?}", middle(0.5));
}

#[test]
fn wires_follow_polygons_and_not_their_triangles() {
    let scene = scene(vec![item(square(0.0), [0.8, 0.7, 0.6, 1.0])]);
    let plain = draw(&scene, &options(View::Front, 100, 100)).unwrap();
    let wired = draw(&scene, &PictureOptions { wireframe: true, ..options(View::Front, 100, 100) }).unwrap();
    // The square's sides run along the margin, at 8 and 92.
    let luminance = |picture: &Picture, x: u32, y: u32| pixel(picture, x, y).iter().sum::<i32>();
    for k in 12..88 {
        assert!(luminance(&wired, 8, k) < luminance(&plain, 8, k) - 60, "side at {k}");
        assert_eq!(pixel(&wired, k, k), pixel(&plain, k, k), "diagonal at {k}");
        assert_eq!(pixel(&wired, k, 99 - k), pixel(&plain, k, 99 - k), "diagonal at {k}");
    }
}

#[test]
fn hidden_wires_are_not_drawn() {
    // A small square behind a large one.
    let behind =
        Mesh::new(square(-0.5).positions().iter().map(|p| *p * DVec3::new(0.5, 0.5, 1.0)).collect(), [[0u32, 1, 2, 3]]);
    let front = item(square(0.0), [0.8, 0.7, 0.6, 1.0]);
    let both = scene(vec![front.clone(), item(behind.unwrap(), GREEN)]);
    let wires = PictureOptions { wireframe: true, ..options(View::Front, 100, 100) };
    let (one, two) = (draw(&scene(vec![front]), &wires).unwrap(), draw(&both, &wires).unwrap());
    for (a, b) in pixels(&one).zip(pixels(&two)) {
        // Light comes out a little different; a line would be 100 darker.
        assert!(a.2.iter().zip(b.2).all(|(a, b)| (a - b).abs() < 12), "{a:?} {b:?}");
    }
}

#[test]
fn curves_are_of_even_width_and_dotted_where_hidden() {
    let wall = item(square(0.0), [0.9, 0.9, 0.9, 1.0]);
    // Ink in the picture: how much less green there is than in the picture without the line.
    let ink = |z: f64, slope: f64| {
        let mut drawn = scene(vec![wall.clone()]);
        drawn.curves.push(line(&[[-0.8, -0.8 * slope, z], [0.8, 0.8 * slope, z]], [1.0, 0.0, 0.0, 1.0]));
        let with = draw(&drawn, &options(View::Front, 200, 200)).unwrap();
        let without = draw(&scene(vec![wall.clone()]), &options(View::Front, 200, 200)).unwrap();
        let full = f64::from(pixel(&without, 100, 90)[1]);
        let sum: i32 = pixels(&with).zip(pixels(&without)).map(|(a, b)| (b.2[1] - a.2[1]).max(0)).sum();
        let length = 1.6 * 84.0 * (1.0 + slope * slope).sqrt();
        f64::from(sum) / full / length
    };
    // Gamma makes the edges of the line count less than their coverage.
    let level = ink(0.5, 0.0);
    assert!((1.8..2.6).contains(&level), "{level}");
    for slope in [0.25, 0.5, 1.0] {
        assert!((ink(0.5, slope) / level - 1.0).abs() < 0.12, "{slope}: {} {level}", ink(0.5, slope));
    }
    // In the surface it is seen; behind it there are dots.
    assert!((ink(0.0, 0.5) / ink(0.5, 0.5) - 1.0).abs() < 0.02);
    let hidden = ink(-0.5, 0.5);
    assert!((0.05..0.5).contains(&(hidden / level)), "{hidden} {level}");
}

#[test]
fn pictures_of_curves_alone_have_no_holes_in_the_lines() {
    let mut drawn = scene(Vec::new());
    drawn.curves.push(line(&[[-1.0, 0.0, 0.0], [-0.2, 0.1, 0.0], [0.3, 0.1, 0.2], [1.0, 0.0, 0.0]], BLUE));
    let picture = draw(&drawn, &options(View::Front, 100, 40)).unwrap();
    for x in 9..91 {
        assert!((0..40).any(|y| is_blue(pixel(&picture, x, y))), "column {x}");
    }
}

#[test]
fn png_holds_the_same_pixels() {
    let picture = draw(&scene(vec![item(sphere(DVec3::ZERO, 1.0), RED)]), &options(View::Front, 37, 23)).unwrap();
    let read = image::load_from_memory(&picture.to_png().unwrap()).unwrap().into_rgb8();
    assert_eq!((read.width(), read.height()), (37, 23));
    assert_eq!(read.into_raw(), picture.rgb);

    let broken = Picture { rgb: vec![0; 5], ..picture };
    assert!(matches!(broken.to_png(), Err(PngError::Length { width: 37, height: 23, found: 5 })));
    assert!(broken.to_png().unwrap_err().to_string().contains("37 x 23"));
    assert!(matches!(Picture { width: 0, height: 0, rgb: Vec::new() }.to_png(), Err(PngError::Encode(_))));
}

#[test]
fn errors_say_what_is_wrong() {
    let empty = draw(&Scene::default(), &PictureOptions::default()).unwrap_err();
    assert_eq!(empty, PictureError::NothingToDraw { polygons: 0, curves: 0, curves_drawn: true });
    assert!(empty.to_string().starts_with("nothing to draw"), "{empty}");

    let mut only_curves = scene(vec![item(Mesh::new(vec![DVec3::ZERO], [] as [[u32; 3]; 0]).unwrap(), RED)]);
    only_curves.curves.push(line(&[[0.0; 3], [1.0, 0.0, 0.0]], RED));
    let off = PictureOptions { curves: false, ..PictureOptions::default() };
    let hidden = draw(&only_curves, &off).unwrap_err();
    assert_eq!(hidden, PictureError::NothingToDraw { polygons: 0, curves: 1, curves_drawn: false });
    assert!(hidden.to_string().contains("curves are switched off"), "{hidden}");

    let ball = scene(vec![item(sphere(DVec3::ZERO, 1.0), RED)]);
    for (width, height) in [(0, 10), (10, 0), (16_385, 10), (10, u32::MAX)] {
        let error = draw(&ball, &options(View::Front, width, height)).unwrap_err();
        assert_eq!(error, PictureError::Size { width, height });
    }
    assert!(draw(&ball, &options(View::Front, 16_384, 1)).is_ok());

    let far = scene(vec![item(sphere(DVec3::X * 1e13, 1.0), RED)]);
    let error = draw(&far, &PictureOptions::default()).unwrap_err();
    assert!(matches!(error, PictureError::OutOfReach { distance } if distance > 9e12), "{error}");
    assert!(error.to_string().contains("check the scale"), "{error}");
}

#[test]
fn nothing_that_can_be_given_panics() {
    let point = Mesh::new(vec![DVec3::splat(2.0); 3], [[0u32, 1, 2], [0, 0, 0]]).unwrap();
    let sliver = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::Y * 1e-300], [[0u32, 1, 2], [0, 1, 3]]);
    let dead = square(0.0).with_normals(vec![DVec3::ZERO; 4]).unwrap();
    let strange = [f64::NAN, f64::INFINITY, -3.0, f64::NAN];
    let material = Material { colour: strange, metallic: f64::NAN, roughness: -1.0, ..Material::default() };
    let scenes = [
        scene(vec![item(point, RED)]),
        scene(vec![item(sliver.unwrap(), RED)]),
        scene(vec![MeshItem { name: String::new(), mesh: dead, material }]),
        scene(vec![item(sphere(DVec3::splat(1e12 - 2.0), 1.0), RED)]),
        scene(vec![item(sphere(DVec3::ZERO, 1e-200), RED)]),
        scene(vec![item(sphere(DVec3::ZERO, 9e11), RED), item(sphere(DVec3::X, 1e-9), BLUE)]),
        Scene { meshes: Vec::new(), curves: vec![line(&[[0.0; 3], [0.0, 1e-300, 0.0]], strange)] },
    ];
    for scene in &scenes {
        for (view, (width, height)) in VIEWS.into_iter().zip([(1, 1), (33, 7), (3, 90), (40, 30)]) {
            let options = PictureOptions { wireframe: true, ..options(view, width, height) };
            let picture = draw(scene, &options).unwrap();
            assert_eq!(picture.rgb.len() as u32, width * height * 3);
        }
    }
}
