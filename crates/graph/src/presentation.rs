//! What a graph holds for those who look at it, and no evaluation asks for: frames behind nodes, and reference pictures to
//! sketch over.

use serde::Deserialize;

use crate::graph::{Graph, GraphError, NodeId};

/// A titled rectangle behind the nodes of a canvas.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Frame {
    /// What stands on it; may be empty.
    #[serde(default)]
    pub title: String,
    /// Red, green and blue, sRGB from 0 to 1.
    pub colour: [f64; 3],
    /// Upper left corner, in points of the canvas as node positions are.
    pub at: [f64; 2],
    /// Width and height, points; above zero.
    pub size: [f64; 2],
}

/// A picture behind the strokes of a view.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReferencePicture {
    /// The plane it stands in, as sketches name theirs: `front`, `side` or `top`.
    pub view: String,
    /// Its file, seen from the folder of the graph.
    pub file: String,
    /// Its middle in the coordinates of a stroke of that plane, metres.
    pub centre: [f64; 2],
    /// How wide it is, metres; above zero. Its height follows from its pixels.
    pub width: f64,
    /// From 0, not seen, to 1, covering all behind it.
    #[serde(default = "half")]
    pub opacity: f64,
    /// Whether it stays where it is when the pointer drags it.
    #[serde(default)]
    pub locked: bool,
    /// Whether it is not drawn.
    #[serde(default)]
    pub hidden: bool,
}

fn half() -> f64 {
    0.5
}

/// Why a frame or a reference picture can't be as it is asked for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PresentationError {
    /// A number of a frame is not finite, or its size is nothing.
    #[error("frame {0} needs finite numbers, and a width and height above 0")]
    Frame(
        /// Its place among the frames, from 0.
        usize,
    ),
    /// A number of a picture is not finite or out of range.
    #[error("reference picture {0} needs finite numbers, a width above 0 m and an opacity from 0 to 1")]
    Numbers(
        /// Its place among the pictures, from 0.
        usize,
    ),
    /// There is no such plane.
    #[error("reference picture {index} stands in \"{view}\", which is no plane to sketch in: write front, side or top")]
    View {
        /// Its place among the pictures, from 0.
        index: usize,
        /// The plane that was asked for.
        view: String,
    },
}

impl Graph {
    /// The frames behind its nodes; later ones lie over earlier ones. [`crate::Edit::Frames`] changes them.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// The pictures behind its sketches. [`crate::Edit::References`] changes them.
    pub fn references(&self) -> &[ReferencePicture] {
        &self.references
    }

    pub(crate) fn replace_frames(&mut self, frames: &[Frame]) -> Result<Vec<Frame>, PresentationError> {
        check_frames(frames)?;
        Ok(std::mem::replace(&mut self.frames, frames.to_vec()))
    }

    pub(crate) fn replace_references(
        &mut self,
        references: &[ReferencePicture],
    ) -> Result<Vec<ReferencePicture>, PresentationError> {
        check_references(references)?;
        Ok(std::mem::replace(&mut self.references, references.to_vec()))
    }

    pub(crate) fn replace_collapsed(&mut self, id: NodeId, collapsed: bool) -> Result<bool, GraphError> {
        let node = self.nodes.get_mut(&id).ok_or(GraphError::NoSuchNode)?;
        Ok(std::mem::replace(&mut node.collapsed, collapsed))
    }
}

/// Asks whether frames can be drawn.
pub(crate) fn check_frames(frames: &[Frame]) -> Result<(), PresentationError> {
    let good = |frame: &Frame| {
        let numbers = frame.colour.iter().chain(&frame.at).chain(&frame.size);
        numbers.into_iter().all(|number| number.is_finite()) && frame.size.iter().all(|side| *side > 0.0)
    };
    frames.iter().position(|frame| !good(frame)).map_or(Ok(()), |index| Err(PresentationError::Frame(index)))
}

/// Asks whether pictures can be drawn.
pub(crate) fn check_references(references: &[ReferencePicture]) -> Result<(), PresentationError> {
    for (index, picture) in references.iter().enumerate() {
        let is_finite = picture.centre.iter().all(|number| number.is_finite()) && picture.width.is_finite();
        let is_seen = picture.width > 0.0 && (0.0..=1.0).contains(&picture.opacity);
        if !(is_finite && is_seen) {
            return Err(PresentationError::Numbers(index));
        }
        if !matches!(picture.view.as_str(), "front" | "side" | "top") {
            return Err(PresentationError::View { index, view: picture.view.clone() });
        }
    }
    Ok(())
}
