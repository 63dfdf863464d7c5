//! **Trace image**: outlines of a shape in a reference picture, as closed strokes in a view plane.

use glam::DVec2;
use maquette_geometry::curve::{ArcLength, Curve};
use maquette_geometry::file_format::picture::{self, Channel, PictureError};
use maquette_geometry::outline::{Calming, Keep, Outline, OutlineError, Tracing, calmed, trace_while};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::anchor::Anchor;
use crate::view_plane::ViewPlane;
use crate::wire;

#[derive(Clone, Copy)]
struct ChannelChoice(Channel);

impl Choices for ChannelChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Channel::Dark), "dark", "what is dark: a drawing on paper; transparent pixels count as white"),
        (Self(Channel::Light), "light", "what is light: luminance; transparent pixels count as black"),
        (Self(Channel::Alpha), "alpha", "what is opaque, whatever its colour"),
    ];
}

#[derive(Clone, Copy)]
struct KeepChoice(Keep);

impl Choices for KeepChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Keep::Largest), "largest", "the outline that encloses most"),
        (Self(Keep::All), "all", "all that enclose at least `least-area`"),
    ];
}

/// The lower left and the upper right corner of outlines, in pixels, y up.
fn extent(outlines: &[Curve]) -> Option<[DVec2; 2]> {
    let bounds = outlines.iter().map(|outline| {
        let (low, high) = outline.bounds();
        [low.truncate(), high.truncate()]
    });
    bounds.reduce(|[low, high], [l, h]| [low.min(l), high.max(h)])
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "trace-image",
        2,
        "input",
        "Outlines of a shape in a picture (PNG, JPEG), as closed curves on a view plane: counter-clockwise around the shape \
         as the picture shows it, clockwise around its holes.",
    );
    node.reference("thesis 5.1");
    let file = node.file(
        "file",
        &["png", "jpg", "jpeg"],
        "The picture, .png or .jpg, as it was held; up to 8 million pixels.",
    );
    let channel = node.choice::<ChannelChoice>("channel", "What of the picture is the shape.");
    let threshold = node.number(
        "threshold",
        0.5,
        0.01..=0.99,
        "How dark, light or opaque a pixel of the shape is at least; between pixels, the outline is where this is passed.",
    );
    let keep = node.choice::<KeepChoice>("keep", "Which outlines are kept.");
    let holes = node.boolean("holes", true, "Keep the holes of the outlines that are kept, as curves of their own.");
    let least_area = node.number(
        "least-area",
        16.0,
        0.0..=1e7,
        "Outlines and holes that enclose fewer pixels are left out: specks.",
    );
    node.soft_range(least_area, 0.0..=1000.0);
    let smooth = node.number(
        "smooth",
        6.0,
        0.0..=1000.0,
        "Bends of this many pixels are halved, so that the steps between pixels go; corners stay. 0 smooths nothing.",
    );
    node.soft_range(smooth, 0.0..=50.0);
    let corner_angle =
        node.angle("corner-angle", 45.0, 1.0..=179.0, "Turns by more than this are corners, which stay.");
    let tolerance = node.length(
        "tolerance",
        0.0005,
        0.0..=10.0,
        "Points go that are not needed to keep the smoothed outline this close; 0 keeps all.",
    );
    node.soft_range(tolerance, 0.0..=0.01);
    let plane = node.choice::<ViewPlane>("plane", "The plane on which the outlines are placed.");
    let offset = node.length("offset", 0.0, -1e4..=1e4, "Place of the plane along the axis across it.");
    node.soft_range(offset, -1.0..=1.0);
    let pixel = node.length("scale", 0.001, 1e-9..=1e6, "Length of one pixel of the picture.");
    node.soft_range(pixel, 1e-4..=0.01);
    let anchor = node.choice::<Anchor>("anchor", "Which point of the picture lies on the plane's origin.");
    let curves = node.output::<wire::Curves>("curves", "The outlines, larger ones first, each followed by its holes.");
    let found = node.table(
        "outlines",
        &[
            ("curve", Unit::None),
            ("hole", Unit::None),
            ("points", Unit::None),
            ("length", Unit::Length),
            ("width", Unit::Length),
            ("height", Unit::Length),
        ],
        "Each outline and hole with its size on the plane.",
    );
    node.reads_file(file);
    node.evaluate(move |ports| {
        let bytes = ports.file(file)?;
        let go_on = ports.progress_callback();
        ports.progress(0.0)?;
        let mask = match picture::read(&bytes, ports.choice(channel).0) {
            Err(error @ PictureError::NoAlpha) => Err(error).at(channel)?,
            mask => mask.at(file)?,
        };
        let tracing = Tracing {
            threshold: ports.value(threshold),
            keep: ports.choice(keep).0,
            holes: ports.value(holes),
            least_area: ports.value(least_area),
        };
        let traced = match trace_while(&mask, &tracing, &|share| go_on(0.3 + 0.5 * share)) {
            Err(OutlineError::Stopped) => return Err(NodeError::Cancelled),
            Err(error @ (OutlineError::Nothing { .. } | OutlineError::Everything { .. })) => {
                Err(error).at(threshold)?
            }
            Err(error @ OutlineError::TooSmall { .. }) => Err(error).at(least_area)?,
            traced => traced.at(file)?,
        };
        let scale = ports.value(pixel);
        let calming = Calming {
            wave: ports.value(smooth),
            corner_angle: ports.value(corner_angle).to_radians(),
            tolerance: ports.value(tolerance) / scale,
        };
        let mut calm = Vec::with_capacity(traced.len());
        for outline in &traced {
            ports.progress(0.8 + 0.2 * calm.len() as f64 / traced.len() as f64)?;
            calm.push(calmed(&outline.curve, &calming).at(file)?);
        }
        let cut_off = traced.iter().filter(|outline| outline.cut_off).count();
        if cut_off > 0 {
            ports.warn(format!(
                "{cut_off} outline(s) run along the edge of the picture: what lies beyond is missing; leave a margin \
                 around the shape"
            ));
        }
        let plane = ports.choice(plane);
        let offset = ports.value(offset);
        let anchor = ports.choice(anchor).of(DVec2::new(0.0, mask.height() as f64), extent(&calm));
        let place = |outline: &Curve| outline.map(|p| plane.place((p.truncate() - anchor) * scale, offset));
        let placed: Vec<Curve> = calm.iter().map(place).collect::<Result<_, _>>().at(pixel)?;
        let row = |((flat, placed), traced): ((&Curve, &Curve), &Outline)| {
            let (low, high) = flat.bounds();
            let size = (high - low) * scale;
            vec![
                placed.name().into(),
                traced.hole_in.is_some().into(),
                placed.points().len().into(),
                ArcLength::of(placed).length().into(),
                size.x.into(),
                size.y.into(),
            ]
        };
        ports.table(found, calm.iter().zip(&placed).zip(&traced).map(row).collect());
        ports.write(curves, wire::Curves(placed));
        ports.progress(1.0)?;
        Ok(())
    });
    node
}

#[cfg(test)]
mod tests {
    use super::*;
    use maquette_graph::Literal;
    use maquette_graph::harness::{Harness, TrialError};

    const SOLE: &[u8] = include_bytes!("../../../../graphs/data/pictures/sole.png");

    fn fault(content: &'static [u8], settings: &[(&str, Literal)]) -> (Option<String>, String) {
        let kind = kind();
        let mut harness = Harness::new(&kind).file("file", "sole.png", content);
        for (input, literal) in settings {
            harness = harness.set(input, literal.clone());
        }
        match harness.run().unwrap_err() {
            TrialError::Failed(failure) => (failure.port, failure.message),
            stopped => panic!("{stopped}"),
        }
    }

    #[test]
    fn faults_lie_at_the_input_that_mends_them() {
        let choice = |name: &str| Literal::Choice(name.to_owned());
        let number = Literal::Number;
        for (content, settings, port, said) in [
            (SOLE, vec![("channel", choice("alpha"))], "channel", "no alpha channel"),
            (SOLE, vec![("least-area", number(1e6))], "least-area", "lower the least area"),
            (&SOLE[..400], vec![], "file", "export it again"),
            (b"GIF89a".as_slice(), vec![], "file", "no PNG and no JPEG"),
            (b"".as_slice(), vec![], "file", "is empty"),
        ] {
            let (at, message) = fault(content, &settings);
            assert!(at.as_deref() == Some(port) && message.contains(said), "{at:?}: {message}");
        }
    }
}
