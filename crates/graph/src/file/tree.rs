//! The file as RON spells it, before anything is understood: names and pieces of its own text, whose places in the
//! file are known because they are slices of it.

use std::fmt;

use ron::error::SpannedResult;
use ron::value::RawValue;
use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error as _, MapAccess, Visitor};

use crate::file::limit::{FIRST_INPUT, Meter, NODE, UNKNOWN_FIELD};

/// Fields with a name, in the order of the file.
pub(super) type Fields<'a> = Vec<(String, &'a RawValue)>;

/// The whole file.
#[derive(Debug, Default)]
pub(super) struct FileTree<'a> {
    pub(super) version: Option<&'a RawValue>,
    pub(super) notes: Option<&'a RawValue>,
    /// Versions of kinds, where their defaults were other ones before.
    pub(super) kinds: Option<Entries<'a, &'a RawValue>>,
    pub(super) nodes: Option<Entries<'a, NodeTree<'a>>>,
    pub(super) layout: Option<Entries<'a, &'a RawValue>>,
    pub(super) unknown: Fields<'a>,
}

/// One node.
#[derive(Debug, Default)]
pub(super) struct NodeTree<'a> {
    pub(super) kind: Option<&'a RawValue>,
    pub(super) note: Option<&'a RawValue>,
    pub(super) inputs: Option<Entries<'a, &'a RawValue>>,
    pub(super) unknown: Fields<'a>,
}

/// A map in the order of the file; names may occur twice.
#[derive(Debug)]
pub(super) struct Entries<'a, V>(pub(super) Vec<(&'a RawValue, V)>);

/// Takes a file apart.
///
/// # Errors
/// It is not RON or not shaped like a graph, or it asks for more than the meter has, which then says so.
pub(super) fn take_apart<'a>(text: &'a str, meter: &Meter) -> SpannedResult<FileTree<'a>> {
    let mut deserializer = ron::Deserializer::from_str(text)?;
    let tree = FileSeed(meter).deserialize(&mut deserializer);
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

struct FileSeed<'m>(&'m Meter);

impl<'de> Visitor<'de> for FileSeed<'_> {
    type Value = FileTree<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a graph: (version: 1, nodes: { ... })")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<FileTree<'de>, A::Error> {
        let mut tree = FileTree::default();
        while let Some(name) = map.next_key::<String>()? {
            match name.as_str() {
                "version" => once(&mut tree.version, &name, &mut map, Piece(self.0))?,
                "notes" => once(&mut tree.notes, &name, &mut map, Piece(self.0))?,
                "kinds" => once(&mut tree.kinds, &name, &mut map, EntriesSeed(self.0, Piece(self.0)))?,
                "nodes" => once(&mut tree.nodes, &name, &mut map, EntriesSeed(self.0, NodeSeed(self.0)))?,
                "layout" => once(&mut tree.layout, &name, &mut map, EntriesSeed(self.0, Piece(self.0)))?,
                _ => {
                    self.0.take(UNKNOWN_FIELD);
                    tree.unknown.push((name, map.next_value_seed(Piece(self.0))?));
                }
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
        let mut tree = NodeTree::default();
        if !self.0.take(NODE) {
            return Err(A::Error::custom("too much"));
        }
        while let Some(name) = map.next_key::<String>()? {
            match name.as_str() {
                "kind" => once(&mut tree.kind, &name, &mut map, Piece(self.0))?,
                "note" => once(&mut tree.note, &name, &mut map, Piece(self.0))?,
                "inputs" => {
                    self.0.take(FIRST_INPUT);
                    once(&mut tree.inputs, &name, &mut map, EntriesSeed(self.0, Piece(self.0)))?;
                }
                _ => {
                    self.0.take(UNKNOWN_FIELD);
                    tree.unknown.push((name, map.next_value_seed(Piece(self.0))?));
                }
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
