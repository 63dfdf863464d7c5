//! `-o 'out/{stiffness}-{legs.height}.glb'`: the names of the files of each variant.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use maquette_geometry::file_format::FileFormat;

use super::values::Value;
use super::variants::{Axis, Variants};
use crate::commands::write;

/// A file name with places for values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pattern {
    pub(super) text: String,
    pub(super) parts: Vec<Part>,
    pub(super) format: FileFormat,
}

/// A piece of a pattern.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Text(String),
    /// The value of an axis.
    Axis(usize),
    /// The number of the variant, from 1, with as many digits as the last one.
    Index,
}

impl Pattern {
    /// Reads a pattern: `{address}`, `{index}`, and `{{` and `}}` for brackets that are meant.
    pub(super) fn parse(text: &str, axes: &[Axis]) -> Result<Self, String> {
        let fail = |reason: String| format!("error: -o {text}: {reason}");
        let mut parts = Vec::new();
        let mut plain = String::new();
        let mut rest = text;
        while let Some(at) = rest.find(['{', '}']) {
            plain.push_str(&rest[..at]);
            let bracket = &rest[at..=at];
            rest = &rest[at + 1..];
            if let Some(after) = rest.strip_prefix(bracket) {
                plain.push_str(bracket);
                rest = after;
                continue;
            }
            let end = rest.find('}').filter(|_| bracket == "{");
            let end = end.ok_or_else(|| {
                fail(format!("a {bracket} stands alone; write {bracket}{bracket} for one that is meant"))
            })?;
            let name = &rest[..end];
            rest = &rest[end + 1..];
            let part = match axes.iter().position(|axis| axis.address == name) {
                Some(axis) => Part::Axis(axis),
                None if name == "index" => Part::Index,
                None => {
                    let known: Vec<String> = axes.iter().map(|axis| format!("{{{}}}", axis.address)).collect();
                    return Err(fail(format!("{{{name}}} is not varied; there is {}, {{index}}", known.join(", "))));
                }
            };
            if !plain.is_empty() {
                parts.push(Part::Text(std::mem::take(&mut plain)));
            }
            parts.push(part);
        }
        plain.push_str(rest);
        if !plain.is_empty() {
            parts.push(Part::Text(plain));
        }
        // The extension does not vary.
        let last = match parts.last() {
            Some(Part::Text(last)) => last.as_str(),
            _ => "",
        };
        let format = write::format(Path::new(&format!("name{last}")))
            .map_err(|_| fail("end it in the format to write: .glb, .gltf, .obj, .ply or .json".to_owned()))?;
        Ok(Self { text: text.to_owned(), parts, format })
    }

    /// The file of a variant.
    pub(super) fn file(&self, variants: &Variants, variant: usize) -> PathBuf {
        let digits = variants.len().to_string().len();
        let values: Vec<&Value> = variants.values(variant).map(|(_, value)| value).collect();
        let pieces = self.parts.iter().map(|part| match part {
            Part::Text(text) => text.clone(),
            Part::Axis(axis) => file_name(value_text(values[*axis])),
            Part::Index => format!("{:0digits$}", variant + 1),
        });
        PathBuf::from(pieces.collect::<String>())
    }

    /// The folder that all files of the pattern are in.
    pub(super) fn folder(&self) -> PathBuf {
        let fixed = match self.parts.first() {
            Some(Part::Text(text)) => text.as_str(),
            _ => "",
        };
        let end = fixed.rfind(std::path::is_separator).map_or(0, |at| at + 1);
        PathBuf::from(&fixed[..end])
    }
}

/// The files that writing to this one makes.
pub(super) fn written(path: &Path, format: FileFormat) -> Vec<PathBuf> {
    match format {
        FileFormat::Obj => vec![path.to_owned(), path.with_extension("mtl")],
        _ => vec![path.to_owned()],
    }
}

/// Says where two variants, or two patterns, would write the same file, or one that is read.
pub(super) fn check_distinct(
    patterns: &[Pattern],
    variants: &Variants,
    taken: &[(PathBuf, String)],
) -> Result<(), String> {
    // File systems that don't tell large letters from small ones must not lose results.
    let key = |path: &Path| {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        path.components().collect::<PathBuf>().to_string_lossy().to_lowercase()
    };
    let mut known: BTreeMap<String, (PathBuf, String)> = BTreeMap::new();
    for (path, what) in taken {
        known.insert(key(path), (path.clone(), what.clone()));
    }
    for variant in 0..variants.len() {
        for pattern in patterns {
            for path in written(&pattern.file(variants, variant), pattern.format) {
                let what = format!("the variant {}", variants.describe(variant));
                let Some((other, before)) = known.insert(key(&path), (path.clone(), what.clone())) else { continue };
                let same = if other == path {
                    ""
                } else {
                    " (names that differ only in large and small letters count as the same)"
                };
                return Err(format!(
                    "error: -o {}: {} would be written for {what} and is {before}'s already{same}; put {{index}} or more \
                     addresses into the name",
                    pattern.text,
                    path.display()
                ));
            }
        }
    }
    Ok(())
}

/// A value as it stands in a name: of a file, what it is called.
pub(super) fn value_text(value: &Value) -> &str {
    match &value.literal {
        maquette_graph::Literal::File(path) => {
            Path::new(path).file_stem().and_then(|stem| stem.to_str()).unwrap_or(&value.text)
        }
        _ => &value.text,
    }
}

/// Longest piece that a value gives to a name, letters.
const LONGEST: usize = 80;

/// A text as part of a file name on every system: letters, digits, `-`, `_`, `+` and dots that are not first.
pub(super) fn file_name(text: &str) -> String {
    let allowed = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '+' | '.');
    let name: String = text.chars().take(LONGEST).map(|c| if allowed(c) { c } else { '_' }).collect();
    let name = if name.starts_with('.') { name.replacen('.', "_", 1) } else { name };
    if name.is_empty() { "_".to_owned() } else { name }
}

#[cfg(test)]
mod tests {
    use maquette_graph::Graph;

    use super::super::values::Vary;
    use super::super::variants::Combining;
    use super::*;

    fn variants(varies: &[&str]) -> Variants {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let mut graph = Graph::new();
        graph.add(&catalogue, "detail-generator", "body").unwrap();
        graph.add(&catalogue, "transform", "moved").unwrap();
        graph.add(&catalogue, "import-curves", "file").unwrap();
        graph.add(&catalogue, "pick", "picked").unwrap();
        let varies = varies.iter().map(|text| Vary::parse(&mut graph, text).unwrap()).collect();
        Variants::new(varies, &Combining::default()).unwrap()
    }

    fn names(pattern: &str, variants: &Variants) -> Vec<String> {
        let pattern = Pattern::parse(pattern, &variants.axes).unwrap();
        (0..variants.len()).map(|i| pattern.file(variants, i).to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn values_and_numbers_are_put_in() {
        let variants = variants(&["body.k_s=0.5,1", "moved.rotate=(0,1,0),(0,-2,0)"]);
        let names = names("out/{body.k_s}/{{a}}{moved.rotate}-{index}.glb", &variants);
        assert_eq!(
            names,
            ["out/0.5/{a}0_1_0-1.glb", "out/0.5/{a}0_-2_0-2.glb", "out/1/{a}0_1_0-3.glb", "out/1/{a}0_-2_0-4.glb"]
        );
    }

    #[test]
    fn no_value_leads_out_of_the_folder() {
        let variants = variants(&["file.file=../a/arm.json,/etc/..,../../leg.svg"]);
        assert_eq!(names("out/{file.file}.glb", &variants), ["out/arm.glb", "out/_etc_...glb", "out/leg.glb"]);
        for text in ["..", "../..", "a/b", "a\\b", ".hidden", "", "c:x", "a\0b"] {
            let name = file_name(text);
            assert_eq!(Path::new(&name).components().count(), 1, "{name}");
            assert!(!name.starts_with('.') && !name.contains(['/', '\\', ':', '\0']), "{name}");
        }
    }

    #[test]
    fn two_variants_never_share_a_file() {
        let variants = variants(&["body.k_s=1,2", "body.k_b=1,3"]);
        let check = |patterns: &[&str], taken: &[(PathBuf, String)]| {
            let patterns: Vec<_> = patterns.iter().map(|p| Pattern::parse(p, &variants.axes).unwrap()).collect();
            check_distinct(&patterns, &variants, taken)
        };
        let error = check(&["{body.k_s}.glb"], &[]).unwrap_err();
        assert!(error.contains("1.glb would be written for the variant body.k_s=1 body.k_b=3 and is the variant body.k_s=1 body.k_b=1's"), "{error}");
        check(&["{body.k_s}{body.k_b}.glb", "{index}.obj", "{index}.ply"], &[]).unwrap();
        check(&["{index}.glb", "./{index}.glb"], &[]).unwrap_err();
        check(&["{index}.obj", "{index}.glb"], &[(PathBuf::from("2.mtl"), "a file".to_owned())]).unwrap_err();
        // 1 with 13 and 11 with 3.
        let variants = super::tests::variants(&["body.k_s=1,11", "body.k_b=13,3"]);
        let pattern = Pattern::parse("{body.k_s}{body.k_b}.glb", &variants.axes).unwrap();
        check_distinct(&[pattern], &variants, &[]).unwrap_err();
    }

    #[test]
    fn what_is_no_pattern_is_refused() {
        let variants = variants(&["body.k_s=1,2"]);
        for (text, said) in [
            ("{body.k_t}.glb", "{body.k_t} is not varied; there is {body.k_s}, {index}"),
            ("{body.k_s.glb", "a { stands alone; write {{"),
            ("body}.glb", "a } stands alone; write }}"),
            ("{body.k_s}", "end it in the format to write: .glb"),
            ("{index}.svg", "end it in the format to write: .glb"),
            ("", "end it in the format to write: .glb"),
        ] {
            let error = Pattern::parse(text, &variants.axes).unwrap_err();
            assert!(error.contains(said), "{text}: {error}");
        }
        assert_eq!(Pattern::parse("out/a-{index}.glb", &variants.axes).unwrap().folder(), Path::new("out/"));
        assert_eq!(Pattern::parse("{index}/a.glb", &variants.axes).unwrap().folder(), Path::new(""));
    }
}
