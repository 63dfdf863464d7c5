//! **Import curves**: contours and sections from JSON, paths from SVG.

use glam::DVec2;
use maquette_geometry::curve::{ArcLength, Curve};
use maquette_geometry::file_format::{FileFormat, ReadError, curves_json, svg};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::anchor::Anchor;
use crate::view_plane::ViewPlane;
use crate::wire;

/// The lower left and the upper right corner of paths, in SVG units, y down; none where there are no points.
fn extent(paths: &[svg::Path2d]) -> Option<[DVec2; 2]> {
    let points = paths.iter().flat_map(|path| &path.points).map(|p| [*p, *p]);
    let bounds = points.reduce(|[low, high], [p, _]| [p.min(low), p.max(high)]);
    bounds.map(|[low, high]| [DVec2::new(low.x, high.y), DVec2::new(high.x, low.y)])
}

/// Metres of a pixel: SVG has 96 of them an inch.
const LIFE_SIZE: f64 = 0.0254 / 96.0;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "import-curves",
        1,
        "input",
        "Curves of a file: contours or sections as JSON, or the paths of an SVG drawing placed on a view plane. The JSON is \
         {\"contours\": [{\"name\": \"left\", \"closed\": false, \"points\": [[x, y, z], ..]}]}, metres.",
    );
    let file = node.file("file", &["json", "svg"], "The file, .json or .svg.");
    let plane = node.choice::<ViewPlane>("plane", "SVG: the plane on which the drawing is placed.");
    let offset = node.length("offset", 0.0, -1e4..=1e4, "SVG: place of the plane along the axis across it.");
    node.soft_range(offset, -1.0..=1.0);
    let scale = node.length(
        "scale",
        LIFE_SIZE,
        1e-9..=1e6,
        "SVG: length of one pixel of the drawing, of which 96 make an inch; by default it comes in life-size.",
    );
    node.soft_range(scale, 1e-4..=0.1);
    let anchor = node.choice::<Anchor>("anchor", "SVG: which point of the drawing lies on the plane's origin.");
    let tolerance =
        node.length("tolerance", 1e-4, 1e-9..=1.0, "SVG: largest distance of the points' polyline from the true path.");
    node.soft_range(tolerance, 1e-5..=1e-2);
    let curves = node.output::<wire::Curves>("curves", "The curves in the order of the file, with their names.");
    let found = node.table(
        "curves",
        &[("curve", Unit::None), ("closed", Unit::None), ("points", Unit::None), ("length", Unit::Length)],
        "The curves of the file.",
    );
    node.reads_file(file);
    node.evaluate(move |ports| {
        let path = ports.path(file)?;
        let bytes = ports.file(file)?;
        let imported: Vec<Curve> = match FileFormat::from_path(&path.to_string_lossy()).at(file)? {
            FileFormat::Json => match curves_json::read_while(&bytes, &ports.progress_callback()) {
                Err(ReadError::Stopped) => return Err(NodeError::Cancelled),
                curves => curves.at(file)?,
            },
            FileFormat::Svg => {
                let (plane, offset, scale) = (ports.choice(plane), ports.value(offset), ports.value(scale));
                let paths = svg::read(&bytes, ports.value(tolerance) / scale).at(file)?;
                let anchor = ports.choice(anchor).of(DVec2::ZERO, extent(&paths));
                let placed = paths.iter().enumerate().map(|(index, path)| {
                    let name = if path.name.is_empty() { format!("path {index}") } else { path.name.clone() };
                    // SVG's y runs down.
                    let drawn = path.points.iter().map(|p| (*p - anchor) * DVec2::new(scale, -scale));
                    Curve::new(name, drawn.map(|p| plane.place(p, offset)).collect(), path.closed)
                });
                placed.collect::<Result<_, _>>().at(file)?
            }
            other => {
                let message = format!("curves come from .json or .svg files, not from .{}", other.extension());
                return Err(message).at(file);
            }
        };
        let row = |curve: &Curve| {
            let length = ArcLength::of(curve).length();
            vec![curve.name().into(), curve.is_closed().into(), curve.points().len().into(), length.into()]
        };
        ports.table(found, imported.iter().map(row).collect());
        ports.write(curves, wire::Curves(imported));
        Ok(())
    });
    node
}
