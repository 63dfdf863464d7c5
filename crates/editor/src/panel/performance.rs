//! Where the time goes: a bar for each node, and the last evaluation as a timeline.

use std::time::Duration;

use egui::{Color32, Rect, RichText, Sense, Ui, pos2, vec2};

use crate::canvas::face::time;
use crate::command::ViewCommand;
use crate::panel::PanelContext;

pub(crate) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let Some(evaluation) = context.results.evaluation() else {
        ui.label(RichText::new("Nothing was evaluated yet.").weak());
        return;
    };
    ui.label(format!(
        "last evaluation: {}, {} ran, {} known",
        time(evaluation.duration),
        evaluation.run_count(),
        evaluation.hit_count()
    ));
    let mut asked = None;
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let mut rows: Vec<(&str, Duration, bool)> =
            evaluation.outcomes().map(|(_, outcome)| (outcome.name.as_str(), outcome.duration, outcome.ran)).collect();
        rows.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(b.0)));
        let longest = rows.first().map_or(1e-9, |row| row.1.as_secs_f64().max(1e-9));
        for (name, duration, ran) in rows {
            ui.horizontal(|ui| {
                let link = ui.add_sized([130.0, 16.0], egui::Link::new(name));
                if link.clicked() {
                    asked = Some(name.to_owned());
                }
                let width = (ui.available_width() - 70.0).max(10.0);
                let (rect, _) = ui.allocate_exact_size(vec2(width, 12.0), Sense::hover());
                #[expect(clippy::cast_possible_truncation, reason = "a share")]
                let share = (duration.as_secs_f64() / longest) as f32;
                let bar = Rect::from_min_size(rect.min, vec2(rect.width() * share, rect.height()));
                let colour = if ran { ui.visuals().selection.bg_fill } else { ui.visuals().weak_text_color() };
                ui.painter().rect_filled(bar, 2.0, colour);
                ui.label(RichText::new(time(duration)).size(11.0));
            });
        }
        timeline(ui, context);
    });
    if let Some(name) = asked {
        context.ask(ViewCommand::Find(name));
    }
}

/// What ran when: a lane for each that ran at the same time.
fn timeline(ui: &mut Ui, context: &PanelContext<'_>) {
    let spans = context.results.timeline();
    let Some(end) = spans.iter().map(|span| span.end).max().filter(|end| !end.is_zero()) else { return };
    ui.add_space(6.0);
    ui.label(RichText::new("timeline").weak());
    let mut lanes: Vec<Duration> = Vec::new();
    let placed: Vec<usize> = spans
        .iter()
        .map(|span| {
            let free = lanes.iter().position(|until| *until <= span.begin);
            let lane = free.unwrap_or(lanes.len());
            if lane == lanes.len() {
                lanes.push(span.end);
            } else {
                lanes[lane] = span.end;
            }
            lane
        })
        .collect();
    #[expect(clippy::cast_precision_loss, reason = "a few lanes")]
    let height = 16.0 * lanes.len() as f32;
    let (area, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    for (index, (span, lane)) in spans.iter().zip(placed).enumerate() {
        #[expect(clippy::cast_possible_truncation, reason = "a share")]
        let at = |time: Duration| area.left() + area.width() * (time.as_secs_f64() / end.as_secs_f64()) as f32;
        #[expect(clippy::cast_precision_loss, reason = "a few lanes")]
        let top = area.top() + 16.0 * lane as f32;
        let rect =
            Rect::from_min_max(pos2(at(span.begin), top), pos2(at(span.end).max(at(span.begin) + 1.5), top + 14.0));
        let hue = (index as f32 * 0.381_966).fract();
        ui.painter().rect_filled(rect, 2.0, Color32::from(egui::ecolor::Hsva::new(hue, 0.45, 0.65, 1.0)));
        let response = ui.interact(rect, ui.id().with(("span", index)), Sense::hover());
        response.on_hover_text(format!("{}: {} from {}", span.name, time(span.end - span.begin), time(span.begin)));
        if rect.width() > 50.0 {
            let text = ui.painter().with_clip_rect(rect);
            text.text(
                rect.left_center() + vec2(3.0, 0.0),
                egui::Align2::LEFT_CENTER,
                &span.name,
                egui::FontId::proportional(10.0),
                Color32::WHITE,
            );
        }
    }
}
