//! Signs on buttons and nodes, each of which the fonts must have.

macro_rules! signs {
    ($($(#[$doc:meta])* $name:ident = $sign:literal;)*) => {
        $($(#[$doc])* pub(crate) const $name: &str = $sign;)*
        /// All of them.
        #[cfg(test)]
        const ALL: &[&str] = &[$($sign),*];
    };
}

signs! {
    /// Back to the default.
    RESET = "⟲";
    /// Makes a parameter.
    PROMOTE = "⏶";
    /// Where a link comes from.
    FROM = "⏴";
    /// Throws away.
    REMOVE = "🗑";
    /// Shows alone.
    DISPLAY = "👁";
    /// Shows always.
    PIN = "★";
    /// Shows more.
    EXPAND = "☰";
    /// Goes into a graph.
    ENTER = "⏵";
    /// Chooses a file.
    BROWSE = "…";
    /// An error.
    ERROR = "×";
    /// A warning.
    WARNING = "!";
    /// Runs the other way.
    REVERSE = "⬌";
    /// Turns into its mirror image.
    MIRROR = "◑";
    /// Joins its end and its beginning.
    CLOSE = "○";
    /// Sorted with the largest first.
    DOWN = "⏷";
    /// Sorted with the smallest first.
    UP = "⏶";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fonts_have_every_sign() {
        let context = egui::Context::default();
        context.run_ui(egui::RawInput::default(), |_| {}).textures_delta.clear();
        let lacks =
            |sign: &&&str| !context.fonts_mut(|fonts| fonts.has_glyphs(&egui::FontId::proportional(12.0), sign));
        let missing: Vec<_> = ALL.iter().filter(lacks).collect();
        assert!(missing.is_empty(), "{missing:?}");
    }
}
