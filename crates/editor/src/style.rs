//! How everything looks: egui's own styles, with contrast where it is needed.

use egui::{Color32, Context, CornerRadius, Theme};

/// Applies it to light and dark.
pub(crate) fn apply(context: &Context) {
    context.style_mut_of(Theme::Dark, |style| {
        let visuals = &mut style.visuals;
        visuals.panel_fill = Color32::from_rgb(31, 33, 38);
        visuals.window_fill = Color32::from_rgb(38, 41, 47);
        visuals.extreme_bg_color = Color32::from_rgb(20, 21, 25);
        visuals.override_text_color = Some(Color32::from_rgb(222, 225, 230));
        visuals.selection.bg_fill = Color32::from_rgb(38, 92, 150);
        visuals.selection.stroke.color = Color32::from_rgb(255, 176, 66);
        visuals.error_fg_color = Color32::from_rgb(255, 112, 100);
    });
    context.style_mut_of(Theme::Light, |style| {
        let visuals = &mut style.visuals;
        visuals.override_text_color = Some(Color32::from_rgb(28, 30, 34));
        visuals.selection.stroke.color = Color32::from_rgb(190, 96, 0);
        visuals.error_fg_color = Color32::from_rgb(180, 20, 20);
        visuals.warn_fg_color = Color32::from_rgb(140, 80, 0);
        visuals.hyperlink_color = Color32::from_rgb(0, 86, 160);
        visuals.weak_text_color = Some(Color32::from_rgb(88, 91, 97));
    });
    for theme in [Theme::Dark, Theme::Light] {
        context.style_mut_of(theme, |style| {
            style.spacing.item_spacing = egui::vec2(6.0, 4.0);
            style.visuals.window_corner_radius = CornerRadius::same(5);
            style.visuals.menu_corner_radius = CornerRadius::same(5);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::frames;

    /// Luminance after WCAG 2, of a colour without transparency.
    fn luminance(colour: Color32) -> f64 {
        let linear = |byte: u8| {
            let share = f64::from(byte) / 255.0;
            if share <= 0.040_45 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b())
    }

    fn contrast(text: Color32, background: Color32) -> f64 {
        let [a, b] = [background.blend(text), background].map(luminance);
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn black_on_white_is_the_highest_contrast() {
        assert!((contrast(Color32::BLACK, Color32::WHITE) - 21.0).abs() < 1e-6);
        assert!((contrast(Color32::from_gray(118), Color32::WHITE) - 4.54).abs() < 0.01);
    }

    #[test]
    fn every_text_can_be_read_on_what_is_behind_it_in_light_and_dark() {
        let context = Context::default();
        apply(&context);
        let mut wrong = Vec::new();
        for theme in [Theme::Dark, Theme::Light] {
            let style = context.style_of(theme);
            let visuals = &style.visuals;
            let backgrounds = [
                ("panel", visuals.panel_fill),
                ("window and node", visuals.window_fill),
                ("field", visuals.extreme_bg_color),
                ("canvas", visuals.extreme_bg_color.blend(visuals.widgets.noninteractive.bg_fill)),
                ("striped row", visuals.panel_fill.blend(visuals.faint_bg_color)),
                ("view", crate::viewport::draw::background(visuals.dark_mode)),
            ];
            let mut texts = vec![
                ("text", visuals.text_color()),
                ("weak text", visuals.weak_text_color()),
                ("strong text", visuals.strong_text_color()),
                ("link", visuals.hyperlink_color),
                ("error", visuals.error_fg_color),
                ("warning", visuals.warn_fg_color),
            ];
            texts.extend(crate::canvas::face::status_colours(visuals).map(|colour| ("status", colour)));
            for (text, colour) in &texts {
                for (behind, background) in backgrounds {
                    let found = contrast(*colour, background);
                    if found < 4.5 {
                        wrong.push(format!("{theme:?}: {text} on {behind}: {found:.2}"));
                    }
                }
            }
            let mut pair = |what: &str, text: Color32, background: Color32| {
                let found = contrast(text, background);
                if found < 4.5 {
                    wrong.push(format!("{theme:?}: {what}: {found:.2}"));
                }
            };
            let button = visuals.panel_fill.blend(visuals.widgets.inactive.weak_bg_fill);
            pair("button", visuals.text_color(), button);
            pair(
                "hovered button",
                visuals.text_color(),
                visuals.panel_fill.blend(visuals.widgets.hovered.weak_bg_fill),
            );
            pair("what is chosen", visuals.text_color(), visuals.panel_fill.blend(visuals.selection.bg_fill));
            for (colour, name) in frames::COLOURS {
                let frame = maquette_graph::Frame { title: String::new(), colour, at: [0.0; 2], size: [1.0; 2] };
                let behind = visuals.window_fill.blend(frames::fill_of(&frame));
                pair(&format!("title of a {name} frame"), visuals.strong_text_color(), behind);
            }
        }
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}
