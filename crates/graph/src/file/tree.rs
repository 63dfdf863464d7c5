//! The file as RON spells it, before anything is understood: names and pieces of its own text, whose places in the
//! file are known because they are slices of it.

use std::collections::HashSet;
use std::fmt;

use ron::error::SpannedResult;
use ron::value::RawValue;
use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error as _, MapAccess, Visitor};

use crate::file::limit::{BODY, FIRST_INPUT, INTERFACE, Meter, NODE, UNKNOWN_FIELD};

/// Fields with a name, in the order of the file.
pub(super) type Fields<'a> = Vec<(String, &'a RawValue)>;

/// The whole file.
#[derive(Debug, Default)]
pub(super) struct FileTree<'a> {
    pub(super) version: Option<&'a RawValue>,
    pub(super) notes: Option<&'a RawValue>,
    /// Versions of kinds, where their defaults were other ones before.
    pub(super) kinds: Option<Entries<'a, &'a RawValue>>,
    pub(super) parameters: Option<Entries<'a, &'a RawValue>>,
    pub(super) nodes: Option<Entries<'a, NodeTree<'a>>>,
    pub(super) outputs: Option<Entries<'a, &'a RawValue>>,
    pub(super) layout: Option<Entries<'a, &'a RawValue>>,
    pub(super) frames: Option<&'a RawValue>,
    pub(super) references: Option<&'a RawValue>,
    pub(super) unknown: Fields<'a>,
}

/// One node.
#[derive(Debug, Default)]
pub(super) struct NodeTree<'a> {
    pub(super) kind: Option<&'a RawValue>,
    pub(super) note: Option<&'a RawValue>,
    pub(super) muted: Option<&'a RawValue>,
    pub(super) collapsed: Option<&'a RawValue>,
    pub(super) inputs: Option<Entries<'a, &'a RawValue>>,
    pub(super) each: Option<&'a RawValue>,
    pub(super) feed_back: Option<&'a RawValue>,
    pub(super) body: Option<&'a RawValue>,
    pub(super) unknown: Fields<'a>,
}

/// Brackets with named fields, in the order of the file.
#[derive(Debug, Default)]
pub(super) struct FieldsTree<'a>(pub(super) Fields<'a>);

/// A map in the order of the file; names may occur twice.
#[derive(Debug)]
pub(super) struct Entries<'a, V>(pub(super) Vec<(&'a RawValue, V)>);

/// Takes the text of a graph apart.
///
/// # Errors
/// It is not RON or not shaped like a graph, or it asks for more than the meter has, which then says so.
pub(super) fn take_apart<'a>(text: &'a str, meter: &Meter) -> SpannedResult<FileTree<'a>> {
    seeded(text, FileSeed(meter))
}

/// As [`take_apart`] for brackets with named fields.
pub(super) fn take_fields_apart<'a>(text: &'a str, meter: &Meter) -> SpannedResult<FieldsTree<'a>> {
    seeded(text, FieldsSeed(meter))
}

fn seeded<'a, S: DeserializeSeed<'a>>(text: &'a str, seed: S) -> SpannedResult<S::Value> {
    let mut deserializer = ron::Deserializer::from_str(text)?;
    let tree = seed.deserialize(&mut deserializer);
    let tree = tree.and_then(|tree| deserializer.end().map(|()| tree));
    tree.map_err(|error| deserializer.span_error(error))
}

/// A piece of text that the meter has room for.
#[derive(Clone, Copy)]
struct Piece<'m>(&'m Meter);

impl<'de> DeserializeSeed<'de> for Piece<'_> {
    type Value = &'de RawValue;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<&'de RawValue, D::Error> {
        let piece = <&RawValue>::deserialize(deserializer)?;
        if self.0.take_text(piece.get_ron()) { Ok(piece) } else { Err(D::Error::custom("too much")) }
    }
}

/// A piece that costs as much whatever it says: a body, which is taken apart with the same meter later.
#[derive(Clone, Copy)]
struct Lump<'m>(&'m Meter, usize);

impl<'de> DeserializeSeed<'de> for Lump<'_> {
    type Value = &'de RawValue;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<&'de RawValue, D::Error> {
        let piece = <&RawValue>::deserialize(deserializer)?;
        if self.0.take(self.1) { Ok(piece) } else { Err(D::Error::custom("too much")) }
    }
}

/// A parameter or output of a graph: a piece of text that becomes more than others.
#[derive(Clone, Copy)]
struct Port<'m>(&'m Meter);

impl<'de> DeserializeSeed<'de> for Port<'_> {
    type Value = &'de RawValue;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<&'de RawValue, D::Error> {
        self.0.take(INTERFACE);
        Piece(self.0).deserialize(deserializer)
    }
}

struct FileSeed<'m>(&'m Meter);

impl<'de> Visitor<'de> for FileSeed<'_> {
    type Value = FileTree<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a graph: (version: 1, nodes: { ... })")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<FileTree<'de>, A::Error> {
        let meter = self.0;
        let mut tree = FileTree::default();
        while let Some(name) = map.next_key::<String>()? {
            match name.as_str() {
                "version" => once(&mut tree.version, &name, &mut map, Piece(meter))?,
                "notes" => once(&mut tree.notes, &name, &mut map, Piece(meter))?,
                "kinds" => once(&mut tree.kinds, &name, &mut map, EntriesSeed(meter, Piece(meter)))?,
                "parameters" => once(&mut tree.parameters, &name, &mut map, EntriesSeed(meter, Port(meter)))?,
                "nodes" => once(&mut tree.nodes, &name, &mut map, EntriesSeed(meter, NodeSeed(meter)))?,
                "outputs" => once(&mut tree.outputs, &name, &mut map, EntriesSeed(meter, Port(meter)))?,
                "frames" => once(&mut tree.frames, &name, &mut map, Piece(meter))?,
                "references" => once(&mut tree.references, &name, &mut map, Piece(meter))?,
                "layout" => once(&mut tree.layout, &name, &mut map, EntriesSeed(meter, Piece(meter)))?,
                _ => unknown(&mut tree.unknown, name, &mut map, meter)?,
            }
        }
        Ok(tree)
    }
}

/// Reads the value of a field that may occur once. The error comes before the value is read, so that its place in the
/// file is that of the name.
fn once<'de, S, A>(slot: &mut Option<S::Value>, name: &str, map: &mut A, seed: S) -> Result<(), A::Error>
where
    S: DeserializeSeed<'de>,
    A: MapAccess<'de>,
{
    if slot.is_some() {
        return Err(A::Error::custom(format!("the field \"{name}\" occurs twice")));
    }
    *slot = Some(map.next_value_seed(seed)?);
    Ok(())
}

fn unknown<'de, A>(fields: &mut Fields<'de>, name: String, map: &mut A, meter: &Meter) -> Result<(), A::Error>
where
    A: MapAccess<'de>,
{
    meter.take(UNKNOWN_FIELD);
    fields.push((name, map.next_value_seed(Piece(meter))?));
    Ok(())
}

impl<'de> DeserializeSeed<'de> for FileSeed<'_> {
    type Value = FileTree<'de>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<FileTree<'de>, D::Error> {
        deserializer.deserialize_struct("", &[], self)
    }
}

#[derive(Clone, Copy)]
struct NodeSeed<'m>(&'m Meter);

impl<'de> Visitor<'de> for NodeSeed<'_> {
    type Value = NodeTree<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a node: (kind: \"...\", inputs: { ... })")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<NodeTree<'de>, A::Error> {
        let meter = self.0;
        if !meter.take(NODE) {
            return Err(A::Error::custom("too much"));
        }
        let mut tree = NodeTree::default();
        while let Some(name) = map.next_key::<String>()? {
            match name.as_str() {
                "kind" => once(&mut tree.kind, &name, &mut map, Piece(meter))?,
                "note" => once(&mut tree.note, &name, &mut map, Piece(meter))?,
                "muted" => once(&mut tree.muted, &name, &mut map, Piece(meter))?,
                "collapsed" => once(&mut tree.collapsed, &name, &mut map, Piece(meter))?,
                "inputs" => {
                    meter.take(FIRST_INPUT);
                    once(&mut tree.inputs, &name, &mut map, EntriesSeed(meter, Piece(meter)))?;
                }
                "each" => once(&mut tree.each, &name, &mut map, Piece(meter))?,
                "feed_back" => once(&mut tree.feed_back, &name, &mut map, Piece(meter))?,
                "body" => once(&mut tree.body, &name, &mut map, Lump(meter, BODY))?,
                _ => unknown(&mut tree.unknown, name, &mut map, meter)?,
            }
        }
        Ok(tree)
    }
}

impl<'de> DeserializeSeed<'de> for NodeSeed<'_> {
    type Value = NodeTree<'de>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<NodeTree<'de>, D::Error> {
        deserializer.deserialize_struct("", &[], self)
    }
}

struct FieldsSeed<'m>(&'m Meter);

impl<'de> Visitor<'de> for FieldsSeed<'_> {
    type Value = FieldsTree<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("named fields in round brackets")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<FieldsTree<'de>, A::Error> {
        let mut fields: Fields<'de> = Vec::new();
        let mut known = HashSet::new();
        while let Some(name) = map.next_key::<String>()? {
            if !known.insert(name.clone()) {
                return Err(A::Error::custom(format!("the field \"{name}\" occurs twice")));
            }
            unknown(&mut fields, name, &mut map, self.0)?;
        }
        Ok(FieldsTree(fields))
    }
}

impl<'de> DeserializeSeed<'de> for FieldsSeed<'_> {
    type Value = FieldsTree<'de>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<FieldsTree<'de>, D::Error> {
        deserializer.deserialize_struct("", &[], self)
    }
}

/// Entries whose values are read by another seed.
struct EntriesSeed<'m, S>(&'m Meter, S);

impl<'de, S: DeserializeSeed<'de> + Copy> Visitor<'de> for EntriesSeed<'_, S> {
    type Value = Entries<'de, S::Value>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map: { \"name\": ..., }")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut entries = Vec::new();
        while let Some(name) = map.next_key_seed(Piece(self.0))? {
            entries.push((name, map.next_value_seed(self.1)?));
        }
        Ok(Entries(entries))
    }
}

impl<'de, S: DeserializeSeed<'de> + Copy> DeserializeSeed<'de> for EntriesSeed<'_, S> {
    type Value = Entries<'de, S::Value>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_map(self)
    }
}

/// The text of a piece without the white space and comments around it.
pub(super) fn trimmed(raw: &RawValue) -> &str {
    let text = raw.get_ron().trim();
    // Comments are rare; finding their end takes a second look at the whole piece.
    if text.starts_with('/') || text.ends_with('/') || text.contains("//") { raw.trim().get_ron() } else { text }
}
