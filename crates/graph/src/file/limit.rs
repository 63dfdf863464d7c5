//! How large a graph's file may be.

/// Bytes of the largest file that is read, 16 MiB: some hundred thousand nodes' worth of text, or as many points of strokes.
pub const MOST_BYTES: usize = 16 << 20;
