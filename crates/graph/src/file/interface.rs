//! Parameters and outputs of a graph, from text.

use serde::Deserialize;

use crate::catalogue::closest;
use crate::file::limit::TOO_LARGE;
use crate::file::literal_text::{Spelled, parse};
use crate::file::read::Reader;
use crate::file::syntax::in_words;
use crate::file::tree::{FieldsTree, FileTree, take_fields_apart, trimmed};
use crate::graph::Link;
use crate::interface::{GraphOutput, OutputSource};
use crate::literal::Literal;
use crate::parameter::Parameter;
use crate::port::{OptionSpec, Range, Unit};

/// What is wrong: where, counted in bytes from the beginning of the file, what, and what to do.
struct Flaw {
    at: usize,
    message: String,
    remedy: String,
}

impl<'a> Reader<'a> {
    pub(super) fn parameters(&mut self, tree: &FileTree<'a>) {
        for (name, raw) in tree.parameters.iter().flat_map(|entries| &entries.0) {
            let name_at = self.offset(trimmed(name));
            let name = self.name(name, None, "a parameter's name");
            let piece = trimmed(raw);
            let flaw = match self.parameter(&name, piece) {
                Ok(parameter) => match self.graph.check_parameter(&parameter, None) {
                    Ok(()) => {
                        self.graph.parameters.push(parameter);
                        continue;
                    }
                    Err(error) => Flaw { at: name_at, message: error.to_string(), remedy: "it is kept".to_owned() },
                },
                Err(flaw) => flaw,
            };
            self.error(flaw.at, None, None, format!("parameter \"{name}\": {}", flaw.message), &flaw.remedy);
            self.graph.unread_parameters.push((name, piece.to_owned()));
        }
    }

    fn fields(&self, piece: &'a str, example: &str) -> Result<FieldsTree<'a>, Flaw> {
        take_fields_apart(piece, &self.inclusion.meter).map_err(|error| {
            let lines = crate::file::place::LineIndex::new(piece);
            let within = lines.byte(error.span.start.line, error.span.start.col);
            let is_exceeded = self.inclusion.meter.is_exceeded();
            let message = if is_exceeded { TOO_LARGE.to_owned() } else { in_words(&error.code) };
            let remedy = format!("write {example}");
            Flaw { at: self.offset(piece) + within, message, remedy }
        })
    }

    /// The value of a field.
    fn value<T: for<'de> Deserialize<'de>>(&self, piece: &'a str, field: &str, example: &str) -> Result<T, Flaw> {
        ron::from_str(piece).map_err(|error| Flaw {
            at: self.offset(piece),
            message: format!("the field \"{field}\" can't be read: {}", in_words(&error.code)),
            remedy: format!("write {field}: {example}"),
        })
    }

    fn parameter(&mut self, name: &str, piece: &'a str) -> Result<Parameter, Flaw> {
        let FieldsTree(fields) = self.fields(piece, "(value: 0.5, description: \"...\")")?;
        let mut wire = None;
        let mut value: Option<(usize, Literal)> = None;
        let mut read = Parameter::required(name, crate::WireType::of::<f64>());
        let spec = &mut read.spec;
        let mut unknown = Vec::new();
        for (field, raw) in &fields {
            let piece = trimmed(raw);
            let at = self.offset(piece);
            match field.as_str() {
                "type" => {
                    let named: String = self.value(piece, field, "\"number\"")?;
                    wire = Some(self.catalogue.wire(&named).ok_or_else(|| {
                        let names = || self.catalogue.wires().map(|wire| wire.name());
                        let remedy = match closest(&named, names()) {
                            Some(name) => format!("did you mean \"{name}\"?"),
                            None => format!("use one of {}", names().collect::<Vec<_>>().join(", ")),
                        };
                        Flaw { at, message: format!("there is no type \"{named}\""), remedy }
                    })?);
                }
                "value" => match parse(piece) {
                    Ok(Spelled::Literal(literal)) => value = Some((at, literal)),
                    Ok(Spelled::Link(_) | Spelled::Parameter(_)) => {
                        let message = "a parameter holds a value, and neither a link nor another parameter".to_owned();
                        return Err(Flaw { at, message, remedy: "write value: 0.5, say".to_owned() });
                    }
                    Err(error) => {
                        let message = format!("the value can't be read: {}", error.message);
                        return Err(Flaw { at: at + error.offset, message, remedy: String::new() });
                    }
                },
                "range" | "soft_range" => {
                    let (min, max) = self.value(piece, field, "(0.0, 10.0)")?;
                    let slot = if field == "range" { &mut spec.range } else { &mut spec.soft_range };
                    *slot = Some(Range { min, max });
                }
                "unit" => {
                    let unit: String = self.value(piece, field, "\"m\"")?;
                    let known = [Unit::None, Unit::Length, Unit::Angle].into_iter().find(|u| u.to_string() == unit);
                    spec.unit = known.ok_or_else(|| Flaw {
                        at,
                        message: format!("there is no unit \"{unit}\""),
                        remedy: "write \"m\" or \"degrees\", or leave it out".to_owned(),
                    })?;
                }
                "description" => spec.description = self.value(piece, field, "\"...\"")?,
                "optional" => spec.optional = self.value(piece, field, "true")?,
                "options" => {
                    let pairs: Vec<(String, String)> = self.value(piece, field, "[(\"name\", \"what it does\")]")?;
                    let option = |(name, description)| OptionSpec { name, description };
                    spec.options = pairs.into_iter().map(option).collect();
                }
                "extensions" => spec.extensions = self.value(piece, field, "[\"json\"]")?,
                _ => unknown.push((field.clone(), piece.to_owned())),
            }
        }
        let given = value.as_ref().map(|(_, literal)| literal.to_value().wire());
        spec.wire = wire.or(given).ok_or_else(|| Flaw {
            at: self.offset(piece),
            message: "it has neither a value nor a type".to_owned(),
            remedy: "add value: 0.5, or type: \"curves\", say".to_owned(),
        })?;
        if spec.wire == crate::WireType::of::<crate::Choice>() && spec.options.is_empty() {
            return Err(Flaw {
                at: self.offset(piece),
                message: "a choice needs its options".to_owned(),
                remedy: "add options: [(\"name\", \"what it does\")]".to_owned(),
            });
        }
        if let Some((at, literal)) = &value
            && let Some(message) = spec.refuses(literal)
        {
            return Err(Flaw { at: *at, message, remedy: String::new() });
        }
        for (field, _) in &unknown {
            if let Some((_, raw)) = fields.iter().find(|(name, _)| name == field) {
                self.unknown_field(None, field, trimmed(raw));
            }
        }
        read.unknown_fields = unknown;
        Ok(read.value_of(value.map(|(_, literal)| literal)))
    }

    /// Outputs come when all nodes are there.
    pub(super) fn outputs(&mut self, tree: &FileTree<'a>) {
        for (name, raw) in tree.outputs.iter().flat_map(|entries| &entries.0) {
            let name_at = self.offset(trimmed(name));
            let name = self.name(name, None, "an output's name");
            let piece = trimmed(raw);
            let said = |message: String| format!("output \"{name}\": {message}");
            let (mut output, from) = match self.output_of(&name, piece) {
                Ok(read) => read,
                Err(flaw) => {
                    self.error(flaw.at, None, None, said(flaw.message), &flaw.remedy);
                    self.graph.unread_outputs.push((name, piece.to_owned()));
                    continue;
                }
            };
            if let Err(error) = self.graph.check_output(&output, None) {
                self.error(name_at, None, None, said(error.to_string()), "it is kept");
                self.graph.unread_outputs.push((name, piece.to_owned()));
                continue;
            }
            match from {
                None => {
                    let message = "it comes from nothing".to_owned();
                    self.warning(name_at, None, said(message), "add from: \"node.output\", or remove it");
                }
                Some(from) => {
                    let (at, address) = (self.offset(from), ron::from_str::<String>(from));
                    let found = match &address {
                        Ok(address) => {
                            self.addressed(address).map(|(node, _, out)| Link { node, output: out.to_owned() })
                        }
                        Err(_) => Err(("\"from\" is not a text".to_owned(), "write \"node.output\"".to_owned())),
                    };
                    let linked = found.and_then(|link| {
                        let linked = GraphOutput { from: OutputSource::Link(link), ..output.clone() };
                        match self.graph.check_output(&linked, None) {
                            Ok(()) => Ok(linked),
                            Err(error) => Err((error.to_string(), "name another output".to_owned())),
                        }
                    });
                    match linked {
                        Ok(linked) => output = linked,
                        Err((message, remedy)) => {
                            self.error(at, None, None, said(message), &remedy);
                            output.from = OutputSource::Unread(from.to_owned());
                        }
                    }
                }
            }
            self.graph.outputs.push(output);
        }
    }

    /// The output without its source, and the text that says the source.
    fn output_of(&mut self, name: &str, piece: &'a str) -> Result<(GraphOutput, Option<&'a str>), Flaw> {
        let FieldsTree(fields) = self.fields(piece, "(from: \"node.output\", description: \"...\")")?;
        let mut output = GraphOutput {
            name: name.to_owned(),
            description: String::new(),
            from: OutputSource::Nothing,
            unknown_fields: Vec::new(),
        };
        let mut from = None;
        for (field, raw) in &fields {
            let piece = trimmed(raw);
            match field.as_str() {
                "from" => from = Some(piece),
                "description" => output.description = self.value(piece, field, "\"...\"")?,
                _ => {
                    output.unknown_fields.push((field.clone(), piece.to_owned()));
                    self.unknown_field(None, field, piece);
                }
            }
        }
        Ok((output, from))
    }
}
