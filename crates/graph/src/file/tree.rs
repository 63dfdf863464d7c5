//! The file as RON spells it, before anything is understood: names and pieces of its own text, whose places in the
//! file are known because they are slices of it.

use std::fmt;
use std::marker::PhantomData;

use ron::value::RawValue;
use serde::Deserialize;
use serde::de::{Deserializer, Error as _, MapAccess, Visitor};

/// Fields with a name, in the order of the file.
pub(super) type Fields<'a> = Vec<(String, &'a RawValue)>;

/// The whole file.
#[derive(Debug, Default)]
pub(super) struct FileTree<'a> {
    pub(super) version: Option<&'a RawValue>,
    pub(super) notes: Option<&'a RawValue>,
    pub(super) parameters: Option<Entries<'a, &'a RawValue>>,
    pub(super) nodes: Option<Entries<'a, NodeTree<'a>>>,
    pub(super) outputs: Option<Entries<'a, &'a RawValue>>,
    pub(super) layout: Option<Entries<'a, &'a RawValue>>,
    pub(super) unknown: Fields<'a>,
}

/// One node.
#[derive(Debug, Default)]
pub(super) struct NodeTree<'a> {
    pub(super) kind: Option<&'a RawValue>,
    pub(super) note: Option<&'a RawValue>,
    pub(super) muted: Option<&'a RawValue>,
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

struct FileVisitor;

impl<'de> Visitor<'de> for FileVisitor {
    type Value = FileTree<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a graph: (version: 1, nodes: { ... })")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<FileTree<'de>, A::Error> {
        let mut tree = FileTree::default();
        while let Some(name) = map.next_key::<String>()? {
            match name.as_str() {
                "version" => once(&mut tree.version, &name, &mut map)?,
                "notes" => once(&mut tree.notes, &name, &mut map)?,
                "parameters" => once(&mut tree.parameters, &name, &mut map)?,
                "nodes" => once(&mut tree.nodes, &name, &mut map)?,
                "outputs" => once(&mut tree.outputs, &name, &mut map)?,
                "layout" => once(&mut tree.layout, &name, &mut map)?,
                _ => tree.unknown.push((name, map.next_value()?)),
            }
        }
        Ok(tree)
    }
}

/// Reads the value of a field that may occur once. The error comes before the value is read, so that its place in the
/// file is that of the name.
fn once<'de, T, A>(slot: &mut Option<T>, name: &str, map: &mut A) -> Result<(), A::Error>
where
    T: Deserialize<'de>,
    A: MapAccess<'de>,
{
    if slot.is_some() {
        return Err(A::Error::custom(format!("the field \"{name}\" occurs twice")));
    }
    *slot = Some(map.next_value()?);
    Ok(())
}

impl<'de: 'a, 'a> Deserialize<'de> for FileTree<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_struct("", &[], FileVisitor)
    }
}

struct NodeVisitor;

impl<'de> Visitor<'de> for NodeVisitor {
    type Value = NodeTree<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a node: (kind: \"...\", inputs: { ... })")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<NodeTree<'de>, A::Error> {
        let mut tree = NodeTree::default();
        while let Some(name) = map.next_key::<String>()? {
            match name.as_str() {
                "kind" => once(&mut tree.kind, &name, &mut map)?,
                "note" => once(&mut tree.note, &name, &mut map)?,
                "muted" => once(&mut tree.muted, &name, &mut map)?,
                "inputs" => once(&mut tree.inputs, &name, &mut map)?,
                "each" => once(&mut tree.each, &name, &mut map)?,
                "feed_back" => once(&mut tree.feed_back, &name, &mut map)?,
                "body" => once(&mut tree.body, &name, &mut map)?,
                _ => tree.unknown.push((name, map.next_value()?)),
            }
        }
        Ok(tree)
    }
}

impl<'de: 'a, 'a> Deserialize<'de> for NodeTree<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_struct("", &[], NodeVisitor)
    }
}

struct FieldsVisitor;

impl<'de> Visitor<'de> for FieldsVisitor {
    type Value = FieldsTree<'de>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("named fields in round brackets")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<FieldsTree<'de>, A::Error> {
        let mut fields: Fields<'de> = Vec::new();
        while let Some(name) = map.next_key::<String>()? {
            if fields.iter().any(|(known, _)| *known == name) {
                return Err(A::Error::custom(format!("the field \"{name}\" occurs twice")));
            }
            fields.push((name, map.next_value()?));
        }
        Ok(FieldsTree(fields))
    }
}

impl<'de: 'a, 'a> Deserialize<'de> for FieldsTree<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_struct("", &[], FieldsVisitor)
    }
}

struct EntriesVisitor<V>(PhantomData<V>);

impl<'de, V: Deserialize<'de>> Visitor<'de> for EntriesVisitor<V> {
    type Value = Entries<'de, V>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map: { \"name\": ..., }")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries<'de, V>, A::Error> {
        let mut entries = Vec::new();
        while let Some(name) = map.next_key::<&'de RawValue>()? {
            entries.push((name, map.next_value()?));
        }
        Ok(Entries(entries))
    }
}

impl<'de: 'a, 'a, V: Deserialize<'de>> Deserialize<'de> for Entries<'a, V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(EntriesVisitor(PhantomData))
    }
}

/// The text of a piece without the white space and comments around it.
pub(super) fn trimmed(raw: &RawValue) -> &str {
    let text = raw.get_ron().trim();
    // Comments are rare; finding their end takes a second look at the whole piece.
    if text.starts_with('/') || text.ends_with('/') || text.contains("//") { raw.trim().get_ron() } else { text }
}
