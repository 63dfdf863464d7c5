//! What came out of a variant: what the table shows and the record keeps.

use glam::DVec3;
use maquette_graph::{Evaluation, NodeId, OutcomeState};
use maquette_nodes::wire;
use serde::{Deserialize, Serialize};

/// How it stands with a variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum State {
    /// Evaluated, and written where it is to be written.
    Done,
    /// Finished by an earlier call, and still there.
    Kept,
    /// A node failed.
    Failed,
    /// A figure is beyond a `--fail-if` limit.
    Exceeded,
    /// A file could not be written.
    NotWritten,
    /// Not reached, because the wedge was stopped.
    Stopped,
    /// Not evaluated, because only a list was asked for.
    Listed,
}

impl State {
    /// Its name in tables.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Kept => "kept",
            Self::Failed => "failed",
            Self::Exceeded => "exceeded",
            Self::NotWritten => "not-written",
            Self::Stopped => "stopped",
            Self::Listed => "listed",
        }
    }
}

/// What became of a variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Row {
    /// Its place in the order in which it was asked for, from 1.
    pub(super) index: usize,
    /// The value of each address.
    pub(super) values: Vec<String>,
    pub(super) state: State,
    /// Time of the evaluation.
    pub(super) seconds: f64,
    /// Nodes that ran.
    pub(super) ran: usize,
    /// Nodes in whose place the memo answered.
    pub(super) hits: usize,
    pub(super) results: Vec<ResultRow>,
    pub(super) figures: Vec<FigureRow>,
    pub(super) files: Vec<FileRow>,
    pub(super) warnings: Vec<String>,
    pub(super) errors: Vec<String>,
}

/// A result of the graph.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct ResultRow {
    pub(super) name: String,
    /// Smallest and largest coordinates, metres.
    pub(super) bounds: Option<[[f64; 3]; 2]>,
    #[serde(flatten)]
    pub(super) size: Size,
}

/// How large a result is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub(super) enum Size {
    Mesh { vertices: usize, faces: usize },
    Curves { curves: usize, points: usize },
}

/// A number that a node measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct FigureRow {
    pub(super) node: String,
    pub(super) name: String,
    #[serde(with = "any_number")]
    pub(super) value: f64,
    pub(super) unit: String,
}

/// A file that was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct FileRow {
    pub(super) path: String,
    pub(super) bytes: usize,
    /// Hash of its content, 32 hexadecimal digits.
    pub(super) hash: String,
}

impl Row {
    /// A variant that was not evaluated.
    pub(super) fn unreached(index: usize, values: Vec<String>, state: State) -> Self {
        Self {
            index,
            values,
            state,
            seconds: 0.0,
            ran: 0,
            hits: 0,
            results: Vec::new(),
            figures: Vec::new(),
            files: Vec::new(),
            warnings: Vec::new(),
            errors: Vec::new(),
        }
    }

    /// The box around all results that are drawn: curves count where there is no mesh.
    pub(super) fn bounds(&self) -> Option<[DVec3; 2]> {
        let meshes = self.has_mesh();
        let drawn = self.results.iter().filter(|result| !meshes || matches!(result.size, Size::Mesh { .. }));
        let boxes = drawn.filter_map(|result| result.bounds).map(|bounds| bounds.map(DVec3::from_array));
        boxes.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// Whether a result is a mesh.
    pub(super) fn has_mesh(&self) -> bool {
        self.results.iter().any(|result| matches!(result.size, Size::Mesh { vertices: 1.., .. }))
    }

    /// Takes over what an evaluation gave.
    pub(super) fn measure(&mut self, evaluation: &Evaluation, targets: &[NodeId]) {
        self.seconds = evaluation.duration.as_secs_f64();
        self.ran = evaluation.run_count();
        self.hits = evaluation.hit_count();
        self.results = results(evaluation, targets);
        let done = evaluation.outcomes().filter_map(|(_, outcome)| match &outcome.state {
            OutcomeState::Done { report, .. } => Some((outcome, report)),
            _ => None,
        });
        let figures = done.flat_map(|(outcome, report)| {
            report.figures.iter().map(|figure| FigureRow {
                node: outcome.name.clone(),
                name: figure.name.clone(),
                value: figure.value,
                unit: figure.unit.to_string(),
            })
        });
        self.figures = figures.collect();
    }
}

fn results(evaluation: &Evaluation, targets: &[NodeId]) -> Vec<ResultRow> {
    let named = targets.iter().filter_map(|target| Some((evaluation.outcome(*target)?, evaluation.values(*target)?)));
    let values = named.flat_map(|(outcome, values)| values.iter().map(|value| (outcome.name.clone(), value)));
    let result = |(name, value): (String, &maquette_graph::Value)| {
        if let Some(result) = value.get::<wire::MeshResult>() {
            let positions = result.mesh.positions();
            let size = Size::Mesh { vertices: positions.len(), faces: result.mesh.polygon_count() };
            return Some(ResultRow { name, bounds: bounds(positions.iter().copied()), size });
        }
        let result = value.get::<wire::CurvesResult>()?;
        let points = result.curves.iter().flat_map(|curve| curve.points().iter().copied());
        let size = Size::Curves { curves: result.curves.len(), points: points.clone().count() };
        Some(ResultRow { name, bounds: bounds(points), size })
    };
    values.filter_map(result).collect()
}

fn bounds(points: impl Iterator<Item = DVec3>) -> Option<[[f64; 3]; 2]> {
    let (low, high) = points.map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    Some([low.to_array(), high.to_array()])
}

/// Numbers that JSON has no form for are written as texts: `"NaN"`, `"inf"`.
mod any_number {
    use serde::{Deserialize, Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        if value.is_finite() { serializer.serialize_f64(*value) } else { serializer.serialize_str(&value.to_string()) }
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Number {
            Finite(f64),
            Named(String),
        }
        match Number::deserialize(deserializer)? {
            Number::Finite(value) => Ok(value),
            Number::Named(name) => name.parse().map_err(serde::de::Error::custom),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_read_back_whatever_was_measured() {
        let figure = |value| FigureRow { node: "n".into(), name: "gap".into(), value, unit: "m".into() };
        let mut row = Row::unreached(3, vec!["0.5".into()], State::Done);
        row.figures = [0.25, 1e-300, f64::INFINITY, f64::NEG_INFINITY].map(figure).into();
        row.results = vec![
            ResultRow {
                name: "vest".into(),
                bounds: Some([[0.0; 3], [1.0; 3]]),
                size: Size::Mesh { vertices: 8, faces: 6 },
            },
            ResultRow { name: "lines".into(), bounds: None, size: Size::Curves { curves: 0, points: 0 } },
        ];
        row.files = vec![FileRow { path: "a.glb".into(), bytes: 3, hash: "00".into() }];
        let text = serde_json::to_string(&row).unwrap();
        assert_eq!(serde_json::from_str::<Row>(&text).unwrap(), row);
        row.figures = vec![figure(f64::NAN)];
        let read: Row = serde_json::from_str(&serde_json::to_string(&row).unwrap()).unwrap();
        assert!(read.figures[0].value.is_nan());
    }

    #[test]
    fn curves_count_for_the_bounds_where_there_is_no_mesh() {
        let result = |size, end| ResultRow { name: "r".into(), bounds: Some([[0.0; 3], [end; 3]]), size };
        let mut row = Row::unreached(1, vec![], State::Done);
        assert_eq!(row.bounds(), None);
        row.results.push(result(Size::Curves { curves: 1, points: 2 }, 5.0));
        assert_eq!(row.bounds(), Some([DVec3::ZERO, DVec3::splat(5.0)]));
        row.results.push(result(Size::Mesh { vertices: 8, faces: 6 }, 1.0));
        assert_eq!(row.bounds(), Some([DVec3::ZERO, DVec3::ONE]));
    }
}
