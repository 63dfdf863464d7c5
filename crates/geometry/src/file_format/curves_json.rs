//! Curves as JSON: drawn contours and cross-sections.
//!
//! ```json
//! {"units": "metre", "contours": [{"name": "left", "closed": false, "points": [[0.05, 1.46, 0.049], [0.051, 1.47, 0.049]]}]}
//! ```
//!
//! A list `sections` of the same shape is read like `contours`; its entries need no name.

use glam::DVec3;
use serde_json::Value;

use super::ReadError;
use super::pace::Pace;
use crate::curve::Curve;

const FORMAT: &str = "curves JSON";

/// The curves of a file: its `contours`, then its `sections`, in order.
///
/// Each entry is an object with `points` (a list of `[x, y, z]` in metres), `closed` (open where it is left out), and
/// optionally a `name` and the pen's `pressure`, one number a point. Contours without a name are `contour 0`,
/// `contour 1`, ..; sections likewise. Other fields are ignored.
///
/// # Errors
/// [`ReadError`] where the bytes are empty or no JSON, the units are not metres, there is no curve, or an entry does not
/// make a curve; messages name the entry and the point.
pub fn read(bytes: &[u8]) -> Result<Vec<Curve>, ReadError> {
    read_while(bytes, &|_| true)
}

/// The same, calling `progress` with the fraction done.
///
/// # Errors
/// As [`read`], and [`ReadError::Stopped`] where `progress` answers `false`.
pub fn read_while(bytes: &[u8], progress: &dyn Fn(f64) -> bool) -> Result<Vec<Curve>, ReadError> {
    if bytes.is_empty() {
        return Err(ReadError::Empty { format: FORMAT });
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut pace = Pace::new(progress, 2 * bytes.len(), BYTES);
    let reader = std::io::BufReader::with_capacity(BYTES, Watched { bytes, read: 0, pace: &mut pace });
    let document: Value = serde_json::from_reader(reader).map_err(|error| match error.is_io() {
        true => ReadError::Stopped,
        false => malformed(format!("line {}, column {}", error.line(), error.column()), error.to_string()),
    })?;
    let Value::Object(fields) = &document else {
        return Err(malformed("top level", expected("an object with a list \"contours\" or \"sections\"", &document)));
    };
    if let Some(units) = fields.get("units")
        && !matches!(units.as_str(), Some("metre" | "metres" | "meter" | "meters" | "m"))
    {
        return Err(malformed("\"units\"", expected("\"metre\"", units)));
    }
    let mut curves = Vec::new();
    for (list, singular) in [("contours", "contour"), ("sections", "section")] {
        let Some(entries) = fields.get(list) else { continue };
        let Value::Array(entries) = entries else {
            return Err(malformed(format!("\"{list}\""), expected("a list", entries)));
        };
        for (index, entry) in entries.iter().enumerate() {
            pace.at(bytes.len() + index * bytes.len() / entries.len())?;
            curves.push(curve(entry, &format!("{singular} {index}"))?);
        }
    }
    if curves.is_empty() {
        return Err(ReadError::Nothing {
            format: FORMAT,
            what: "curve",
            remedy: "it needs a list \"contours\" or \"sections\" with at least one entry",
        });
    }
    Ok(curves)
}

/// Bytes between two questions whether to go on.
const BYTES: usize = 1 << 16;

/// Hands bytes to the parser, which can't be stopped otherwise.
struct Watched<'a, 'p> {
    bytes: &'a [u8],
    read: usize,
    pace: &'a mut Pace<'p>,
}

impl std::io::Read for Watched<'_, '_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.pace.at(self.read).map_err(std::io::Error::other)?;
        let count = std::io::Read::read(&mut &self.bytes[self.read..], buffer)?;
        self.read += count;
        Ok(count)
    }
}

/// Curves as such a file: a list of `contours`, one a line, with all digits of their points and their pressure where
/// they have one. [`read`] gives equal curves back, except that those without a name come back with one.
pub fn write(curves: &[Curve]) -> Vec<u8> {
    let contours: Vec<String> = curves
        .iter()
        .map(|curve| {
            let points: Vec<Value> = curve.points().iter().map(|p| Value::from(p.to_array().to_vec())).collect();
            let name = match curve.name() {
                "" => String::new(),
                name => format!("\"name\":{},", Value::from(name)),
            };
            let pressure = match curve.pressure() {
                Some(pressure) => format!(",\"pressure\":{}", Value::from(pressure.to_vec())),
                None => String::new(),
            };
            format!("{{{name}\"closed\":{},\"points\":{}{pressure}}}", curve.is_closed(), Value::from(points))
        })
        .collect();
    format!("{{\"units\":\"metre\",\"contours\":[\n{}\n]}}\n", contours.join(",\n")).into_bytes()
}

fn malformed(place: impl Into<String>, problem: impl Into<String>) -> ReadError {
    ReadError::Malformed { format: FORMAT, place: place.into(), problem: problem.into() }
}

/// "expected .., found ..", with the beginning of what was found.
fn expected(what: &str, found: &Value) -> String {
    let kind = match found {
        Value::Null => "null".to_owned(),
        Value::Bool(value) => value.to_string(),
        Value::Number(value) => value.to_string(),
        Value::String(value) => format!("\"{}\"", value.chars().take(24).collect::<String>()),
        Value::Array(values) => format!("a list of {}", values.len()),
        Value::Object(_) => "an object".to_owned(),
    };
    format!("expected {what}, found {kind}")
}

/// One curve. `place` says where it stands, and is its name where it has none.
fn curve(entry: &Value, place: &str) -> Result<Curve, ReadError> {
    let Value::Object(fields) = entry else {
        return Err(malformed(place, expected("an object with a list \"points\"", entry)));
    };
    let (name, place) = match fields.get("name") {
        None | Some(Value::Null) => (place.to_owned(), place.to_owned()),
        Some(Value::String(name)) => (name.clone(), format!("{place} \"{name}\"")),
        Some(other) => return Err(malformed(place, format!("\"name\": {}", expected("a text", other)))),
    };
    let closed = match fields.get("closed") {
        None | Some(Value::Null) => false,
        Some(Value::Bool(closed)) => *closed,
        Some(other) => return Err(malformed(place, format!("\"closed\": {}", expected("true or false", other)))),
    };
    let points = match fields.get("points") {
        Some(Value::Array(points)) => points,
        Some(other) => return Err(malformed(place, format!("\"points\": {}", expected("a list of [x, y, z]", other)))),
        None => return Err(malformed(place, "it has no \"points\": expected a list of [x, y, z] in metres")),
    };
    let points = points
        .iter()
        .enumerate()
        .map(|(index, value)| {
            point(value).ok_or_else(|| {
                malformed(format!("{place}, point {index}"), expected("three numbers [x, y, z] in metres", value))
            })
        })
        .collect::<Result<Vec<DVec3>, _>>()?;
    let pressure = match fields.get("pressure") {
        None | Some(Value::Null) => None,
        Some(value) => {
            let numbers =
                value.as_array().and_then(|values| values.iter().map(Value::as_f64).collect::<Option<Vec<_>>>());
            let problem = || format!("\"pressure\": {}", expected("a list of one number a point", value));
            Some(numbers.ok_or_else(|| malformed(&place, problem()))?)
        }
    };
    Curve::with_pressure(name, points, closed, pressure).map_err(|source| ReadError::Curve { place, source })
}

fn point(value: &Value) -> Option<DVec3> {
    match value.as_array()?.as_slice() {
        [x, y, z] => Some(DVec3::new(x.as_f64()?, y.as_f64()?, z.as_f64()?)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::curve::CurveError;

    const CONTOURS: &str = r#"{"part":"head","units":"metre","axes":"+x left of the body, +y up, +z front",
        "view":"front","plane":{"axis":"z","offset":0.049111},"contours":[
        {"name":"left","closed":false,"points":[[0.050001,1.460243,0.049111],[0.050342,1.466435,0.049111],[0.051583,1.472502,0.049111]]},
        {"name":"right","closed":false,"points":[[-0.005,1.460243,0.049111],[0.0,1.658252,0.049111]]}]}"#;

    const SECTIONS: &str = r#"{"part":"neck","bones":[{"name":"neck_01","head":[0.0,1.413722,0.005113],"tail":[0.0,1.514592,0.044288]}],
        "sections":[{"closed":true,"plane":{"origin":[0.0,1.408678,0.004427],"normal":[0.0,0.93217,0.36202]},
        "points":[[0.0,1.383563,0.069096],[0.004477,1.383595,0.069014],[0.008946,1.383691,0.068768]]}]}"#;

    fn refusal(text: &str) -> String {
        read(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn contours_come_by_name() {
        let curves = read(CONTOURS.as_bytes()).unwrap();
        assert_eq!(curves.iter().map(Curve::name).collect::<Vec<_>>(), ["left", "right"]);
        assert_eq!(curves[0].points()[1], DVec3::new(0.050342, 1.466435, 0.049111));
        assert!(!curves[0].is_closed() && curves[0].points().len() == 3);
    }

    #[test]
    fn sections_without_names_are_numbered() {
        let curves = read(SECTIONS.as_bytes()).unwrap();
        assert_eq!((curves[0].name(), curves[0].is_closed(), curves[0].points().len()), ("section 0", true, 3));
    }

    #[test]
    fn written_curves_come_back_exactly() {
        let mut curves = read(CONTOURS.as_bytes()).unwrap();
        let pressed = Curve::with_pressure(
            "\"quoted\"\n",
            vec![DVec3::new(0.1, -0.2, 1e-300), DVec3::splat(1.0 / 3.0), DVec3::splat(1e20)],
            true,
            Some(vec![0.1, 0.5, 1.0]),
        );
        curves.push(pressed.unwrap());
        let bytes = write(&curves);
        assert_eq!(read(&bytes).unwrap(), curves);
        assert_eq!(String::from_utf8(bytes).unwrap().lines().count(), curves.len() + 2, "one line a curve");
        let nameless = [curves[0].clone().renamed("")];
        assert_eq!(read(&write(&nameless)).unwrap()[0].name(), "contour 0");
    }

    #[test]
    fn entries_that_make_no_curve_are_refused_by_name_and_point() {
        let entry = |entry: &str| refusal(&format!(r#"{{"contours":[{{"points":[[0,0,0],[1,0,0]]}},{entry}]}}"#));
        for (text, expected) in [
            (r#"7"#, "contour 1: expected an object with a list \"points\", found 7"),
            (r#"{"name":3}"#, "contour 1: \"name\": expected a text, found 3"),
            (r#"{"name":"arm"}"#, "contour 1 \"arm\": it has no \"points\": expected a list of [x, y, z] in metres"),
            (r#"{"points":{}}"#, "contour 1: \"points\": expected a list of [x, y, z], found an object"),
            (r#"{"closed":"yes","points":[]}"#, "contour 1: \"closed\": expected true or false, found \"yes\""),
            (
                r#"{"name":"arm","points":[[0,0,0],[1,0]]}"#,
                "contour 1 \"arm\", point 1: expected three numbers [x, y, z] in metres, found a list of 2",
            ),
            (r#"{"points":[[0,0,null]]}"#, "contour 1, point 0: expected three numbers"),
            (
                r#"{"points":[[0,0,0],[1,0,0]],"pressure":[1,"a"]}"#,
                "contour 1: \"pressure\": expected a list of one number a point",
            ),
        ] {
            let message = entry(text);
            assert!(message.starts_with("not a valid curves JSON file: ") && message.contains(expected), "{message}");
        }
        let place = "contour 1 \"arm\"".to_owned();
        let source = CurveError::TooFewPoints { name: "arm".to_owned(), found: 1, needed: 2 };
        let text = r#"{"contours":[{"points":[[0,0,0],[1,0,0]]},{"name":"arm","points":[[0,0,0],[0,0,0]]}]}"#;
        assert_eq!(read(text.as_bytes()), Err(ReadError::Curve { place, source }));
        assert!(entry(r#"{"points":[[0,0,0],[1,0,0]],"pressure":[1]}"#).contains("2 points but 1 pressures"));
    }

    #[test]
    fn files_of_another_shape_are_refused() {
        assert_eq!(read(b""), Err(ReadError::Empty { format: "curves JSON" }));
        for (text, expected) in [
            ("[]", "top level: expected an object with a list \"contours\" or \"sections\", found a list of 0"),
            ("{}", "holds no curve: it needs a list \"contours\" or \"sections\""),
            (r#"{"contours":[]}"#, "holds no curve"),
            (r#"{"sections":{}}"#, "\"sections\": expected a list, found an object"),
            (r#"{"units":"cm","contours":[]}"#, "\"units\": expected \"metre\", found \"cm\""),
            ("{\"contours\":\n[", "line 2, column 1"),
            (r#"{"contours":[{"points":[[NaN,0,0]]}]}"#, "line 1"),
            (r#"{"contours":[{"points":[[1e999,0,0]]}]}"#, "number out of range"),
        ] {
            let message = refusal(text);
            assert!(message.contains(expected), "{text}: {message}");
        }
        assert!(refusal(&"[".repeat(100_000)).contains("recursion limit"));
        assert!(matches!(read(b"\xff\xfe{"), Err(ReadError::Malformed { .. })));
    }

    #[test]
    fn a_file_cut_off_anywhere_is_refused() {
        for length in 0..SECTIONS.len() {
            assert!(read(&SECTIONS.as_bytes()[..length]).is_err());
        }
    }

    proptest! {
        #[test]
        fn any_curve_comes_back_exactly(points in proptest::collection::vec(proptest::array::uniform3(proptest::num::f64::NORMAL), 3..40), closed in any::<bool>()) {
            let curve = Curve::new("any", points.into_iter().map(DVec3::from).collect(), closed).unwrap();
            prop_assert_eq!(read(&write(std::slice::from_ref(&curve))).unwrap(), vec![curve]);
        }

        #[test]
        fn random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..100)) {
            prop_assert!(read(&bytes).is_err());
        }
    }
}
