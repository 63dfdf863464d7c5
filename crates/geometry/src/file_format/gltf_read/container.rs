//! The file around the geometry: binary container, JSON, buffers and accessors, every length checked before it is used.

use base64::Engine as _;
use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::validation::Checked;
use gltf_json::{Accessor, Index, Root, buffer};
use std::borrow::Cow;

use super::{FORMAT, malformed};
use crate::file_format::ReadError;

/// Extensions that change how a file looks and not where its triangles are.
const HARMLESS: [&str; 5] = ["KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_", "KHR_animation_"];

/// A glTF document and the bytes its accessors point into.
pub(super) struct Container<'a> {
    pub(super) root: Root,
    /// The buffers that could be found, in order; an error where one lies elsewhere.
    buffers: Vec<Result<Cow<'a, [u8]>, ReadError>>,
}

/// Items of an accessor: `count` of them, `stride` bytes apart, each wholly inside `bytes`.
pub(super) struct Items<'a> {
    bytes: &'a [u8],
    stride: usize,
    pub(super) count: usize,
    component: ComponentType,
    normalized: bool,
}

impl<'a> Container<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, ReadError> {
        if bytes.is_empty() {
            return Err(ReadError::Empty { format: FORMAT });
        }
        let (json, binary) = if bytes.starts_with(b"glTF") { split(bytes)? } else { (bytes, None) };
        let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
        let root = Root::from_slice(json).map_err(|error| malformed("JSON", error.to_string()))?;
        if root.asset.version.split('.').next() != Some("2") {
            return Err(ReadError::Unsupported {
                format: FORMAT,
                what: format!("version {:?}", root.asset.version),
                remedy: "export as glTF 2.0",
            });
        }
        let harmful =
            root.extensions_required.iter().find(|name| !HARMLESS.iter().any(|prefix| name.starts_with(prefix)));
        if let Some(name) = harmful {
            return Err(ReadError::Unsupported {
                format: FORMAT,
                what: format!("the extension {name}"),
                remedy: "export without compression and quantisation",
            });
        }
        let buffers = root.buffers.iter().enumerate().map(|(index, buffer)| contents(index, buffer, binary)).collect();
        Ok(Self { root, buffers })
    }

    /// The items of an accessor of the type and one of the component types given.
    pub(super) fn items(
        &self,
        index: Index<Accessor>,
        type_: Type,
        components: &[ComponentType],
        place: &str,
    ) -> Result<Items<'_>, ReadError> {
        let place = format!("{place}, accessor {}", index.value());
        let accessor = self.root.get(index).ok_or_else(|| malformed(&place, "it is not there"))?;
        let unsupported =
            |what: &str, remedy| ReadError::Unsupported { format: FORMAT, what: format!("{what} ({place})"), remedy };
        if accessor.sparse.is_some() {
            return Err(unsupported("sparse data", "export without sparse accessors"));
        }
        let Some(view) = accessor.buffer_view else {
            return Err(unsupported("data without a buffer view, as compression leaves it", "export uncompressed"));
        };
        let view = self
            .root
            .get(view)
            .ok_or_else(|| malformed(&place, format!("buffer view {} is not there", view.value())))?;
        let (Checked::Valid(GenericComponentType(component)), Checked::Valid(found)) =
            (accessor.component_type, accessor.type_)
        else {
            return Err(malformed(&place, "its type is none that glTF knows"));
        };
        if found != type_ || !components.contains(&component) {
            return Err(malformed(&place, format!("{found:?} of {component:?} does not suit its use")));
        }
        let size = component.size() * found.multiplicity();
        let bytes = self.view(view, &place)?;
        let offset = usize::try_from(accessor.byte_offset.unwrap_or_default().0).unwrap_or(usize::MAX);
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        let stride = view.byte_stride.map_or(size, |stride| if stride.0 == 0 { size } else { stride.0 });
        let bytes = bytes.get(offset..).unwrap_or_default();
        let needed = count.checked_sub(1).and_then(|last| last.checked_mul(stride)).and_then(|at| at.checked_add(size));
        if stride < size {
            return Err(malformed(&place, format!("a stride of {stride} bytes for items of {size}")));
        }
        if needed.is_none_or(|needed| needed > bytes.len()) {
            return Err(malformed(&place, format!("{count} items do not fit its buffer view, or there are none")));
        }
        Ok(Items { bytes, stride, count, component, normalized: accessor.normalized })
    }

    fn view(&self, view: &buffer::View, place: &str) -> Result<&[u8], ReadError> {
        let buffer = match self.buffers.get(view.buffer.value()) {
            Some(Ok(buffer)) => buffer,
            Some(Err(error)) => return Err(error.clone()),
            None => return Err(malformed(place, format!("buffer {} is not there", view.buffer.value()))),
        };
        let start = usize::try_from(view.byte_offset.unwrap_or_default().0).unwrap_or(usize::MAX);
        let length = usize::try_from(view.byte_length.0).unwrap_or(usize::MAX);
        start
            .checked_add(length)
            .and_then(|end| buffer.get(start..end))
            .ok_or_else(|| malformed(place, "its buffer view is larger than the buffer"))
    }
}

impl Items<'_> {
    fn item(&self, index: usize) -> &[u8] {
        self.bytes.get(index * self.stride..).unwrap_or_default()
    }

    /// Component `k` of an item as a number; integers are normalised where the accessor says so.
    fn number(&self, item: &[u8], k: usize) -> f32 {
        let scale = |value: u32, most: u32| {
            if self.normalized { value as f32 / most as f32 } else { value as f32 }
        };
        match self.component {
            ComponentType::F32 => {
                item.get(4 * k..).and_then(|b| b.first_chunk()).map_or(0.0, |b| f32::from_le_bytes(*b))
            }
            ComponentType::U8 => scale(unsigned(item, k, 1), u32::from(u8::MAX)),
            _ => scale(unsigned(item, k, 2), u32::from(u16::MAX)),
        }
    }

    /// Item `index` as `N` numbers.
    pub(super) fn numbers<const N: usize>(&self, index: usize) -> [f32; N] {
        let item = self.item(index);
        std::array::from_fn(|k| self.number(item, k))
    }

    /// Item `index` as an index.
    pub(super) fn index(&self, index: usize) -> u32 {
        unsigned(self.item(index), 0, self.component.size())
    }
}

/// Component `k`, of `size` bytes, as an unsigned integer.
fn unsigned(item: &[u8], k: usize, size: usize) -> u32 {
    let bytes = item.get(k * size..(k + 1) * size).unwrap_or_default();
    bytes.iter().rev().fold(0, |value, byte| (value << 8) | u32::from(*byte))
}

/// JSON and, where it is there, the binary chunk of a `.glb`.
fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), ReadError> {
    let number = |at: usize| bytes.get(at..).and_then(|b| b.first_chunk()).map(|b| u32::from_le_bytes(*b));
    let truncated = || malformed("header", "the file is cut off: export or copy it again");
    let version = number(4).ok_or_else(truncated)?;
    if version != 2 {
        return Err(ReadError::Unsupported {
            format: FORMAT,
            what: format!("container version {version}"),
            remedy: "export as glTF 2.0",
        });
    }
    let length = number(8).ok_or_else(truncated)? as usize;
    if length > bytes.len() {
        return Err(malformed("header", format!("{length} bytes announced and {} there: it is cut off", bytes.len())));
    }
    let chunk = |at: usize| {
        let size = number(at).ok_or_else(truncated)? as usize;
        let kind = bytes.get(at + 4..at + 8).ok_or_else(truncated)?;
        let end = (at + 8).checked_add(size).ok_or_else(truncated)?;
        let contents = bytes.get(at + 8..end).ok_or_else(truncated)?;
        Ok((kind, contents, end))
    };
    let (kind, json, mut at) = chunk(12)?;
    if kind != b"JSON" {
        return Err(malformed("header", "the first chunk is not JSON"));
    }
    // Chunks of other kinds are to be skipped (glTF 2.0, 4.4.3).
    while at < length {
        let (kind, contents, end) = chunk(at)?;
        if kind == b"BIN\0" {
            return Ok((json, Some(contents)));
        }
        at = end;
    }
    Ok((json, None))
}

/// The bytes of a buffer.
fn contents<'a>(
    index: usize,
    buffer: &gltf_json::Buffer,
    binary: Option<&'a [u8]>,
) -> Result<Cow<'a, [u8]>, ReadError> {
    let place = format!("buffer {index}");
    let bytes: Cow<'a, [u8]> = match &buffer.uri {
        Some(uri) => {
            let Some(data) = uri.strip_prefix("data:") else {
                return Err(ReadError::ExternalBuffer { buffer: index, uri: uri.chars().take(120).collect() });
            };
            let (_, data) =
                data.split_once(";base64,").ok_or_else(|| malformed(&place, "its embedded data is not base64"))?;
            base64::engine::general_purpose::STANDARD
                .decode(data)
                .map_err(|error| malformed(&place, format!("its embedded data is not base64: {error}")))?
                .into()
        }
        None if index == 0 => binary.ok_or_else(|| malformed(&place, "it has no data"))?.into(),
        None => return Err(malformed(&place, "it has no data")),
    };
    let length = usize::try_from(buffer.byte_length.0).unwrap_or(usize::MAX);
    if length > bytes.len() {
        return Err(malformed(&place, format!("{length} bytes announced and {} there", bytes.len())));
    }
    Ok(match bytes {
        Cow::Borrowed(bytes) => Cow::Borrowed(&bytes[..length]),
        Cow::Owned(mut bytes) => {
            bytes.truncate(length);
            Cow::Owned(bytes)
        }
    })
}
