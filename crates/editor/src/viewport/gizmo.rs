//! The axes in the corner of a view: they say which way is which, and turn the free view when they are clicked.

use egui::{Color32, FontId, Pos2, Rect, Sense, Stroke, vec2};

use super::camera::{Camera, Direction};
use super::draw::AXES;

const REACH: f32 = 26.0;

/// Draws the axes into the upper right corner.
pub(crate) fn show(ui: &mut egui::Ui, rect: Rect, camera: &mut Camera) {
    if rect.width() < 140.0 || rect.height() < 110.0 {
        return;
    }
    let middle = rect.right_top() + vec2(-REACH - 16.0, REACH + 16.0);
    let [right, up, back] = camera.frame();
    // From the farthest to the nearest, so that nearer ones lie over others.
    let mut tips: Vec<(f64, usize, bool)> =
        (0..3).flat_map(|axis| [(back[axis], axis, true), (-back[axis], axis, false)]).collect();
    tips.sort_by(|a, b| a.0.total_cmp(&b.0));
    let names = ["X", "Y", "Z"];
    for (towards, axis, positive) in tips {
        let sign = if positive { 1.0 } else { -1.0 };
        #[expect(clippy::cast_possible_truncation, reason = "points of the screen")]
        let offset = vec2((right[axis] * sign) as f32, (-up[axis] * sign) as f32) * REACH;
        let tip: Pos2 = middle + offset;
        let [r, g, b, _] = AXES[axis];
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let colour = Color32::from_rgb((r * 255.0) as u8, (g * 255.0) as u8, (b * 255.0) as u8);
        let free = camera.direction == Direction::Free;
        let flat = towards.abs() > 0.99 && !free;
        if flat {
            continue;
        }
        if positive {
            ui.painter().line_segment([middle, tip], Stroke::new(2.0, colour));
            ui.painter().circle_filled(tip, 7.5, colour);
            ui.painter().text(
                tip,
                egui::Align2::CENTER_CENTER,
                names[axis],
                FontId::proportional(10.0),
                Color32::BLACK,
            );
        } else {
            ui.painter().circle(tip, 5.0, colour.gamma_multiply(0.35), Stroke::new(1.0, colour));
        }
        if free {
            let id = ui.id().with(("gizmo", axis, positive));
            let response = ui.interact(Rect::from_center_size(tip, vec2(15.0, 15.0)), id, Sense::click());
            let label = format!("look from {}{}", if positive { "+" } else { "-" }, names[axis]);
            response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &label));
            if response.on_hover_text(&label).clicked() {
                let quarter = std::f64::consts::FRAC_PI_2;
                (camera.turn, camera.rise) = match (axis, positive) {
                    (0, true) => (quarter, 0.0),
                    (0, false) => (-quarter, 0.0),
                    (1, true) => (0.0, 1.55),
                    (1, false) => (0.0, -1.55),
                    (_, true) => (0.0, 0.0),
                    (_, false) => (2.0 * quarter, 0.0),
                };
            }
        }
    }
}
