//! What travels along a wire: an immutable, content-hashed value of an open set of types.

use std::any::{Any, TypeId};
use std::fmt;
use std::sync::Arc;

use xxhash_rust::xxh3::Xxh3;

/// A type that can travel along a wire. Implement it for your own types; the engine needs no change.
pub trait Wire: Any + Send + Sync {
    /// Name shown to artists and written in messages: `kebab-case`, unique in a catalogue.
    const NAME: &'static str;
    /// One line on what such a value is.
    const DESCRIPTION: &'static str;

    /// Feeds everything that makes two values different into the hasher. Equal content must give equal hashes on
    /// every machine: no addresses, no hash map order.
    fn hash_content(&self, hasher: &mut ContentHasher);

    /// Bytes held, heap included; what the memo's budget counts. An estimate is enough.
    fn byte_size(&self) -> usize;

    /// A few words on the content, such as "5 curves, 320 points".
    fn summary(&self) -> String;
}

/// Identity of a wire type at run time.
#[derive(Clone, Copy)]
pub struct WireType(&'static WireDescription);

/// Apart from [`WireType`], because every value and every link carries one of those.
struct WireDescription {
    id: TypeId,
    name: &'static str,
    description: &'static str,
}

trait Described: Wire {
    const WIRE: WireDescription =
        WireDescription { id: TypeId::of::<Self>(), name: Self::NAME, description: Self::DESCRIPTION };
}

impl<T: Wire> Described for T {}

impl WireType {
    /// The type of wires that carry `T`.
    pub fn of<T: Wire>() -> Self {
        Self(&T::WIRE)
    }

    /// Name, such as `curves`.
    pub fn name(&self) -> &'static str {
        self.0.name
    }

    /// One line on what such a value is.
    pub fn description(&self) -> &'static str {
        self.0.description
    }
}

impl PartialEq for WireType {
    fn eq(&self, other: &Self) -> bool {
        self.0.id == other.0.id
    }
}

impl Eq for WireType {}

impl fmt::Debug for WireType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Display for WireType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Hash of a value's type and content: equal values have equal hashes on every machine and in every run (xxh3, 128
/// bit; not meant to withstand an adversary).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ContentHash(pub u128);

impl fmt::Display for ContentHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

/// Collects content into a [`ContentHash`]. Lengths are hashed with lists, so that neighbouring lists can't be
/// confused.
pub struct ContentHasher(Xxh3);

impl ContentHasher {
    pub(crate) fn new(domain: &str) -> Self {
        let mut hasher = Self(Xxh3::new());
        hasher.text(domain);
        hasher
    }

    pub(crate) fn finish(&self) -> ContentHash {
        ContentHash(self.0.digest128())
    }

    /// Hash of raw bytes, a file's say.
    pub fn of_bytes(bytes: &[u8]) -> ContentHash {
        ContentHash(xxhash_rust::xxh3::xxh3_128(bytes))
    }

    /// A number; the sign of zero counts.
    pub fn number(&mut self, number: f64) {
        self.0.update(&number.to_bits().to_le_bytes());
    }

    /// A list of numbers.
    pub fn numbers(&mut self, numbers: &[f64]) {
        self.integer(numbers.len() as u64);
        if cfg!(target_endian = "little") {
            self.0.update(bytemuck::cast_slice(numbers));
        } else {
            numbers.iter().for_each(|n| self.number(*n));
        }
    }

    /// A list of unsigned 32-bit integers, indices say.
    pub fn indices(&mut self, indices: &[u32]) {
        self.integer(indices.len() as u64);
        if cfg!(target_endian = "little") {
            self.0.update(bytemuck::cast_slice(indices));
        } else {
            indices.iter().for_each(|n| self.0.update(&n.to_le_bytes()));
        }
    }

    /// An integer, a count, a flag.
    pub fn integer(&mut self, integer: u64) {
        self.0.update(&integer.to_le_bytes());
    }

    /// A text with its length.
    pub fn text(&mut self, text: &str) {
        self.integer(text.len() as u64);
        self.0.update(text.as_bytes());
    }

    /// Another value's hash.
    pub fn hash(&mut self, hash: ContentHash) {
        self.0.update(&hash.0.to_le_bytes());
    }
}

trait ErasedWire: Send + Sync {
    fn as_any(&self) -> &dyn Any;
    fn summary(&self) -> String;
}

impl<T: Wire> ErasedWire for T {
    fn as_any(&self) -> &dyn Any {
        self
    }

    fn summary(&self) -> String {
        Wire::summary(self)
    }
}

/// Hashes keys that are well mixed already (content hashes) or small and dense (nodes), where the standard hash
/// would cost more than the look-up.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct KeyHasher(u64);

/// For maps keyed by content hashes or nodes. Nothing may depend on their order.
pub(crate) type KeyHasherBuilder = std::hash::BuildHasherDefault<KeyHasher>;

impl std::hash::Hasher for KeyHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(u64::from(*byte)));
    }

    fn write_u32(&mut self, key: u32) {
        self.write_u64(u64::from(key));
    }

    fn write_u64(&mut self, key: u64) {
        // 2^64 divided by the golden ratio: neighbouring keys end up far apart.
        self.0 = (self.0.rotate_left(5) ^ key).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }

    fn write_u128(&mut self, key: u128) {
        let [low, high] = [key, key >> 64].map(|half| u64::try_from(half & u128::from(u64::MAX)).unwrap_or(0));
        self.write_u64(low ^ high);
    }
}

/// An immutable value with its type and content hash. Cloning shares the content.
#[derive(Clone)]
pub struct Value {
    wire: WireType,
    hash: ContentHash,
    bytes: usize,
    data: Arc<dyn ErasedWire>,
}

impl Value {
    /// Wraps a value and hashes it, once.
    pub fn new<T: Wire>(data: T) -> Self {
        let mut hasher = ContentHasher::new(T::NAME);
        data.hash_content(&mut hasher);
        Self { wire: WireType::of::<T>(), hash: hasher.finish(), bytes: data.byte_size(), data: Arc::new(data) }
    }

    /// Its type.
    pub fn wire(&self) -> WireType {
        self.wire
    }

    /// Hash of type and content.
    pub fn hash(&self) -> ContentHash {
        self.hash
    }

    /// Bytes held.
    pub fn byte_size(&self) -> usize {
        self.bytes
    }

    /// A few words on the content.
    pub fn summary(&self) -> String {
        self.data.summary()
    }

    /// The content, where it is of type `T`.
    pub fn get<T: Wire>(&self) -> Option<&T> {
        self.data.as_any().downcast_ref()
    }
}

impl fmt::Debug for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}({})", self.wire, self.summary())
    }
}

impl PartialEq for Value {
    fn eq(&self, other: &Self) -> bool {
        self.wire == other.wire && self.hash == other.hash
    }
}

impl Wire for f64 {
    const NAME: &'static str = "number";
    const DESCRIPTION: &'static str = "A number.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.number(*self);
    }

    fn byte_size(&self) -> usize {
        size_of::<Self>()
    }

    fn summary(&self) -> String {
        self.to_string()
    }
}

impl Wire for i64 {
    const NAME: &'static str = "integer";
    const DESCRIPTION: &'static str = "A whole number.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.integer(self.cast_unsigned());
    }

    fn byte_size(&self) -> usize {
        size_of::<Self>()
    }

    fn summary(&self) -> String {
        self.to_string()
    }
}

impl Wire for bool {
    const NAME: &'static str = "boolean";
    const DESCRIPTION: &'static str = "Yes or no.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.integer(u64::from(*self));
    }

    fn byte_size(&self) -> usize {
        size_of::<Self>()
    }

    fn summary(&self) -> String {
        self.to_string()
    }
}

impl Wire for String {
    const NAME: &'static str = "text";
    const DESCRIPTION: &'static str = "A text.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.text(self);
    }

    fn byte_size(&self) -> usize {
        size_of::<Self>() + self.len()
    }

    fn summary(&self) -> String {
        format!("{self:?}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_tell_type_and_content_apart() {
        assert_eq!(Value::new(1.0).hash(), Value::new(1.0).hash());
        assert_ne!(Value::new(1.0).hash(), Value::new(2.0).hash());
        assert_ne!(Value::new(0_i64).hash(), Value::new(false).hash());
        let mut two_lists = ContentHasher::new("");
        two_lists.numbers(&[1.0]);
        two_lists.numbers(&[2.0, 3.0]);
        let mut other_split = ContentHasher::new("");
        other_split.numbers(&[1.0, 2.0]);
        other_split.numbers(&[3.0]);
        assert_ne!(two_lists.finish(), other_split.finish());
    }

    #[test]
    fn the_hash_is_the_same_on_every_machine() {
        // A change here invalidates every stored hash: bump the version of the file that stores them.
        assert_eq!(Value::new(1.5).hash().to_string(), "c43eae32fbb2cb7c3d761ce55486884e");
    }

    #[test]
    fn a_value_is_read_as_its_own_type_only() {
        let value = Value::new(2.5);
        assert_eq!(value.get::<f64>(), Some(&2.5));
        assert_eq!(value.get::<i64>(), None);
    }
}
