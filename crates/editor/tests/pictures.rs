//! What the views draw, with a software renderer: that it is there, where it is, and that modes differ.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui::{Key, Modifiers, Pos2, vec2};
use egui_kittest::{Harness, wgpu::WgpuTestRenderer};
use image::RgbaImage;
use maquette_editor::command::ViewCommand;
use maquette_editor::{App, Direction, Options, Shading};
use support::*;

/// A window with the vest and a renderer.
fn drawn() -> Window {
    let options = Options { path: Some(graph("vest.ron")), ..Options::default() };
    let mut window = Harness::builder()
        .with_size(vec2(1200.0, 800.0))
        .with_step_dt(1.0 / 60.0)
        .renderer(WgpuTestRenderer::new())
        .build_eframe(move |context| App::new(context, options).unwrap());
    settle(&mut window);
    window
}

fn picture(window: &mut Window) -> RgbaImage {
    window.run_steps(2);
    window.render().unwrap()
}

fn at(picture: &RgbaImage, place: Pos2) -> [u8; 3] {
    let [r, g, b, _] = picture.get_pixel(place.x as u32, place.y as u32).0;
    [r, g, b]
}

fn differ(a: [u8; 3], b: [u8; 3]) -> i32 {
    a.iter().zip(b).map(|(a, b)| (i32::from(*a) - i32::from(b)).abs()).sum()
}

/// The share of a view in which two pictures differ.
fn share(a: &RgbaImage, b: &RgbaImage, rect: egui::Rect) -> f64 {
    let mut count = [0.0, 0.0];
    for y in rect.top() as u32..rect.bottom() as u32 {
        for x in rect.left() as u32..rect.right() as u32 {
            let place = Pos2::new(x as f32, y as f32);
            count[usize::from(differ(at(a, place), at(b, place)) > 24)] += 1.0;
        }
    }
    count[1] / (count[0] + count[1])
}

#[test]
fn the_vest_is_where_it_is_and_follows_what_it_is_made_of() {
    let mut window = drawn();
    let before = picture(&mut window);
    let front = rect(&window, "Front view");
    let belly = seen(&window, Direction::Front, "Front view", [0.09, 1.0, 0.1]);
    let beside = front.left_center() + vec2(40.0, 0.0);
    let [r, _, b] = at(&before, belly);
    assert!(b > r.saturating_add(15), "the vest is blue: {:?}", at(&before, belly));
    assert!(differ(at(&before, belly), at(&before, beside)) > 60);
    // Wider by pulling its side.
    window.state_mut().ask(ViewCommand::Find("side rail".to_owned()));
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::W);
    let begin = seen(&window, Direction::Front, "Front view", [0.138, 1.15, 0.012]);
    drag(&mut window, &way(begin, begin + vec2(16.0, 0.0), 6));
    settle(&mut window);
    let after = picture(&mut window);
    let side = rect(&window, "Perspective view");
    assert!(share(&before, &after, side) > 0.004, "the perspective follows: {}", share(&before, &after, side));
}

#[test]
fn every_shading_mode_looks_different() {
    let mut window = drawn();
    let area = rect(&window, "Front view").shrink(20.0);
    let mut pictures = Vec::new();
    for shading in Shading::ALL {
        window.state_mut().settings_mut().shading = shading;
        window.run_steps(2);
        settle(&mut window);
        pictures.push((shading, picture(&mut window)));
    }
    for (index, (shading, one)) in pictures.iter().enumerate() {
        for (other, another) in &pictures[index + 1..] {
            let share = share(one, another, area);
            assert!(share > 0.05, "{shading:?} and {other:?} differ in {share} of the view");
        }
    }
}

#[test]
fn light_and_dark_both_have_contrast() {
    let mut window = drawn();
    let corner = rect(&window, "Side view").left_bottom() + vec2(60.0, -40.0);
    let dark = picture(&mut window);
    window.ctx.set_theme(egui::Theme::Light);
    let light = picture(&mut window);
    let sum = |picture| at(picture, corner).iter().map(|c| i32::from(*c)).sum::<i32>();
    assert!(sum(&dark) < 240 && sum(&light) > 560, "{} and {}", sum(&dark), sum(&light));
}

/// Size of the pictures that are compared: small, so that what differs between renderers, edges and letters, does not count.
const SMALL: [u32; 2] = [150, 100];
/// Set to any value, the pictures that are compared with are written anew; look at them before they are committed.
const WRITE: &str = "MAQUETTE_WRITE_PICTURES";

/// Compares a picture with the one of that name in `tests/pictures`.
#[track_caller]
fn assert_looks_like(window: &mut Window, name: &str) {
    let picture = window.render().unwrap();
    let small = image::imageops::resize(&picture, SMALL[0], SMALL[1], image::imageops::FilterType::Triangle);
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures").join(name).with_extension("png");
    if std::env::var_os(WRITE).is_some() {
        small.save(&path).unwrap();
        return;
    }
    let known = image::open(&path).unwrap().into_rgba8();
    assert_eq!(known.dimensions(), small.dimensions());
    let offs: Vec<i32> =
        known.pixels().zip(small.pixels()).map(|(a, b)| differ([a[0], a[1], a[2]], [b[0], b[1], b[2]])).collect();
    // Summed over red, green and blue, of 765.
    let mean = f64::from(offs.iter().sum::<i32>()) / offs.len() as f64;
    let wrong = offs.iter().filter(|off| **off > 120).count() as f64 / offs.len() as f64;
    assert!(mean < 6.0 && wrong < 0.004, "{name} looks otherwise: {mean} on the mean, {wrong} of it clearly");
}

#[test]
fn the_window_looks_as_it_did() {
    let mut window = drawn();
    window.state_mut().ask(ViewCommand::Find("sorted".to_owned()));
    settle(&mut window);
    assert_looks_like(&mut window, "sorted");
    window.state_mut().settings_mut().shading = Shading::Zebra;
    window.ctx.set_theme(egui::Theme::Light);
    window.run_steps(3);
    settle(&mut window);
    assert_looks_like(&mut window, "zebra-light");
    let options = Options { path: Some(graph("leg-deformed.ron")), ..Options::default() };
    let mut window = Harness::builder()
        .with_size(vec2(1200.0, 800.0))
        .with_step_dt(1.0 / 60.0)
        .renderer(WgpuTestRenderer::new())
        .build_eframe(move |context| App::new(context, options).unwrap());
    window.state_mut().settings_mut().shading = Shading::Silhouette;
    settle(&mut window);
    window.run_steps(3);
    assert_looks_like(&mut window, "silhouette");
}
