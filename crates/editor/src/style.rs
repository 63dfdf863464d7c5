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
    });
    for theme in [Theme::Dark, Theme::Light] {
        context.style_mut_of(theme, |style| {
            style.spacing.item_spacing = egui::vec2(6.0, 4.0);
            style.visuals.window_corner_radius = CornerRadius::same(5);
            style.visuals.menu_corner_radius = CornerRadius::same(5);
        });
    }
}
