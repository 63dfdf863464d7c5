//! Reference pictures in the views: drawn behind everything else, moved with the pointer, scaled by a length one knows.

use egui::{Color32, Mesh, Pos2, Rect, Shape, Stroke};
use glam::DVec2;
use maquette_graph::ReferencePicture;

use crate::command::{Command, GraphCommand, Message};
use crate::panel::PanelContext;
use crate::reference_pictures::PictureState;
use crate::sketch::target::{Plane, rounded};

use super::camera::{Camera, Direction, ViewSize};
use super::sketch_tool::ToolView;

/// Squares along an edge of a picture that is seen in perspective.
const SQUARES: usize = 16;
const ACCENT: Color32 = Color32::from_rgb(255, 160, 45);

/// The plane of a picture.
fn plane_of(picture: &ReferencePicture) -> Option<Plane> {
    let view = Direction::ALL.into_iter().find(|view| view.plane() == Some(picture.view.as_str()))?;
    Plane::of_view(view)
}

/// Half its width and height, metres, along the coordinates of its plane.
fn half(picture: &ReferencePicture, aspect: f64) -> DVec2 {
    0.5 * picture.width * DVec2::new(1.0, 1.0 / aspect)
}

/// The point of the plane at a place of the picture, from 0 to 1 rightwards and downwards as the view shows it.
fn place(picture: &ReferencePicture, aspect: f64, across: f64, down: f64) -> DVec2 {
    // The second coordinate of the top plane runs down the screen.
    let up = if picture.view == "top" { down - 0.5 } else { 0.5 - down };
    DVec2::from_array(picture.centre) + 2.0 * half(picture, aspect) * DVec2::new(across - 0.5, up)
}

fn aspect_of(state: Option<&PictureState>) -> Option<f64> {
    match state {
        Some(PictureState::Ready(texture)) => {
            let [width, height] = texture.size();
            #[expect(clippy::cast_precision_loss, reason = "pixels of a picture")]
            let aspect = width as f64 / height.max(1) as f64;
            Some(aspect)
        }
        _ => None,
    }
}

/// Whether a view shows a picture: its own one flat, the free one in space.
fn is_seen(picture: &ReferencePicture, camera: &Camera) -> bool {
    let plane = plane_of(picture);
    !picture.hidden && plane.is_some_and(|plane| camera.direction == Direction::Free || plane.view == camera.direction)
}

/// Draws the pictures of a view.
pub(crate) fn show(ui: &egui::Ui, rect: Rect, context: &PanelContext<'_>, camera: &Camera, size: ViewSize) {
    let painter = ui.painter().with_clip_rect(rect);
    for picture in context.document.graph().references().iter().filter(|picture| is_seen(picture, camera)) {
        let Some(plane) = plane_of(picture) else { continue };
        let state = context.pictures.state(context.document, &picture.file);
        let screen = |at: DVec2| camera.project(size, plane.place(at)).map(|seen| rect.min + seen);
        if let (Some(PictureState::Ready(texture)), Some(aspect)) = (state, aspect_of(state)) {
            let squares = if camera.direction == Direction::Free { SQUARES } else { 1 };
            let share = |k: usize| {
                #[expect(clippy::cast_precision_loss, reason = "a few squares")]
                let share = k as f64 / squares as f64;
                share
            };
            #[expect(clippy::cast_possible_truncation, reason = "a share")]
            let tint = Color32::WHITE.gamma_multiply(picture.opacity as f32);
            let mut mesh = Mesh::with_texture(texture.id());
            let corners: Option<Vec<(Pos2, Pos2)>> = (0..=squares)
                .flat_map(|row| (0..=squares).map(move |column| (share(column), share(row))))
                .map(|(across, down)| {
                    #[expect(clippy::cast_possible_truncation, reason = "a share")]
                    let texel = Pos2::new(across as f32, down as f32);
                    Some((screen(place(picture, aspect, across, down))?, texel))
                })
                .collect();
            // One that reaches behind the eye is not drawn.
            let Some(corners) = corners else { continue };
            for (pos, uv) in corners {
                mesh.vertices.push(egui::epaint::Vertex { pos, uv, color: tint });
            }
            for row in 0..squares {
                for column in 0..squares {
                    let corner = |right: usize, below: usize| {
                        u32::try_from((row + below) * (squares + 1) + column + right).unwrap_or(0)
                    };
                    mesh.add_triangle(corner(0, 0), corner(1, 0), corner(1, 1));
                    mesh.add_triangle(corner(0, 0), corner(1, 1), corner(0, 1));
                }
            }
            painter.add(Shape::mesh(mesh));
            continue;
        }
        // In place of one that is not there, an empty frame that says why.
        let corners: Vec<Pos2> = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]
            .into_iter()
            .filter_map(|(across, down)| screen(place(picture, 1.0, across, down)))
            .collect();
        let (colour, text) = match state {
            Some(PictureState::Failed(problem)) => (ui.visuals().error_fg_color, problem.clone()),
            _ => (ui.visuals().weak_text_color(), format!("reading {}", picture.file)),
        };
        if camera.direction != Direction::Free
            && let Some(middle) = screen(DVec2::from_array(picture.centre))
        {
            let font = egui::FontId::proportional(12.0);
            let lines = painter.layout(text, font, colour, rect.width() * 0.8);
            painter.galley(middle - lines.size() / 2.0, lines, colour);
        }
        painter.extend(Shape::dashed_line(&corners, Stroke::new(1.0, colour), 6.0, 4.0));
    }
}

/// What the pointer does with a picture from press to release.
#[derive(Clone, Debug)]
enum Gesture {
    /// Moves this one.
    Move { index: usize, base: Vec<ReferencePicture>, begin: DVec2 },
    /// Draws along something of known length in this one.
    Measure { index: usize, from: DVec2, to: DVec2 },
}

/// The tool that moves and scales pictures, of one view.
#[derive(Clone, Debug, Default)]
pub(crate) struct PictureTool {
    gesture: Option<Gesture>,
}

/// The uppermost picture under a point of the view that is not locked, and the point in its plane.
fn under(context: &PanelContext<'_>, view: &ToolView<'_>, at: egui::Vec2) -> Option<(usize, DVec2)> {
    if view.camera.direction == Direction::Free {
        return None;
    }
    let references = context.document.graph().references();
    references.iter().enumerate().rev().find_map(|(index, picture)| {
        if picture.locked || !is_seen(picture, view.camera) {
            return None;
        }
        let point = view.meet(plane_of(picture)?, at)?;
        let aspect = aspect_of(context.pictures.state(context.document, &picture.file)).unwrap_or(1.0);
        let off = (point - DVec2::from_array(picture.centre)).abs();
        off.cmple(half(picture, aspect)).all().then_some((index, point))
    })
}

impl PictureTool {
    pub(crate) fn press(
        &mut self,
        context: &mut PanelContext<'_>,
        view: &ToolView<'_>,
        at: egui::Vec2,
        measures: bool,
    ) {
        self.gesture = under(context, view, at).map(|(index, point)| match measures {
            true => Gesture::Measure { index, from: point, to: point },
            false => Gesture::Move { index, base: context.document.graph().references().to_vec(), begin: point },
        });
        if self.gesture.is_none() {
            let text =
                "no picture here that can be moved: unlock it, or add one (View menu, or drop a file on the view)";
            context.ask(Command::Say(Message::error(text)));
        }
    }

    pub(crate) fn drag(&mut self, context: &mut PanelContext<'_>, view: &ToolView<'_>, at: egui::Vec2) {
        let references = context.document.graph().references();
        let plane = |index: usize| references.get(index).and_then(plane_of);
        match &mut self.gesture {
            None => {}
            Some(Gesture::Move { index, base, begin }) => {
                let Some(now) = plane(*index).and_then(|plane| view.meet(plane, at)) else { return };
                let mut moved = base.clone();
                if let Some(picture) = moved.get_mut(*index) {
                    picture.centre = rounded(DVec2::from_array(picture.centre) + now - *begin).to_array();
                }
                let gesture = Some(format!("picture {index}"));
                context.ask(GraphCommand::References { name: "move a picture".to_owned(), pictures: moved, gesture });
            }
            Some(Gesture::Measure { index, to, .. }) => {
                if let Some(now) = plane(*index).and_then(|plane| view.meet(plane, at)) {
                    *to = now;
                }
            }
        }
    }

    pub(crate) fn release(&mut self, context: &mut PanelContext<'_>) {
        match self.gesture.take() {
            None => {}
            Some(Gesture::Move { .. }) => context.ask(GraphCommand::EndGesture),
            Some(Gesture::Measure { index, from, to }) => {
                let mut pictures = context.document.graph().references().to_vec();
                let drawn = from.distance(to);
                let Some(picture) = pictures.get_mut(index).filter(|_| drawn > 0.0) else { return };
                let factor = context.settings.known_length / drawn;
                if !(1e-4..=1e4).contains(&factor) {
                    context.ask(Command::Say(Message::error("draw along something longer to scale the picture by")));
                    return;
                }
                // Where one began to draw, the picture stays.
                let centre = from + (DVec2::from_array(picture.centre) - from) * factor;
                picture.centre = rounded(centre).to_array();
                picture.width = rounded(DVec2::splat(picture.width * factor)).x.max(1e-5);
                context.ask(GraphCommand::References { name: "scale a picture".to_owned(), pictures, gesture: None });
            }
        }
    }

    /// The line that is drawn along something of known length, with what it measures now.
    pub(crate) fn show(
        &self,
        painter: &egui::Painter,
        context: &PanelContext<'_>,
        screen: impl Fn(glam::DVec3) -> Option<Pos2>,
    ) {
        let Some(Gesture::Measure { index, from, to }) = &self.gesture else { return };
        let Some(plane) = context.document.graph().references().get(*index).and_then(plane_of) else { return };
        let (Some(a), Some(b)) = (screen(plane.place(*from)), screen(plane.place(*to))) else { return };
        painter.line_segment([a, b], Stroke::new(2.0, ACCENT));
        for end in [a, b] {
            painter.circle_filled(end, 3.0, ACCENT);
        }
        let text = format!("{:.3} m becomes {:.3} m", from.distance(*to), context.settings.known_length);
        let font = egui::FontId::proportional(12.0);
        painter.text(a.lerp(b, 0.5) + egui::vec2(8.0, -8.0), egui::Align2::LEFT_BOTTOM, text, font, ACCENT);
    }
}

/// A new picture in a view: in the middle of what it shows, as large as half of it.
pub(crate) fn placed(camera: &Camera, size: ViewSize, file: String) -> Option<ReferencePicture> {
    let plane = Plane::of_view(camera.direction)?;
    let centre = rounded(plane.drawn(camera.focus()));
    let width = rounded(DVec2::splat(0.5 * size.longer() * camera.metres_per_point(size))).x;
    Some(ReferencePicture {
        view: camera.direction.plane()?.to_owned(),
        file,
        centre: centre.to_array(),
        width: width.max(1e-5),
        opacity: 0.5,
        locked: false,
        hidden: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(view: &str) -> ReferencePicture {
        let (view, file) = (view.to_owned(), "a.png".to_owned());
        ReferencePicture { view, file, centre: [0.5, 1.0], width: 2.0, opacity: 0.5, locked: false, hidden: false }
    }

    #[test]
    fn the_upper_left_corner_of_a_picture_is_that_of_its_view() {
        // Twice as wide as high, so that it reaches one metre to each side and half a metre up and down.
        let corner = |view: &str| place(&picture(view), 2.0, 0.0, 0.0);
        assert_eq!(corner("front"), DVec2::new(-0.5, 1.5));
        assert_eq!(corner("side"), DVec2::new(-0.5, 1.5));
        // From above, z runs down the screen.
        assert_eq!(corner("top"), DVec2::new(-0.5, 0.5));
        for view in ["front", "side", "top"] {
            let held = picture(view);
            let mut camera = Camera::new(plane_of(&held).unwrap().view);
            camera.focus = [0.0, 0.0, 0.0];
            let size = ViewSize::new(egui::vec2(400.0, 300.0));
            let seen = |across, down| {
                camera.project(size, plane_of(&held).unwrap().place(place(&held, 2.0, across, down))).unwrap()
            };
            assert!(seen(0.0, 0.0).x < seen(1.0, 0.0).x && seen(0.0, 0.0).y < seen(0.0, 1.0).y, "{view}");
        }
    }
}
