//! Which point of a flat picture comes to lie on the origin of the plane on which it is placed.

use glam::DVec2;
use maquette_graph::Choices;

/// The point of a picture or drawing that lies on the plane's origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    BottomCentre,
    Centre,
    Page,
}

impl Choices for Anchor {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::BottomCentre, "bottom-centre", "the middle of the lower edge of what is drawn"),
        (Self::Centre, "centre", "the middle of what is drawn"),
        (Self::Page, "page", "the upper left corner of the page or picture; what is drawn hangs below it"),
    ];
}

impl Anchor {
    /// Where it is, in the coordinates of the picture, whether their y runs up or down.
    ///
    /// `page` is the page's upper left corner; `drawn` the lower left and the upper right corner of all that is drawn,
    /// where anything is.
    pub(crate) fn of(self, page: DVec2, drawn: Option<[DVec2; 2]>) -> DVec2 {
        match (self, drawn) {
            (Self::Page, _) | (_, None) => page,
            (Self::Centre, Some([low, high])) => (low + high) / 2.0,
            (Self::BottomCentre, Some([low, high])) => DVec2::new((low.x + high.x) / 2.0, low.y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_anchor_is_a_point_of_the_page_or_of_what_is_drawn() {
        // A page of 10 by 20 whose y runs down.
        let (page, drawn) = (DVec2::ZERO, Some([DVec2::new(1.0, 18.0), DVec2::new(5.0, 6.0)]));
        assert_eq!(Anchor::BottomCentre.of(page, drawn), DVec2::new(3.0, 18.0));
        assert_eq!(Anchor::Centre.of(page, drawn), DVec2::new(3.0, 12.0));
        assert_eq!(Anchor::Page.of(page, drawn), page);
        // The same with y up.
        let (page, drawn) = (DVec2::new(0.0, 20.0), Some([DVec2::new(1.0, 2.0), DVec2::new(5.0, 14.0)]));
        assert_eq!(Anchor::BottomCentre.of(page, drawn), DVec2::new(3.0, 2.0));
        assert_eq!(Anchor::Centre.of(page, drawn), DVec2::new(3.0, 8.0));
        assert_eq!(Anchor::Page.of(page, drawn), page);
        for anchor in Anchor::OPTIONS {
            assert_eq!(anchor.0.of(page, None), page);
        }
    }
}
